"""The command ``fatigue basis`` as a user gives it."""

import json

import pytest
from click.testing import CliRunner

from fatigue.__main__ import cli
from tests.chain_case import by_factors, by_matrix
from tests.small_case import small_case


def run(*arguments):
    """Result of the command."""
    return CliRunner().invoke(cli, ["-q", "basis", *map(str, arguments)])


def test_text_says_what_the_modes_carry(tmp_path):
    """One line for each direction, and why there is no dynamic mass."""
    result = run(by_factors(tmp_path).write(tmp_path))
    assert result.exit_code == 0
    assert "Effective modal mass" in result.output
    assert "20 % on the boundary" in result.output
    assert "no damping ratio" in result.output
    assert "written" not in result.output


def test_json_holds_rows_and_notes(tmp_path):
    """The record of machines has null where a number cannot be had."""
    result = run(by_matrix(tmp_path).write(tmp_path), "--json", "--damping", "0.02")
    assert result.exit_code == 0
    record = json.loads(result.output)
    rows = {row["direction"]: row for row in record["findings"]["mass_sum"]["rows"]}
    assert rows["x"]["share_in_band"] == pytest.approx(0.79, abs=0.02)
    assert rows["rx"]["share_in_band"] is None
    assert record["findings"]["dynamic_mass"]["rows"]


def test_files_are_written_and_named(tmp_path):
    """With a folder, tables and page are there; a second run replaces them."""
    case = by_factors(tmp_path / "case").write(tmp_path / "case")
    for _ in range(2):
        result = run(case, "-o", tmp_path / "out", "--csv")
        assert result.exit_code == 0
        assert "basis.html" in result.output
    assert (tmp_path / "out" / "mass_sum.csv").exists()


def test_exit_codes(tmp_path):
    """2: wrong usage; 3: a case that is not there, a file that is not there, a file in the way."""
    case = small_case().write(tmp_path)
    assert run(case, "--csv").exit_code == 2
    assert run(case, "--band-hz", "-1").exit_code == 2
    assert run(tmp_path / "none.toml").exit_code == 2 or run(tmp_path / "none.toml").exception
    body = small_case()
    body.body["participation"] = "none.csv"
    result = run(body.write(tmp_path))
    assert result.exception.exit_code == 3
    assert "none.csv" in str(result.exception)
