"""The residue of a pass: against the naive four-point rule, and the same from every counter."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.life.counting.block import BlockStress
from fatigue.life.counting.chunks import count_chunks, count_chunks_and_residue
from fatigue.life.counting.count import count, count_and_residue
from fatigue.life.counting.record import CountedRecord
from fatigue.life.counting.residue import BlockResidue, residue_indices, residue_of_rows
from fatigue.life.counting.rows import count_rows, count_rows_and_residue
from fatigue.life.counting.single.prepare import single_record
from fatigue.life.curves import catalogue, damage_law
from fatigue.life.records.history import Residue
from fatigue.life.rule import CycleRule
from tests import naive
from tests.life.counting.single.test_count import adversarial

LAW = damage_law(catalogue()["master-aluminium"], "mean-2sigma", "none", 1e7)
RULE = CycleRule(LAW, True)
integers = st.lists(st.integers(-4, 4).map(float), min_size=1, max_size=60)


def of(residue: BlockResidue, row: int, surface: int) -> np.ndarray:
    """Membrane and bending stress of one residue, (2, r)."""
    span = slice(residue.first[row, surface], residue.first[row, surface] + residue.length[row, surface])
    return np.stack([residue.membrane[span], residue.bending[span]])


@settings(deadline=None)
@given(integers)
def test_residue_is_what_the_four_point_rule_leaves(values: list[float]) -> None:
    """Ties and plateaus included; a constant signal leaves one point."""
    _, rest = naive.four_point(naive.turning_points(values))
    found = np.array(values)[residue_indices(np.array(values))]
    assert found.tolist() == ([x for _, x in rest] or values[:1])


@settings(deadline=None)
@given(integers)
def test_residue_of_a_residue_is_itself(values: list[float]) -> None:
    """Nothing more closes."""
    once = np.array(values)[residue_indices(np.array(values))]
    assert residue_indices(once).tolist() == list(range(len(once)))


def test_residue_of_nothing_is_nothing() -> None:
    """No samples, no reversals."""
    assert residue_indices(np.empty(0)).size == 0


KINDS = ("ties", "held", "clipped", "growing", "zigzag", "wrapping plateau", "constant", "noise")


def blocks(kind: str, t: int) -> tuple[BlockStress, np.ndarray]:
    """Six points of a kind, membrane and bending of their own."""
    rng = np.random.default_rng(len(kind) + t)
    q = np.array([adversarial(rng, kind, t) for _ in range(8)])
    S_m, S_b = rng.normal(size=(6, 8)), 0.4 * rng.normal(size=(6, 8))
    S_m[0], S_b[0] = np.eye(8)[0], 0.0  # ties stay ties
    S_m[1] = S_b[1] = 0.0
    return BlockStress(S_m, S_b, np.ones(6), np.full((6, 2), 0.2)), q


@pytest.mark.parametrize("residue", ["half", "repeat"])
@pytest.mark.parametrize(
    "kind", ["ties", "held", "clipped", "growing", "zigzag", "wrapping plateau", "constant", "noise"]
)
def test_all_counters_keep_the_same_residue(kind: str, residue: Residue) -> None:
    """Whole rows, chunks of any length, and single precision, which is as good as its count."""
    stress, q = blocks(kind, 1500)
    expected = residue_of_rows(stress.membrane @ q, stress.bending @ q)
    record = CountedRecord(q, residue)
    counted, rows = count_rows_and_residue(stress, record, RULE)
    in_chunks = [count_chunks_and_residue(stress, record, RULE, chunk)[1] for chunk in (37, 700, 8192)]
    single = count_and_residue(stress, CountedRecord(q, residue, single_record(q)), RULE)[1]
    for row, surface in np.ndindex(6, 2):
        exact = of(expected, row, surface)
        assert np.array_equal(of(rows, row, surface), exact)
        scale = np.abs(exact).max(initial=1e-300)
        for other in in_chunks:
            assert of(other, row, surface) == pytest.approx(exact, abs=1e-12 * scale)
        if kind not in ("constant", "clipped"):  # a reversal more or less between stresses equal but for rounding
            assert of(single, row, surface) == pytest.approx(exact, abs=2e-6 * scale), (row, surface)
    assert np.array_equal(counted.damage, count_rows(stress, record, RULE).damage)


def test_counts_beside_a_residue_are_those_without() -> None:
    """Keeping the residue changes nothing in the count: to the last bit in whole rows and in single precision."""
    stress, q = blocks("noise", 3000)
    for record in (CountedRecord(q, "repeat"), CountedRecord(q, "half", single_record(q))):
        assert np.array_equal(count_and_residue(stress, record, RULE)[0].damage, count(stress, record, RULE).damage)
    half = CountedRecord(q, "half")
    kept, plain = count_chunks_and_residue(stress, half, RULE, 500)[0], count_chunks(stress, half, RULE, 500)
    for name in ("damage", "cycles", "max_range", "power_sum"):
        assert getattr(kept, name) == pytest.approx(getattr(plain, name), rel=1e-13)


def test_residues_longer_than_the_room_for_them_are_kept_whole() -> None:
    """A diverging zigzag never closes a cycle: all of its reversals wait, also where single precision has no room."""
    t = 900
    q = (np.arange(t) + 1.0) * (-1.0) ** np.arange(t)
    stress = BlockStress(np.ones((1, 1)), np.zeros((1, 1)), np.ones(1), np.zeros((1, 2)))
    for record in (CountedRecord(q[None], "half", single_record(q[None])), CountedRecord(q[None], "repeat")):
        assert of(count_and_residue(stress, record, RULE)[1], 0, 0)[0] == pytest.approx(q, rel=1e-6)
