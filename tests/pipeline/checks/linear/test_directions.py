"""The critical direction of two stresses: against counting every direction on its own, and what must not be counted."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.life.counting.rainflow import rainflow
from fatigue.life.curves import catalogue, damage_law, user_curve
from fatigue.life.mission import Loop, Pass, Plan
from fatigue.life.records.history import ModalHistory
from fatigue.life.rule import CycleRule, cycle_damage
from fatigue.pipeline.checks.linear import directions
from fatigue.pipeline.checks.linear.directions import direction_damage, half_circle, worst_directions
from fatigue.pipeline.checks.linear.signals import Signals, counted_damage, counted_mission
from fatigue.pipeline.mission.event_load import HowCounted, prepare_event

PSI = half_circle(5.0)
SUMS = np.stack([np.cos(np.radians(PSI)), np.sin(np.radians(PSI))], axis=1)
PLAIN = CycleRule(damage_law(user_curve("c", (3.0,), (), 30.0, "throat", "test"), None, "none", 1e7), False)
KNEE = CycleRule(damage_law(user_curve("c", (3.0, 5.0), (5e6, 1e8), 30.0, "throat", "test"), None, "none", 1e7), False)
MASTER = CycleRule(damage_law(catalogue()["master-steel"], None, "none", 1e7), True)
ONE = np.ones(1)
PARTS = np.eye(2)[None]  # the coordinates are sigma_perp and tau_perp themselves


def event(name, across, residue="repeat", **how):
    """An event of two stresses over time."""
    q = np.ascontiguousarray(np.array(across, dtype=np.float64))
    history = ModalHistory(name, np.arange(len(q)), q, 0.01, 0.0)
    return prepare_event(history, HowCounted(residue, **how), None, None)


def plan_of(*weights, loops=()):
    """A mission of events that occur so often per km."""
    passes = tuple(Pass(f"event {i}", 10, None, None, 1000.0 * weight) for i, weight in enumerate(weights))
    return Plan(passes, 1e3, 1.0, 1.0, loops)


def by_brute_force(loads, weights, rule, residue):
    """Damage per km in every direction: each history made, counted and summed up on its own."""
    total = np.zeros(len(SUMS))
    for load, weight in zip(loads, weights, strict=True):
        for i, stress in enumerate(load.stress_factor * (SUMS @ load.counted.q)):
            cycles = rainflow(stress, residue)
            total[i] += weight * float((cycles.count * cycle_damage(cycles.range, rule.law)).sum())
    return total


@given(st.integers(0, 2**32 - 1), st.sampled_from(["repeat", "half"]), st.sampled_from([PLAIN, KNEE]))
@settings(max_examples=15, deadline=None)
def test_every_direction_is_counted(seed, residue, rule):
    """Damage in all directions is that of histories counted one by one, and the worst is the worst of the sums."""
    rng = np.random.default_rng(seed)
    loads = [event(f"e{i}", rng.normal(0.0, 40.0, (2, 60)), residue, stress_factor=1.0 + i) for i in range(2)]
    weights = (0.5, 2.0)
    expected = by_brute_force(loads, weights, rule, residue)
    found = direction_damage(SUMS, 1.0, rule, loads, plan_of(*weights), "a point")
    np.testing.assert_allclose(found, expected, rtol=1e-9)
    worst = worst_directions(PARTS, SUMS, ONE, rule, loads, plan_of(*weights), "a point")
    assert expected[worst[0]] == pytest.approx(expected.max(), rel=1e-9)


def test_the_worst_of_the_sums_and_not_the_sum_of_the_worst():
    """Two events at right angles: what each does in its own worst direction belongs to no single crack."""
    wave = np.sin(2.0 * np.pi * np.arange(40) / 40.0)
    loads = [event("a", [50.0 * wave, 0.0 * wave]), event("b", [0.0 * wave, 50.0 * wave])]
    damage = [direction_damage(SUMS, 1.0, PLAIN, [load], plan_of(1.0), "x") for load in loads]
    assert [PSI[one.argmax()] for one in damage] == [0.0, 90.0]
    both = direction_damage(SUMS, 1.0, PLAIN, loads, plan_of(1.0, 1.0), "x")
    np.testing.assert_allclose(both, damage[0] + damage[1], rtol=1e-12)
    assert both.max() < 0.6 * (damage[0].max() + damage[1].max())


def test_a_force_that_changes_its_sign_has_its_whole_range():
    """The resultant of +-10 has the range 10, and that of a force that turns none; here both have 20."""
    wave = np.sin(2.0 * np.pi * np.arange(200) / 200.0)
    turned = np.roll(wave, 50)
    for across in ([10.0 * wave, 0.0 * wave], [10.0 * wave, 10.0 * turned]):
        load = event("e", across)
        worst = worst_directions(PARTS, SUMS, ONE, PLAIN, [load], plan_of(1.0), "x")
        signals = Signals.of_pairs(SUMS[worst], SUMS[worst], ONE, PLAIN)
        found = counted_mission(signals, [load], plan_of(1.0), "x")
        assert found.max_range[0, 0] == pytest.approx(20.0, rel=1e-3)


def test_directions_miss_a_thousandth_of_the_range_at_most():
    """A stress at 42.5 deg, between two directions, keeps 99.9 % of its range."""
    wave = 50.0 * np.sin(2.0 * np.pi * np.arange(40) / 40.0)
    angle = np.radians(42.5)
    load = event("e", [np.cos(angle) * wave, np.sin(angle) * wave])
    worst = worst_directions(PARTS, SUMS, ONE, PLAIN, [load], plan_of(1.0), "x")[0]
    assert PSI[worst] == 40.0  # the first of two equal ones
    assert 1.0 > np.ptp(SUMS[worst] @ load.counted.q) / 100.0 > 0.999


def test_without_damage_the_largest_range_decides():
    """Below a cut-off every direction has no damage; that with the largest range comes to it first."""
    wave = np.sin(2.0 * np.pi * np.arange(40) / 40.0)
    load = event("e", [0.1 * wave, 0.2 * wave])
    assert not direction_damage(SUMS, 1.0, KNEE, [load], plan_of(1.0), "x").any()
    assert PSI[worst_directions(PARTS, SUMS, ONE, KNEE, [load], plan_of(1.0), "x")[0]] == 65.0


@pytest.mark.parametrize("rule", [PLAIN, KNEE, MASTER])
def test_what_is_recovered_at_once_does_not_matter(monkeypatch, rule):
    """The direction of a point is the same among others, alone, from modes, and on a curve with a bending ratio."""
    rng = np.random.default_rng(3)
    load, parts = event("e", rng.normal(0.0, 5.0, (4, 80))), rng.normal(0.0, 3.0, (9, 2, 4))
    load = replace(load, offset=np.array([1.0, 0.0, 0.0, 2.0]))
    together = worst_directions(parts, SUMS, np.ones(9), rule, [load], plan_of(1.0), "x")
    monkeypatch.setattr(directions, "AT_ONCE", 1)
    alone = worst_directions(parts, SUMS, np.ones(9), rule, [load], plan_of(1.0), "x")
    assert together.tolist() == alone.tolist()
    of_modes = [direction_damage(SUMS @ one, 1.0, rule, [load], plan_of(1.0), "x").argmax() for one in parts]
    assert together.tolist() == of_modes


@pytest.mark.parametrize("rule", [PLAIN, KNEE, MASTER])
@pytest.mark.parametrize("loops", [(), (Loop("run", (0, 1, 0), 3.0),)])
def test_damage_alone_is_that_of_the_mission(rule, loops):
    """``counted_damage`` is the damage of ``counted_mission``, cycles across events of a sequence among it."""
    rng = np.random.default_rng(5)
    loads = [event("a", rng.normal(0.0, 30.0, (2, 50))), event("b", 60.0 + rng.normal(0.0, 20.0, (2, 70)))]
    plan = plan_of(0.5, 2.0, loops=loops)
    signals = Signals(SUMS[:6], np.roll(SUMS[:6], 1, axis=0), np.linspace(1.0, 1.5, 6), rule)
    alone, whole = counted_damage(signals, loads, plan, "x"), counted_mission(signals, loads, plan, "x")
    np.testing.assert_allclose(alone, whole.damage_per_km, rtol=1e-9)
