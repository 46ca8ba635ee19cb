"""Evidence on the page: what was run and what it found, what was not, of this very result."""

import shutil

import pytest

from fatigue.assess import assess
from fatigue.report.page import report_page
from fatigue.report.sections.evidence.recount import read_recount
from fatigue.results import RECOUNT, read_provenance, strangers, write_provenance
from fatigue.verify.recount import keep, recount
from tests.command_line import fatigue
from tests.report.reading import Page
from tests.small_case import sine_only


@pytest.fixture(scope="module")
def verified(tmp_path_factory):
    """A case, and its result with a recount."""
    folder = tmp_path_factory.mktemp("evidence")
    assess(sine_only().write(folder / "case"), folder / "result", recounts=True)
    return folder


@pytest.fixture
def result(verified, tmp_path):
    """The result copied, to be written to, beside its case."""
    shutil.copytree(verified, tmp_path / "copy")
    return tmp_path / "copy" / "result"


def rows(html):
    """Rows of the table of evidence by their subject."""
    return {row[0]: row[1:] for row in Page(html).tables["evidence-table"][1:]}


def test_assess_with_a_recount_shows_it(verified):
    """The outcome lies beside the result, is one of its documents, and stands on the page that was written with it."""
    folder = verified / "result"
    record = read_provenance(folder)
    kept = read_recount(folder, record)
    assert kept["passed"]
    assert 20 < kept["points"] <= kept["points_in_all"] == 28
    assert not strangers(folder, record)
    state, finding = rows((folder / "report.html").read_text(encoding="utf-8"))["Recount by independent code"]
    assert state == "✓ in order"
    assert finding.startswith(f"{kept['points']} of 28 points counted again from the input files: all ")


def test_what_was_not_run_says_so(result):
    """Without recount, known values and conversion nothing is claimed."""
    (result / RECOUNT).unlink()
    found = rows(report_page(result))
    assert found["Recount by independent code"][0] == "– not run"
    assert found["Known values"][0] == "– not run"
    assert found["Audit of the import"][0] == "– nothing on record"
    state, finding = found["Modal basis"]
    assert state == "– not run"
    assert finding.startswith("modes: 2 normal and 1 interface; how complete it is for these welds says `fatigue basis")
    assert found["Tables against each other"][0] == "✓ in order"


def test_a_recount_of_another_result_does_not_count(result):
    """Nor one that was edited, or that is no JSON."""
    record, path = read_provenance(result), result / RECOUNT
    assert read_recount(result, record) is not None
    assert read_recount(result, {**record, "result": "0" * 32, "outputs": []}) is None
    path.write_text(path.read_text().replace('"passed": true', '"passed": True', 1))
    assert read_recount(result, record) is None
    assert read_recount(result, {**record, "outputs": []}) is None


def test_verify_keeps_its_outcome_and_report_shows_it(result):
    """From the command line, over a result without one; the same recount gives the same bytes."""
    before = (result / RECOUNT).read_bytes()
    (result / RECOUNT).unlink()
    assert fatigue("verify", "--results", result).returncode == 0
    assert (result / RECOUNT).read_bytes() == before
    assert not strangers(result, read_provenance(result))
    assert rows(report_page(result))["Recount by independent code"][0] == "✓ in order"


def test_a_recount_that_differs_is_told(result):
    """By its columns, on the page; the outcome of a failure is kept like any other."""
    record = read_provenance(result)
    found = recount(result)
    wrong = found.columns[3]
    object.__setattr__(wrong, "difference", 1.0)
    assert not wrong.passed
    keep(result, found, record)
    state, finding = rows(report_page(result))["Recount by independent code"]
    assert state == "✕ differs"
    assert finding.endswith(f"{wrong.table}.{wrong.column} differs")


def test_an_older_result_keeps_none(result):
    """Without a hash nothing tells what a recount is of."""
    (result / RECOUNT).unlink()
    found = recount(result)
    keep(result, found, {"program": "fatigue"})
    assert not (result / RECOUNT).exists()


def test_another_assessment_takes_the_recount_away(result):
    """The outcome is of the numbers that were there."""
    case = result.parent / "case" / "case.toml"
    case.write_text(case.read_text().replace("target_km = 1000000.0", "target_km = 1100000.0"))
    assess(case, result, report=False)
    assert not (result / RECOUNT).exists()


def test_sampling_ends_and_audit(result):
    """Lights of an audit are counted and those that are not green named; ends that are not resolved are counted."""
    record = read_provenance(result)
    record["conversion"] = {
        "convention": "on_element",
        "remarks": [],
        "audit": [
            {"check": name, "light": light, "value": 1.0, "finding": "f", "remedy": "r"}
            for name, light in (("sign", "green"), ("balance", "yellow"), ("moments", "green"))
        ],
    }
    record["warnings"] = [
        {"code": "end_unresolved", "where": "A", "what": "w", "remedy": "r", "count": n} for n in (1, 2)
    ]
    write_provenance(result, record)
    found = rows(report_page(result))
    assert found["Audit of the import"] == ["! look at it", "1 yellow and 2 green: balance"]
    assert found["Weld ends"] == ["! look at it", "at 3 welds the mesh does not resolve the end that is treated"]
    assert found["Sampling"][0] == "✓ in order"
    assert found["Sampling"][1].endswith("20 are enough")


def test_every_subject_leads_somewhere(verified):
    """The links of the table are ids of the page."""
    page = Page((verified / "result" / "report.html").read_text(encoding="utf-8"))
    ids = {given.get("id") for _, given in page.tags}
    links = {given["href"][1:] for tag, given in page.tags if tag == "a" and given.get("href", "").startswith("#")}
    assert links <= ids
