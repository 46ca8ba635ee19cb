"""Values of a case that are allowed and hardly meant."""

import pytest

from fatigue.case import case_warnings, load_case
from tests.small_case import small_case


def warnings_of(tmp_path, change):
    """Tell the warnings of a small case in which something is changed."""
    case = small_case(seconds=1.0)
    change(case)
    return case_warnings(load_case(case.write(tmp_path)))


def test_a_sound_case_is_silent(tmp_path):
    """Speeds, shares and mileages of a train are no doubt."""
    assert warnings_of(tmp_path, lambda case: None) == []


@pytest.mark.parametrize(
    ("place", "value", "code"),
    [
        ("speed_km_h", 600.1, "unusual_speed"),
        ("speed_km_h", 350e3, "unusual_speed"),  # m/h
        ("speed_km_h", 0.0972, "unusual_speed"),  # km/s
        ("stress_factor", 1000.0, "unusual_factor"),
        ("stress_factor", 1e-3, "unusual_factor"),
        ("target_km", 1.2e10, "unusual_mileage"),  # m
        ("target_km", 12.0, "unusual_mileage"),  # million km
        ("km_per_year", 5e8, "unusual_mileage"),
        ("km_per_year", 1369.0, "unusual_mileage"),  # of a day: 730 years
        ("damage_limit", 100.0, "unusual_limit"),  # per cent
        ("damage_limit", 1e-3, "unusual_limit"),
        ("yield_MPa", 250e6, "unusual_yield"),  # Pa
        ("yield_MPa", 0.25, "unusual_yield"),  # GPa
    ],
)
def test_values_beyond_what_is_usual(tmp_path, place, value, code):
    """Each is told with its place, its value and the bounds."""

    def change(case):
        table = case.curve if place == "yield_MPa" else case.mission if place in case.mission else case.events[0]
        table[place] = value

    (problem,) = warnings_of(tmp_path, change)
    assert problem.code == code
    assert problem.where.startswith("case.toml: ")
    assert f"{value:g}" in problem.what


@pytest.mark.parametrize(
    ("place", "values"),
    [
        ("speed_km_h", (1.0, 97.2, 600.0)),
        ("stress_factor", (0.1, 1.35, 10.0)),
        ("damage_limit", (0.3, 0.5, 1.0, 2.0)),
        ("yield_MPa", (20.0, 355.0, 2000.0)),
    ],
)
def test_usual_values_are_silent(tmp_path, place, values):
    """The bounds themselves belong to what is usual."""
    for value in values:

        def change(case, value=value):
            table = case.curve if place == "yield_MPa" else case.mission if place in case.mission else case.events[0]
            table[place] = value

        assert warnings_of(tmp_path, change) == []


def test_shares_next_to_nothing_and_events_that_never_happen(tmp_path):
    """A share of a millionth is told; one of 0 is an event that does no damage."""

    def change(case):
        case.events[0] |= {"share": 1.0 - 1e-6}
        case.events[1] |= {"share": 1e-6}
        case.events[2] |= {"per_1000_km": 0.0}

    share, idle = warnings_of(tmp_path, change)
    assert (share.code, idle.code) == ("unusual_share", "idle_event")
    assert "share = 1e-06 is outside 1e-05 to 1" in share.what
    assert "'load and unload'" in idle.where


def test_a_kind_is_told_once(tmp_path):
    """Of many speeds the one that is furthest off stands first, the others are counted."""

    def change(case):
        case.events = [
            case.events[0] | {"name": f"e{i}", "share": 0.05, "speed_km_h": 1e3 * (i + 1)} for i in range(20)
        ]

    (problem,) = warnings_of(tmp_path, change)
    assert problem.count == 20
    assert "speed_km_h = 20000" in problem.what
    assert "mission.event[20].speed_km_h ('e19')" in problem.where
    assert "and 16 more" in problem.what


def test_a_curve_in_other_units(tmp_path):
    """Ranges in Pa, the logarithm of cycles, the slope upside down."""

    def change(case):
        case.curve = {"name": "own"}
        case.extra = (
            "[curves.own]\nslopes = [0.333, 5.0]\nknees_cycles = [7.0]\nrange_at_2e6_MPa = 71e6\n"
            'applies = "structural"\nsource = "me"'
        )

    (problem,) = warnings_of(tmp_path, change)
    assert problem.code == "unusual_curve"
    assert problem.count == 3
    assert "range_at_2e6_MPa = 7.1e+07 is outside 5 to 1000 MPa" in problem.what
    assert "0.333 at curves.own.slopes" in problem.what


def test_events_whose_names_look_alike(tmp_path):
    """Two events that differ in the case of a letter."""
    (problem,) = warnings_of(tmp_path, lambda case: case.events[1].update(name="Sine"))
    assert problem.code == "similar_names"
    assert "'sine' and 'Sine'" in problem.what
