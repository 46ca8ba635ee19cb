"""Unit systems are consistent."""

import pytest

from fatigue.errors import CaseError
from fatigue.readers.units.systems import SYSTEMS, unit_system


@pytest.mark.parametrize(("name", "newton"), [("mm-t-s", 1.0), ("m-kg-s", 1.0), ("in-lbf-s", 4.4482216152605)])
def test_force(name, newton):
    """Mass times length over s^2 is the unit of force; the pound-force of NIST SP 811."""
    assert SYSTEMS[name].force == pytest.approx(newton, rel=1e-12)


def test_modal_coordinate():
    """1 m of a mode of unit mass in kg is 1000 mm sqrt(1e-3 t); of unit displacement it is 1000 mm."""
    assert SYSTEMS["m-kg-s"].modal_coordinate("mass") == pytest.approx(1000 * 1e-3**0.5)
    assert SYSTEMS["m-kg-s"].modal_coordinate("length") == 1000.0


def test_an_unknown_system():
    """Those known are named."""
    with pytest.raises(CaseError, match=r"here: unknown unit system 'cgs'. Name one of mm-t-s, m-kg-s, in-lbf-s"):
        unit_system("cgs", "here")
