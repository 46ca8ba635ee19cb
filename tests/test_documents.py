"""The documents of a result: all of one result, all that can be written, and nothing of the user's lost."""

import shutil
from pathlib import Path

import pytest

from fatigue.assess import assess
from fatigue.case import load_case
from fatigue.documents import AGAIN, CSV, missing_extras, write_documents
from fatigue.errors import DataError
from fatigue.results import (
    ASSESSED,
    OPTIONAL,
    PAGE,
    PRINT,
    WORKBOOK,
    is_derived,
    read_provenance,
    strangers,
    write_provenance,
)
from fatigue.results.belonging import carried
from tests.report.files.test_pdf import program
from tests.small_case import sine_only

UNASKED = "checks.csv"  # of a table that the case has to ask for
OF_AN_ASSESSMENT = [  # others are made later
    name for name in CSV if name.removesuffix(".csv") in ASSESSED | OPTIONAL and name != UNASKED
]
PRINTS = 'for a in "$@"; do case "$a" in --print-to-pdf=*) echo "%PDF" > "${a#*=}";; esac; done'


@pytest.fixture(scope="module")
def assessed(tmp_path_factory):
    """A case and its result."""
    folder = tmp_path_factory.mktemp("documents")
    assess(load_case(sine_only().write(folder / "case")), folder / "result", report=False)
    return folder


@pytest.fixture
def result(assessed, tmp_path):
    """Case and result copied, to be written to."""
    shutil.copytree(assessed, tmp_path / "copy")
    return tmp_path / "copy" / "result"


def test_every_document_carries_the_result_or_stands_in_the_list(result, tmp_path, monkeypatch):
    """Page, picture, print, workbook and CSV together."""
    monkeypatch.setenv("FATIGUE_BROWSER", str(program(tmp_path / "browser", PRINTS)))
    wanted = [*AGAIN, WORKBOOK, *CSV, PRINT]
    done = write_documents(result, wanted)
    assert not done.problems
    written = {path.name for path in done.written}
    assert written == {*AGAIN, WORKBOOK, *OF_AN_ASSESSMENT, PRINT}
    record = read_provenance(result)
    assert not strangers(result, record)
    assert carried(result / PRINT) == record["result"]
    assert all(is_derived(result, name, record) for name in written)
    assert not [path.name for path in result.iterdir() if path.name.startswith(".")]


def test_what_is_missing_is_known_at_once_and_the_rest_is_written(result, tmp_path, monkeypatch):
    """No browser, no xlsxwriter: both named with the remedy, page, picture and CSV written."""
    monkeypatch.setenv("FATIGUE_BROWSER", str(tmp_path / "none"))
    monkeypatch.setitem(__import__("sys").modules, "xlsxwriter", None)
    wanted = [*AGAIN, WORKBOOK, *CSV, PRINT]
    assert set(missing_extras(wanted)) == {WORKBOOK, PRINT}
    assert not missing_extras([*AGAIN, *CSV])
    done = write_documents(result, wanted)
    assert {problem.code for problem in done.problems} == {"no_xlsxwriter", "no_browser"}
    assert {path.name for path in done.written} == {*AGAIN, *OF_AN_ASSESSMENT}


def test_nothing_goes_on_that_is_refused(result, tmp_path, monkeypatch, caplog):
    """CSV is there and no browser is: one refusal, and no word of going on; with force the others are written."""
    monkeypatch.setenv("FATIGUE_BROWSER", str(tmp_path / "none"))
    write_documents(result, CSV)
    with pytest.raises(DataError, match="is there already"):
        write_documents(result, [*AGAIN, *CSV, PRINT])
    assert "Going on" not in caplog.text
    assert {path.name for path in write_documents(result, [*CSV, PRINT], force=True).written} == {*OF_AN_ASSESSMENT}
    assert "Going on with the others." in caplog.text


def test_a_browser_that_fails_costs_only_the_print(result, tmp_path, monkeypatch):
    """It is found out late; the others are there all the same."""
    monkeypatch.setenv("FATIGUE_BROWSER", str(program(tmp_path / "browser", "echo no display >&2; exit 1")))
    done = write_documents(result, [*AGAIN, PRINT])
    assert [problem.code for problem in done.problems] == ["no_pdf"]
    assert {path.name for path in done.written} == set(AGAIN)


def test_the_users_own_files_are_refused_without_force(result):
    """A page of his own, and a workbook he wrote into; with force they are replaced."""
    write_documents(result, [*AGAIN, WORKBOOK])
    (result / WORKBOOK).write_bytes((result / WORKBOOK).read_bytes() + b"mine")
    with pytest.raises(DataError, match=r"nodes\.xlsx: is there already"):
        write_documents(result, [*AGAIN, WORKBOOK])
    (result / PAGE).write_text("my own page")
    with pytest.raises(DataError, match=r"report\.html: was not written by fatigue, or was changed since"):
        write_documents(result)
    assert (result / PAGE).read_text() == "my own page"
    write_documents(result, [*AGAIN, WORKBOOK], force=True)
    assert not strangers(result, read_provenance(result))


def test_a_new_result_of_the_same_case_takes_all_documents_along(result):
    """Edited and assessed again: nothing derived from the old one is left, what is the user's stays."""
    write_documents(result, [*AGAIN, WORKBOOK, *CSV])
    for name in ("notes.txt", "notes.xlsx", "my.csv"):
        (result / name).write_text("mine")
    path = result.parent / "case" / "case.toml"
    path.write_text(path.read_text().replace("target_km = 1000000.0", "target_km = 2e6"))
    assess(load_case(path), result, report=False)
    left = {entry.name for entry in result.iterdir()}
    assert not left & {*AGAIN, WORKBOOK, *CSV}
    assert {"notes.txt", "notes.xlsx", "my.csv", "nodes.parquet", "exports.json"} <= left
    assert read_provenance(result)["mission"]["target_km"] == 2e6


def test_a_workbook_somebody_wrote_into_stops_the_next_assessment(result):
    """His notes are not thrown away; one line says so before anything is counted."""
    write_documents(result, [WORKBOOK])
    with (result / WORKBOOK).open("ab") as file:
        file.write(b"notes")
    case = load_case(result.parent / "case" / "case.toml")
    with pytest.raises(DataError, match=r"nodes\.xlsx: is there already .* or was changed since"):
        assess(case, result, report=False)
    assess(case, result, report=False, force=True)
    assert not (result / WORKBOOK).exists()


def test_mixed_tables_make_no_documents(result):
    """A provenance from elsewhere beside these tables."""
    write_provenance(result, read_provenance(result) | {"result": "0" * 32})
    with pytest.raises(DataError, match=r"nodes\.parquet: belongs to the result"):
        write_documents(result)
    assert not (result / PAGE).exists()


def test_inputs_of_the_case_are_never_overwritten(assessed, tmp_path):
    """Assessed into its own folder, whose welds.csv is an input: CSV is refused with force as well."""
    shutil.copytree(assessed / "case", tmp_path / "case")
    assess(load_case(tmp_path / "case" / "case.toml"), tmp_path / "case", report=False)
    before = (tmp_path / "case" / "welds.csv").read_bytes()
    with pytest.raises(DataError, match=r"welds\.csv: is an input of the case"):
        write_documents(tmp_path / "case", CSV, force=True)
    assert (tmp_path / "case" / "welds.csv").read_bytes() == before
    assess(load_case(tmp_path / "case" / "case.toml"), tmp_path / "case", report=False)
    assert (tmp_path / "case" / "welds.csv").read_bytes() == before


def test_another_run_in_the_folder_is_told(result, monkeypatch):
    """While an assessment holds the folder no report is written into it."""
    refused = []

    def meanwhile(label, done, total):
        with pytest.raises(DataError, match="another run is writing to this folder"):
            write_documents(result)
        refused.append(label)

    assess(load_case(result.parent / "case" / "case.toml"), result, report=False, progress=meanwhile)
    assert refused


def test_a_run_that_became_another_case_meanwhile_is_refused(assessed, tmp_path, monkeypatch):
    """Two cases start into one empty folder; the one that comes second finds the result of the first."""
    shutil.copytree(assessed / "case", tmp_path / "a")
    shutil.copytree(assessed / "case", tmp_path / "b")
    first, second = (load_case(tmp_path / name / "case.toml") for name in "ab")
    import fatigue.assess as story  # noqa: PLC0415

    read = story.read_body

    def slow(case, *, strict):
        body = read(case, strict=strict)
        if case.path.parent.name == "b":
            monkeypatch.setattr(story, "read_body", read)
            assess(first, tmp_path / "result", report=False)
        return body

    monkeypatch.setattr(story, "read_body", slow)
    with pytest.raises(DataError, match="holds the result of another case"):
        assess(second, tmp_path / "result", report=False)
    assert Path(read_provenance(tmp_path / "result")["case_path"]).parent.name == "a"
