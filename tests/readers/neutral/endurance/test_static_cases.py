"""Static load cases: what the file says arrives, and what it says wrong is told."""

from pathlib import Path

import numpy as np
import pytest

from fatigue.case import load_case
from fatigue.errors import DataError
from fatigue.readers.neutral.body.coordinates import Coordinates
from fatigue.readers.neutral.body.modes import Modes, read_modes
from fatigue.readers.neutral.endurance.endurance_lines import read_endurance_lines
from fatigue.readers.neutral.endurance.static_cases import read_static_cases
from tests.readers.neutral_tables import changed, without, write

ONES = np.ones(2)
BODY = Coordinates(Modes(np.array([3, 7]), ONES, ONES, ONES, ("normal", "normal"), ONES), ("payload",))
CASES = {
    "case": ["dead", "full", "pitch", "roll", "a", "b", "c"],
    "kind": ["static", "static", "alternating", "alternating", "state", "state", "state"],
    "group": ["ride"] * 4 + ["stops"] * 3,
    "factor": [1.0, 2.0, 0.5, None, None, None, None],
    "q_7": [1.0, 3.0, 4.0, None, 1.0, 2.0, 3.0],
    "u_payload": [10.0, 20.0, None, 8.0, None, None, 5.0],
}
AT_POINTS = {
    "case": ["a", "a", "b", "b"],
    "kind": ["state"] * 4,
    "group": ["stops"] * 4,
    "factor": [1.0, 1.0, -2.0, -2.0],
    "point": ["p2", "p1", "p1", "p2"],
    "sx_MPa": [10.0, 20.0, 30.0, None],
    "txy_MPa": [1.0, 2.0, 3.0, 4.0],
}
SUFFIXES = pytest.mark.parametrize("suffix", [".csv", ".parquet"])


def refusal(path, ignore=()):
    """Message of the refusal of a file."""
    with pytest.raises(DataError) as refused:
        read_static_cases(path, BODY, ignore)
    return str(refused.value)


@SUFFIXES
def test_amounts_of_coordinates(tmp_path, suffix):
    """Amounts stand in the order of the coordinates, times their factor, 0 where absent; static cases add up."""
    groups, warnings = read_static_cases(write(tmp_path / f"c{suffix}", CASES), BODY, ())
    assert warnings == []
    ride, stops = groups["ride"], groups["stops"]
    assert (ride.kind, ride.cases, ride.points) == ("alternating", ("pitch", "roll"), ())
    np.testing.assert_array_equal(ride.static, [0.0, 7.0, 50.0])
    np.testing.assert_array_equal(ride.loads, [[0.0, 2.0, 0.0], [0.0, 0.0, 8.0]])
    assert (stops.kind, stops.cases) == ("state", ("a", "b", "c"))
    np.testing.assert_array_equal(stops.static, np.zeros(3))
    np.testing.assert_array_equal(stops.loads, [[0.0, 1.0, 0.0], [0.0, 2.0, 0.0], [0.0, 3.0, 5.0]])


def test_stress_is_linear_in_the_amounts(tmp_path):
    """The stress of a case is the sum over the coordinates, whatever the shape of the modal stress."""
    groups, _ = read_static_cases(write(tmp_path / "c.csv", CASES), BODY, ())
    modal = np.arange(24.0).reshape(2, 3, 4)
    np.testing.assert_allclose(groups["ride"].static_of(modal), 7.0 * modal[:, 1] + 50.0 * modal[:, 2])
    np.testing.assert_allclose(groups["stops"].loads_of(modal)[:, 2], 3.0 * modal[:, 1] + 5.0 * modal[:, 2])
    np.testing.assert_allclose(groups["stops"].loads_of(modal[..., 0])[:, 1], 2.0 * modal[:, 1, 0])


@SUFFIXES
def test_stresses_at_points(tmp_path, suffix):
    """With a column of points the stresses of the cases are given as they are, times their factor."""
    groups, _ = read_static_cases(write(tmp_path / f"c{suffix}", AT_POINTS), BODY, ())
    assert groups["stops"].points == ("p1", "p2")
    static, loads = groups["stops"].stress_at(["p2"])
    np.testing.assert_array_equal(static, np.zeros((1, 3)))
    np.testing.assert_array_equal(loads, [[[10.0, 0.0, 1.0], [0.0, 0.0, -8.0]]])


def test_an_ignored_mode_is_ignored(tmp_path):
    """Its column may stay in the table, as in a history."""
    path = write(tmp_path / "c.csv", CASES | {"q_9": [1.0] * 7})
    groups, _ = read_static_cases(path, BODY, (9,))
    np.testing.assert_array_equal(groups["ride"].static, [0.0, 7.0, 50.0])


def test_one_case_may_be_in_two_groups(tmp_path):
    """A case is what it is in each group."""
    groups, _ = read_static_cases(write(tmp_path / "c.csv", changed(CASES, "case", 5, "dead")), BODY, ())
    assert groups["stops"].cases == ("dead", "b", "c")


@SUFFIXES
@pytest.mark.parametrize(
    ("columns", "message"),
    [
        (without(CASES, "kind"), "column kind: the column is missing. Add it;"),
        (
            changed(CASES, "kind", 3, "dynamic"),
            "column kind, row 3: 'dynamic' is not one of static, alternating, state.",
        ),
        (changed(CASES, "group", 2, None), "column group, row 2: the text is missing. Give a text."),
        (
            changed(CASES, "case", 6, "a"),
            "column group, case, row 6: group stops, case a repeats row 5. Keep one of the",
        ),
        (changed(CASES, "factor", 1, 0.0), "column factor, row 1: 0 takes the case out. Remove the case instead."),
        (changed(CASES, "q_7", 2, float("inf")), "column q_7, row 2: inf is not finite. Give a finite number."),
        (CASES | {"q_9": [1.0] * 7}, "column q_9: the body has no mode 9. Remove the column, or add the mode to the"),
        (CASES | {"u_wind": [1.0] * 7}, "column u_wind: the body has no unit load 'wind', it has payload. Remove the"),
        (CASES | {"mode_7": [1.0] * 7}, "column mode_7: the column is unknown and not read. "),
        (
            without(without(CASES, "q_7"), "u_payload"),
            " no column is an amount of a mode or unit load. Give columns q_",
        ),
        (
            changed(CASES, "kind", 5, "static"),
            "column kind, row 5: group 'stops' has 2 state and 1 other cases. Add what",
        ),
        (
            changed(changed(CASES, "kind", 3, "static"), "kind", 4, "static"),
            "column kind, row 1: in group 'ride' all 4",
        ),
        (changed(CASES, "group", 7, "third"), "column kind, row 7: group 'third' has one state, which makes no pair."),
        (AT_POINTS | {"q_7": [1.0] * 4}, "column q_7: the column is unknown and not read. Remove it."),
        (
            without(without(AT_POINTS, "sx_MPa"), "txy_MPa"),
            "column point: the points have no stresses. Give sx_MPa, sy",
        ),
        (changed(AT_POINTS, "point", 4, None), "column point, row 4: the text is missing. Give a text."),
        (
            changed(AT_POINTS, "point", 4, "p3"),
            "column point: case 'a' of group 'stops' has no stress at 1 points, 'p3'.",
        ),
        (
            changed(AT_POINTS, "kind", 2, "static"),
            "column kind, row 2: case 'a' is static here and state in row 1. Give a",
        ),
        (changed(AT_POINTS, "sx_MPa", 1, "x"), "column sx_MPa, row 1: 'x' is not a number. Give a number."),
    ],
)
def test_bad_cases(tmp_path, suffix, columns, message):
    """Every mistake in the cases names file, column, row and value."""
    path = write(tmp_path / f"c{suffix}", columns)
    assert refusal(path).startswith(f"c{suffix}:{' ' * (message[0] != ' ')}{message}")


def test_the_tables_of_the_example_are_read():
    """Static load cases and invented lines of the car body go with its unit loads."""
    folder = Path(__file__).parents[4] / "data" / "carbody"
    case = load_case(folder / "case_loads.toml")
    modes, _ = read_modes(folder / "modes.csv", (), strict=True)
    loads = Coordinates(modes, tuple(load.name for load in case.body.unit_load))
    groups, warnings = read_static_cases(folder / "static_cases.csv", loads, ())
    lines, of_lines = read_endurance_lines(folder / "endurance_lines.csv", (), strict=True)
    assert warnings + of_lines == []
    assert {name: len(group.cases) for name, group in groups.items()} == {"ride": 3, "stops": 4}
    assert {line.component for line in lines.values()} == {"perp", "shear"}
    assert all("invented" in line.name and "invented" in line.edition for line in lines.values())
