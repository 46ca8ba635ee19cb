"""A constant stress beside the samples: no bit of a range changes, and means, stress ratios and f_M are those of both.

Closed forms for the history of six samples, and any history, offset and counter against counting the sum of both.
"""

from collections.abc import Callable
from dataclasses import fields, replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from fatigue.life.counting.block import BlockCount, BlockStress
from fatigue.life.counting.chunks import count_chunks, try_chunks
from fatigue.life.counting.count import count_at_factors
from fatigue.life.counting.factors import trials
from fatigue.life.counting.record import CountedRecord
from fatigue.life.counting.rows import count_rows
from fatigue.life.counting.single.count import count_single
from fatigue.life.counting.single.prepare import single_record
from fatigue.life.curves import DamageLaw, catalogue, damage_law
from fatigue.life.records.history import Residue
from fatigue.life.records.spool import create_spool
from fatigue.life.rule import CycleRule

Floats = NDArray[np.float64]
Counter = Callable[[BlockStress, CountedRecord, CycleRule], BlockCount]

ALUMINIUM = catalogue()["master-aluminium"]
STRAIGHT = damage_law(ALUMINIUM, "mean-2sigma", "none", 1e7)
HAIBACH = damage_law(ALUMINIUM, "mean-2sigma", "haibach", 1e7)
SIX = np.array([0.0, 20.0, -20.0, 15.0, -10.0, 0.0])
LEVELS = ("mean", "r_largest", "damage_mean_stress")  # all else is of ranges
COUNTERS: dict[str, Counter] = {
    "rows": count_rows,
    "chunks": count_chunks,
    "short chunks": lambda stress, record, rule: count_chunks(stress, record, rule, 700),
    "single precision": count_single,
}
OFFSETS = st.sampled_from([0.0, 50.0, -110.0, 1e-9, 3e5, -7.3e8]) | st.floats(-1e6, 1e6)


def record_of(q: NDArray[np.floating], residue: Residue) -> CountedRecord:
    """A record that every counter can count."""
    return CountedRecord(q, residue, single_record(q))


def a_block(seed: int, samples: int = 1500) -> tuple[BlockStress, Floats]:
    """Five points under three modes, smooth and noisy, one of them at rest; the third mode has a mean of 4."""
    rng = np.random.default_rng(seed)
    q = rng.standard_normal((3, samples))
    q[0] = np.convolve(q[0], np.ones(9) / 3.0, "same")
    q[2] += 4.0
    S_m, S_b = rng.normal(0.0, 20.0, (5, 3)), rng.normal(0.0, 8.0, (5, 3))
    S_m[4] = S_b[4] = 0.0
    return BlockStress(S_m, S_b, np.full(5, 1.36), np.full((5, 2), 0.3)), q


def assert_same_bits(found: BlockCount, expected: BlockCount, but: tuple[str, ...] = LEVELS) -> None:
    """Every field but some has the same bits."""
    for name in sorted({field.name for field in fields(BlockCount)} - set(but)):
        assert getattr(found, name).tobytes() == getattr(expected, name).tobytes(), name


@pytest.mark.parametrize(
    ("offset", "R", "with_f_M"),
    [
        (0.0, -1.0, 7.61030736812631e-07),
        (50.0, 0.42857142857142855, 7.61030736812631e-07),
        (110.0, 0.6923076923076923, 2.687871564822062e-06),
    ],
)
@pytest.mark.parametrize("counter", [count_rows, count_chunks])
def test_six_samples_under_an_offset(counter: Counter, offset: float, R: float, with_f_M: float) -> None:
    """Pure membrane of 4 mm, yield stress 180 MPa: the range stays, R and the factor of the mean stress follow."""
    size = np.array([4.0 ** (1.6 / 7.2)])
    stress = BlockStress(np.ones((1, 1)), np.zeros((1, 1)), size, np.zeros((1, 2)), offset=np.full((1, 2), offset))
    for counts_it in (False, True):
        found = counter(stress, CountedRecord(SIX[None], "repeat"), CycleRule(STRAIGHT, True, 180.0, counts_it))
        expected = with_f_M if counts_it else 7.61030736812631e-07
        np.testing.assert_allclose(found.damage, expected, rtol=1e-9)
        np.testing.assert_allclose(found.damage_mean_stress, with_f_M, rtol=1e-9)
        np.testing.assert_allclose(found.r_largest, R, rtol=1e-14)
        np.testing.assert_allclose(found.mean, offset + 5.0 / 6.0, rtol=1e-14)
        np.testing.assert_array_equal(found.max_range, 40.0)
        np.testing.assert_array_equal(found.cycles, 2.0)


@given(
    seed=st.integers(0, 50),
    offset=st.lists(OFFSETS, min_size=10, max_size=10),
    single=st.booleans(),
    law=st.sampled_from([STRAIGHT, HAIBACH]),
    residue=st.sampled_from(["repeat", "half"]),
    yield_MPa=st.sampled_from([None, 120.0]),
)
@settings(max_examples=25, deadline=None)
@pytest.mark.parametrize("counter", COUNTERS)
def test_no_bit_of_a_range_changes(
    counter: str,
    seed: int,
    offset: list[float],
    single: bool,
    law: DamageLaw,
    residue: Residue,
    yield_MPa: float | None,
) -> None:
    """Any offset, one for each face, under any counter, samples in single or double precision; means move by it."""
    stress, q = a_block(seed)
    record = record_of(q.astype(np.float32) if single else q, residue)
    law = STRAIGHT if counter == "single precision" else law
    rule, of_faces = CycleRule(law, True, yield_MPa), np.reshape(offset, (5, 2))
    without = COUNTERS[counter](stress, record, rule)
    found = COUNTERS[counter](replace(stress, offset=of_faces), record, rule)
    assert_same_bits(found, without)
    np.testing.assert_array_equal(found.mean, without.mean + of_faces)
    if yield_MPa is not None:
        assert (found.damage_mean_stress >= found.damage * (1.0 - 1e-9)).all()


@given(seed=st.integers(0, 50), offset=st.lists(st.floats(-300.0, 300.0), min_size=10, max_size=10))
@settings(max_examples=25, deadline=None)
@pytest.mark.parametrize("counter", COUNTERS)
@pytest.mark.parametrize("counts_it", [False, True])
def test_levels_are_those_of_the_sum(counter: str, counts_it: bool, seed: int, offset: list[float]) -> None:
    """Mean, R and damage with f_M against samples that hold the offset of their face, face by face."""
    stress, q = a_block(seed)
    rule, of_faces = CycleRule(STRAIGHT, True, 150.0, counts_it), np.reshape(offset, (5, 2))
    found = COUNTERS[counter](replace(stress, offset=of_faces), record_of(q, "repeat"), rule)
    for face in range(2):
        held = BlockStress(
            np.column_stack([stress.membrane, of_faces[:, face]]),
            np.column_stack([stress.bending, np.zeros(5)]),
            stress.size,
            stress.same_ratio,
        )
        expected = count_rows(held, CountedRecord(np.vstack([q, np.ones(q.shape[1])]), "repeat"), rule)
        for name in ("mean", "damage", "damage_mean_stress", "max_range"):
            a, b = getattr(found, name)[:, face], getattr(expected, name)[:, face]
            np.testing.assert_allclose(a, b, rtol=2e-6, atol=1e-9 if name == "mean" else 0.0, err_msg=name)
        highest = np.abs(of_faces[:4, face]) + expected.max_range[:4, face]
        ratio = found.r_largest[:4, face] - expected.r_largest[:4, face]
        assert (np.abs(ratio) <= 2e-5 * (1.0 + expected.r_largest[:4, face] ** 2) * (1.0 + highest)).all()


def test_a_record_on_disk_is_counted_with_its_offset(tmp_path: Path) -> None:
    """As one in memory; what is put behind other points brings its own offset, or none."""
    stress, q = a_block(3)
    spool = create_spool(tmp_path / "q", q.shape, np.dtype(np.float32))
    spool[:, 0 : q.shape[1]] = q.astype(np.float32)
    rule = CycleRule(HAIBACH, True, 100.0)
    offset = np.linspace(-80.0, 90.0, 10).reshape(5, 2)
    found = count_chunks(replace(stress, offset=offset), CountedRecord(spool, "half"), rule)
    expected = count_rows(replace(stress, offset=offset), CountedRecord(q.astype(np.float32), "half"), rule)
    np.testing.assert_allclose(found.damage_mean_stress, expected.damage_mean_stress, rtol=1e-12)
    np.testing.assert_allclose(found.r_largest, expected.r_largest, rtol=1e-12)
    both = stress.beside(replace(stress, offset=offset))
    np.testing.assert_array_equal(both.level, np.vstack([np.zeros((5, 2)), offset]))
    together = count_rows(both, CountedRecord(q, "half"), rule)
    alone = count_rows(stress, CountedRecord(q, "half"), rule)
    assert_same_bits(together.at(slice(5)), alone, but=())
    np.testing.assert_array_equal(together.mean[5:], alone.mean + offset)


@pytest.mark.parametrize("law", [STRAIGHT, HAIBACH], ids=["straight", "haibach"])
def test_a_factor_is_on_the_offset_too(law: DamageLaw) -> None:
    """Damage at a factor f is that of f times samples and offset, f_M beginning and ending within the factors."""
    rule = CycleRule(law, True, 180.0, True)
    stress, q = a_block(4, samples=300)
    stress = replace(stress, offset=np.linspace(-150.0, 200.0, 10).reshape(5, 2))
    assert stress.offset is not None
    first, step = np.full((5, 2), 0.3), np.full((5, 2), 0.05)
    record = CountedRecord(q, "repeat")
    found = count_at_factors(stress, record, rule, first, step, 30)
    in_chunks = trials(first, step, 30)
    try_chunks(stress, record, rule, in_chunks, chunk=37)
    np.testing.assert_allclose(in_chunks.damage, found, rtol=1e-12)
    for i in range(0, 30, 4):
        f = 0.3 * np.exp(0.05 * i)
        scaled = replace(
            stress, membrane=f * stress.membrane, bending=f * stress.bending, offset=f * np.asarray(stress.offset)
        )
        np.testing.assert_allclose(found[:, :, i], count_rows(scaled, record, rule).damage, rtol=1e-10)
    without = count_at_factors(replace(stress, offset=None), record, rule, first, step, 30)
    assert (found != without).any()
