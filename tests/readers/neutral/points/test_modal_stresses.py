"""Modal stresses: extrapolated to the toe as they are read; every row has its place, and what is wrong is told."""

import numpy as np
import pytest

from fatigue.readers.neutral.body.coordinates import Coordinates
from fatigue.readers.neutral.body.modes import read_modes
from fatigue.readers.neutral.points.modal_stresses import read_modal_stresses
from fatigue.readers.neutral.points.stress_points import read_stress_points
from tests.readers.neutral_tables import MODES, changed, picked, refusal_of, without, write

SUFFIXES = pytest.mark.parametrize("suffix", [".csv", ".parquet"])
KINDS = {"a": "hot_spot_a", "b": "hot_spot_b", "p": "parent"}
THICKNESS = 10.0
READ_OUTS = {"a": (10.0, 4.0), "b": (4.0, 8.0, 12.0), "p": (0.0,)}  # of a, the far one is number 1
WEIGHTS = {"a": (-0.67, 1.67), "b": (3.0, -3.0, 1.0), "p": (1.0,)}
SURFACES = {"a": ("top", "bottom"), "b": ("edge",), "p": ("bottom",)}
COORDINATES = (3, 7, 12, "gravity")
COMPONENTS = ("sx_MPa", "sy_MPa", "txy_MPa")


def value(point, read_out, coordinate, surface, component):
    """A stress that tells where it belongs."""
    place = COORDINATES.index(coordinate)
    return 100.0 * "abp".index(point) + 10.0 * place + read_out + 0.5 * (surface == "bottom") + 0.1 * component


def stresses(order=None):
    """The table of three points, three modes and a unit load; ``order`` shuffles its rows."""
    rows = [
        (point, number, distance, coordinate, surface)
        for point, distances in READ_OUTS.items()
        for number, distance in enumerate(distances, 1)
        for coordinate in COORDINATES
        for surface in SURFACES[point]
    ]
    if order is not None:
        rows = [rows[i] for i in np.random.default_rng(order).permutation(len(rows))]
    columns = {
        "point": [row[0] for row in rows],
        "read_out": [row[1] for row in rows],
        "distance_mm": [row[2] for row in rows],
        "mode": [None if isinstance(row[3], str) else row[3] for row in rows],
        "unit_load": [row[3] if isinstance(row[3], str) else None for row in rows],
        "surface": [row[4] for row in rows],
    }
    for i, name in enumerate(COMPONENTS):
        columns[name] = [value(row[0], row[1], row[3], row[4], i) for row in rows]
    return columns


def row_of(columns, **wanted):
    """Number of the first row with these values, counted from 1."""
    rows = zip(*(columns[name] for name in wanted), strict=True)
    return [tuple(row) for row in rows].index(tuple(wanted.values())) + 1


def body(folder, ignore_modes=(), scale=None, loads=("gravity",)):
    """Points and coordinates of a small body."""
    columns = MODES if scale is None else MODES | {"scale": scale}
    modes, _ = read_modes(write(folder / "m.csv", columns), ignore_modes, strict=True)
    count = len(KINDS)
    points = {"point": list(KINDS), "kind": list(KINDS.values()), "thickness_mm": [THICKNESS] * count}
    points |= {name: [0.0] * count for name in ("x_mm", "y_mm", "z_mm", "e1_y", "e1_z", "normal_x", "normal_y")}
    points |= {name: [1.0] * count for name in ("e1_x", "normal_z")} | {"curve": ["c"] * count}
    found, _ = read_stress_points(write(folder / "points.csv", points), {}, {"c"}, strict=True)
    return found, Coordinates(modes, loads)


def expected(scale=(1.0, 1.0, 1.0)):
    """Tensors (3, 2, 3, 4) of the three points by hand."""
    tensor = np.zeros((3, 2, 3, 4))
    for i, (point, weights) in enumerate(WEIGHTS.items()):
        for surface in SURFACES[point]:
            for j, coordinate in enumerate(COORDINATES):
                for k in range(3):
                    terms = [w * value(point, n, coordinate, surface, k) for n, w in enumerate(weights, 1)]
                    tensor[i, int(surface == "bottom"), k, j] = sum(terms) * (*scale, 1.0)[j]
    tensor[1, :, 1:] = 0.0  # an edge has sx alone
    return tensor


@SUFFIXES
@pytest.mark.parametrize("order", [None, 0, 1])
def test_stress_at_the_toe(tmp_path, suffix, order):
    """Each point has the printed weights of the set of its distances, whatever the order of the rows."""
    points, coordinates = body(tmp_path)
    path = write(tmp_path / f"s{suffix}", stresses(order))
    stress, warnings = read_modal_stresses(path, points, coordinates, (), strict=True)
    assert warnings == []
    np.testing.assert_allclose(stress.tensor, expected(), rtol=1e-12, atol=1e-12)
    assert stress.given.tolist() == [[True, True], [True, False], [False, True]]
    assert [name for name, _ in stress.surface] == ["top", "edge", "top"]
    assert stress.read_outs == ("a fine (0.4 t, 1 t)", "b fine (4 mm, 8 mm, 12 mm)", "")


def test_scale_and_ignored_modes(tmp_path):
    """The scale of a mode is on its stress, as on its forces, and not on that of loads; ignored modes are skipped."""
    points, coordinates = body(tmp_path, scale=[-2.0, 0.5, 1000.0])
    path = write(tmp_path / "s.csv", stresses())
    stress, _ = read_modal_stresses(path, points, coordinates, (), strict=True)
    np.testing.assert_allclose(stress.tensor, expected((0.5, -2.0, 1000.0)), rtol=1e-12, atol=1e-12)
    points, coordinates = body(tmp_path, ignore_modes=[7])
    stress, warnings = read_modal_stresses(path, points, coordinates, (7,), strict=True)
    assert warnings == []
    np.testing.assert_allclose(stress.tensor, expected()[..., [0, 2, 3]], rtol=1e-12, atol=1e-12)


def test_an_edge_needs_nothing_but_its_stress(tmp_path):
    """Of an edge sy and txy may be empty; where they are given, they are not used."""
    points, coordinates = body(tmp_path)
    columns = stresses()
    for name in COMPONENTS[1:]:
        columns[name] = [None if point == "b" else v for point, v in zip(columns["point"], columns[name], strict=True)]
    stress, _ = read_modal_stresses(write(tmp_path / "s.csv", columns), points, coordinates, (), strict=True)
    np.testing.assert_allclose(stress.tensor, expected(), rtol=1e-12, atol=1e-12)


def test_rows_of_other_unit_loads_are_told(tmp_path):
    """Rows of a unit load that the case does not have are skipped with a warning."""
    points, coordinates = body(tmp_path, loads=())
    path = write(tmp_path / "s.csv", stresses())
    stress, warnings = read_modal_stresses(path, points, coordinates, (), strict=True)
    assert [w.code for w in warnings] == ["unused_stress"]
    assert "rows of 'gravity' are not used" in warnings[0].what
    np.testing.assert_allclose(stress.tensor, expected()[..., :3], rtol=1e-12, atol=1e-12)


FIRST_B = row_of(stresses(), point="b")
LOAD = row_of(stresses(), unit_load="gravity")


@SUFFIXES
@pytest.mark.parametrize(
    ("columns", "message"),
    [
        (without(stresses(), "sx_MPa"), "s{}: column sx_MPa: the column is missing."),
        (without(stresses(), "txy_MPa"), "s{}: column txy_MPa: the column is missing."),
        (changed(stresses(), "point", 3, "q"), "s{}: column point, row 3: 'q' is not one of points.csv."),
        (
            picked(stresses(), list(range(1, FIRST_B))),
            "s{}: column point: no stress is given at 2 points: b, p. Add its rows, or remove it from points.csv.",
        ),
        (
            picked(stresses(), [*range(1, 6), *range(7, len(stresses()["point"]) + 1)]),
            "s{}: point a, read-out 1, mode 12, bottom: no stress is given (1 such row is missing, at 1 point)",
        ),
        (
            picked(stresses(), [i for i in range(1, len(stresses()["point"]) + 1) if i != LOAD]),
            "s{}: point a, read-out 1, unit load gravity, top: no stress is given",
        ),
        (
            picked(stresses(), [*range(1, len(stresses()["point"]) + 1), 2]),
            "s{}: column point, read_out, mode, surface, row 33: point a, read-out 1, mode 3, bottom repeats row 2.",
        ),
        (changed(stresses(), "mode", 1, 5), "s{}: column mode, row 1: modes 5 are not in the table of modes. Add them"),
        (
            changed(stresses(), "mode", LOAD, 3),
            f"s{{}}: column mode, row {LOAD}: the row has a mode and a unit load. Give one of them",
        ),
        (
            changed(stresses(), "unit_load", LOAD, None),
            f"s{{}}: column mode, row {LOAD}: the row has neither a mode nor a unit load. Give one of them.",
        ),
        (
            changed(stresses(), "surface", 1, "upper"),
            "s{}: column surface, row 1: 'upper' is not one of top, bottom, edge. Give one of top, bottom, edge.",
        ),
        (
            changed(stresses(), "surface", 1, "edge"),
            "s{}: column surface, row 1: point a is of kind hot_spot_a, whose surface is top or bottom. Give top or",
        ),
        (
            changed(stresses(), "surface", FIRST_B, "top"),
            f"s{{}}: column surface, row {FIRST_B}: point b is of kind hot_spot_b, whose surface is edge. Give edge,",
        ),
        (changed(stresses(), "sx_MPa", 4, None), "s{}: column sx_MPa, row 4: the value is missing or NaN. Give a"),
        (changed(stresses(), "txy_MPa", 4, None), "s{}: column txy_MPa, row 4: the value is missing or NaN. Give a"),
        (changed(stresses(), "sy_MPa", 4, float("inf")), "s{}: column sy_MPa, row 4: inf is not finite. Give a finite"),
        (
            changed(stresses(), "distance_mm", 4, None),
            "s{}: column distance_mm, row 4: the value is missing or NaN. Give the distance of the read-out",
        ),
        (
            changed(stresses(), "distance_mm", 4, 9.0),
            "s{}: column distance_mm, row 4: 9 mm of point a, read-out 1 was 10 mm before. Give one distance to each",
        ),
        (
            changed(stresses(), "distance_mm", 4, -4.0),
            "s{}: column distance_mm, row 4: -4 is below 0. Give at least 0.",
        ),
        (changed(stresses(), "read_out", 4, 1.5), "s{}: column read_out, row 4: 1.5 is not a whole number."),
    ],
)
def test_bad_stresses(tmp_path, suffix, columns, message):
    """A mistake is told with file, place, value and remedy."""
    points, coordinates = body(tmp_path)
    path = write(tmp_path / f"s{suffix}", columns)
    assert message.format(suffix) in refusal_of(read_modal_stresses, path, points, coordinates, ())


def test_distances_of_no_set(tmp_path):
    """Read-outs that fit no rule are refused, once for each kind, with the sets; a point without a toe has one."""
    points, coordinates = body(tmp_path)
    columns = stresses()
    moved = {("a", 4.0): 5.0, ("b", 8.0): 8.2, ("p", 0.0): 0.0}
    keys = zip(columns["point"], columns["distance_mm"], strict=True)
    columns["distance_mm"] = [moved.get(key, key[1]) for key in keys]
    again = picked(columns, [i for i, name in enumerate(columns["point"], 1) if name == "p"])
    again["read_out"] = [2] * len(again["point"])
    columns = {name: values + again[name] for name, values in columns.items()}
    found = refusal_of(read_modal_stresses, write(tmp_path / "s.csv", columns), points, coordinates, ()).splitlines()
    remedy = "Read the stress at the distances of one set: "
    of_a = "s.csv: point a: read-outs at 5, 10 mm are no set of kind hot_spot_a, within 1 % of its 10 mm. "
    of_a += remedy + "a fine (0.4 t, 1 t), a quadratic (0.4 t, 0.9 t, 1.4 t), a coarse (0.5 t, 1.5 t)."
    of_b = "s.csv: point b: read-outs at 4, 8.2, 12 mm are no set of kind hot_spot_b, within 0.1 mm. "
    of_b += remedy + "b fine (4 mm, 8 mm, 12 mm), b coarse (5 mm, 15 mm)."
    of_p = "s.csv: point p: 2 read-outs are given, and a point of kind parent has one. Keep the read-out at the point."
    assert found == [of_a, of_b, of_p]
