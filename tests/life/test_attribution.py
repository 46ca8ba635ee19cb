"""Attribution of damage to modes and instants, and its gradient: identities, finite differences, cases by hand."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.life.attribution import (
    DamageRule,
    credit,
    local_slope,
    log_ratio_factor_slope,
    size_exponent,
)
from fatigue.life.counting.rainflow import count_block, rainflow
from fatigue.life.curves import DamageLaw, catalogue, damage_law, user_curve
from fatigue.life.damage import M_SS, cycle_damage, ratio_factor, size_factor

ALUMINIUM = catalogue()["master-aluminium"]
THREE_SLOPES = user_curve("three", (3.0, 5.0, 9.0), (5e6, 1e8), 60.0, "dS", "a test")
PLAIN = user_curve("plain", (3.0, 5.0), (1e7,), 40.0, "structural", "a test")
LAWS = {
    "straight": DamageRule(damage_law(ALUMINIUM, None, "none", 1e7), 1.4, True, None),
    "haibach": DamageRule(damage_law(ALUMINIUM, None, "haibach", 1e6), 1.4, True, None),
    "three slopes": DamageRule(damage_law(THREE_SLOPES, None, "none", 1e7), 1.4, True, None),
    "plain stress": DamageRule(damage_law(PLAIN, None, "none", 1e7), 1.1, False, None),
    "mean stress": DamageRule(damage_law(ALUMINIUM, None, "none", 1e7), 1.4, True, 120.0),
}
CUTOFF = DamageRule(damage_law(ALUMINIUM, None, "cutoff", 1e6), 1.4, True, None)
SIDES = pytest.mark.parametrize("side", [1.0, -1.0], ids=["top", "bottom"])
RESIDUES = pytest.mark.parametrize("residue", ["repeat", "half"])


def record(modes=5, samples=600, seed=3):
    """Coordinates (m, t) of modes with peaks many samples wide, and membrane and bending shapes of one point."""
    rng = np.random.default_rng(seed)
    q = np.stack([np.convolve(rng.standard_normal(samples), np.hanning(9), mode="same") for _ in range(modes)])
    return q, rng.normal(0.0, 20.0, modes), rng.normal(0.0, 12.0, modes)


def count(membrane, bending, side, rule, residue):
    """Count and lay out the damage of one face."""
    cycles = rainflow(membrane + side * bending, residue)
    return credit(cycles.start, cycles.end, cycles.count, membrane, bending, side, rule)


def damage(membrane, bending, side, rule, residue):
    """Miner sum of one face from the counter of the assessment."""
    counted = count_block(
        membrane[None],
        bending[None],
        np.array([rule.size]),
        np.zeros((1, 2)),
        rule.law,
        uses_bending_ratio=rule.uses_bending_ratio,
        residue=residue,
        yield_MPa=rule.yield_stress,
        mean_stress=rule.yield_stress is not None,
    )
    return counted.damage[0, 0 if side > 0 else 1]


def mean_tension(rule, q):
    """Lift the first mode so that the mean-stress rule, where it is on, holds for some cycles and not for others."""
    if rule.yield_stress is not None:
        q[0] += 6.0
    return q


@SIDES
@RESIDUES
@pytest.mark.parametrize("rule", [*LAWS.values(), CUTOFF], ids=[*LAWS, "cutoff"])
def test_parts_add_up_to_the_damage_of_the_assessment(rule, residue, side):
    """Modes and instants share out the damage that the counter finds, to rounding, on every kind of curve."""
    q, S_m, S_b = record()
    q = mean_tension(rule, q)
    found = count(S_m @ q, S_b @ q, side, rule, residue)
    modes = (S_m + side * S_b) * (q @ found.share)
    expected = damage(S_m @ q, S_b @ q, side, rule, residue)
    assert found.damage == pytest.approx(expected, rel=1e-13)
    assert modes.sum() == pytest.approx(expected, rel=1e-12)
    assert found.place.sum() == pytest.approx(expected, rel=1e-13)
    assert 0.0 < found.top_cycle < expected


@given(
    signal=st.lists(st.integers(-20, 20), min_size=2, max_size=60),
    side=st.sampled_from([1.0, -1.0]),
    residue=st.sampled_from(["repeat", "half"]),
)
@settings(deadline=None, max_examples=60)
def test_parts_add_up_on_any_signal(signal, side, residue):
    """Plateaus, ties, single steps and constant signals change nothing: parts add up, and nothing is owed to a mean."""
    rule = LAWS["three slopes"]
    q = np.array([signal, np.roll(signal, 3)], dtype=float)
    S_m, S_b = np.array([3.0, 1.0]), np.array([-0.5, 2.0])
    found = count(S_m @ q, S_b @ q, side, rule, residue)
    modes = (S_m + side * S_b) * (q @ found.share)
    assert modes.sum() == pytest.approx(found.damage, rel=1e-10, abs=1e-300)
    assert found.share.sum() == pytest.approx(0.0, abs=1e-12 * np.abs(found.share).sum())
    assert found.place.min(initial=0.0) >= 0.0


@SIDES
@RESIDUES
@pytest.mark.parametrize("rule", LAWS.values(), ids=LAWS)
def test_mode_slopes_against_finite_differences(rule, residue, side):
    """The gradient predicts what a slightly larger mode does to the counted damage, bending ratio and mean included."""
    q, S_m, S_b = record()
    q = mean_tension(rule, q)
    found = count(S_m @ q, S_b @ q, side, rule, residue)
    slopes = S_m * (q @ found.by_membrane) + S_b * (q @ found.by_bending)
    step = 1e-6
    for k in range(len(q)):
        scale = np.ones(len(q))
        scale[k] = 1.0 + step
        above = damage((scale * S_m) @ q, (scale * S_b) @ q, side, rule, residue)
        scale[k] = 1.0 - step
        below = damage((scale * S_m) @ q, (scale * S_b) @ q, side, rule, residue)
        assert slopes[k] == pytest.approx((above - below) / (2 * step), rel=1e-6, abs=1e-6 * found.damage)


@SIDES
@pytest.mark.parametrize("rule", LAWS.values(), ids=LAWS)
def test_load_slope_is_the_sum_of_the_mode_slopes(rule, side):
    """Scaling all modes scales the load: sum of mode slopes = sum n d k, and k D on one slope (Euler)."""
    q, S_m, S_b = record()
    q = mean_tension(rule, q)
    found = count(S_m @ q, S_b @ q, side, rule, "repeat")
    slopes = S_m * (q @ found.by_membrane) + S_b * (q @ found.by_bending)
    assert slopes.sum() == pytest.approx(found.slope, rel=1e-11)
    if rule.law.is_straight:
        assert found.slope == pytest.approx(rule.law.slopes[0] * found.damage, rel=1e-13)


@pytest.mark.parametrize("rule", LAWS.values(), ids=LAWS)
def test_thickness_slope_against_finite_differences(rule):
    """A thicker plate at constant line force: membrane falls with t, bending with t^2, the ratio moves too."""
    q, S_m, S_b = record()
    q = mean_tension(rule, q)
    membrane, bending = S_m @ q, S_b @ q
    found = count(membrane, bending, 1.0, rule, "repeat")
    slope = -found.by_membrane @ membrane - 2.0 * found.by_bending @ bending
    step = 1e-6
    above, below = (damage(membrane / t, bending / t**2, 1.0, rule, "repeat") for t in (1.0 + step, 1.0 - step))
    assert slope == pytest.approx((above - below) / (2 * step), rel=1e-6)


def test_relieving_mode_has_a_negative_share():
    """A mode that runs against another takes off what the other adds on top: 1 / 0.7 and -0.3 / 0.7 by hand."""
    t = np.arange(400) / 40.0
    q = np.stack([np.sin(2 * np.pi * t), -0.3 * np.sin(2 * np.pi * t)])
    stress = 50.0 * q.sum(axis=0)
    found = count(stress, 0.0 * stress, 1.0, LAWS["straight"], "repeat")
    assert 50.0 * (q @ found.share) / found.damage == pytest.approx([1 / 0.7, -0.3 / 0.7], rel=1e-12)


def test_cycle_across_the_end_of_the_record_is_placed_at_its_own_instants():
    """One cycle, from the last third to the first: half of its damage at either sample, signs of the range kept."""
    stress = np.array([10.0, 0.0, 0.0, -10.0, 5.0])
    found = count(stress, 0.0 * stress, 1.0, LAWS["straight"], "repeat")
    assert np.flatnonzero(found.place).tolist() == [0, 3]
    assert found.place[[0, 3]] == pytest.approx(0.5 * found.damage)
    assert found.share[[0, 3]] == pytest.approx(np.array([1.0, -1.0]) * found.damage / 20.0)


def test_nothing_happens_nothing_is_owed():
    """A constant stress has no cycles and no damage to share out."""
    found = count(np.full(9, 7.0), np.full(9, 2.0), 1.0, LAWS["haibach"], "half")
    assert (found.damage, found.top_cycle, found.slope) == (0.0, 0.0, 0.0)
    assert not found.share.any()
    assert not found.by_bending.any()


def test_local_slope_changes_at_the_knees():
    """At a knee the segment of the larger ranges holds, as in the damage itself."""
    law = DamageLaw(np.array([3.0, 5.0]), np.array([20.0, 25.0]), np.array([40.0]), 0.0)
    assert local_slope(np.array([80.0, 40.0, 39.9]), law).tolist() == [3.0, 3.0, 5.0]
    x = np.array([80.0, 20.0])
    numeric = (np.log(cycle_damage(x * 1.0001, law)) - np.log(cycle_damage(x, law))) / np.log(1.0001)
    assert local_slope(x, law) == pytest.approx(numeric, rel=1e-9)


def test_slope_of_the_bending_ratio_factor():
    """Slope d ln I^(1/m) / dr against differences of the factor itself."""
    r, step = np.linspace(0.01, 0.99, 9), 1e-6
    numeric = (np.log(ratio_factor(r + step)) - np.log(ratio_factor(r - step))) / (2 * step)
    assert log_ratio_factor_slope(r) == pytest.approx(numeric, rel=1e-8)


@pytest.mark.parametrize(
    ("curve", "rule", "thickness", "expected"),
    [
        (ALUMINIUM, "actual", 8.0, (M_SS - 2) / (2 * M_SS)),
        (ALUMINIUM, "asme", 20.0, (M_SS - 2) / (2 * M_SS)),
        (ALUMINIUM, "asme", 8.0, 0.0),
        (ALUMINIUM, "asme", 200.0, 0.0),
        (PLAIN, "actual", 8.0, 0.0),
        (user_curve("t", (3.0,), (), 40.0, "structural", "a test", None, 25.0, 0.2), "actual", 30.0, 0.2),
        (user_curve("t", (3.0,), (), 40.0, "structural", "a test", None, 25.0, 0.2), "actual", 20.0, 0.0),
    ],
)
def test_size_exponent_is_that_of_the_size_factor(curve, rule, thickness, expected):
    """The exponent of the thickness rule, inside and outside its limits, against the factor itself."""
    t, step = np.array([thickness]), 1e-6
    numeric = np.log(size_factor(t * (1 + step), curve, rule) / size_factor(t, curve, rule))[0] / step
    assert size_exponent(thickness, curve, rule) == pytest.approx(expected)
    assert numeric == pytest.approx(expected, abs=1e-6)
