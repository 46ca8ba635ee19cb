"""Shapes and static solutions at loaded points, read: orders of rows, ignored modes, mistakes with their places."""

import numpy as np
import pandas as pd
import pytest

from fatigue.errors import DataError
from fatigue.readers.neutral.body.interface_shapes import read_interface_shapes
from fatigue.readers.neutral.body.modes import Modes
from fatigue.readers.neutral.body.static_flexibility import read_flexibility

MODES = Modes(
    np.array([3, 7]), np.array([5.0, 60.0]), np.full(2, np.nan), np.ones(2), ("normal", "interface"), np.ones(2)
)
SHAPES = pd.DataFrame(
    {
        "point": ["B", "12", "12", "B", "12", "12"],
        "direction": ["z", "rx", "z", "z", "rx", "z"],
        "mode": [7, 3, 3, 3, 7, 7],
        "value": [0.7, 1e-3, 0.3, -0.4, 2e-3, 0.5],
    }
)
STATIC = pd.DataFrame({"point": ["B", "12"], "direction": ["z", "rx"], "value_mm_per_N": [1e-4, 2e-12]})


def shapes(table, tmp_path, ignore=(), suffix="csv"):
    """Shapes read from a table that was written."""
    path = tmp_path / f"shapes.{suffix}"
    table.to_csv(path, index=False) if suffix == "csv" else table.to_parquet(path, index=False)
    return read_interface_shapes(path, MODES, ignore, strict=True)[0]


def test_shapes_in_any_order(tmp_path):
    """Rows are put in order by point and direction, values by mode; names of points may be numbers."""
    found = shapes(SHAPES, tmp_path)
    assert list(zip(found.point, found.direction, strict=True)) == [("12", "z"), ("12", "rx"), ("B", "z")]
    np.testing.assert_array_equal(found.value, [[0.3, 0.5], [1e-3, 2e-3], [-0.4, 0.7]])
    assert found.points == ("12", "B")
    np.testing.assert_array_equal(found.row("B", "z"), [-0.4, 0.7])
    assert found.row("B", "x") is None
    again = shapes(SHAPES.sample(frac=1.0, random_state=3), tmp_path, suffix="parquet")
    np.testing.assert_array_equal(again.value, found.value)


def test_ignored_and_missing_modes(tmp_path):
    """Rows of ignored modes are skipped; what has no row is NaN."""
    more = pd.concat([SHAPES, SHAPES[:1].assign(mode=9)])
    np.testing.assert_array_equal(shapes(more, tmp_path, ignore=[9]).value, shapes(SHAPES, tmp_path).value)
    holed = shapes(SHAPES.drop(index=5), tmp_path).value
    assert np.argwhere(np.isnan(holed)).tolist() == [[0, 1]]


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"direction": "q"}, "'q' is not one of x, y, z, rx, ry, rz"),
        ({"mode": 9}, "modes 9 are not in the table of modes"),
        ({"value": np.inf}, "is not finite"),
        ({"value": np.nan}, "missing or NaN"),
        ({"point": None}, "the text is missing"),
        ({"point": "12", "direction": "rx", "mode": 3}, "repeats row"),
    ],
)
def test_mistakes_of_shapes(tmp_path, change, said):
    """Each names the file, the column and the row."""
    table = SHAPES.copy()
    for name, value in change.items():
        table.loc[0, name] = value
    with pytest.raises(DataError, match=r"shapes\.csv") as refused:
        shapes(table, tmp_path)
    assert said in str(refused.value)


def test_static_solution(tmp_path):
    """Values in the order of the file."""
    path = tmp_path / "static.csv"
    STATIC.to_csv(path, index=False)
    found, warnings = read_flexibility(path, strict=True)
    assert [(one.point, one.direction, one.value) for one in found] == [("B", "z", 1e-4), ("12", "rx", 2e-12)]
    assert not warnings


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"value_mm_per_N": 0.0}, "0 is not above 0"),
        ({"value_mm_per_N": -1e-5}, "-1e-05 is not above 0"),
        ({"direction": "down"}, "'down' is not one of"),
        ({"point": "12", "direction": "rx"}, "repeats row"),
    ],
)
def test_mistakes_of_a_static_solution(tmp_path, change, said):
    """Each names the file, the column and the row."""
    path, table = tmp_path / "static.csv", STATIC.copy()
    for name, value in change.items():
        table.loc[0, name] = value
    table.to_csv(path, index=False)
    with pytest.raises(DataError, match=r"static\.csv") as refused:
        read_flexibility(path, strict=True)
    assert said in str(refused.value)
