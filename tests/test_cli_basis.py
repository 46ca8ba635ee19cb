"""What the command line says of a modal basis, and what it refuses."""

import json

import pandas as pd
import pytest

from tests.chain_case import by_factors, by_matrix
from tests.command_line import fatigue
from tests.small_case import small_case


def test_basis_is_told_and_written(tmp_path):
    """Words for people, JSON for machines, tables and a page; a second run replaces them, nothing foreign."""
    case = by_factors(tmp_path / "case").write(tmp_path / "case")
    done = fatigue("basis", case)
    assert done.returncode == 0, done.stderr
    assert "20.0 % on the boundary" in done.stdout
    assert "no damping ratio" in done.stdout
    assert "written" not in done.stdout
    done = fatigue("basis", case, "-o", tmp_path / "out", "--csv", "--damping", "0.02", "--json")
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    rows = {row["direction"]: row for row in found["findings"]["mass_sum"]["rows"]}
    assert rows["x"]["summed_mass"] == pytest.approx(6.0)
    assert rows["rx"]["share_in_band"] is None
    assert str(tmp_path / "out" / "basis.html") in found["written"]
    assert len(pd.read_csv(tmp_path / "out" / "mass_sum.csv")) == 6
    (tmp_path / "out" / "basis.html").write_text("mine", encoding="utf-8")
    done = fatigue("basis", case, "-o", tmp_path / "out")
    assert done.returncode == 3
    assert "basis.html: is there already" in done.stderr
    assert fatigue("basis", case, "-o", tmp_path / "out", "--force").returncode == 0


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--csv",), "name their folder with -o"),
        (("--force",), "name their folder with -o"),
        (("--band-hz", "-1"), "Invalid value for '--band-hz'"),
        (("--damping", "nan"), "Invalid value for '--damping'"),
        (("--damping", "2"), "2.0 is not in the range 0.0<x<1.0"),
    ],
)
def test_wrong_usage(tmp_path, options, words):
    """Exit code 2, before anything is read."""
    done = fatigue("basis", small_case().write(tmp_path), *options)
    assert done.returncode == 2
    assert words in done.stderr


def test_bad_cases(tmp_path):
    """Exit code 3: a case or a file that is not there, keys that need each other."""
    assert fatigue("basis", tmp_path / "none.toml").returncode == 3
    case = small_case()
    case.body["participation"] = "none.csv"
    done = fatigue("basis", case.write(tmp_path))
    assert (done.returncode, "none.csv" in done.stderr) == (3, True)
    case = by_matrix(tmp_path)
    case.body.pop("mass_rows")
    done = fatigue("basis", case.write(tmp_path))
    assert done.returncode == 3
    assert "body.mass_rows" in done.stderr
    assert "Give mass_rows too" in done.stderr
