"""A weld register that was edited, written or taken away since the assessment: no result is mixed with it unseen."""

import csv
import json
import logging
import shutil

import pytest

from fatigue.assess import assess
from fatigue.diagnose import diagnose
from fatigue.errors import DataError
from fatigue.report.page import report_page
from fatigue.verify.recount import recount
from tests.report.converted import converted
from tests.report.reading import Page

REGISTER = "welds_register.csv"


@pytest.fixture(scope="module")
def registered(tmp_path_factory):
    """A converted case with its register, assessed."""
    folder = tmp_path_factory.mktemp("registered")
    assess(converted(folder) / "case.toml", folder / "result", threads=1, report=False)
    return folder


@pytest.fixture(scope="module")
def plain(tmp_path_factory):
    """The same without register and record of a conversion."""
    folder = tmp_path_factory.mktemp("plain")
    body = converted(folder)
    case = body / "case.toml"
    lines = case.read_text().splitlines(keepends=True)
    case.write_text("".join(line for line in lines if not line.startswith("register")))
    for name in (REGISTER, "convert.json"):
        (body / name).rename(folder / name)
    assess(case, folder / "result", threads=1, report=False)
    return folder


def thicker(path):
    """Another thickness for all welds, which changes no names and no numbers of points."""
    with path.open(newline="") as file:
        rows = list(csv.DictReader(file))
    with path.open("w", newline="") as file:
        writer = csv.DictWriter(file, rows[0])
        writer.writeheader()
        writer.writerows(row | {"thickness_mm": "20", "confirmed": "true"} for row in rows)


def doubt_of_page(folder, caplog):
    """What the page says of the register; standard error says the same."""
    caplog.clear()
    with caplog.at_level(logging.WARNING, "fatigue"):
        text = " ".join(Page(report_page(folder / "result")).text)
    (said,) = [line for line in caplog.messages if REGISTER in line]
    assert f"Outdated: {said.partition('outdated: ')[2]}" in text
    return said


def refusals(folder):
    """What diagnosis and recount say, with exit code 3."""
    for run in (diagnose, recount):
        with pytest.raises(DataError) as refused:
            run(folder / "result")
        yield str(refused.value)


def test_as_it_was(registered, plain):
    """Nothing is said, and nothing refused."""
    for folder in (registered, plain):
        assert "Outdated" not in report_page(folder / "result")
        diagnose(folder / "result")
        assert recount(folder / "result").passed


def test_edited(registered, tmp_path, caplog):
    """The page shows the welds as they were assessed, and says so."""
    shutil.copytree(registered, tmp_path / "new")
    thicker(tmp_path / "new" / "body" / REGISTER)
    assert "has changed since the assessment, and the welds are shown" in doubt_of_page(tmp_path / "new", caplog)
    diagnosed, recounted = refusals(tmp_path / "new")
    assert "has changed since the assessment" in diagnosed
    assert "is not the file the result was computed from" in recounted


def test_taken_away(registered, tmp_path, caplog):
    """It is missing."""
    shutil.copytree(registered, tmp_path / "new")
    (tmp_path / "new" / "body" / REGISTER).unlink()
    assert "is not there any more, and the welds are shown" in doubt_of_page(tmp_path / "new", caplog)
    assert all(REGISTER in said for said in refusals(tmp_path / "new"))


@pytest.mark.parametrize("name", [REGISTER, "convert.json"])
def test_come_since(plain, tmp_path, caplog, name):
    """The case does not name it and its hash is not known: it would act unseen."""
    shutil.copytree(plain, tmp_path / "new")
    shutil.copy(plain / name, tmp_path / "new" / "body")
    if name == REGISTER:
        thicker(tmp_path / "new" / "body" / REGISTER)
        assert "was not there when the result was computed" in doubt_of_page(tmp_path / "new", caplog)
    for said in refusals(tmp_path / "new"):
        assert f"{name}: was not there when the result was computed" in said
    assert json.loads((tmp_path / "new" / "result" / "provenance.json").read_text())["program"] == "fatigue"
