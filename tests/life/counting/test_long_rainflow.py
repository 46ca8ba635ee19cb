"""Cycles of long records: the same, in the same order, as of records in memory."""

import tracemalloc
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.life.counting import long_rainflow
from fatigue.life.counting.long_rainflow import Piece, long_cycles
from fatigue.life.counting.rainflow import rainflow

LEVELS = st.lists(st.tuples(st.integers(-3, 3), st.integers(-2, 2)), min_size=1, max_size=60)


def pieces_joined(membrane, bending, side, residue, cuts):
    """Cycles of a record that comes in some chunks."""
    edges = [0, *sorted(cut % (len(membrane) + 1) for cut in cuts), len(membrane)]

    def chunks():
        return ((membrane[a:b], bending[a:b]) for a, b in pairwise(edges) if b > a)

    pieces = list(long_cycles(chunks, side, residue))
    return Piece._make(np.concatenate(arrays) for arrays in zip(*pieces, strict=True))


@pytest.mark.parametrize("residue", ["repeat", "half"])
@pytest.mark.parametrize("side", [1.0, -1.0])
@given(levels=LEVELS, cuts=st.lists(st.integers(0, 60), max_size=4))
@settings(max_examples=100, deadline=None)  # the first one compiles
def test_cycles_are_those_of_the_whole_record(residue, side, levels, cuts):
    """Few levels, so that plateaus, ties and several largest samples occur; wherever the record is cut."""
    membrane, bending = np.array(levels, dtype=np.float64).T
    stress = membrane + side * bending
    expected = rainflow(stress, residue)
    found = pieces_joined(membrane, bending, side, residue, cuts)
    at = found.at
    np.testing.assert_array_equal(at, np.stack([expected.start, expected.end], axis=1))
    np.testing.assert_array_equal(found.weight, expected.count)
    np.testing.assert_array_equal(found.stress, stress[at])
    np.testing.assert_array_equal(found.membrane, membrane[at])
    np.testing.assert_array_equal(found.bending, bending[at])
    np.testing.assert_array_equal(found.shift, np.zeros(at.shape))


def test_pieces_and_a_growing_residue(monkeypatch):
    """Swings that grow close nothing until the end: the stack of open reversals takes what it needs."""
    monkeypatch.setattr(long_rainflow, "FEWEST", 100)
    t = np.arange(4000)
    s = t * (-1.0) ** t
    for residue in ("repeat", "half"):
        expected = rainflow(s, residue)
        found = pieces_joined(s, 0.0 * s, 1.0, residue, [1000, 1001, 2500])
        np.testing.assert_array_equal(found.at[:, 0], expected.start)
        np.testing.assert_array_equal(found.weight, expected.count)


def test_memory_does_not_grow_with_the_record():
    """Pieces are used up one by one: a record of 3 million samples takes a fifth of what one copy of it would."""
    rng = np.random.default_rng(0)
    chunk, bending = rng.normal(size=20_000), np.zeros(20_000)
    tracemalloc.start()
    try:
        cycles = sum(
            len(piece.weight) for piece in long_cycles(lambda: ((chunk, bending) for _ in range(150)), 1.0, "repeat")
        )
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert cycles > 900_000
    assert peak < 24e6
