"""Rainflow counting of one signal, against the `rainflow` package, a slow version and invariants."""

from collections import Counter
from collections.abc import Callable

import numpy as np
import pytest
import rainflow as oracle
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from fatigue.errors import NumericalError
from fatigue.life.counting.rainflow import Cycles, rainflow
from tests import naive

Signal = NDArray[np.float64]
Spectrum = dict[tuple[float, float], float]

RESIDUES = ("half", "repeat")
INTEGERS = st.lists(st.integers(-6, 6), min_size=2, max_size=50).map(lambda x: np.array(x, dtype=float))


def spectrum(cycles: Cycles) -> Spectrum:
    """Add up the counts by range and mean."""
    totals: Spectrum = {}
    for x, mean, n in zip(cycles.range.tolist(), cycles.mean.tolist(), cycles.count.tolist(), strict=True):
        totals[x, mean] = totals.get((x, mean), 0.0) + n
    return totals


def by_range(cycles: Cycles) -> dict[float, float]:
    """Add up the counts by range."""
    return {float(x): float(cycles.count[cycles.range == x].sum()) for x in np.unique(cycles.range)}


def random_signal(rng: np.random.Generator, kind: int) -> Signal:
    """Draw integers with ties, held samples, a clipped walk, a growing or a decaying history, or plain noise."""
    t = int(rng.integers(2, 120))
    integers = rng.integers(-4, 5, t).astype(float)
    return [
        integers,
        np.repeat(integers, rng.integers(1, 4, t)),
        np.clip(np.cumsum(rng.integers(-2, 3, t)), -5, 5).astype(float),
        rng.normal(size=t) * np.linspace(0, 1, t),
        rng.normal(size=t) * np.linspace(1, 0, t),
        rng.normal(size=t),
    ][kind]


@pytest.mark.parametrize("kind", range(6))
def test_half_is_what_the_rainflow_package_counts(kind: int) -> None:
    """Every cycle, in the same order, with the same two samples, in 500 random signals of each kind."""
    rng = np.random.default_rng(kind)
    for _ in range(500):
        s = random_signal(rng, kind)
        if s.size < 3 or np.ptp(s) == 0:
            continue  # where the package finds nothing, or a cycle of range 0
        c = rainflow(s, "half")
        rows = list(zip(c.range, c.mean, c.count, c.start, c.end, strict=True))
        assert rows == list(oracle.extract_cycles(s.tolist()))


@pytest.mark.parametrize("kind", range(6))
def test_repeat_is_what_the_package_counts_from_maximum_to_maximum(kind: int) -> None:
    """Range, mean and count of the rotated and closed block, in 500 random signals of each kind."""
    rng = np.random.default_rng(100 + kind)
    for _ in range(500):
        s = random_signal(rng, kind)
        if np.ptp(s) == 0:
            continue
        path = np.append(np.roll(s, -s.argmax()), s.max())
        expected: Spectrum = {}
        for x, mean, n, _, _ in oracle.extract_cycles(path.tolist()):
            expected[x, mean] = expected.get((x, mean), 0.0) + n
        assert spectrum(rainflow(s, "repeat")) == expected


@settings(deadline=None, max_examples=100)
@given(INTEGERS)
def test_repeat_is_what_one_more_pass_adds(s: Signal) -> None:
    """Closed cycles of three passes in series minus those of two."""
    closed = [
        Counter((abs(a[1] - b[1]), (a[1] + b[1]) / 2) for a, b in naive.four_point(naive.turning_points(passes))[0])
        for passes in (np.tile(s, 2), np.tile(s, 3))
    ]
    assert spectrum(rainflow(s, "repeat")) == closed[1] - closed[0]


@pytest.mark.parametrize("seed", range(20))
def test_repeat_finds_the_two_samples_in_the_given_block(seed: int) -> None:
    """Pairs of samples as the slow version has them, when no two samples are equal."""
    s = np.random.default_rng(seed).normal(size=61)
    c = rainflow(s, "repeat")
    ends = Counter(frozenset(pair) for pair in zip(c.start.tolist(), c.end.tolist(), strict=True))
    expected: Counter[frozenset[int]] = Counter()
    for i, j, n in naive.cycles(s, "repeat"):
        expected[frozenset((i, j))] += n
    assert ends == expected


def test_a_cycle_across_the_end_of_the_block_ends_before_it_starts() -> None:
    """The cycle of range 7 goes from the last peak into the first valley of the next pass."""
    c = rainflow(np.array([-2, 1, -3, 5, -1, 3, -4, 4, -2]), "repeat")
    assert (c.range[2], c.start[2], c.end[2]) == (7, 7, 2)


@pytest.mark.parametrize("residue", RESIDUES)
@pytest.mark.parametrize("signal", [[], [3.0], [3.0, 3.0, 3.0]])
def test_a_signal_that_never_changes_has_no_cycles(signal: list[float], residue: str) -> None:
    """Nothing, one sample, a constant."""
    assert rainflow(np.array(signal), residue).range.size == 0


@pytest.mark.parametrize(
    ("signal", "half", "repeat"),
    [
        ([0, 1], {1: 0.5}, {1: 1}),
        ([0, 1, 2, 3], {3: 0.5}, {3: 1}),
        ([0, 5, 0, 0], {5: 1}, {5: 1}),
        ([0, 5, 5, -5, -5, 0], {5: 1, 10: 0.5}, {10: 1}),
        ([0, 5, 5, 0, 0, 5], {5: 1.5}, {5: 2}),
    ],
)
def test_short_signals_and_plateaus(signal: list[int], half: dict[float, float], repeat: dict[float, float]) -> None:
    """Count of each range of signals on which other programs lose cycles."""
    assert by_range(rainflow(np.array(signal), "half")) == half
    assert by_range(rainflow(np.array(signal), "repeat")) == repeat


def test_a_plateau_reports_its_last_sample() -> None:
    """In a single pass, and in a block whose maximum lasts from its end into its beginning."""
    half = rainflow(np.array([0, 5, 5, 5, -5, -5, 0]), "half")
    assert list(zip(half.start, half.end, strict=True)) == [(0, 3), (3, 5), (5, 6)]
    repeat = rainflow(np.array([5, 5, 1, 1, 3, 3, 0, 0, 0, 5]), "repeat")
    assert list(zip(repeat.range, repeat.start, repeat.end, strict=True)) == [(2, 3, 5), (5, 1, 8)]


@pytest.mark.parametrize(
    ("signal", "ranges"),
    [
        (np.array([0, 100, -100, 100, 0], dtype=np.int8), {100: 1, 200: 1}),
        (np.array([0, 200, 10, 200, 0], dtype=np.uint8), {190: 1, 200: 1}),
        (np.array([0, 100, -100, 100, 0], dtype=np.float32), {100: 1, 200: 1}),
    ],
)
def test_narrow_number_types_do_not_overflow(signal: NDArray[np.generic], ranges: dict[float, float]) -> None:
    """Integers of 8 bits wrap round in other programs."""
    assert by_range(rainflow(signal, "half")) == ranges


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_a_sample_that_is_not_finite_is_refused(value: float) -> None:
    """The message names the first such sample."""
    with pytest.raises(NumericalError, match="sample 2 of the signal: the stress is NaN or infinite"):
        rainflow(np.array([0.0, 1.0, value, 1.0, value]), "half")


def test_the_signal_is_left_as_it_was() -> None:
    """Counting writes into its own buffers only."""
    s = np.array([1.0, 3.0, 3.0, -2.0, 4.0, 0.0])
    before = s.copy()
    rainflow(s, "repeat")
    np.testing.assert_array_equal(s, before)


# ------------------------------------------------------------------------------------------------ invariants


@settings(deadline=None, max_examples=150)
@given(INTEGERS)
def test_half_counts_add_up_to_the_turning_points(s: Signal) -> None:
    """(turning points - 1) / 2: every range between neighbours is half a cycle of some size."""
    assert rainflow(s, "half").count.sum() == max(len(naive.turning_points(s)) - 1, 0) / 2


@settings(deadline=None, max_examples=150)
@given(INTEGERS)
def test_half_is_closed_cycles_and_residue(s: Signal) -> None:
    """The three-point rule of ASTM and the four-point rule count the same."""
    assert spectrum(rainflow(s, "half")) == naive.spectrum(naive.cycles(s, "half"), s)


@settings(deadline=None, max_examples=150)
@given(INTEGERS, st.sampled_from(RESIDUES))
def test_the_largest_cycle_is_the_whole_range(s: Signal, residue: str) -> None:
    """Whatever the residue, the extremes of the signal form a cycle."""
    assert rainflow(s, residue).range.max(initial=0.0) == np.ptp(s)


@settings(deadline=None, max_examples=150)
@given(INTEGERS, st.integers(0, 50))
def test_a_recurring_block_may_begin_anywhere(s: Signal, shift: int) -> None:
    """Only whole cycles, the same ones after a cyclic rotation."""
    cycles = rainflow(s, "repeat")
    assert np.all(cycles.count == 1.0)
    assert spectrum(rainflow(np.roll(s, shift), "repeat")) == spectrum(cycles)


@settings(deadline=None, max_examples=150)
@given(INTEGERS, st.sampled_from([1, 3, 5, 8]))
def test_damage_grows_from_closed_to_half_to_repeat(s: Signal, m: int) -> None:
    """Sum of n S^m: closed cycles alone, with the residue as half cycles, of the block for ever."""
    closed, _ = naive.four_point(naive.turning_points(s))
    half, repeat = (rainflow(s, residue) for residue in RESIDUES)
    sums = [sum(abs(a[1] - b[1]) ** m for a, b in closed), *(np.sum(c.count * c.range**m) for c in (half, repeat))]
    assert sums == sorted(sums)


@settings(deadline=None, max_examples=150)
@given(INTEGERS, st.sampled_from(RESIDUES), st.integers(1, 3), st.integers(-9, 9))
def test_counts_ignore_sign_offset_direction_and_held_samples(s: Signal, residue: str, held: int, offset: int) -> None:
    """The ranges and means move with the signal, the counts stay."""
    expected = spectrum(rainflow(s, residue))

    def moved(change: Callable[[float], float]) -> Spectrum:
        return {(x, change(mean)): n for (x, mean), n in expected.items()}

    assert spectrum(rainflow(-s, residue)) == moved(lambda mean: -mean)
    assert spectrum(rainflow(s + offset, residue)) == moved(lambda mean: mean + offset)
    assert spectrum(rainflow(s[::-1], residue)) == expected
    assert spectrum(rainflow(np.repeat(s, held), residue)) == expected


@settings(deadline=None, max_examples=100)
@given(INTEGERS, st.sampled_from(RESIDUES))
def test_each_cycle_points_to_its_two_samples(s: Signal, residue: str) -> None:
    """Range and mean are those of the samples at start and end."""
    c = rainflow(s, residue)
    np.testing.assert_array_equal(c.range, np.abs(s[c.start] - s[c.end]))
    np.testing.assert_array_equal(c.mean, (s[c.start] + s[c.end]) / 2)
