"""Lateral frequencies of equipment in the vehicle: closed forms, both ways, and what a soft body cannot give."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from fatigue.errors import CaseError
from fatigue.vehicle.definition import Vehicle
from fatigue.vehicle.elastic import Point
from fatigue.vehicle.stability.coupled import (
    coupled,
    free_body,
    hanger_stiffness,
    in_series_hz,
    mount_coupled,
    mount_in_series,
    with_mounts,
)
from tests.vehicle_bodies import MASS, elastic_body, rigid_body
from tests.vehicle_oracles import body

frequencies = st.floats(1.5, 30.0)


def soft_at(stiffness, equipment="converter", hz=400.0):
    """A car body that gives way by 1/k along y at each mount of equipment alone, by one mode for each, and is rigid."""
    found = elastic_body(np.full(4, hz))
    points = {}
    for name, point in found.points.items():
        shape = np.zeros((6, 4))
        if name.startswith(equipment):
            shape[1, int(name[-1]) - 1] = 2.0 * np.pi * hz / np.sqrt(stiffness)  # phi^2/w^2 = 1/k
        points[name] = Point(point.place, shape)
    return replace(found, points=points)


def test_on_a_rigid_body_series_is_nominal():
    """Nothing gives way: the frequency in series is the nominal one, and there is no limit."""
    assert in_series_hz(Vehicle(), rigid_body()) == pytest.approx(9.2, rel=1e-12)
    assert mount_in_series(Vehicle(), rigid_body(), 14.0) == pytest.approx(14.0, rel=1e-9)
    assert hanger_stiffness(rigid_body()) == np.inf


def test_coupled_with_a_rigid_body_is_the_two_mass_oscillator():
    """All inertia against rotation: converter and car body swing against each other, ``w^2 = k (1/m + 1/M)``."""
    stiff = replace(rigid_body(), inertia=1e12 * np.eye(3))
    vehicle = Vehicle()
    huge = dict.fromkeys(("ixx_kg_m2", "iyy_kg_m2", "izz_kg_m2"), 1000000000000.0)
    vehicle = replace(vehicle, converter=replace(vehicle.converter, **huge))
    vehicle = replace(vehicle, transformer=replace(vehicle.transformer, mass_kg=1e-6))
    found = coupled(vehicle, stiff)
    assert found.coupled_hz == pytest.approx(9.2 * np.sqrt(1.0 + 6600.0 / MASS), rel=1e-6)
    assert found.coupled_share == pytest.approx(MASS / (MASS + 6600.0), rel=1e-5)


@pytest.mark.parametrize("equipment", ["converter", "transformer"])
def test_hangers_in_series_are_springs_in_series(equipment):
    """Four hangers of k_h and four mounts of k: ``4/(1/k + 1/k_h)``, and 4 k_h at most."""
    k_h = 2.0e6
    soft, of = soft_at(k_h, equipment), getattr(Vehicle(), equipment)
    assert hanger_stiffness(soft, equipment) == pytest.approx(4 * k_h, rel=1e-9)
    k = of.mass_kg * (2.0 * np.pi * of.fe_hz) ** 2 / 4.0
    expected = np.sqrt(4.0 / (1.0 / k + 1.0 / k_h) / of.mass_kg) / (2.0 * np.pi)
    assert in_series_hz(Vehicle(), soft, equipment) == pytest.approx(expected, rel=1e-9)


@given(frequencies, st.floats(1e6, 1e9))
@settings(deadline=None, max_examples=40)
def test_mounts_in_series_give_what_is_wanted_or_say_the_limit(wanted, k_h):
    """Forward proves backward; what is refused lies beyond the stiffness of the hangers."""
    limit = np.sqrt(4.0 * k_h / 6600.0) / (2.0 * np.pi)
    assume(abs(wanted / limit - 1.0) > 1e-4)
    if wanted < limit:
        nominal = mount_in_series(Vehicle(), soft_at(k_h), wanted)
        assert nominal > wanted
        assert in_series_hz(with_mounts(Vehicle(), nominal), soft_at(k_h)) == pytest.approx(wanted, rel=1e-6)
    else:
        with pytest.raises(CaseError, match=rf"it has {limit:.2f} Hz at most, however stiff the mounts"):
            mount_in_series(Vehicle(), soft_at(k_h), wanted)


@pytest.mark.parametrize("wanted", [2.0, 5.0, 8.0, 9.2])
def test_mounts_give_a_coupled_frequency(wanted):
    """On the frame body, forward and backward, exactly; in the running vehicle it is nearly the same."""
    found = coupled(with_mounts(Vehicle(), mount_coupled(Vehicle(), body(), wanted)), body())
    assert found.coupled_hz == pytest.approx(wanted, rel=1e-6)
    assert found.running.frequency_hz == pytest.approx(wanted, rel=0.03)
    assert found.running.of.name == "converter lateral"


def test_the_reference_converter_is_coupled_at_9_0_hz():
    """9.2 Hz nominal: 8.990 Hz coupled, 9.026 Hz and 4.1 % running; on the weak basis nothing gives way locally."""
    found = coupled(Vehicle(), body())
    assert found.nominal_hz == 9.2
    assert found.in_series_hz == pytest.approx(9.2, rel=1e-12)
    assert found.coupled_hz == pytest.approx(8.990, abs=5e-4)
    assert found.running.frequency_hz == pytest.approx(9.026, abs=5e-4)
    assert found.running.damping == pytest.approx(0.0412, abs=5e-5)
    assert 0.5 < found.running_share < found.running.of.shares["conv"]


def test_what_no_mounts_give_is_refused_with_the_limit():
    """Soft hangers: a highest frequency. Modes of the body in the way: the frequencies on both sides of them."""
    soft = soft_at(2.0e6)
    stiffest = free_body(Vehicle(), soft, "converter").mode(1e12)[0]
    with pytest.raises(
        CaseError, match=r"coupled with the car body it has \d\.\d\d Hz at most, however stiff"
    ) as caught:
        mount_coupled(Vehicle(), soft, 14.0)
    assert f"it has {stiffest:.2f} Hz at most" in str(caught.value)
    assert "its hangers have 8 MN/m" in str(caught.value)
    with pytest.raises(CaseError, match=r"9\.9\d Hz at most below, 20\.4\d Hz at least above, and modes of the body"):
        mount_coupled(Vehicle(), body(), 14.0)


@pytest.mark.parametrize("wanted", [0.0, -1.0, np.nan, np.inf])
@pytest.mark.parametrize("find", [mount_in_series, mount_coupled])
def test_no_frequency(find, wanted):
    """One clear line."""
    with pytest.raises(CaseError, match="is no frequency"):
        find(Vehicle(), rigid_body(), wanted)


@given(st.floats(2.0, 40.0))
@settings(deadline=None, max_examples=20)
def test_all_mounts_that_make_a_frequency(hz):
    """Each stiffness found makes it an eigenvalue of the free body."""
    free = free_body(Vehicle(), body(), "converter")
    for k in free.mounts_with(hz):
        shifted = free.K + k * free.R.T @ free.R - (2.0 * np.pi * hz) ** 2 * free.M
        scaled = np.linalg.eigvalsh(shifted / np.sqrt(np.outer(np.diag(free.M), np.diag(free.M))))
        assert np.abs(scaled).min() < 1e-6 * (2.0 * np.pi * hz) ** 2 * (1.0 + k / 1e9)
