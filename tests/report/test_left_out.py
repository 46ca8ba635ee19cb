"""Welds that are not assessed in everything a result is looked at with: they have a reason and no numbers."""

import json
import shutil

import numpy as np
import pandas as pd
import pytest

from fatigue.diagnose import diagnose
from fatigue.errors import DataError
from fatigue.report.files.browser import find_browser
from fatigue.report.files.export import write_csv
from fatigue.report.files.pdf import print_pdf
from fatigue.report.files.vtp import write_vtp
from fatigue.report.files.workbook.book import write_xlsx
from fatigue.report.page import report_page
from fatigue.results import json_ready
from fatigue.results.summary import result_summary
from fatigue.verify.recount import recount
from tests.report.converted import NAME, NOTHING_KNOWN, REASON, assessed
from tests.report.reading import Page, cells_of

CASES = {
    "excluded and candidate": ([{"weld": NAME}, {"status": "excluded", "reason": REASON}, {}, NOTHING_KNOWN], None),
    "excluded and bounds": ([{"status": "excluded", "reason": REASON}, {"weld": NAME}, {}, NOTHING_KNOWN], 1.0),
    "all but one": (
        [{"status": "excluded", "reason": REASON}, {"status": "candidate"}, {"weld": NAME}, NOTHING_KNOWN],
        None,
    ),
    "toes on one face": (
        [
            {"weld": NAME, "surface": "bottom"},
            {"surface": "top"},
            {"status": "excluded", "reason": REASON},
            NOTHING_KNOWN,
        ],
        None,
    ),
}


@pytest.fixture(scope="module", params=CASES)
def result(request, tmp_path_factory):
    """Result of an edited conversion; read it, never write to it."""
    changes, share = CASES[request.param]
    return assessed(tmp_path_factory.mktemp("converted"), changes, share)


@pytest.fixture
def copy(result, tmp_path):
    """Copy the result and its case, to be written to."""
    shutil.copytree(result.parent, tmp_path / "all")
    return tmp_path / "all" / "result"


def welds_of(folder):
    """Table of welds, those assessed and those not."""
    welds = pd.read_parquet(folder / "welds.parquet")
    return welds[welds.status == "assessed"], welds[welds.status != "assessed"]


def test_the_cases_are_what_they_say(result):
    """Every weld has a row and a name of its own; those left out have a reason; bounds are among the points."""
    assessed_rows, left_out = welds_of(result)
    assert len(assessed_rows) + len(left_out) == 4
    assert pd.concat([assessed_rows, left_out]).weld.is_unique
    assert NAME in set(assessed_rows.weld)
    assert REASON in set(left_out.reason)
    assert left_out.reason.ne("").all()
    unknown = left_out[left_out.weld == "gone"].iloc[0]
    assert (unknown.reason, pd.isna(unknown.nodes), pd.isna(unknown.length_mm)) == ("candidate", True, True)
    share = json.loads((result / "provenance.json").read_text())["rules"]["screening"]["share_of_limit"]
    assert (pd.read_parquet(result / "nodes.parquet").screened != "").any() == (share > 0.0)


def test_the_page_lists_them_with_their_reason(result):
    """No number is made up, none has a decimal point it should not have, no name becomes markup."""
    page = Page((result / "report.html").read_text(encoding="utf-8"))
    assessed_rows, left_out = welds_of(result)
    head, *rows = page.tables["weld-register"]
    by_name = {row[0]: dict(zip(head, row, strict=True)) for row in rows}
    assert set(by_name) == {*assessed_rows.weld, *left_out.weld}
    for row in left_out.itertuples():
        shown = [cell for name, cell in by_name[row.weld].items() if name not in ("weld", "description", "status")]
        assert by_name[row.weld]["status"] == ("" if row.reason == "candidate" else "excluded: ") + row.reason
        assert {*shown[:5], *shown[8:]} == {"–"}
    nodes = {by_name[name]["nodes"] for name in assessed_rows.weld}
    assert nodes == {"7"}
    assert not any(tag == "script" and "alert" in str(given) for tag, given in page.tags)
    assert "nan" not in " ".join(page.text).lower().split()
    worst = assessed_rows.sort_values("utilisation").iloc[-1]
    assert f"node {worst.worst_node:.0f}, {worst.worst_surface} face" in " ".join(page.text)


def test_workbook_and_csv_leave_their_numbers_empty(copy):
    """Whole numbers stay whole beside empty cells, flags that nobody knows are empty, reasons are texts."""
    pytest.importorskip("xlsxwriter")
    cells = cells_of(write_xlsx(copy), "welds")
    assessed_rows, left_out = welds_of(copy)
    by_utilisation = assessed_rows.sort_values("utilisation", ascending=False, kind="stable")
    for number, row in enumerate([*by_utilisation.itertuples(), *left_out.itertuples()], start=2):
        assert cells[f"A{number}"] == row.weld
        assert cells.get(f"H{number}", "") == row.reason
        assert (f"C{number}" in cells) == (f"D{number}" in cells) == (row.status == "assessed")
    write_csv(copy)
    written = pd.read_csv(copy / "welds.csv", dtype=str, keep_default_na=False)
    assert written.worst_node.tolist() == [*(str(int(n)) for n in assessed_rows.worst_node), *[""] * len(left_out)]
    assert written.fulfilled.isin(["True", "False", ""]).all()
    assert set(written.reason) == {
        *left_out.reason.where(~left_out.reason.str.startswith("="), "'" + left_out.reason),
        "",
    }


def test_the_words_for_them(tmp_path):
    """Left out is not excluded; an excluded weld without a reason has none, and a reason may begin with any word."""
    changes = [{"status": "excluded"}, {"status": "excluded", "reason": "candidates were ruled out"}, {}]
    result = assessed(tmp_path, changes)
    page = Page((result / "report.html").read_text(encoding="utf-8"))
    statuses = {row[7] for row in page.tables["weld-register"][1:]}
    assert statuses == {"assessed", "excluded", "excluded: candidates were ruled out"}
    assert "2 welds are excluded" in " ".join(" ".join(page.text).split())
    folder = assessed(tmp_path, [{"status": "candidate", "reason": "two\nlines"}, {}, {}], name="another")
    page = Page((folder / "report.html").read_text(encoding="utf-8"))
    assert "1 weld is not assessed" in " ".join(" ".join(page.text).split())
    assert "Not assessed: 1 weld\n" in result_summary(folder, top=1).as_text()
    assert "candidate: two lines\n" in result_summary(folder, top=1).as_text()
    assert "The worst point\n" in result_summary(folder, top=1).as_text()


def test_the_picture_has_the_assessed_lines(copy):
    """One line for each weld that was assessed."""
    assert f'NumberOfLines="{len(welds_of(copy)[0])}"' in write_vtp(copy).read_text()


def test_show_tells_them_and_their_reasons(result):
    """In the text, in JSON, and when one is asked for."""
    found = result_summary(result, top=3)
    assessed_rows, left_out = welds_of(result)
    assert set(found.welds.weld) == set(assessed_rows.weld)
    assert found.welds.worst_node.dtype == np.int64
    text = found.as_text()
    assert f"Not assessed: {len(left_out)} welds" in text
    assert REASON in text
    record = json.loads(json.dumps(json_ready(found.as_record()), allow_nan=False))
    assert {row["weld"]: row["reason"] for row in record["not_assessed"]} == dict(
        zip(left_out.weld, left_out.reason, strict=True)
    )
    with pytest.raises(DataError, match="weld 'gone' is not assessed: candidate"):
        result_summary(result, top=3, only=["gone"])


def test_the_recount_agrees(result):
    """It reads the register by itself."""
    found = recount(result, sample=5)
    assert found.passed, found.as_text()
    assert "reason" in {check.column for check in found.columns}


def test_the_recount_misses_a_reason(copy):
    """A row that was left out and is gone from the result, or has another reason, is found."""
    welds = pd.read_parquet(copy / "welds.parquet")
    welds.loc[welds.reason == REASON, "reason"] = "none"
    welds.to_parquet(copy / "welds.parquet")
    found = recount(copy, sample=1)
    assert [check.column for check in found.columns if not check.passed] == ["reason"]


def test_a_diagnosis_and_its_page(copy):
    """The diagnosis reads the same welds, and its page is written."""
    found = diagnose(copy)
    assert NAME in found.as_text()
    assert NAME in " ".join(Page(report_page(copy)).text)


def test_printed(tmp_path):
    """The page prints, the reasons included."""
    try:
        find_browser()
    except DataError:
        pytest.skip("no browser")
    folder = assessed(tmp_path, *CASES["all but one"])
    print_pdf(folder / "report.html", folder / "report.pdf")
    assert (folder / "report.pdf").read_bytes().startswith(b"%PDF")
