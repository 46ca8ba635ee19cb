"""What page and command line say beside the verdict: other assumptions, shear at the toe, checks beside it."""

import json
import re
import shutil
from string import ascii_uppercase

import pandas as pd
import pytest
from click.testing import CliRunner

from fatigue.assess import assess
from fatigue.cli import cli
from fatigue.report.files.workbook.book import write_xlsx
from fatigue.report.files.workbook.sheet import heading, leading
from fatigue.report.page import report_page
from fatigue.report.wording import life
from fatigue.results import TABLES, read_table
from fatigue.shown.digits import results
from tests.checks_case import write_checks_case
from tests.older_result import without_hashes
from tests.report.reading import Page, cells_of
from tests.small_case import small_case


@pytest.fixture(scope="module")
def checked(tmp_path_factory):
    """Result of the small case with all checks, at a target between the verdicts of its variants."""
    folder = tmp_path_factory.mktemp("checked")
    path = write_checks_case(folder / "case")
    path.write_text(path.read_text().replace("target_km = 1000000.0", "target_km = 500.0"))
    assess(path, folder / "result", threads=1, report=False)
    return folder / "result"


@pytest.fixture(scope="module")
def checked_page(checked):
    """Its report."""
    return Page(report_page(checked))


@pytest.fixture(scope="module")
def plain(tmp_path_factory):
    """Result of a case that asks for nothing beside the toe, whose verdicts hold under any assumption."""
    folder = tmp_path_factory.mktemp("plain")
    case = small_case(seconds=4.0)
    case.mission["target_km"] = 1.0
    assess(case.write(folder / "case"), folder / "result", threads=1, report=False)
    return folder / "result"


def shown(folder, *options) -> str:
    """What ``fatigue show`` prints."""
    done = CliRunner().invoke(cli, ["show", str(folder), *options])
    assert done.exit_code == 0, done.output
    return done.stdout


def test_welds_whose_verdict_changes_are_on_page_one(checked, checked_page):
    """Every number of the matrix is that of the table; a changed verdict has its sign."""
    found = read_table(checked, "sensitivity").to_pandas()
    head, *rows = checked_page.tables["sensitivity"]
    flipping = found.loc[found["flips"], "weld"].unique()
    assert {row[0] for row in rows} == {*flipping} != set()
    for row in rows:
        of_weld = found[found["weld"] == row[0]].set_index("variant")
        for name, variant in (("mean − 3σ", "survival_3sigma"), ("damage limit 0.5", "damage_limit_0.5")):
            cell, entry = row[head.index(name)], of_weld.loc[variant]
            assert cell.endswith(results([entry["utilisation"]])[0])
            assert cell.startswith("✕") == entry["flips"]
    assert "No weld's verdict changes under: " in checked_page.words


def test_show_and_json_say_the_same(checked):
    """The variants that change a verdict with their welds; the keys that were there stay."""
    found = read_table(checked, "sensitivity").to_pandas()
    record, text = json.loads(shown(checked, "--json")), shown(checked)
    assert {"title", "assumptions", "target_km", "fulfilled", "welds", "not_assessed", "points"} < set(record)
    for entry in record["sensitivity"]:
        of_variant = found[found["variant"] == entry["variant"]].set_index("weld")
        assert {one["weld"] for one in entry["changes"]} == {*of_variant.index[of_variant["flips"]]}
        for weld, one in entry["welds"].items():
            assert one["utilisation"] == pytest.approx(of_variant.loc[weld, "utilisation"])
    assert "Verdict under other assumptions" in text
    assert "damage_limit_0.5: damage sum of 0.5 allowed" in text
    of_a = json.loads(shown(checked, "--json", "--weld", "A"))["sensitivity"]
    (only,) = {one["weld"] for entry in of_a for one in entry["changes"]}
    assert only == "A"


def test_checks_are_on_the_page_with_their_worst_place(checked, checked_page):
    """Each check of a weld has one row: the place that uses up most; a missed one is named first."""
    checks = pd.read_parquet(checked / "checks.parquet")
    keys = ["weld", "point", "check", "side", "component", "curve"]
    toes = checks[checks["check"] != "endurance"]
    worst = toes.groupby(keys, dropna=False)["utilisation_stress"].max()
    assert len(checked_page.tables["checks"]) - 1 == len(worst)
    assert {row[3] for row in checked_page.tables["checks"][1:]} == {*results(list(worst))}
    assert "Not met : B: root" in checked_page.words
    assert "these decide verdict and exit code: throat, across" in checked_page.words
    assert "root" in {row[0] for row in checked_page.tables["weld-1-checks"]}
    assert "Checks beside the toe that are not met (utilisation of the stress): B: throat_root" in shown(checked)
    assert json.loads(shown(checked, "--json"))["checks_missed"][0]["check"] == "throat_root"


def test_endurance_and_miner_life_stand_side_by_side(checked, checked_page):
    """The endurance of a weld has the life of its toe beside it."""
    welds = pd.read_parquet(checked / "welds.parquet").set_index("weld")
    head, *rows = checked_page.tables["endurance"]
    assert {row[head.index("weld")] for row in rows} == {"A", "B"}
    for row in rows:
        assert row[head.index("Miner life [km]")] == life(welds.loc[row[0], "life_km"])


def test_the_register_has_the_worst_check(checked_page):
    """Toe and root stand side by side."""
    head, *rows = checked_page.tables["weld-register"]
    of_b = next(row for row in rows if row[0] == "B")
    assert of_b[head.index("worst check beside the toe")] == "root"
    assert of_b[head.index("joint")] == "T"


def test_all_models_of_shear_stand_side_by_side(checked, checked_page):
    """Of each weld the point with the largest sum, with every sum of the table of nodes."""
    nodes = pd.read_parquet(checked / "nodes.parquet").query("toe")
    head, *rows = checked_page.tables["shear"]
    columns = {
        "normal stress": "utilisation",
        "path, range": "utilisation_path_range",
        "path, length": "utilisation_path_length",
        "ASME factor": "utilisation_asme",
    }
    largest = nodes[list(columns.values())].max(axis=1)
    for row in rows:
        point = nodes.loc[largest[nodes["weld"] == row[0]].idxmax()]
        assert [row[head.index(name)] for name in columns] == [
            results([point[column]])[0] for column in columns.values()
        ]
    assert "Length and moment are not examined where a bound settles a point" in checked_page.words


def test_nothing_appears_where_nothing_was_asked(plain):
    """No sections of checks, no columns of them, and one line for steady verdicts."""
    page = Page(report_page(plain))
    assert not {"checks", "endurance", "sensitivity", "weld-1-checks"} & set(page.tables)
    assert "worst check beside the toe" not in page.tables["weld-register"][0]
    assert "stress category" not in page.tables["weld-register"][0]
    assert "Checks beside the toe" not in page.words
    assert "No weld's verdict changes under" in page.words
    text = shown(plain)
    assert "Checks beside" not in text
    assert "* the verdict changes" not in text


def test_a_result_without_the_table_is_shown_all_the_same(plain, tmp_path):
    """As older versions wrote it: nothing is said of other assumptions."""
    folder = without_hashes(shutil.copytree(plain, tmp_path / "older"))
    (folder / "sensitivity.parquet").unlink()
    assert "other assumptions (" not in shown(folder)
    assert json.loads(shown(folder, "--json"))["sensitivity"] is None
    assert "when one assumption is changed" not in Page(report_page(folder)).words


def test_sensitivity_and_checks_are_sheets_of_the_workbook(checked, tmp_path, monkeypatch):
    """With head, unit and numbers of the table; one that is too long says where its rows are."""
    pytest.importorskip("xlsxwriter")
    book = write_xlsx(checked, tmp_path)
    for name in ("band", "sensitivity", "checks"):
        cells = cells_of(book, name)
        table = read_table(checked, name).to_pandas()
        if "utilisation" in table:
            table = table.sort_values("utilisation", ascending=False, kind="stable", na_position="last")
        rows = {int(re.sub("[A-Z]", "", address)) for address in cells}
        assert rows == set(range(1, len(table) + 2))
        for letter, column in zip(ascii_uppercase, leading(TABLES[name]), strict=False):
            assert cells[f"{letter}1"].split("\n")[0] == heading(column)[0]
            if column.type == "float":
                found = [cells.get(f"{letter}{i}", float("nan")) for i in range(2, len(table) + 2)]
                finite = table[column.name].astype(float).replace(float("inf"), float("nan"))
                assert [f for f in found if not isinstance(f, str)] == pytest.approx(
                    [f for f, of in zip(finite, found, strict=True) if not isinstance(of, str)], nan_ok=True
                )
    meanings = cells_of(book, "columns").values()
    assert {"sensitivity", "checks", "utilisation_stress", "basis"} <= set(meanings)

    checks = len(read_table(checked, "checks"))
    monkeypatch.setattr("fatigue.report.files.workbook.book._MOST_ROWS", checks - 1)
    assert len(read_table(checked, "nodes")) < checks
    assert list(cells_of(write_xlsx(checked, tmp_path), "checks").values()) == [
        f"{checks} rows do not fit into a sheet: use checks.parquet or CSV"
    ]
