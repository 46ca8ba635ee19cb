"""Result folders on the command line: another case, copied folders, lost cases, documents that do not belong."""

import json
import shutil

import pytest

from fatigue.results import write_provenance
from tests.command_line import assess, fatigue
from tests.report.reading import Page
from tests.small_case import sine_only


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    """A case, its result and all documents that need no browser."""
    folder = tmp_path_factory.mktemp("folders")
    assess(sine_only().write(folder / "case"), "-o", folder / "result")
    done = fatigue("-q", "report", folder / "result", "--csv", "--xlsx")
    assert done.returncode == 0, done.stderr
    return folder / "result"


@pytest.fixture
def copied(result, tmp_path):
    """The result folder alone, copied elsewhere."""
    shutil.copytree(result, tmp_path / "archive" / "result")
    return tmp_path / "archive" / "result"


def edit(case):
    """Another total distance, which every life depends on; the line as it is then."""
    lines = case.read_text().splitlines(keepends=True)
    (place,) = (i for i, line in enumerate(lines) if line.startswith("target_km = "))
    lines[place] = "target_km = 12345.5\n"
    case.write_text("".join(lines))
    return lines[place].strip()


def one_line(done, code):
    """The only line of a refusal."""
    assert done.returncode == code, done.stderr
    assert "Traceback" not in done.stderr
    (line,) = done.stderr.strip().splitlines()
    return line


def test_another_case_into_the_same_folder(result, tmp_path):
    """Refused in one line with exit code 3, nothing touched; --force replaces all of it."""
    shutil.copytree(result.parent, tmp_path / "work")
    folder = tmp_path / "work" / "result"
    other = tmp_path / "work" / "case" / "other.toml"
    shutil.copy(tmp_path / "work" / "case" / "case.toml", other)
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    line = one_line(assess(other, "-o", folder), 3)
    assert "holds the result of another case" in line
    assert "case.toml. Give another folder with -o, or --force to replace it." in line
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == before
    assert assess(other, "-o", folder, "--force", "--exit-zero").returncode == 0
    left = {path.name for path in folder.iterdir()}
    assert not left & {"report.html", "weld_lines.vtp", "nodes.xlsx", "nodes.csv"}
    assert json.loads((folder / "provenance.json").read_text())["case_file"] == "other.toml"


def test_the_same_case_from_another_place_is_daily_work(result, tmp_path):
    """Started in the folder of the case, with ./case.toml; moved as a whole, edited, and run again."""
    shutil.copytree(result.parent, tmp_path / "moved")
    case = tmp_path / "moved" / "case"
    edit(case / "case.toml")
    done = fatigue(
        "-q", "assess", "./case.toml", "-o", "../result", "--no-report", "--exit-zero", cwd=case
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert not (tmp_path / "moved" / "result" / "nodes.csv").exists()
    assert fatigue("-q", "verify", "--results", "../result", "--sample", 1, cwd=case).returncode == 0


@pytest.mark.parametrize("command", [("verify", "--results"), ("diagnose",)], ids=["verify", "diagnose"])
def test_a_result_without_its_case_names_the_option(copied, command):
    """One line with the place that was looked at and --case; with it the command runs."""
    line = one_line(fatigue("-q", *command, copied), 3)
    assert "case.toml: the case of this result is not there" in line
    assert "--case" in line


def test_a_report_without_its_case_says_what_it_lacks(copied, result):
    """On stderr and on the page; with --case everything is there again."""
    done = fatigue("report", copied)
    assert done.returncode == 0, done.stderr
    page = (copied / "report.html").read_text()
    for said in (done.stderr, page):
        assert "the case file is not where it was" in said
        assert "mesh, stress histories and spectra are not shown" in said
        assert "fatigue report DIR --case CASE" in said
    assert "weld-1-psd" not in Page(page).figures
    done = fatigue("-q", "report", copied, "--case", result.parent / "case" / "case.toml")
    assert done.returncode == 0, done.stderr
    page = (copied / "report.html").read_text()
    assert "not where it was" not in page
    assert "weld-1-psd" in Page(page).figures


@pytest.mark.parametrize("command", [("verify", "--results"), ("diagnose",), ("report",)], ids=lambda c: c[0])
def test_a_case_that_is_not_the_one_is_refused(copied, result, tmp_path, command):
    """An edited copy, and a path that is not there."""
    shutil.copytree(result.parent / "case", tmp_path / "edited")
    case = tmp_path / "edited" / "case.toml"
    edit(case)
    line = one_line(fatigue("-q", *command, copied, "--case", case), 3)
    assert "is not the case of this result" in line or "is not the file the result was computed from" in line
    line = one_line(fatigue("-q", *command, copied, "--case", tmp_path / "none.toml"), 3)
    assert "none.toml: there is no such file. Correct the path after --case." in line
    line = one_line(fatigue("-q", *command, copied, "--case", tmp_path / "edited"), 3)
    assert "this is a folder. Give the path of the case.toml in it." in line


def test_an_edited_case_is_told_by_the_report(result, tmp_path):
    """The page keeps the assessed case text and says why it shows no records."""
    shutil.copytree(result.parent, tmp_path / "work")
    case = tmp_path / "work" / "case" / "case.toml"
    edited = edit(case)
    done = fatigue("report", tmp_path / "work" / "result")
    assert done.returncode == 0
    assert "the case file has changed since the assessment" in done.stderr
    page = (tmp_path / "work" / "result" / "report.html").read_text()
    assert "has changed since the assessment" in page
    assert edited not in page


def test_verify_names_the_document_that_does_not_belong(result, tmp_path):
    """A workbook of another result copied in: exit code 4 and its name; the numbers agree all the same."""
    shutil.copytree(result.parent, tmp_path / "work")
    folder = tmp_path / "work" / "result"
    assert fatigue("-q", "verify", "--results", folder, "--sample", 1).returncode == 0
    with (folder / "welds.csv").open("a") as file:
        file.write("W9,mine\n")
    done = fatigue("-q", "verify", "--results", folder, "--sample", 1)
    assert done.returncode == 4
    assert "agree with the recount; 1 files of the folder do not belong to its result" in done.stdout
    assert "welds.csv: was changed since it was written" in done.stdout
    record = json.loads((folder / "provenance.json").read_text())
    write_provenance(folder, record | {"result": "1" * 32})
    done = fatigue("-q", "verify", "--results", folder, "--json")
    assert done.returncode == 4
    named = {problem["where"].rpartition("/")[2] for problem in json.loads(done.stdout)["strangers"]}
    assert {"nodes.parquet", "damage.parquet", "report.html", "nodes.xlsx", "nodes.csv"} <= named
    shown = fatigue("-q", "show", folder)
    assert shown.returncode == 3
    assert "nodes.parquet: belongs to the result" in shown.stderr
