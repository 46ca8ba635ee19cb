"""The bound of the damage by path range: a worked example, and never below what is counted."""

import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.life.bounds.path_bound import (
    largest_combined_range,
    path_bound,
    path_length,
    path_length_bound,
    power_bound,
    power_integrals,
)
from fatigue.life.curves import DamageLaw, catalogue
from fatigue.life.path.count import count_path
from fatigue.life.path.ranges import combined_range, end_ranges, path_damage
from fatigue.life.rule import CycleRule, size_factor

MICRO = json.loads((Path(__file__).parents[2] / "data" / "path_oracles.json").read_text(encoding="utf-8"))[
    "micro_example"
]
SIZE = float(size_factor(np.array([6.0]), catalogue()["master-steel"], "actual")[0])
H = MICRO["inputs"]["h"]
MASTER = DamageLaw(np.array([1.0 / H]), np.array([np.log(MICRO["inputs"]["C"]) / H]), np.empty(0), 0.0)
LAWS = {
    "straight": MASTER,
    "slope 1": DamageLaw(np.array([1.0]), np.array([10.0]), np.empty(0), 0.0),
    "knee": DamageLaw(np.array([3.0, 5.0]), np.array([28.0, 28.0 + 2.0 * np.log(20.0)]), np.array([20.0]), 0.0),
    "cut-off": DamageLaw(np.array([3.0]), np.array([28.0]), np.empty(0), 15.0),
}


def test_bound_of_the_example():
    """Path length, largest range and bound of both events are the known ones."""
    rule, total = CycleRule(MASTER, uses_bending_ratio=True), 0.0
    for name, residue, passes in (("track", "repeat", 150_000.0), ("load_unload", "half", 6.0)):
        event = MICRO["events"][name]
        s, tau = (np.array(event[a]) + np.array(event[b]) for a, b in (("membrane", "bending"), ("tau_m", "tau_b")))
        length = path_length(s, tau, 3.0, residue)
        xh = largest_combined_range(np.ptp(s), np.ptp(tau), SIZE, 3.0, rule)
        bound = path_bound(length, xh, SIZE, rule)
        known = event["path"]
        assert [length, xh, bound] == pytest.approx([known[k] for k in ("path_length", "x_bound", "D_bound_T1")], 1e-8)
        total += passes * float(bound)
    assert total == pytest.approx(MICRO["mission"]["T1"], 1e-8)


@settings(deadline=None, max_examples=200)
@given(
    st.integers(0, 2**32 - 1),
    st.integers(2, 60),
    st.sampled_from(sorted(LAWS)),
    st.booleans(),
    st.sampled_from(["half", "repeat"]),
    st.sampled_from([1.0, -1.0]),
    st.sampled_from([0.0, 1.0, 3.0]),
)
def test_never_below_the_count(seed, samples, law, uses_bending_ratio, residue, side, beta):
    """Of any path, on any curve, no half cycle is larger than xh and their damage is not larger than the bound.

    The length without histories is not smaller than the path, and makes a bound as well.
    """
    random = np.random.default_rng(seed)
    q = random.normal(size=(3, samples)).cumsum(axis=1) if seed % 2 else random.integers(-3, 4, (3, samples)) * 1.0
    modal = random.normal(size=(4, 3)) * random.choice([0.0, 1.0, 10.0], size=(4, 1))
    membrane, bending, in_plane, twist = modal @ q
    s, tau = membrane + side * bending, in_plane + side * twist
    rule = CycleRule(LAWS[law], uses_bending_ratio=uses_bending_ratio)

    cycles = count_path(s, tau, beta, residue)
    ranges = end_ranges(cycles, membrane, bending, in_plane, twist, side)
    x = combined_range(ranges, SIZE, beta, rule)
    damage = path_damage(cycles, x, rule.law).range

    length = path_length(s, tau, beta, residue)
    xh = largest_combined_range(np.ptp(s), np.ptp(tau), SIZE, beta, rule)
    assert x.max(initial=0.0) <= xh * (1.0 + 1e-9)
    assert damage <= path_bound(length, xh, SIZE, rule) * (1.0 + 1e-9)

    dq = np.diff(q, append=q[:, :1]) if residue == "repeat" else np.diff(q)
    w_s, w_tau = modal[0] + side * modal[1], modal[2] + side * modal[3]
    first_tier = path_length_bound(w_s, w_tau, beta, dq @ dq.T, dq.shape[1])
    assert first_tier >= length * (1.0 - 1e-9) - 1e-12
    assert path_bound(first_tier, xh, SIZE, rule) >= damage * (1.0 - 1e-9)

    closed = [np.append(a, a[0]) if residue == "repeat" else a for a in (s, np.sqrt(beta) * tau)]
    path = np.stack(closed) - random.normal(size=(2, 1)) * random.choice([0.0, 1.0, 10.0])  # seen from any point
    integrals = power_integrals(path)
    for power, integral in zip((3, 4), integrals, strict=True):
        sum_of_powers = 0.5 * (cycles.range**power).sum()
        assert sum_of_powers <= 2.0 ** (power - 2) * integral * (1.0 + 1e-9) + 1e-300
    largest = np.hypot(np.ptp(s), np.sqrt(beta) * np.ptp(tau))
    closer = power_bound(np.asarray(length), integrals, np.asarray(largest), np.asarray(SIZE), rule)
    assert damage <= closer * (1.0 + 1e-9)
    assert closer <= path_bound(length, xh, SIZE, rule) * (1.0 + 1e-6)


def test_many_points_at_once():
    """Lengths and bounds of several points are those of each."""
    random = np.random.default_rng(5)
    s, tau = random.normal(size=(2, 4, 30))
    rule = CycleRule(MASTER, uses_bending_ratio=True)
    together = path_length(s, tau, 3.0, "repeat")
    np.testing.assert_allclose(together, [path_length(a, b, 3.0, "repeat") for a, b in zip(s, tau, strict=True)])
    xh = largest_combined_range(np.ptp(s, axis=1), np.ptp(tau, axis=1), SIZE, 3.0, rule)
    bound = path_bound(together, xh, SIZE, rule)
    np.testing.assert_allclose(bound[2], path_bound(together[2], xh[2], SIZE, rule))


def test_powers_along_a_straight_path_are_exact():
    """Back and forth about the middle every half cycle has the power that the path has; a circle has more of it."""
    back_and_forth = np.array([[-1.0, 1.0, -1.0], [0.0, 0.0, 0.0]])
    assert power_integrals(back_and_forth)[0] == pytest.approx(2.0 * 2.0, rel=1e-12)
    finely = np.stack([np.interp(np.linspace(0.0, 2.0, 2001), [0.0, 1.0, 2.0], back_and_forth[0]), np.zeros(2001)])
    assert power_integrals(finely) == pytest.approx([4.0, 4.0], rel=1e-5)
    assert 2.0 * power_integrals(finely)[0] == pytest.approx(0.5 * 2 * 2.0**3, rel=1e-12)  # nothing is lost
    turn = np.linspace(0.0, 2.0 * np.pi, 3601)
    assert power_integrals(np.stack([np.cos(turn), np.sin(turn)])) == pytest.approx(
        [6.0 * np.pi, 8.0 * np.pi], rel=1e-5
    )


def test_what_the_bound_leaves_out():
    """What never moves has the bound 0, ranges below a cut-off too; with f_M in the damage there is none."""
    rule = CycleRule(LAWS["cut-off"], uses_bending_ratio=False)
    assert path_bound(np.zeros(1), np.zeros(1), np.ones(1), rule)[0] == 0.0
    assert path_bound(np.array([1e3]), np.array([14.0]), np.ones(1), rule)[0] == 0.0
    with pytest.raises(ValueError, match="without f_M"):
        path_bound(np.ones(1), np.ones(1), np.ones(1), CycleRule(MASTER, True, yield_MPa=355.0, mean_stress=True))
    assert power_bound(np.zeros(1), np.zeros((2, 1)), np.zeros(1), np.ones(1), rule)[0] == 0.0
    with pytest.raises(ValueError, match="without f_M"):
        with_f_M = CycleRule(MASTER, True, yield_MPa=355.0, mean_stress=True)
        power_bound(np.ones(1), np.ones((2, 1)), np.ones(1), np.ones(1), with_f_M)


def test_powers_that_exceed_double_precision_bound_nothing_and_say_so() -> None:
    """Overflow in a power of the path gives an infinite integral, without an error of arithmetic."""
    path = np.array([[[0.0, 1e160, 0.0], [0.0, 1.0, 0.0]], [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]])
    with np.errstate(over="raise", invalid="raise"):
        integrals = power_integrals(path)
    assert np.isinf(integrals[:, 0]).all()
    np.testing.assert_allclose(integrals[:, 1], [2.0, 4.0])  # int of 3 x^2 there and back; of 4 x^3 by its ends
