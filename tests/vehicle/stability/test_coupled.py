"""Equipment below a car body: mounts and hangers in series."""

from dataclasses import replace

import numpy as np
import pytest

from fatigue.errors import NumericalError
from fatigue.vehicle.definition import Vehicle
from fatigue.vehicle.elastic import ElasticBody, Point
from fatigue.vehicle.stability.coupled import coupled_hz, hanger_flexibility, mounts_for


def body(stiffness_N_m):
    """A body whose one mode moves all converter hangers alike and has this stiffness there."""
    w = 2 * np.pi * 500.0
    shape = np.zeros((6, 1))
    shape[1] = w / np.sqrt(stiffness_N_m)
    points = {f"converter_{mount}": Point(np.zeros(3), shape) for mount in (1, 2, 3, 4)}
    return ElasticBody(3e4, np.zeros(3), np.eye(3), np.array([500.0]), np.array([0.1]), points)


def test_hangers_in_series_with_mounts():
    """Two springs in series: the closed form."""
    vehicle = Vehicle()
    assert hanger_flexibility(body(53e6)) == pytest.approx(1 / 53e6)
    mounts = 6600 * (2 * np.pi * 9.2) ** 2
    expected = np.sqrt(mounts * 53e6 / (mounts + 53e6) / 6600) / (2 * np.pi)
    assert coupled_hz(vehicle, body(53e6)) == pytest.approx(expected)


def test_mounts_for_a_frequency():
    """The mounts that are found give the frequency that was asked for."""
    vehicle = Vehicle()
    for wanted in (9.2, 9.71, 12.0, 14.0):
        fe = mounts_for(vehicle, body(106e6), wanted)
        found = replace(vehicle, converter=replace(vehicle.converter, fe_hz=fe))
        assert coupled_hz(found, body(106e6)) == pytest.approx(wanted)
        assert fe > wanted


def test_hangers_that_are_too_soft():
    """The shipped hangers of 8.5 MN/m carry 6.6 t at 5.7 Hz at most, and that is said."""
    with pytest.raises(NumericalError, match=r"no mounts give 9\.2 Hz: on rigid ones its hangers give 5\.712 Hz"):
        mounts_for(Vehicle(), body(8.5e6), 9.2)
