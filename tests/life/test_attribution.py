"""Attribution of damage to modes and instants, and its gradient: identities, finite differences, cases by hand."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.life.attribution import credit
from fatigue.life.counting.rainflow import rainflow
from fatigue.life.counting.rows import count_histories
from fatigue.life.curves import catalogue, damage_law, user_curve
from fatigue.life.rule import CycleRule

ALUMINIUM = catalogue()["master-aluminium"]
THREE_SLOPES = user_curve("three", (3.0, 5.0, 9.0), (5e6, 1e8), 60.0, "dS", "a test")
PLAIN = user_curve("plain", (3.0, 5.0), (1e7,), 40.0, "structural", "a test")
LAWS = {
    "straight": CycleRule(damage_law(ALUMINIUM, None, "none", 1e7), True),
    "haibach": CycleRule(damage_law(ALUMINIUM, None, "haibach", 1e6), True),
    "three slopes": CycleRule(damage_law(THREE_SLOPES, None, "none", 1e7), True),
    "plain stress": CycleRule(damage_law(PLAIN, None, "none", 1e7), False),
    "mean stress": CycleRule(damage_law(ALUMINIUM, None, "none", 1e7), True, 120.0, True),
}
CUTOFF = CycleRule(damage_law(ALUMINIUM, None, "cutoff", 1e6), True)
SIZE = 1.4
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
    return credit(cycles, membrane, bending, side, SIZE, rule)


def damage(membrane, bending, side, rule, residue):
    """Miner sum of one face from the counter of the assessment."""
    one = np.array([SIZE]), np.zeros((1, 2))
    counted = count_histories(membrane[None], bending[None], *one, residue, rule)
    return counted.damage[0, 0 if side > 0 else 1]


def mean_tension(rule, q):
    """Lift the first mode so that the mean-stress rule, where it is on, holds for some cycles and not for others."""
    if rule.mean_stress:
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


@pytest.mark.parametrize("stress", [(100.0, 200.0), (200.0, 100.0)], ids=["rises", "falls"])
def test_the_largest_stress_of_a_cycle_has_a_slope_of_its_own(stress):
    """One cycle by hand: x = S^(1 - 1/m) max^(1/m) times a constant, so the peak counts in the range and beside it."""
    rule = CycleRule(LAWS["straight"].law, False, 120.0, True)
    membrane = np.array(stress)
    found = count(membrane, 0.0 * membrane, 1.0, rule, "repeat")
    k, m, S, maximum = rule.law.slopes[0], 3.6, 100.0, 200.0
    of_range, of_peak = (1.0 - 1.0 / m) / S, 1.0 / (m * maximum)
    expected = np.where(membrane == maximum, of_range + of_peak, -of_range)
    assert found.by_membrane == pytest.approx(k * found.damage * expected, rel=1e-12)
    assert found.slope == pytest.approx(k * found.damage, rel=1e-12)


@SIDES
def test_a_mean_stress_that_grows_has_its_own_slope(side):
    """The same constant on all samples: what the gradient adds up to, by finite differences; 0 without the rule."""
    q, S_m, S_b = record()
    q = mean_tension(LAWS["mean stress"], q)
    membrane = S_m @ q - (S_m @ q + side * (S_b @ q)).mean() + 110.0  # some cycles in tension, some across zero
    bending = S_b @ q
    stress = membrane + side * bending
    assert stress.min() < 0.0 < stress.mean()
    for name, rule in LAWS.items():
        found = count(membrane, bending, side, rule, "repeat").by_membrane.sum()
        above, below = (damage(membrane + shift, bending, side, rule, "repeat") for shift in (1e-4, -1e-4))
        scale = damage(membrane, bending, side, rule, "repeat")
        assert found == pytest.approx((above - below) / 2e-4, rel=1e-5, abs=1e-9 * scale)
        assert (found > 1e-5 * scale) == (name == "mean stress")


@SIDES
@RESIDUES
def test_a_constant_beside_the_samples_is_one_in_them(residue, side):
    """Damage, shares and slopes under f_M are those of samples that hold the constant; and the slope by it is right."""
    rule = LAWS["mean stress"]
    q, S_m, S_b = record()
    membrane, bending, constant = S_m @ q, S_b @ q, 75.0
    cycles = rainflow(membrane + side * bending, residue)
    found = credit(cycles, membrane, bending, side, SIZE, rule, constant)
    held = count(membrane + constant, bending, side, rule, residue)
    for name in ("damage", "top_cycle", "slope", "share", "place", "by_membrane", "by_bending"):
        np.testing.assert_allclose(getattr(found, name), getattr(held, name), rtol=1e-9, atol=1e-15, err_msg=name)
    assert found.damage > credit(cycles, membrane, bending, side, SIZE, rule).damage
    near = [credit(cycles, membrane, bending, side, SIZE, rule, constant + d).damage for d in (-1e-5, 1e-5)]
    assert found.by_offset == pytest.approx((near[1] - near[0]) / 2e-5, rel=1e-5)
