"""The bounds of the damage against what is counted: never below, for any history, curve and residue."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from fatigue.life.bounds.forms import face_forms
from fatigue.life.bounds.screening import (
    ModalExtent,
    PowerSums,
    damage_bound,
    extent_bound,
    may_need_mean_stress,
    modal_extent,
    size_bound,
)
from fatigue.life.counting.rainflow import rainflow
from fatigue.life.counting.rows import count_histories
from fatigue.life.curves import DamageLaw
from fatigue.life.records.history import ModalHistory, Residue, upsampled
from fatigue.life.rule import CycleRule, cycle_damage
from tests.awkward_records import KINDS, LAWS, modal_coordinates

Floats = NDArray[np.float64]


def bound_of(S_m: Floats, S_b: Floats, extent: ModalExtent) -> tuple[Floats, PowerSums]:
    """Bound range and power sums from the shapes alone."""
    return extent_bound(S_m, S_b, face_forms(S_m, S_b, extent.products), extent)


@pytest.mark.parametrize("residue", ["half", "repeat"])
@pytest.mark.parametrize("kind", KINDS)
def test_no_point_is_damaged_more_than_its_bound(kind: str, residue: Residue) -> None:
    """Range, variation, equivalent range and damage of 18 000 points in 450 records, without a time loop."""
    rng = np.random.default_rng(KINDS.index(kind))
    names = list(LAWS)
    for draw in range(25):
        law, uses_ratio = LAWS[names[draw % len(names)]], draw % 3 > 0
        q = modal_coordinates(rng, kind)
        factor = int(rng.choice([1, 1, 4])) if q.shape[1] > 3 else 1
        q = upsampled(ModalHistory("e", np.arange(len(q)), q, 0.1, 0.0), factor, residue).q.astype(np.float64)
        scale = 30.0 * np.exp(2 * rng.normal(size=(20, 1)))
        S_m, S_b = (scale * rng.normal(size=(20, len(q))) for _ in range(2))
        S_b[0], S_m[1], S_b[2] = S_m[0], 0.0, 0.0
        size = rng.uniform(1.0, 2.0, 20)
        count = count_histories(S_m @ q, S_b @ q, size, np.zeros((20, 2)), residue, CycleRule(law, uses_ratio))
        largest, sums = bound_of(S_m, S_b, modal_extent(q, residue))
        bound, equivalent = damage_bound(largest, sums, size[:, None], CycleRule(law, uses_ratio))

        stress = np.stack([S_m + S_b, S_m - S_b], axis=1)
        s = stress @ q
        closed = np.concatenate([s, s[..., :1]], axis=-1) if residue == "repeat" else s
        true_range, true_variation = np.ptp(s, axis=-1), np.abs(np.diff(closed)).sum(axis=-1)
        noise = 1e-12 * np.abs(stress) @ np.abs(q).max(axis=1) * s.shape[-1]
        assert (true_range <= largest + noise).all()
        assert (0.5 * true_variation <= sums[1] + noise).all()
        counted = count.max_range > noise  # not the rounding errors of a constant
        assert (count.damage[counted] <= bound[counted]).all()
        assert (count.max_equivalent_range[counted] <= equivalent[counted]).all()


@settings(deadline=None, max_examples=200)
@given(st.lists(st.integers(-6, 6), min_size=2, max_size=60), st.sampled_from(["half", "repeat"]))
def test_the_ranges_add_up_to_half_the_total_variation(signal: list[int], residue: Residue) -> None:
    """At slope 1 without bending the bound is the damage, for any history."""
    s = np.array([signal], dtype=float)
    count = count_histories(s, 0 * s, np.ones(1), np.zeros((1, 2)), residue, CycleRule(LAWS["slope 1"], False))
    closed = np.append(s, s[:, :1] if residue == "repeat" else [])
    variation = np.abs(np.diff(closed)).sum(keepdims=True)
    bound, _ = damage_bound(np.ptp(s, axis=1), {1: variation / 2}, np.ones(1), CycleRule(LAWS["slope 1"], False))
    assert bound[0] == pytest.approx(count.damage[0, 0], rel=1e-8)


@settings(deadline=None, max_examples=200)
@given(
    st.lists(st.floats(-9, 9), min_size=2, max_size=60), st.sampled_from(["half", "repeat"]), st.sampled_from([2, 3])
)
def test_the_powers_of_the_ranges_are_bounded_by_the_crossings(signal: list[float], residue: Residue, p: int) -> None:
    """Sum n S^p <= 2^(p-2) TV(s |s|^(p-1)), for any history and any zero level."""
    s = np.array(signal)
    cycles = rainflow(s, residue)
    f = s * np.abs(s) ** (p - 1)
    variation = np.abs(np.diff(np.append(f, f[0]) if residue == "repeat" else f)).sum()
    assert (cycles.count * cycles.range**p).sum() <= 2.0 ** (p - 2) * variation * (1 + 1e-12) + 1e-300


@pytest.mark.parametrize("law", LAWS.values())
def test_constant_amplitude_is_damaged_as_much_as_its_bound(law: DamageLaw) -> None:
    """Cycles of one range from the first sample on: nothing smaller is possible in membrane stress."""
    wave = np.tile([0.0, 100.0], 50)[None]
    count = count_histories(wave, 0 * wave, np.ones(1), np.zeros((1, 2)), "repeat", CycleRule(law, True))
    bound, largest = damage_bound(
        *bound_of(np.ones((1, 1)), np.zeros((1, 1)), modal_extent(wave, "repeat")),
        np.ones(1),
        CycleRule(law, True),
    )
    assert bound[0] == pytest.approx(count.damage[0], rel=1e-7)
    assert largest[0] == pytest.approx(count.max_equivalent_range[0], rel=1e-7)


def test_the_bound_without_a_time_loop_is_not_far_off() -> None:
    """For 40 resonances: some times the damage in range and variation, not orders of magnitude."""
    rng = np.random.default_rng(4)
    f = np.fft.rfftfreq(4000)
    noise = rng.normal(size=(40, f.size)) + 1j * rng.normal(size=(40, f.size))
    q = np.fft.irfft(noise / (1 - (f / np.linspace(0.01, 0.18, 40)[:, None]) ** 2 + 0.06j), 4000)
    S = rng.normal(size=(50, 40)) / q.std(axis=1)
    s = S @ q
    largest, sums = bound_of(S, 0 * S, modal_extent(q, "half"))
    largest, sums = largest[:, 0], {p: bound[:, 0] for p, bound in sums.items()}
    assert np.median(largest / np.ptp(s, axis=1)) < 3.5
    assert np.median(sums[1] / np.abs(np.diff(s)).sum(axis=1)) < 0.7
    law = LAWS["straight"]
    damage = count_histories(s, 0 * s, np.ones(50), np.zeros((50, 2)), "half", CycleRule(law, True)).damage[:, 0]
    bound, _ = damage_bound(largest, sums, np.ones(50), CycleRule(law, True))
    assert np.median(bound / damage) < 60.0


@settings(deadline=None, max_examples=100)
@given(st.lists(st.floats(0.1, 100), min_size=1, max_size=30), st.sampled_from(sorted(LAWS)))
def test_the_exact_sums_of_any_ranges_bound_their_damage(ranges: list[float], name: str) -> None:
    """Whatever the ranges, without the crossings in between."""
    S, law = np.array(ranges), LAWS[name]
    sums = {q: (S**q).sum(keepdims=True) for q in (1, 2, 3, 4)}
    bound, _ = damage_bound(S.max(keepdims=True), sums, np.ones(1), CycleRule(law, False))
    assert cycle_damage(S, law).sum() <= bound[0]


def test_one_large_cycle_does_not_spoil_the_bound_between_two_powers() -> None:
    """Many cycles of 50 and one of 200 MPa at slope 3.6: a tenth above the damage, by the largest range two thirds."""
    S, law = np.append(np.full(1000, 50.0), 200.0), LAWS["straight"]
    sums = {q: (S**q).sum(keepdims=True) for q in (1, 2, 3, 4)}
    damage = cycle_damage(S, law).sum()
    tight, _ = damage_bound(S[-1:], sums, np.ones(1), CycleRule(law, False))
    wide, _ = damage_bound(S[-1:], {q: sums[q] for q in (1, 2, 3)}, np.ones(1), CycleRule(law, False))
    assert tight[0] < 1.1 * damage
    assert wide[0] > 1.6 * damage


def test_below_the_cutoff_there_is_no_damage() -> None:
    """The bound is 0, not small."""
    law = LAWS["cutoff"]
    ranges = np.array([0.99, 1.01]) * law.cutoff
    bound, _ = damage_bound(ranges, {1: 50 * ranges}, np.ones(2), CycleRule(law, False))
    assert (bound > 0.0).tolist() == [False, True]


def test_a_slope_below_1_has_no_bound() -> None:
    """Many small cycles may then do more damage than few large ones."""
    law = DamageLaw(np.array([0.9]), np.array([10.0]), np.array([]), 0.0)
    sums = {q: np.ones(1) for q in (1, 2, 3)}
    assert np.isinf(damage_bound(np.ones(1), sums, np.ones(1), CycleRule(law, False))[0]).all()


def test_points_in_high_mean_tension_are_told() -> None:
    """From half the yield stress at the largest possible stress on."""
    found = may_need_mean_stress(np.array([100.0, 100.0, -50.0]), np.array([24.0, 26.0, 100.0]), 250.0)
    assert found.tolist() == [False, True, False]


@pytest.mark.parametrize("residue", ["half", "repeat"])
@pytest.mark.parametrize("level", [0.9, -3.0, 50.0])
def test_where_the_record_lies_moves_no_bound(level: float, residue: Residue) -> None:
    """All sizes are about the mean: with a constant added to the coordinates they stay what they are."""
    rng = np.random.default_rng(7)
    q = rng.normal(size=(4, 300)) ** 3  # a few far peaks, so that the largest size is not the deviation
    S_m, S_b = rng.normal(size=(2, 30, 4))
    moved = q + level * rng.normal(size=(4, 1))
    here, there = (modal_extent(x, residue) for x in (q, moved))
    assert there.reach == pytest.approx(here.reach, rel=1e-9)
    for found, expected in zip(size_bound(S_m, S_b, there), size_bound(S_m, S_b, here), strict=True):
        np.testing.assert_allclose(found, expected, rtol=1e-9)
    largest, sums = bound_of(S_m, S_b, there)
    np.testing.assert_allclose(largest, bound_of(S_m, S_b, here)[0], rtol=1e-9)
    np.testing.assert_allclose(sums[2], bound_of(S_m, S_b, here)[1][2], rtol=1e-9)


@settings(deadline=None, max_examples=60)
@given(st.lists(st.integers(-9, 9), min_size=2, max_size=40), st.sampled_from(["half", "repeat"]))
def test_the_sizes_of_one_mode_are_those_of_its_stress(signal: list[int], residue: Residue) -> None:
    """Of one mode the bounds are the numbers themselves: max |s|, sqrt(sum s^2), sqrt(sum ds^2), about the mean."""
    q = np.array([signal], dtype=float)
    s = 3.0 * (q[0] - q[0].mean())
    steps = np.diff(np.append(s, s[0]) if residue == "repeat" else s)
    found = size_bound(np.array([[2.0]]), np.array([[1.0]]), modal_extent(q, residue))
    expected = (np.abs(s).max(), np.sqrt(np.sum(s**2)), np.sqrt(np.sum(steps**2)))
    for (top, bottom), wanted in zip((size[0] for size in found), expected, strict=True):
        assert top == pytest.approx(wanted, rel=1e-6, abs=1e-6)
        assert bottom == pytest.approx(wanted / 3.0, rel=1e-6, abs=1e-6)


@pytest.mark.parametrize("residue", ["half", "repeat"])
@pytest.mark.parametrize("kind", KINDS)
def test_no_stress_is_larger_than_its_sizes(kind: str, residue: Residue) -> None:
    """Largest stress, sum of squares and of squared steps of 1500 points, about the mean, against their bounds."""
    rng = np.random.default_rng(40 + KINDS.index(kind))
    for _ in range(5):
        q = modal_coordinates(rng, kind)
        S_m, S_b = 30.0 * rng.normal(size=(2, 30, len(q)))
        s = np.stack([S_m + S_b, S_m - S_b], axis=1) @ q
        noise = 1e-12 * (np.abs(S_m) + np.abs(S_b)) @ np.abs(q).max(axis=1) * s.shape[-1]
        s -= s.mean(axis=-1, keepdims=True)
        steps = np.diff(np.concatenate([s, s[..., :1]], axis=-1) if residue == "repeat" else s, axis=-1)
        peak, size, of_steps = size_bound(S_m, S_b, modal_extent(q, residue))
        above = 1.0 + 1e-9
        assert (np.abs(s).max(axis=-1) <= above * peak + noise[:, None]).all()
        assert (np.linalg.norm(s, axis=-1) <= above * size + noise[:, None]).all()
        assert (np.linalg.norm(steps, axis=-1) <= above * of_steps + noise[:, None]).all()
