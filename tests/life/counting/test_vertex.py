"""Reversals at the vertices of parabolas: what that gains, what stays as it was; all counters read the same ones."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from fatigue.life.attribution import credit
from fatigue.life.counting.block import BlockCount, BlockStress
from fatigue.life.counting.chunks import count_chunks
from fatigue.life.counting.count import count, count_at_factors
from fatigue.life.counting.long_rainflow import Piece, long_cycles
from fatigue.life.counting.rainflow import rainflow
from fatigue.life.counting.record import CountedRecord
from fatigue.life.counting.rows import count_rows
from fatigue.life.counting.single.prepare import single_record
from fatigue.life.counting.vertex import spread, vertex_history
from fatigue.life.records.history import Residue
from fatigue.life.rule import CycleRule
from tests import naive
from tests.life.counting.test_chunks import LAWS, RESIDUES, assert_same, signals

Floats = NDArray[np.float64]

values = st.integers(-8, 8).map(float)
histories = st.lists(st.tuples(values, values), min_size=1, max_size=40).map(
    lambda pairs: np.ascontiguousarray(np.array(pairs).T)
)


def block_of(stresses: Floats) -> tuple[BlockStress, Floats]:
    """A block whose modal coordinates are its membrane and bending stresses (2, n, t), and these coordinates."""
    _, n, t = stresses.shape
    rng = np.random.default_rng(n)
    own = rng.uniform(1.0, 2.0, n), rng.uniform(0.0, 1.0, (n, 2))
    return BlockStress(np.eye(n, 2 * n), np.eye(n, 2 * n, n), *own), stresses.reshape(2 * n, t)


def damage(s: Floats, slope: float, *, vertex: bool) -> float:
    """Sum n S^k of a signal."""
    moved = vertex_history(s, np.zeros(len(s)), 1.0, recurs=False).membrane if vertex else s
    cycles = rainflow(moved, "half")
    return float((cycles.count * cycles.range**slope).sum())


@pytest.mark.parametrize(
    ("samples", "as_sampled", "at_vertices"), [(6.3, 0.134, 0.028), (8.0, 0.086, 0.011), (10.0, 0.057, 0.005)]
)
def test_what_a_sine_loses(samples: float, as_sampled: float, at_vertices: float) -> None:
    """At 10 samples per peak next to nothing, at 6.3 3 % in place of 13 %; k = 3.6."""
    s = np.sin(2 * np.pi * np.arange(20_000) / (samples + 0.0137))
    exact = damage(np.tile([1.0, -1.0], round(20_000 / samples)), 3.6, vertex=False)
    assert 1.0 - damage(s, 3.6, vertex=False) / exact == pytest.approx(as_sampled, abs=0.006)
    assert 1.0 - damage(s, 3.6, vertex=True) / exact == pytest.approx(at_vertices, abs=0.004)


def test_a_parabola_is_read_exactly() -> None:
    """Its vertex, membrane and bending at the same instant, between the samples."""
    t = np.arange(-3.0, 4.0)
    membrane, bending = 7.0 - 2.0 * (t - 0.3) ** 2 + t, 1.0 + 0.5 * (t - 0.3) ** 2 - t
    moved = vertex_history(membrane, bending, 1.0, recurs=False)
    assert moved.shift.tolist() == pytest.approx([0, 0, 0, 0.3, 0, 0, 0])
    assert moved.membrane[3] == pytest.approx(7.3)
    assert moved.bending[3] == pytest.approx(0.7)


@pytest.mark.parametrize(
    ("s", "recurs", "moving"),
    [
        ([0.0, 2.0, 1.0], False, [1]),
        ([0.0, 2.0, 1.0], True, [0, 1]),
        ([0.0, 2.0, 2.0, 1.0], False, []),  # a plateau
        ([2.0, 0.0, 1.0, 2.0], True, [1]),  # a plateau across the end of the block
        ([1.0, 1.0, 1.0], True, []),
        ([1.0], True, []),
        ([1.0, 2.0], True, []),  # symmetric: it is the vertex
        ([0.0, 1.0, 2.0, 3.0], False, []),
    ],
)
def test_ends_and_plateaus_stay(s: list[float], recurs: bool, moving: list[int]) -> None:
    """What has no neighbour on one side, or an equal one, is where it is; of what recurs the ends are neighbours."""
    moved = vertex_history(np.array(s), np.zeros(len(s)), 1.0, recurs=recurs)
    assert np.flatnonzero(moved.shift).tolist() == moving


@settings(deadline=None, max_examples=200)
@given(histories, st.sampled_from(RESIDUES), st.sampled_from([1.0, -1.0]))
def test_reversals_stay_and_no_range_is_smaller(stress: Floats, residue: Residue, side: float) -> None:
    """Peaks rise and valleys fall, by an eighth of the larger step at most; between them nothing changes."""
    recurs = residue == "repeat"
    s = stress[0] + side * stress[1]
    moved = vertex_history(*stress, side, recurs=recurs)
    v = moved.membrane + side * moved.bending
    points = [i for i, _ in naive.turning_points(s)]
    assert [i for i, _ in naive.turning_points(v)] == points
    steps = np.maximum(np.abs(s - np.roll(s, 1)), np.abs(s - np.roll(s, -1)))
    assert (np.abs(v - s) <= steps / 8.0 + 1e-12).all()
    assert (np.abs(np.diff(v[points])) >= np.abs(np.diff(s[points])) - 1e-12).all()
    assert (np.abs(moved.shift) <= 0.5).all()
    expected = naive.at_vertices(*stress, side, residue)
    np.testing.assert_allclose(moved, expected, atol=1e-12)


@settings(deadline=None, max_examples=100)
@given(histories, st.sampled_from(RESIDUES), st.integers(1, 9))
def test_counters_agree_with_counting_by_hand(stress: Floats, residue: Residue, chunk: int) -> None:
    """Whole rows, chunks of any length, and a slow count of the moved history."""
    rule = CycleRule(LAWS["straight"], uses_bending_ratio=False)
    block, q = block_of(stress[:, None])
    record = CountedRecord(q, residue, vertex=True)
    whole = count_rows(block, record, rule)
    for other in (whole, count_chunks(block, record, rule, chunk)):
        for face, side in enumerate((1.0, -1.0)):
            m, b, _ = (np.array(x) for x in naive.at_vertices(*stress, side, residue))
            found = naive.cycles(m + side * b, residue)
            ranges = np.array([abs((m + side * b)[i] - (m + side * b)[j]) for i, j, _ in found])
            weights = np.array([n for *_, n in found])
            assert other.cycles[0, face] == pytest.approx(weights.sum())
            assert other.max_range[0, face] == pytest.approx(ranges.max(initial=0.0))
            assert other.power_sum[0, face] == pytest.approx(np.sum(weights * ranges ** rule.law.slopes[0]))


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
@pytest.mark.parametrize("residue", RESIDUES)
def test_chunks_read_the_same_vertices_as_rows(residue: Residue, law: Any) -> None:
    """Whatever the law, and whether a reversal is the first or the last sample of a chunk."""
    rule = CycleRule(law, uses_bending_ratio=True, yield_MPa=50.0, mean_stress=True)
    for stresses in signals(np.random.default_rng(4), 3, 500):
        block, q = block_of(stresses)
        record = CountedRecord(q, residue, vertex=True)
        for chunk in (1, 2, 7, 100):
            assert_same(count_chunks(block, record, rule, chunk), count_rows(block, record, rule))


@pytest.mark.parametrize("residue", RESIDUES)
def test_cycles_of_long_records_are_the_same(residue: Residue) -> None:
    """Instants, stresses and shifts, from chunks of any length."""
    for stresses in signals(np.random.default_rng(5), 1, 400):
        m, b = stresses[:, 0]
        moved = vertex_history(m, b, -1.0, recurs=residue == "repeat")
        cycles = rainflow(moved.membrane - moved.bending, residue)
        for width in (1, 3, 400):
            chunks = [(m[i : i + width], b[i : i + width]) for i in range(0, 400, width)]
            pieces = list(long_cycles(lambda of=chunks: iter(of), -1.0, residue, vertex=True))
            found = Piece._make(np.concatenate(arrays) for arrays in zip(*pieces, strict=True))
            at = np.stack([cycles.start, cycles.end], axis=1)
            np.testing.assert_array_equal(found.at, at)
            np.testing.assert_allclose(found.shift, moved.shift[at], atol=1e-12)
            np.testing.assert_allclose(found.membrane, moved.membrane[at], atol=1e-12)
            np.testing.assert_allclose(found.bending, moved.bending[at], atol=1e-12)


def test_the_counter_in_single_precision_leaves_vertices_to_the_others() -> None:
    """A record prepared for it is counted in double precision."""
    q = np.random.default_rng(0).normal(size=(4, 2000))
    block, _ = block_of(q.reshape(2, 2, 2000))
    rule = CycleRule(LAWS["straight"], uses_bending_ratio=True)
    record = CountedRecord(q, "repeat", single_record(q), vertex=True)
    assert_same(count(block, record, rule), count_rows(block, record, rule))


@pytest.mark.parametrize("residue", RESIDUES)
def test_damage_under_factors_reads_vertices_too(residue: Residue) -> None:
    """At a factor of 1 the damage that is counted."""
    stresses = np.random.default_rng(1).normal(size=(2, 3, 300)) * 40.0
    block, q = block_of(stresses)
    rule = CycleRule(LAWS["haibach"], uses_bending_ratio=True)
    record = CountedRecord(q, residue, vertex=True)
    found = count_at_factors(block, record, rule, np.ones((3, 2)), np.full((3, 2), 0.01), 3)
    np.testing.assert_allclose(found[..., 0], count(block, record, rule).damage, rtol=1e-12)


@pytest.mark.parametrize("residue", RESIDUES)
def test_parts_add_up_on_the_samples(residue: Residue) -> None:
    """What is laid on vertices is laid on their three samples: times the samples it is the damage."""
    m, b = np.random.default_rng(2).normal(size=(2, 400)) * 40.0
    moved = vertex_history(m, b, 1.0, recurs=residue == "repeat")
    cycles = rainflow(moved.membrane + moved.bending, residue)
    rule = CycleRule(LAWS["straight"], uses_bending_ratio=True)
    found = credit(cycles, moved.membrane, moved.bending, 1.0, 1.5, rule, shift=moved.shift)
    assert found.share @ (m + b) == pytest.approx(found.damage, rel=1e-10)
    assert found.place.sum() == pytest.approx(found.damage)
    scaled = [float(np.vdot(by, x)) for by, x in ((found.by_membrane, m), (found.by_bending, b))]
    assert sum(scaled) == pytest.approx(found.slope, rel=1e-10)  # Euler: all stresses scaled
    np.testing.assert_allclose(spread(np.eye(400)[7], np.zeros(400)), np.eye(400)[7])


def test_the_slope_of_the_damage_by_one_stress() -> None:
    """By a difference: membrane stress scaled alone, to what the shift of instants does to bending ratios."""
    t = np.arange(600)
    m, b = 40.0 * np.sin(0.7 * t), 25.0 * np.sin(0.7 * t + 0.4) + 5.0 * np.sin(0.31 * t)
    rule = CycleRule(LAWS["straight"], uses_bending_ratio=True)

    def of(factor: float) -> Any:
        moved = vertex_history(factor * m, b, 1.0, recurs=False)
        cycles = rainflow(moved.membrane + moved.bending, "half")
        return credit(cycles, moved.membrane, moved.bending, 1.0, 1.5, rule, shift=moved.shift)

    difference = (of(1.0 + 1e-6).damage - of(1.0 - 1e-6).damage) / 2e-6
    assert float(np.vdot(of(1.0).by_membrane, m)) == pytest.approx(difference, rel=0.01)


def test_fields_of_a_count_without_vertices_are_as_before() -> None:
    """``samples`` is the default of a record."""
    q = np.random.default_rng(3).normal(size=(2, 100))
    block, _ = block_of(q.reshape(2, 1, 100))
    rule = CycleRule(LAWS["straight"], uses_bending_ratio=True)
    plain, explicit = (count_rows(block, CountedRecord(q, "half", vertex=v), rule) for v in (False, False))
    for name in BlockCount.__slots__:
        np.testing.assert_array_equal(getattr(plain, name), getattr(explicit, name))
    assert not CountedRecord(q, "half").vertex
