"""Tables to fill in from a standard: names and structure, no value, and refused as long as they are empty."""

import csv
import tomllib
from pathlib import Path

import pytest

from fatigue.case import load_case
from fatigue.errors import FatigueError
from fatigue.example import write_example, write_templates
from fatigue.readers.neutral.body.strength_factors import read_strength_factors
from fatigue.readers.neutral.endurance.endurance_lines import read_endurance_lines
from tests.small_case import small_case

WELD = {"en17149-weld"}


@pytest.fixture
def templates(tmp_path: Path) -> Path:
    """The folder that ``fatigue example DIR --templates`` fills."""
    write_templates(tmp_path / "templates")
    return tmp_path / "templates"


def test_no_value_of_a_standard_is_given(templates: Path) -> None:
    """Values and clauses are empty in every row, slopes and ranges of the curves are comments."""
    tables = {
        "strength_factors_en17149-3": ("value", "clause"),
        "endurance_lines_dvs1608": ("stress_max_MPa", "clause"),
    }
    for name, columns in tables.items():
        with (templates / f"{name}.csv").open(encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        assert rows
        assert all(row[column] == "" for row in rows for column in columns)
    curves = tomllib.loads((templates / "curves_en17149-3.toml").read_text(encoding="utf-8"))["curves"]
    assert not any(set(curve) & {"slopes", "range_at_2e6_MPa", "knees_cycles", "clause"} for curve in curves.values())


def test_an_empty_template_is_refused(templates: Path, tmp_path: Path) -> None:
    """With file, column and row; a curve with the key that is missing."""
    with pytest.raises(FatigueError, match="column value, row 1: the value is missing"):
        read_strength_factors(templates / "strength_factors_en17149-3.csv", WELD, strict=True)
    with pytest.raises(FatigueError, match="column stress_max_MPa, row 1: the value is missing"):
        read_endurance_lines(templates / "endurance_lines_dvs1608.csv", set(), strict=True)
    case = small_case()
    case.extra = (templates / "curves_en17149-3.toml").read_text(encoding="utf-8")
    with pytest.raises(FatigueError, match=r"curves\.en17149-weld\.slopes: the key is missing"):
        load_case(case.write(tmp_path))


def test_a_filled_template_is_read(templates: Path) -> None:
    """Only its empty cells are missing."""
    path = templates / "strength_factors_en17149-3.csv"
    filled = path.read_text(encoding="utf-8").replace(",,,,", ",0.9,7.1,2025,")
    path.write_text(filled, encoding="utf-8")
    factors, warnings = read_strength_factors(path, WELD, strict=True)
    assert {factor.value for factor in factors} == {0.9}
    assert not warnings


def test_files_that_are_there_stay(templates: Path) -> None:
    """Neither command overwrites without being told to."""
    for write in (write_templates, lambda folder: write_example(folder.parent / "example")):
        if write is not write_templates:
            write(templates)
        with pytest.raises(FatigueError, match="is there already"):
            write(templates)
