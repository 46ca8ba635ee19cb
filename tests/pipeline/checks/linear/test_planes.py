"""The critical plane: that of the whole mission, not of each event; by range where nothing damages."""

import numpy as np
import pandas as pd
import pytest

from fatigue.case import load_case
from fatigue.life.curves import damage_law, user_curve
from fatigue.life.mission import Plan
from fatigue.life.rule import CycleRule
from fatigue.pipeline.checks import points as points_module
from fatigue.pipeline.checks.linear.planes import critical_planes, face_pairs
from fatigue.pipeline.checks.linear.signals import counted_mission
from fatigue.pipeline.checks.points import batches, point_rows
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.mission.plan import mission_plan
from fatigue.pipeline.run.work import ScreeningOptions, open_work
from fatigue.pipeline.solve.body import Body, read_body
from fatigue.pipeline.solve.point_stress import point_stress
from fatigue.pipeline.solve.weld_groups import one_group
from fatigue.weld.beside.planes import PARENT_DEG, TOE_DEG, normal_stress
from tests.small_case import small_case
from tests.stress_point_case import curve_text, point, stresses, write_points

IN_CHECKS = curve_text("points", 60.0, slopes=(3.0, 5.0), knees=(5e6,))


def rule_of(slopes=(3.0,), knees=(), reference=60.0):
    """Rule of the cycles on a curve in plain stress."""
    return CycleRule(
        damage_law(user_curve("c", slopes, knees, reference, "hot_spot", "test"), None, "none", 1e7), False
    )


@pytest.fixture(scope="module")
def mission(tmp_path_factory) -> tuple[list[EventLoad], Plan]:
    """Events that move sx alone, txy alone, both in phase, and the stress around a circle."""
    case = small_case()
    t = 0.005 * np.arange(400)
    sine, cosine, none = np.sin(2 * np.pi * 5.0 * t), np.cos(2 * np.pi * 5.0 * t), np.zeros_like(t)
    case.histories = {
        "x": pd.DataFrame({"time_s": t, "q_1": 40.0 * sine, "q_2": none, "q_7": none}),
        "xy": pd.DataFrame({"time_s": t, "q_1": none, "q_2": none, "q_7": 45.0 * sine}),
        "in phase": pd.DataFrame({"time_s": t, "q_1": 40.0 * sine, "q_2": none, "q_7": 30.0 * sine}),
        "turning": pd.DataFrame({"time_s": t, "q_1": 50.0 * cosine, "q_2": -50.0 * cosine, "q_7": 50.0 * sine}),
    }
    case.events = [{"name": name, "history": name, "per_1000_km": 1000.0} for name in case.histories]
    folder = tmp_path_factory.mktemp("planes")
    body = read_body(load_case(case.write(folder)), strict=False)
    plan, _ = mission_plan(body)
    work = open_work(one_group(body, folder), plan, ScreeningOptions(0.0), folder, threads=1)
    return list(work.loads), plan


def on_planes(planes=TOE_DEG):
    """Stress (1, d, 2, 3) at one point whose three coordinates are sx, sy and txy, the same at both faces."""
    return np.repeat(normal_stress(np.eye(3), np.array(planes, float))[None, :, None], 2, axis=2)


def events(mission, *which):
    """Some events and their plan."""
    loads, plan = mission
    at = [plan.names.index(name) for name in which]
    passes = tuple(plan.passes[i] for i in at)
    return [loads[i] for i in at], Plan(passes, plan.target_km, plan.km_per_year, plan.damage_limit)


def critical_of(mission, rule, *which, planes=TOE_DEG):
    """The critical plane [deg] of the top face under some events."""
    loads, plan = events(mission, *which)
    return planes[critical_planes(on_planes(planes), np.ones(1), rule, loads, plan, "test")[0, 0]]


def test_the_sum_of_the_mission_comes_first(mission):
    """One event is worst at 0 deg, one at 45 deg; together a plane between them is, with less than both sums."""
    rule = rule_of()
    assert critical_of(mission, rule, "x") == 0
    assert critical_of(mission, rule, "xy") == 45
    both = critical_of(mission, rule, "x", "xy")
    assert 0 < both < 45
    loads, plan = events(mission, "x", "xy")
    pairs = face_pairs(on_planes()[0], np.ones(len(TOE_DEG)), rule)
    damage = counted_mission(pairs, loads, plan, "test").damage_per_km[:, 0]
    alone = [counted_mission(pairs, *events(mission, name), "test").damage_per_km[:, 0].max() for name in ("x", "xy")]
    assert damage[TOE_DEG.index(both)] == damage.max()
    assert damage.max() < 0.95 * sum(alone)


def test_planes_at_both_faces_are_their_own(mission):
    """Each face has its critical plane; txy of the other sign turns it over."""
    stress = on_planes()
    stress[:, :, 1] = normal_stress(np.diag([1.0, 1.0, -1.0]), np.array(TOE_DEG, float))
    loads, plan = events(mission, "in phase")
    top, bottom = (TOE_DEG[i] for i in critical_planes(stress, np.ones(1), rule_of(), loads, plan, "test")[0])
    assert 0 < top == -bottom


def test_a_principal_stress_that_turns_is_seen_on_every_plane(mission):
    """Every plane has the range 100 and the same damage, so that the first one stands for all."""
    rule, (loads, plan) = rule_of(), events(mission, "turning")
    stress = on_planes(PARENT_DEG)[0]
    found = counted_mission(face_pairs(stress, np.ones(36), rule), loads, plan, "test")
    assert found.max_range == pytest.approx(np.full((36, 2), 100.0), rel=2e-2)
    half = 0.5 * 1e-3 * 1000.0  # an event counted by number is open: half cycles
    assert found.damage_per_km[9, 0] > 19 * half / (2e6 * (60.0 / 98.0) ** 3)
    assert critical_of(mission, rule, "x", planes=PARENT_DEG) == 0


def test_below_a_cut_off_the_largest_range_decides(mission):
    """Where no plane does any damage the critical one is that of the largest range; without stress the first one."""
    rule = rule_of((3.0, 5.0), (5e6, 1e8), 600.0)
    loads, plan = events(mission, "xy")
    assert not counted_mission(face_pairs(on_planes()[0], np.ones(25), rule), loads, plan, "test").damage_per_km.any()
    assert critical_of(mission, rule, "xy") == 45
    nothing = np.zeros((1, len(TOE_DEG), 2, 3))
    assert not critical_planes(nothing, np.ones(1), rule, loads, plan, "test").any()


@pytest.fixture(scope="module")
def points(tmp_path_factory) -> tuple[Body, list[EventLoad], Plan]:
    """Some points of the small case."""
    case, rng = small_case(), np.random.default_rng(2)
    case.extra = IN_CHECKS
    names = [f"P{i}" for i in range(6)]
    tables = [stresses(p, {m: rng.normal(size=(2, 3)) for m in (1, 2, 7)}, (4.0, 12.0), ("top",)) for p in names]
    folder = tmp_path_factory.mktemp("points")
    body = read_body(load_case(write_points(case, folder, [point(name) for name in names], tables)), strict=False)
    plan, _ = mission_plan(body)
    work = open_work(one_group(body, folder), plan, ScreeningOptions(0.0), folder, threads=1)
    return body, list(work.loads), plan


def test_batches_do_not_change_the_rows(points, monkeypatch):
    """Points counted one by one have the rows of points counted together; one surface needs no other."""
    body, loads, plan = points
    stress, _ = point_stress(body)
    together = point_rows(body.points, stress, body.curves, loads, plan, 1)
    monkeypatch.setattr(points_module, "AT_ONCE", 30)
    assert len(list(batches(body.points, body.curves))) == 6
    alone = point_rows(body.points, stress, body.curves, loads, plan, 3)
    assert set(together["surface"]) == {"top"}
    for name in together.dtype.names:
        if together[name].dtype.kind == "f":
            np.testing.assert_allclose(alone[name], together[name], rtol=1e-9)
        else:
            assert (alone[name] == together[name]).all()
