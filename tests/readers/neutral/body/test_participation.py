"""Participation factors of modes: read, and refused with file, column, row and value."""

import numpy as np
import pandas as pd
import pytest

from fatigue.errors import DataError
from fatigue.readers.neutral.body.modes import Modes
from fatigue.readers.neutral.body.participation import read_participation

MODES = Modes(
    mode=np.array([1, 2, 7]),
    frequency=np.array([5.0, 9.0, 60.0]),
    damping_ratio=np.full(3, np.nan),
    modal_mass=np.ones(3),
    kind=("normal", "normal", "interface"),
    scale=np.ones(3),
)


def read(tmp_path, ignore_modes=(), strict=False, **columns):
    """Read a table of these columns."""
    pd.DataFrame(columns).to_csv(tmp_path / "l.csv", index=False)
    return read_participation(tmp_path / "l.csv", MODES, ignore_modes, strict=strict)


def test_any_order_and_any_direction(tmp_path):
    """Rows are sorted by mode, directions that are not there are NaN, modes may be missing."""
    found, warnings = read(tmp_path, mode=[7, 1], l_rz=[3.0, -4.0], l_x=[1.0, 2.0])
    assert found.mode.tolist() == [1, 7]
    assert found.factor[:, 0].tolist() == [2.0, 1.0]
    assert found.factor[:, 5].tolist() == [-4.0, 3.0]
    assert np.isnan(found.factor[:, 1:5]).all()
    assert warnings == []


def test_ignored_modes_are_skipped(tmp_path):
    """A row of a mode that the case leaves out is passed over."""
    found, _ = read(tmp_path, ignore_modes=(9,), mode=[9, 2], l_x=[1.0, 2.0])
    assert found.mode.tolist() == [2]


@pytest.mark.parametrize(
    ("columns", "code", "words"),
    [
        ({"mode": [1, 3], "l_x": [1.0, 2.0]}, "unknown_id", "column mode, row 2: mode 3 is not in the modes"),
        ({"mode": [1, 1], "l_x": [1.0, 2.0]}, "duplicate", "mode 1 repeats row 1"),
        ({"mode": [1, 2]}, "missing_column", "none of l_x, l_y, l_z, l_rx, l_ry, l_rz is there"),
        ({"mode": [1, 2], "l_x": [1.0, np.inf]}, "bad_value", "column l_x, row 2: inf is not finite"),
        ({"mode": [1, 2], "l_x": [1.0, "heavy"]}, "bad_type", "column l_x, row 2: 'heavy' is not a number"),
        ({"mode": [1.5, 2], "l_x": [1.0, 2.0]}, "bad_value", "1.5 is not a whole number"),
        ({"l_x": [1.0]}, "missing_column", "mode"),
    ],
)
def test_refusals(tmp_path, columns, code, words):
    """Each mistake is told with its place."""
    with pytest.raises(DataError) as error:
        read(tmp_path, **columns)
    assert code in [problem.code for problem in error.value.problems]
    assert words in str(error.value)
