"""What the command line says of a fleet, and what it refuses."""

import json

import pandas as pd
import pytest

from tests.command_line import fatigue
from tests.decide.fleet.fleet_case import fleet_folder


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """The fleet of the docs with its results."""
    return fleet_folder(tmp_path_factory.mktemp("fleet"))


def test_a_fleet_is_told_and_written(folder, tmp_path):
    """Words for people, JSON for machines, tables and a page; the target decides about the exit code."""
    done = fatigue("fleet", folder / "fleet.toml")
    assert done.returncode == 1, done.stderr
    assert "units miss their target of 30 years" in done.stdout
    assert "worst weld of each unit" in done.stdout
    assert "What makes units differ at " in done.stdout
    assert "written" not in done.stdout
    done = fatigue("fleet", folder / "fleet.toml", "-o", tmp_path / "out", "--csv", "--exit-zero", "--json")
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert [row["rank"] for row in found["units"]] == [1, 2, 3, 4]
    assert found["fulfilled"] is False
    assert str(tmp_path / "out" / "fleet.html") in found["written"]
    assert len(pd.read_csv(tmp_path / "out" / "fleet_welds.csv")) == 8
    page = (tmp_path / "out" / "fleet.html").read_text(encoding="utf-8")
    assert "Trailers of depot north" in page
    assert "http://" not in page.split('id="plotly-source"')[0]


def test_wrong_usage(folder):
    """Exit code 2, before anything is read; 3 where the file is not there or wrong."""
    done = fatigue("fleet", folder / "fleet.toml", "--csv")
    assert (done.returncode, "name their folder with -o" in done.stderr) == (2, True)
    done = fatigue("fleet", folder / "none.toml")
    assert (done.returncode, "none.toml: there is no such file" in done.stderr) == (3, True)
    done = fatigue("fleet", folder / "sound" / "case.toml")
    assert (done.returncode, "this is a case (case.toml), not a fleet" in done.stderr) == (3, True)
