"""The cycles of the recount, from the ``rainflow`` package, against published counts."""

import numpy as np
import pytest

from fatigue.verify.recount.anew.cycles import count_cycles


def spectrum_of(sequence, *, recurs):
    """Sum the counts by range."""
    s = np.array(sequence, dtype=float)
    cycles = count_cycles(s, recurs=recurs)
    found = {}
    for i, j, n in zip(cycles.start, cycles.end, cycles.count, strict=True):
        found[abs(s[j] - s[i])] = found.get(abs(s[j] - s[i]), 0.0) + n
    return found


@pytest.mark.parametrize(
    ("sequence", "half", "repeat"),
    [
        ([-2, 1, -3, 5, -1, 3, -4, 4, -2], {3: 0.5, 4: 1.5, 6: 0.5, 8: 1, 9: 0.5}, {3: 1, 4: 1, 7: 1, 9: 1}),
        ([2, 5, 3, 7], {2: 1, 5: 0.5}, {2: 1, 5: 1}),
        ([0, 1], {1: 0.5}, {1: 1}),
        ([1, 0, 0], {1: 0.5}, {1: 1}),
        ([3, 3, 3], {}, {}),
        ([0, 1, 2, 3], {3: 0.5}, {3: 1}),
        ([2, 0, 2, 0, 2], {2: 2}, {2: 2}),
    ],
)
def test_cycles(sequence, half, repeat):
    """ASTM E1049-85 figure 6, residues, two samples, plateaus, ties and a constant."""
    assert spectrum_of(sequence, recurs=False) == half
    assert spectrum_of(sequence, recurs=True) == repeat


def test_a_cycle_may_run_across_the_end_of_a_block():
    """Reversals of a block that recurs are indices of the block itself, one cycle from the largest to the smallest."""
    cycles = count_cycles(np.array([1.0, 0.0, 3.0, 2.0]), recurs=True)
    assert (cycles.start.tolist(), cycles.end.tolist(), cycles.count.tolist()) == ([2], [1], [1.0])
