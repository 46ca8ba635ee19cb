"""Endurance lines: what the file says arrives, and what it says wrong is told."""

import numpy as np
import pytest

from fatigue.readers.neutral.endurance.endurance_lines import read_endurance_lines
from tests.readers.neutral_tables import changed, refusal_of, without, write

LINES = {
    "line": ["across", "across", "across", "sheared", "sheared"],
    "component": ["perp", "perp", "perp", "shear", "shear"],
    "R": [-1.0, 0.0, 0.5, -1.0, 0.5],
    "stress_max_MPa": [60.0, 92.3, 126.3, 35.0, 70.0],
    "edition": ["2031-01"] * 5,
    "clause": ["table 1"] * 5,
}
SUFFIXES = pytest.mark.parametrize("suffix", [".csv", ".parquet"])


@SUFFIXES
def test_lines(tmp_path, suffix):
    """Lines have their points by kappa and amplitude, and say where they come from."""
    lines, warnings = read_endurance_lines(write(tmp_path / f"l{suffix}", LINES), (), strict=True)
    assert warnings == []
    assert list(lines) == ["across", "sheared"]
    line = lines["across"]
    assert (line.component, line.edition, line.clause) == ("perp", "2031-01", "table 1")
    np.testing.assert_allclose(line.kappa, [0.0, 1.0, 3.0])
    np.testing.assert_allclose(line.amplitude, [60.0, 46.15, 31.575])


def test_compression_may_be_in_a_line(tmp_path):
    """R far below -1 is a row like any other; lines of different names may be mixed in the file."""
    columns = {name: [values[i] for i in (0, 3, 1, 4, 2)] for name, values in LINES.items()}
    columns = changed(changed(columns, "R", 1, -1e3), "stress_max_MPa", 1, 0.12)
    lines, _ = read_endurance_lines(write(tmp_path / "l.csv", columns), (), strict=True)
    assert lines["across"].kappa[0] == pytest.approx(-999 / 1001)
    assert lines["across"].amplitude[0] == pytest.approx(60.06)


@SUFFIXES
@pytest.mark.parametrize(
    ("columns", "message"),
    [
        (without(LINES, "edition"), "column edition: the column is missing. Add it;"),
        (without(LINES, "stress_max_MPa"), "column stress_max_MPa: the column is missing. Add it;"),
        (changed(LINES, "clause", 2, None), "column clause, row 2: the text is missing. Give a text."),
        (changed(LINES, "component", 4, "tau"), "column component, row 4: 'tau' is not one of perp, par, shear. Give"),
        (changed(LINES, "component", 2, "par"), "column component, row 2: line 'across' is for perp in row 1 and for"),
        (
            changed(LINES, "R", 3, 1.0),
            "column R, row 3: 1 is no stress ratio of an upper stress: nothing alternates at",
        ),
        (changed(LINES, "R", 1, -1001.0), "column R, row 1: -1001 is below -1000. Give at least -1000."),
        (changed(LINES, "R", 2, None), "column R, row 2: the value is missing or NaN. Give a number."),
        (changed(LINES, "R", 2, -1.0), "column R, row 2: R of line 'across' goes from -1 to -1. Give every R once,"),
        (changed(LINES, "R", 2, 0.7), "column R, row 3: R of line 'across' goes from 0.7 to 0.5. Give every R once,"),
        (changed(LINES, "stress_max_MPa", 5, 0.0), "column stress_max_MPa, row 5: 0 is not above 0. Give more than 0."),
        (
            changed(LINES, "stress_max_MPa", 2, 46.2),
            "column stress_max_MPa, row 2: the upper stress of line 'across' falls from 60 at R = -1 to 46.2 at R = 0,",
        ),
        (
            changed(LINES, "stress_max_MPa", 3, 200.0),
            "column stress_max_MPa, row 3: the amplitude stress_max (1 - R) / 2 of line 'across' rises from 46.15 at",
        ),
        (
            changed(LINES, "edition", 3, "2030-01"),
            "column edition, row 3: line 'across' is from '2031-01' and from '2030-01'. Give a line one edition.",
        ),
    ],
)
def test_bad_lines(tmp_path, suffix, columns, message):
    """Every mistake in the lines names file, column, row and value."""
    path = write(tmp_path / f"l{suffix}", columns)
    assert refusal_of(read_endurance_lines, path, ()).startswith(f"l{suffix}: {message}")


def test_one_row_is_no_line(tmp_path):
    """One stress ratio says nothing of others."""
    columns = {name: values[:4] for name, values in LINES.items()}
    message = refusal_of(read_endurance_lines, write(tmp_path / "l.csv", columns), ())
    assert message == (
        "l.csv: column R, row 4: line 'sheared' has one row, and one stress ratio says nothing of others. "
        "Give the upper stress at a second R, too."
    )


def test_a_line_has_no_name_of_a_curve(tmp_path):
    """A name in the results stands for one of the two."""
    message = refusal_of(read_endurance_lines, write(tmp_path / "l.csv", LINES), {"sheared"})
    assert message.startswith(
        "l.csv: column line, row 4: line 'sheared' has the name of an S-N curve. Give the line an"
    )


def test_all_lines_are_told_at_once(tmp_path):
    """A mistake in one line hides none in another."""
    columns = changed(changed(LINES, "R", 2, -2.0), "R", 5, -3.0)
    message = refusal_of(read_endurance_lines, write(tmp_path / "l.csv", columns), ())
    assert [line.split(":")[1] for line in message.splitlines()] == [" column R, row 2", " column R, row 5"]


def test_a_table_of_amplitudes_is_not_taken_for_one_of_upper_stresses(tmp_path):
    """The allowed amplitudes of the line, given as upper stresses, fall as R rises."""
    columns = LINES | {"stress_max_MPa": [60.0, 46.15, 31.58, 35.0, 70.0]}
    message = refusal_of(read_endurance_lines, write(tmp_path / "l.csv", columns), ())
    assert message.endswith(
        "Give upper stresses; of an amplitude it is 2 amplitude / (1 - R), of a range range / (1 - R)."
    )
