"""Stress points: what the file says arrives, and what it says wrong is told."""

import numpy as np
import pytest

from fatigue.errors import DataError
from fatigue.readers.neutral.points.stress_points import read_stress_points
from tests.readers.neutral_tables import changed, refusal_of, without, write

WELDS = {"seam": "seam", "line 7": "ring", "old": "old"}
CURVES = ("fat-90", "shear-80", "parent-160")
SUFFIXES = pytest.mark.parametrize("suffix", [".csv", ".parquet"])
POINTS = {
    "point": ["a", "b", "n", "p", "h"],
    "kind": ["hot_spot_a", "hot_spot_b", "nominal", "parent", "haz"],
    "weld": ["seam", "line 7", None, None, "old"],
    "x_mm": [1.0, 2.0, 3.0, 4.0, 5.0],
    "y_mm": [0.0] * 5,
    "z_mm": [0.0] * 5,
    "thickness_mm": [8.0, 6.0, 4.0, 3.0, 2.0],
    "e1_x": [0.0, 2.0, 0.0, 1.0, 0.0],
    "e1_y": [3.0, 0.0, 1.0, 0.0, 1.0],
    "e1_z": [0.5, 0.0, 0.0, 0.0, 0.0],
    "normal_x": [0.0] * 5,
    "normal_y": [0.0] * 5,
    "normal_z": [2.0, 1.0, -1.0, 1.0, 1.0],
    "curve": ["fat-90", "fat-90", "fat-90", "parent-160", "parent-160"],
    "curve_shear": ["shear-80", None, None, "shear-80", None],
    "planes": ["normal", None, "planes_60", None, None],
}


def read(path, columns):
    """Points of a table, without warnings."""
    points, warnings = read_stress_points(write(path, columns), WELDS, CURVES, strict=True)
    assert warnings == []
    return points


@SUFFIXES
def test_points(tmp_path, suffix):
    """Points come in the order of the file; frames are unit vectors, e1 in the plate; welds as they are assessed."""
    points = read(tmp_path / f"p{suffix}", POINTS)
    assert points.name == ("a", "b", "n", "p", "h")
    assert points.weld == ("seam", "ring", "", "", "old")
    assert points.curve_shear == ("shear-80", "", "", "shear-80", "")
    assert points.planes == ("normal", "planes_60", "planes_60", "planes_60", "planes_60")
    assert points.thickness.tolist() == [8.0, 6.0, 4.0, 3.0, 2.0]
    assert points.xyz[:, 0].tolist() == [1.0, 2.0, 3.0, 4.0, 5.0]
    assert np.allclose(points.e1, [[0, 1, 0], [1, 0, 0], [0, 1, 0], [1, 0, 0], [0, 1, 0]], atol=1e-15)
    assert np.allclose(points.normal[:, 2], [1, 1, -1, 1, 1])


def test_optional_columns(tmp_path):
    """Points need no weld, no shear curve and no choice of planes."""
    columns = {k: v for k, v in POINTS.items() if k not in ("weld", "curve_shear", "planes")}
    points = read(tmp_path / "p.csv", columns)
    assert set(points.weld) == set(points.curve_shear) == {""}
    assert set(points.planes) == {"planes_60"}


@SUFFIXES
@pytest.mark.parametrize(
    ("columns", "message"),
    [
        (without(POINTS, "kind"), "column kind: the column is missing."),
        (changed(POINTS, "point", 2, "a"), "column point, row 2: point a repeats row 1. Keep one of the rows."),
        (changed(POINTS, "point", 2, None), "column point, row 2: the text is missing. Give a text."),
        (
            changed(POINTS, "kind", 3, "hot_spot_c"),
            "column kind, row 3: 'hot_spot_c' is not one of hot_spot_a, hot_spot_b, nominal, parent, haz. Give one of",
        ),
        (changed(POINTS, "weld", 1, "seem"), "column weld, row 1: 'seem' is not one of the welds. Write 'seam'."),
        (
            changed(POINTS, "curve", 1, "fat-9"),
            "column curve, row 1: 'fat-9' is not one of the curves. Write 'fat-90'.",
        ),
        (changed(POINTS, "curve", 1, None), "column curve, row 1: the text is missing. Give a text."),
        (changed(POINTS, "curve_shear", 1, "none"), "column curve_shear, row 1: 'none' is not one of the curves."),
        (
            changed(POINTS, "curve_shear", 2, "shear-80"),
            "column curve_shear, row 2: shear is counted nowhere on the edge of a plate, kind hot_spot_b. Leave it",
        ),
        (changed(POINTS, "planes", 1, "all"), "column planes, row 1: 'all' is not one of normal, planes_60. Give one"),
        (changed(POINTS, "thickness_mm", 4, 0.0), "column thickness_mm, row 4: 0 is not above 0. Give more than 0."),
        (changed(POINTS, "thickness_mm", 4, None), "column thickness_mm, row 4: the value is missing or NaN."),
        (changed(POINTS, "x_mm", 4, float("inf")), "column x_mm, row 4: inf is not finite. Give a finite number."),
        (changed(POINTS, "normal_z", 2, 0.0), "column normal_x, row 2: the vector is zero. Give the direction normal."),
        (changed(POINTS, "e1_x", 2, 0.0), "column e1_x, row 2: the vector is zero. Give the direction e1."),
        (
            changed(changed(POINTS, "e1_x", 2, 0.1), "e1_z", 2, 1.0),
            "column e1_x, row 2: e1 is along the normal (within 10 deg), so that it tells no direction in the plate.",
        ),
    ],
)
def test_bad_points(tmp_path, suffix, columns, message):
    """A mistake is told with file, column, row, value and remedy."""
    path = write(tmp_path / f"p{suffix}", columns)
    assert f"p{suffix}: {message}" in refusal_of(read_stress_points, path, WELDS, CURVES)


def test_unknown_columns(tmp_path):
    """A misspelt column is told, and is a mistake where strict."""
    path = write(tmp_path / "p.csv", {k.replace("planes", "plane"): v for k, v in POINTS.items()})
    _, warnings = read_stress_points(path, WELDS, CURVES, strict=False)
    assert [w.code for w in warnings] == ["unknown_column"]
    with pytest.raises(DataError, match="Rename it to 'planes'"):
        read_stress_points(path, WELDS, CURVES, strict=True)
