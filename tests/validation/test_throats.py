"""Throats against worked numbers: eleven joints, and the micro example of one station under two events."""

import json
from pathlib import Path

import numpy as np
import pytest

from fatigue.life.curves import damage_law, user_curve
from fatigue.life.mission import Pass, Plan
from fatigue.life.records.history import ModalHistory
from fatigue.life.rule import CycleRule
from fatigue.pipeline.checks.linear.counted import counted_each
from fatigue.pipeline.checks.linear.directions import half_circle, worst_directions
from fatigue.pipeline.mission.event_load import HowCounted, prepare_event
from fatigue.weld.structural_stress import StructuralStress
from fatigue.weld.throat import LineForce, lap_throat, line_force, tee_throat, throat_stress, weld_forces

WORKED = json.loads((Path(__file__).parents[1] / "data" / "throats.json").read_text())
MICRO = WORKED["micro_example"]
PSI = half_circle(5.0)
SUMS = np.stack([np.cos(np.radians(PSI)), np.sin(np.radians(PSI))], axis=1)


@pytest.mark.parametrize("case", WORKED["throats"], ids=[case["name"] for case in WORKED["throats"]])
def test_worked_joint(case):
    """Forces, centroids and stresses of a joint are the worked ones."""
    t = np.array([float(case["plate_thickness_mm"])])
    of_joint = {"tee": tee_throat, "lap": lap_throat}[case["joint"]]
    throat = of_joint(t, case["throat_mm"], case["penetration_mm"], case["line_offset_mm"])
    force, moment = case["line_force_N_per_mm"], case["line_moment_N"]
    given = (force["fx"], force["fy"], force["fz"], moment["mx"], moment["my"])
    load = LineForce(*(np.array([[float(value)]]) for value in given))
    largest = max(abs(v) for weld in case["welds"].values() for v in weld.values() if isinstance(v, float))
    for side, of_weld in weld_forces(load, throat, tuple(case["sides"]), t).items():
        want, stress = case["welds"][side], throat_stress(of_weld, throat, side)
        sign = 1.0 if side == "top" else -1.0
        found = {
            "centroid_y": throat.centroid[0],
            "centroid_z": sign * throat.centroid[1],
            "sigma_perp": stress.sigma_perp,
            "tau_perp": stress.tau_perp,
            "tau_par": stress.tau_par,
            "moment": of_weld.moment,
            "sigma_bend_root": stress.bending,
            "sigma_root": stress.root,
            "sigma_face": stress.face,
            "sigma_wf": np.hypot(stress.sigma_perp, stress.tau_perp),
        }
        assert {"force", *found} == set(want)
        for name, value in found.items():
            assert float(value.ravel()[0]) == pytest.approx(want[name], rel=1e-8, abs=1e-8 * largest), (side, name)
        components = [float(part[0, 0]) for part in (of_weld.x, of_weld.y, of_weld.z)]
        np.testing.assert_allclose(components, want["force"], rtol=1e-8, atol=1e-8 * largest)


@pytest.fixture(scope="module")
def micro():
    """Throat stress of the micro example per unit coordinate, its events and its mission."""
    given = MICRO["inputs"]
    t = np.array([given["thickness_mm"]])
    names = StructuralStress.__dataclass_fields__
    stress = StructuralStress(*(np.array([[mode[name] for mode in given["modes"].values()]]) for name in names))
    throat = tee_throat(t, given["throat_mm"], 0.0, 0.0)
    forces = weld_forces(line_force(stress, t), throat, ("top", "bottom"), t)
    of_sides = {side: throat_stress(force, throat, side) for side, force in forces.items()}
    loads, passes = [], []
    for name, event in given["events"].items():
        q = np.ascontiguousarray(np.array(event["q"], dtype=np.float64).T)
        history = ModalHistory(name, np.arange(len(q)), q, 0.01, 0.0)
        loads.append(prepare_event(history, HowCounted(event["residue"]), None, None))
        share = 1.0 if "length_km" in event else None
        passes.append(Pass(name, q.shape[1], event.get("length_km"), share, event.get("per_1000_km")))
    return of_sides, loads, Plan(tuple(passes), given["target_km"], 1000.0, 1.0)


def european(range_at_2e6, slopes, knees):
    """Rule of a class with its knees."""
    curve = user_curve("class", slopes, knees, range_at_2e6, "throat", "worked example")
    return CycleRule(damage_law(curve, None, "none", 1e7), uses_bending_ratio=False)


@pytest.mark.parametrize("side", ["top", "bottom"])
def test_micro_example(micro, side):
    """Histories, the critical direction and both damage sums are the worked ones, event by event and in all."""
    of_sides, loads, plan = micro
    stress, want = of_sides[side], MICRO["throat_mission"][side]
    across = european(MICRO["inputs"]["class_throat"], (3.0, 5.0), (1e7,))
    along = european(MICRO["inputs"]["class_tau"], (5.0,), (1e8,))
    for load in loads:
        worked = MICRO["throat"][load.counted.event][side]
        for name in ("sigma_perp", "tau_perp", "tau_par"):
            np.testing.assert_allclose(getattr(stress, name)[0] @ load.counted.q, worked[name], rtol=1e-8, atol=1e-8)
    parts, size = np.stack([stress.sigma_perp, stress.tau_perp], axis=1), np.ones(1)
    direction = worst_directions(parts, SUMS, size, across, loads, plan, side)
    assert PSI[direction[0]] == want["direction_deg"]
    (perp,) = counted_each([np.einsum("np,npc->nc", SUMS[direction], parts)], size, across, loads, plan, side)
    (par,) = counted_each([stress.tau_par], size, along, loads, plan, side)
    assert perp["damage_sum"][0] == pytest.approx(want["D_perp"], rel=1e-8)
    assert par["damage_sum"][0] == pytest.approx(want["D_par"], rel=1e-8)
    assert perp["damage_sum"][0] + par["damage_sum"][0] == pytest.approx(want["en1993_sum"], rel=1e-8)
