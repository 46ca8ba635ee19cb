"""Damage in equal pieces of a record: by both counters, whatever the residue, against every cycle laid by hand."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.life.attribution import cycle_credit
from fatigue.life.counting.block import BlockStress
from fatigue.life.counting.chunks import count_chunks
from fatigue.life.counting.count import count_histograms, count_histograms_and_pieces
from fatigue.life.counting.rainflow import rainflow
from fatigue.life.counting.record import CountedRecord
from fatigue.life.counting.rows import count_rows
from fatigue.life.counting.vertex import vertex_history
from fatigue.life.curves import catalogue, damage_law, user_curve
from fatigue.life.rule import CycleRule

PIECES = 30
MASTER = CycleRule(damage_law(catalogue()["master-aluminium"], "mean-2sigma", "none", 1e7), uses_bending_ratio=True)
KNEE = CycleRule(damage_law(user_curve("k", (3.0, 5.0), (1e7,), 60.0, "structural", "own"), None, "none", 1e7), False)


def block(rng, points=3, modes=4):
    """Some points of some modes."""
    stress = rng.normal(0.0, 20.0, (2, points, modes))
    return BlockStress(stress[0], 0.5 * stress[1], rng.uniform(1.0, 2.0, points), np.zeros((points, 2)))


def by_hand(stress, q, residue, rule, vertex):
    """Half of the damage of every cycle in the piece of either instant."""
    laid, samples = np.zeros((len(stress), 2, PIECES)), q.shape[1]
    for point in range(len(stress)):
        for face, side in enumerate((1.0, -1.0)):
            m, b = stress.membrane[point] @ q, stress.bending[point] @ q
            if vertex:
                moved = vertex_history(m, b, side, recurs=residue == "repeat")
                m, b = moved.membrane, moved.bending
            cycles = rainflow(m + side * b, residue)
            both = np.stack([cycles.start, cycles.end])
            damage = cycle_credit(m[both], b[both], cycles.count, side, stress.size[point], rule).damage
            for instants in both:
                np.add.at(laid[point, face], PIECES * instants // samples, 0.5 * damage)
    return laid


@pytest.mark.parametrize("residue", ["repeat", "half"])
@pytest.mark.parametrize("vertex", [False, True])
@pytest.mark.parametrize("rule", [MASTER, KNEE], ids=["master", "knee"])
def test_both_counters_lay_every_cycle_where_it_turns(residue, vertex, rule):
    """Both counters lay every cycle where it turns."""
    rng = np.random.default_rng(7)
    q = np.cumsum(rng.normal(size=(4, 2003)), axis=1) * 0.2 + rng.normal(size=(4, 2003))
    stress, record = block(rng), CountedRecord(q, residue, vertex=vertex)
    expected = by_hand(stress, q, residue, rule, vertex)
    for counter in (count_rows, lambda *a, pieces: count_chunks(*a, 97, pieces=pieces)):
        pieces = np.zeros((3, 2, PIECES))
        counted = counter(stress, record, rule, pieces=pieces)
        np.testing.assert_allclose(pieces, expected, rtol=1e-9, atol=1e-12 * expected.max())
        np.testing.assert_allclose(pieces.sum(axis=2), counted.damage, rtol=1e-12)


def test_pieces_take_nothing_from_the_histograms():
    """Pieces take nothing from the histograms."""
    rng = np.random.default_rng(8)
    stress, record = block(rng), CountedRecord(rng.normal(size=(4, 900)), "repeat")
    histograms, pieces = count_histograms_and_pieces(stress, record, MASTER, PIECES)
    assert np.array_equal(histograms, count_histograms(stress, record, MASTER))
    assert pieces.shape == (3, 2, PIECES)
    assert count_histograms_and_pieces(stress, record, MASTER, 0)[1].shape == (3, 2, 0)


@settings(max_examples=30, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), turn=st.integers(0, PIECES - 1), scale=st.floats(0.1, 10.0))
def test_a_record_that_recurs_begun_at_another_piece_has_its_pieces_turned(seed, turn, scale):
    """A record that recurs begun at another piece has its pieces turned."""
    rng = np.random.default_rng(seed)
    q, stress = rng.normal(size=(4, 10 * PIECES)), block(rng)
    _, pieces = count_histograms_and_pieces(stress, CountedRecord(q, "repeat"), MASTER, PIECES)
    turned = scale * np.roll(q, 10 * turn, axis=1)
    _, found = count_histograms_and_pieces(stress, CountedRecord(turned, "repeat"), MASTER, PIECES)
    power = scale ** MASTER.law.slopes[0]
    np.testing.assert_allclose(
        found, power * np.roll(pieces, turn, axis=2), rtol=1e-9, atol=1e-9 * power * pieces.max()
    )


@pytest.mark.parametrize("samples", [1, 2, 3, 31])
def test_records_of_hardly_any_samples_have_pieces_too(samples):
    """Records of hardly any samples have pieces too."""
    rng = np.random.default_rng(9)
    q = rng.normal(size=(4, samples))
    for residue in ("repeat", "half"):
        stress, record = block(rng), CountedRecord(q, residue)
        by_rows, by_chunks = np.zeros((3, 2, PIECES)), np.zeros((3, 2, PIECES))
        counted = count_rows(stress, record, MASTER, pieces=by_rows)
        count_chunks(stress, record, MASTER, pieces=by_chunks)
        np.testing.assert_allclose(by_rows, by_chunks, rtol=1e-12)
        np.testing.assert_allclose(by_rows.sum(axis=2), counted.damage, rtol=1e-12)


def test_a_plateau_turns_in_the_piece_of_its_last_sample():
    """A plateau turns in the piece of its last sample."""
    q = np.repeat([0.0, 1.0, 1.0, 0.0, -1.0, 0.0], 10)[None]
    stress = BlockStress(np.full((1, 1), 50.0), np.zeros((1, 1)), np.ones(1), np.zeros((1, 2)))
    for residue in ("repeat", "half"):
        by_rows, by_chunks = np.zeros((1, 2, PIECES)), np.zeros((1, 2, PIECES))
        count_rows(stress, CountedRecord(q, residue), MASTER, pieces=by_rows)
        count_chunks(stress, CountedRecord(q, residue), MASTER, 7, pieces=by_chunks)
        np.testing.assert_array_equal(by_rows, by_chunks)
        assert {14, 24} <= set(np.flatnonzero(by_rows[0, 0]).tolist())
