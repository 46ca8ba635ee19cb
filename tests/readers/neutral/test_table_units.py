"""Units that a neutral table states beside its names."""

import pytest

from fatigue.readers.neutral.table_units import column_unit, stated_unit_problem


@pytest.mark.parametrize(("name", "unit"), [("x_mm", "mm"), ("mx_Nmm", "Nmm"), ("mode", ""), ("s", ""), ("q_12", "")])
def test_unit_in_a_name(name, unit):
    """The last word behind an underscore, where it is a unit."""
    assert column_unit(name) == unit


@pytest.mark.parametrize(
    ("column", "unit", "code"),
    [
        ("time_s", "[sec]", None),
        ("fx_N", "Newton", None),
        ("x_mm", "m", "unit"),
        ("q_3", "sqrt(t)*mm", None),
        ("q_3", "mm*sqrt(t)", None),
        ("q_3", "[mm*sqrt(t)]", None),
        ("q_3", "(mm sqrt(t))", None),
        ("q_3", "mm·t^0.5", None),
        ("q_3", "t**0.5 mm", None),
        ("q_3", "mm √t", None),
        ("q_3", "mm*sqrt(kg)", "unit"),
        ("q_3", "m*sqrt(t)", "unit"),
        ("x_mm", "(mm", None),
        ("mx_Nmm", "[N*mm]", None),
        ("mx_Nmm", "N.mm", None),
        ("fx_N", "kN", "unit"),
        ("q_3", "m", "unit"),
        ("mode", "-", None),
        ("mode", "Hz", "unit_unused"),
    ],
)
def test_a_unit_beside_a_name(column, unit, code):
    """It agrees, contradicts the name, or is not used."""
    problem = stated_unit_problem("here", column, unit)
    assert (None if problem is None else problem.code) == code
