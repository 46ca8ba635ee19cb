"""Spectra of cycles: a worked sequence by hand, and what holds of every signal."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from fatigue.life.counting.rainflow import rainflow
from fatigue.life.load_spectrum import (
    LoadCycles,
    cells,
    class_of,
    damage_equivalent,
    from_to,
    joined_cells,
    power_sums,
    range_mean,
    range_spectrum,
    uniform_edges,
    up_crossings,
)
from fatigue.life.mission import range_at_2e6

SEQUENCE = np.array([-2.0, 1.0, -3.0, 5.0, -1.0, 3.0, -4.0, 4.0, -2.0])
EDGES = np.array([0.0, 2.0, 4.0, 6.0, 8.0, 10.0])
LEVELS = np.array([-3.5, -2.5, -1.5, -0.5, 0.5, 1.5, 2.5, 3.5, 4.5])


def counted(signal, residue, constant=0.0):
    """Cycles of a signal that stands on a constant."""
    found = rainflow(signal, residue)
    first, second = signal[found.start] + constant, signal[found.end] + constant
    return LoadCycles(first, second, found.range, found.count)


signals = arrays(np.float64, st.integers(2, 40), elements=st.integers(-6, 6).map(float))
smooth = arrays(np.float64, st.integers(2, 40), elements=st.floats(-100.0, 100.0))
residues = st.sampled_from(["repeat", "half"])


def test_half_cycles_of_the_worked_sequence_by_class():
    """Counts and exceedances of ASTM's sequence, counted half."""
    found = range_spectrum(counted(SEQUENCE, "half"), EDGES, 3.0)
    assert found.count.tolist() == [0.0, 0.5, 1.5, 0.5, 1.5]
    assert found.reached.tolist() == [4.0, 4.0, 3.5, 2.0, 1.5]
    np.testing.assert_array_equal(found.largest, [np.nan, 3.0, 4.0, 6.0, 9.0])
    assert found.power_sum.sum() == pytest.approx(1094.0, rel=1e-12)


def test_cycles_of_the_worked_sequence_from_where_to_where():
    """First and second reversal in time, also of a cycle that wraps past the end."""
    found = counted(SEQUENCE, "repeat")
    pairs = sorted(zip(found.first.tolist(), found.second.tolist(), strict=True))
    assert pairs == [(-2.0, 1.0), (-1.0, 3.0), (4.0, -3.0), (5.0, -4.0)]
    found = counted(SEQUENCE, "half")
    pairs = sorted(zip(found.first.tolist(), found.second.tolist(), found.count.tolist(), strict=True))
    assert pairs == [(-4, 4, 0.5), (-3, 5, 0.5), (-2, 1, 0.5), (-1, 3, 1.0), (1, -3, 0.5), (4, -2, 0.5), (5, -4, 0.5)]


@pytest.mark.parametrize("residue", ["repeat", "half"])
def test_level_crossings_of_the_worked_sequence(residue):
    """The crossings of the samples: upwards where it repeats, half of all where it does not."""
    assert up_crossings(counted(SEQUENCE, residue), LEVELS).tolist() == [1, 2, 3, 4, 4, 3, 3, 2, 1]


def test_sums_of_the_worked_sequence():
    """Sums of n, n S and n S^3, and what follows of them."""
    for residue, cubes in (("half", 1094.0), ("repeat", 1163.0)):
        found = counted(SEQUENCE, residue)
        assert power_sums(found, np.array([1.0, 3.0])).tolist() == [23.0, cubes]
        assert found.count.sum() == 4.0
    per_km = np.array(0.6 / 0.5 * 1163.0)  # a pass of 0.5 km on 0.6 of the mileage
    assert range_at_2e6(per_km, 3.0, 1.2e7) == pytest.approx(20.3066088635794, rel=1e-12)
    alone = damage_equivalent(np.array([1163.0]), np.array([3.0]), 8.0)
    assert alone[0] == pytest.approx(5.258112928883722, rel=1e-12)


def test_a_class_holds_its_lower_edge_and_the_last_its_upper():
    """[lower, upper), and nothing beyond."""
    edges = np.array([1.0, 2.0, 4.0])
    assert class_of(np.array([0.99, 1.0, 2.0, 3.99, 4.0, 4.01]), edges).tolist() == [-1, 0, 1, 1, 1, -1]
    cycles = LoadCycles(np.zeros(4), np.array([0.5, 2.0, 4.0, 9.0]), np.array([0.5, 2.0, 4.0, 9.0]), np.ones(4))
    found = range_spectrum(cycles, edges, 1.0)
    assert found.count.tolist() == [0.0, 2.0]
    assert found.reached.tolist() == [3.0, 3.0]  # with the one beyond the last class


def test_a_signal_that_never_changes_has_no_cycles():
    """All is zero, and edges are there all the same."""
    found = counted(np.full(5, 3.0), "repeat")
    edges = uniform_edges(0.0, 0.0, 4)
    assert edges.tolist() == [0.0, 0.25, 0.5, 0.75, 1.0]
    spectrum = range_spectrum(found, edges, 3.0)
    assert spectrum.count.tolist() == spectrum.reached.tolist() == [0.0] * 4
    assert np.isnan(spectrum.largest).all()
    assert not from_to(found, edges).count.size
    assert up_crossings(found, edges).tolist() == [0.0] * 5
    assert uniform_edges(7.0, 7.0, 2).tolist() == [6.5, 7.0, 7.5]


@given(signals | smooth, residues, st.integers(1, 30))
def test_classes_lose_no_cycle_and_no_power(signal, residue, classes):
    """Sums over the classes are those of the cycles, the largest range included."""
    found = counted(signal, residue)
    edges = uniform_edges(0.0, float(found.range.max(initial=0.0)), classes)
    spectrum = range_spectrum(found, edges, 3.0)
    assert spectrum.count.sum() == found.count.sum() == spectrum.reached[0]
    assert spectrum.power_sum.sum() == pytest.approx(power_sums(found, np.array([3.0]))[0], rel=1e-12)
    assert np.fmax.reduce(spectrum.largest) == found.range.max(initial=-np.inf) or not len(found.range)
    assert (np.diff(spectrum.reached) <= 0.0).all()
    np.testing.assert_allclose(spectrum.reached, [found.count[found.range >= edge].sum() for edge in edges[:-1]])


@given(signals, residues)
def test_ranges_add_up_to_half_of_all_that_is_moved(signal, residue):
    """Sum n S is half the total variation, round to the first sample where the signal repeats."""
    path = np.append(signal, signal[0]) if residue == "repeat" else signal
    assert power_sums(counted(signal, residue), np.array([1.0]))[0] == 0.5 * np.abs(np.diff(path)).sum()


@given(signals | smooth, residues, st.floats(-50.0, 50.0))
def test_crossings_are_those_of_the_samples(signal, residue, constant):
    """Upwards s[i] < u <= s[i+1] where the signal repeats; half of both directions where it does not."""
    found = counted(signal, residue)
    levels = np.unique(np.concatenate([signal, np.linspace(-101.0, 101.0, 23)]))
    path = np.append(signal, signal[0]) if residue == "repeat" else signal
    a, b = path[:-1], path[1:]
    up = np.array([np.count_nonzero((a < u) & (u <= b)) for u in levels], dtype=float)
    down = np.array([np.count_nonzero((b < u) & (u <= a)) for u in levels], dtype=float)
    expected = up if residue == "repeat" else 0.5 * (up + down)
    assert up_crossings(found, levels).tolist() == expected.tolist()
    raised = counted(signal, residue, constant)
    assert (raised.range == found.range).all()


@given(signals | smooth, residues, st.integers(1, 12))
def test_margins_of_the_matrices_agree(signal, residue, classes):
    """Rows of the range-mean matrix add up to the spectrum; both matrices hold the same cycles, diagonal included."""
    found = counted(signal, residue)
    assume(len(found.range))
    ranges = uniform_edges(0.0, float(found.range.max()), classes)
    levels = uniform_edges(float(found.lowest.min()), float(found.highest.max()), classes)
    by_mean, by_reversal = range_mean(found, ranges, levels), from_to(found, levels)
    total = np.bincount(by_mean.row, by_mean.count, classes)
    np.testing.assert_array_equal(total, range_spectrum(found, ranges, 3.0).count)
    assert by_reversal.count.sum() == by_mean.count.sum() == found.count.sum()
    ends = np.bincount(by_reversal.row, by_reversal.count, classes)
    ends += np.bincount(by_reversal.column, by_reversal.count, classes)
    at = class_of(np.concatenate([found.first, found.second]), levels)
    np.testing.assert_array_equal(ends, np.bincount(at, np.tile(found.count, 2), classes))


def test_what_is_taken_away_again_leaves_no_cell():
    """Cells that cancel but for rounding are empty."""
    one = cells(np.array([0, 1]), np.array([0, 1]), np.array([0.3, 1.0]), 2)
    two = cells(np.array([0]), np.array([0]), np.array([-0.1 - 0.2]), 2)
    left = joined_cells([one, two], 2)
    assert (left.row.tolist(), left.count.tolist()) == ([1], [1.0])


def test_a_sum_below_nothing_has_no_equivalent():
    """A sequence that takes away more than it adds has none."""
    assert np.isnan(damage_equivalent(np.array([-1.0]), np.array([3.0]), 1.0)[0])
