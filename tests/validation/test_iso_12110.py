"""ISO 12110-2:2013, worked example of rainflow counting: closed cycles, residue, and the residue in series twice."""

from collections import Counter

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.life.counting.rainflow import rainflow
from tests import naive

EXAMPLE = np.array([4, 7, 2, 10, 5, 9, 3, 4, 2, 12, 5, 11, 1, 4, 3, 10, 6, 12, 4, 8, 1, 9, 4, 6])
RESIDUE = [4, 7, 2, 12, 1, 9, 4, 6]
CLOSED = Counter({1: 2, 4: 3, 6: 1, 8: 1, 11: 1})


def test_closed_cycles_and_residue_of_the_example() -> None:
    """The four-point rule, in the slow version, gives the closed cycles and the residue of the standard."""
    closed, residue = naive.four_point(naive.turning_points(EXAMPLE))
    assert Counter(abs(a[1] - b[1]) for a, b in closed) == CLOSED
    assert [x for _, x in residue] == RESIDUE


def test_the_residue_of_the_example_as_half_cycles() -> None:
    """Counted as ASTM does, the residue adds half a cycle for each range between its neighbours."""
    cycles = rainflow(EXAMPLE, "half")
    expected = Counter(CLOSED)
    for x in np.abs(np.diff(RESIDUE)).tolist():
        expected[x] += 0.5
    assert {x: cycles.count[cycles.range == x].sum() for x in np.unique(cycles.range)} == expected


def test_the_residue_in_series_with_itself() -> None:
    """Twice the residue adds the ranges 2, 3, 7 and 11 to the closed cycles."""
    cycles = rainflow(EXAMPLE, "repeat")
    assert Counter(cycles.range) == CLOSED + Counter([2, 3, 7, 11])


@settings(deadline=None, max_examples=200)
@given(st.lists(st.integers(-6, 6), min_size=2, max_size=40))
def test_a_recurring_block_equals_the_doubled_residue(block: list[int]) -> None:
    """Any block: its closed cycles, and those of its residue followed by its residue."""
    points = naive.turning_points(block)
    closed, residue = naive.four_point(points)
    in_series = [x for _, x in residue + residue]
    points_in_series = naive.turning_points(in_series)
    closed_again, _ = naive.four_point(points_in_series)
    expected = Counter((abs(a[1] - b[1]), (a[1] + b[1]) / 2) for a, b in closed + closed_again)
    cycles = rainflow(np.array(block), "repeat")
    assert Counter(zip(cycles.range.tolist(), cycles.mean.tolist(), strict=True)) == expected
