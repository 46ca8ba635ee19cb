"""Formulas of the recount beside the toe: throats by hand, extrapolation, planes, pairs of static load cases."""

import numpy as np
import pandas as pd
import pytest

from fatigue.verify.recount.anew.beside.endurance import (
    CaseStates,
    HaighLine,
    alternating,
    plane_range,
    worst_combination,
    worst_cycle,
)
from fatigue.verify.recount.anew.beside.point_stress import NEAR_TOE, on_plane, point_tensors, shear_on_plane
from fatigue.verify.recount.anew.beside.throat import throat_stress
from fatigue.verify.recount.inputs.coordinates import RecountCoordinates

TEE = {"joint": "tee", "throat_mm": 4.0, "penetration_mm": 0.0, "line_offset_mm": 0.0, "lever": ""}
LINE = HaighLine.through(np.array([0.5, -1.0, 0.0]), np.array([126.315789474, 60.0, 92.3076923077]))


def of_force(f_y: float, t: float) -> np.ndarray:
    """Components of a line force across the weld alone."""
    return np.array([[f_y / t, 0.0, 0.0, 0.0, 0.0]])


def test_throats_in_tension():
    """Two welds share a tension N, sigma_perp = |tau_perp| = N / (2 sqrt2 a); one is bent by 6 z_c N / a^2, too."""
    both = throat_stress(TEE | {"sides": "both"}, of_force(240.0, 8.0), 8.0, "top")
    assert both["sigma_perp"][0] == pytest.approx(240.0 / (2.0 * np.sqrt(2.0) * 4.0))
    assert both["tau_perp"][0] == pytest.approx(-both["sigma_perp"][0])
    assert both["bending"][0] == 0.0
    one = throat_stress(TEE | {"sides": "bottom"}, of_force(240.0, 8.0), 8.0, "bottom")
    z_c = 8.0 / 2.0 + np.sqrt(0.5) * 4.0 / 2.0
    root = one["sigma_perp"][0] + one["bending"][0]
    assert root == pytest.approx(240.0 / (np.sqrt(2.0) * 4.0) + 6.0 * z_c * 240.0 / 4.0**2)


def test_a_lap_joint_without_restraint():
    """With a leg as long as the plate is thick the root has -2 N / t, the face +4 N / t."""
    t = 6.0
    lap = {"joint": "lap", "sides": "top", "throat_mm": t / np.sqrt(2.0), "penetration_mm": 0.0, "line_offset_mm": 0.0}
    found = throat_stress(lap, of_force(60.0, t), t, "top")
    assert found["sigma_perp"][0] + found["bending"][0] == pytest.approx(-2.0 * 60.0 / t)
    assert found["sigma_perp"][0] - found["bending"][0] == pytest.approx(4.0 * 60.0 / t)


def test_extrapolation_and_planes():
    """The weights are as printed, each mode with its scale; planes turn the tensor, 0 deg first at a toe."""
    coordinates = RecountCoordinates(np.array([2, 5]), (), np.array([1.0, 3.0]), 10.0)
    rows = pd.DataFrame(
        {
            "read_out": [1, 2, 1],
            "distance_mm": [10.0, 4.0, 10.0],
            "mode": [5, 5, 9],
            "surface": "top",
            "sx_MPa": [90.0, 108.0, 1e9],
            "sy_MPa": 0.0,
            "txy_MPa": 0.0,
        }
    )
    found = point_tensors(rows, "hot_spot_a", 10.0, coordinates, np.array([1.0, 3.0]))
    assert found["top"][0].tolist() == pytest.approx([0.0, 3.0 * 120.06])
    tensor = np.array([[100.0], [20.0], [30.0]])
    assert on_plane(tensor, 0.0)[0] == pytest.approx(100.0)
    assert on_plane(tensor, 20.0)[0] == pytest.approx(109.925406015)
    assert shear_on_plane(tensor, 45.0)[0] == pytest.approx(-40.0)
    assert (NEAR_TOE[0], len(NEAR_TOE), max(NEAR_TOE), min(NEAR_TOE)) == (0.0, 25, 60.0, -60.0)


def test_alternating_loads():
    """Three loads of either sense about a static one: range, R and the distance in the plane of normal and shear."""
    in_shear = 1.0 / np.sqrt(3.0)
    loads = np.array([[12.0, 0.0, 4.0 * in_shear], [8.0, 0.0, -6.0 * in_shear], [-5.0, 0.0, 9.0 * in_shear]])
    of = alternating(np.array([30.0, 0.0, 5.0 * in_shear]), loads)
    cycle = worst_cycle(of, "perp", None)
    assert (cycle["range_max_MPa"], cycle["R"]) == pytest.approx((50.0, 5.0 / 55.0))
    assert plane_range(of) == pytest.approx(54.626001135)


@pytest.mark.parametrize(("R", "amplitude"), [(-1.0, 60.0), (-0.7, 56.9832402235), (-0.3, 51.6556291391), (5.0, 60.0)])
def test_endurance_line(R, amplitude):
    """The allowed amplitude is linear in the Haigh plane; in compression it is that of the first row."""
    kappa = (1.0 + R) / (1.0 - R)
    assert LINE.allowed(kappa, 1.0) == pytest.approx(amplitude)


def test_combination_and_what_lies_outside():
    """Components are taken at one pair of states; a cycle above the last row has no allowed amplitude, but a bound."""
    states = CaseStates(np.array([[60.0, 0.0, 0.0], [-42.0, 0.0, 30.0]]))
    u = 51.0 / 56.9832402235
    value, inside = worst_combination(states, {"perp": LINE, "shear": LINE}, ()) or (np.nan, False)
    assert (value, inside) == (pytest.approx(u**2 + (15.0 / LINE.allowed(1.0, 1.0)) ** 2), True)
    cycle = worst_cycle(CaseStates(np.array([[100.0, 0.0, 0.0], [90.0, 0.0, 0.0]])), "perp", LINE)
    assert np.isnan(cycle["utilisation_stress"])
    assert cycle["severity"] == pytest.approx(100.0 / 126.315789474)
