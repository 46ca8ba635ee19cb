"""Damage under factors on all stresses and on dS, against a count of the scaled stress for each of them."""

from dataclasses import replace

import numpy as np
import pytest

from fatigue.life.counting.block import BlockStress
from fatigue.life.counting.chunks import count_chunks, try_chunks
from fatigue.life.counting.count import count_at_factors
from fatigue.life.counting.factors import trials
from fatigue.life.counting.record import CountedRecord
from fatigue.life.counting.rows import count_rows
from fatigue.life.curves import DamageLaw, catalogue, damage_law, user_curve
from fatigue.life.rule import CycleRule

ALUMINIUM = catalogue()["master-aluminium"]
LAWS = {
    "straight": damage_law(ALUMINIUM, None, "none", 1e7),
    "haibach": damage_law(ALUMINIUM, None, "haibach", 1e7),
    "cutoff": damage_law(ALUMINIUM, None, "cutoff", 1e7),
    "three slopes and a cut-off": damage_law(
        user_curve("own", (3.0, 5.0, 9.0), (1e6, 1e7, 1e8), 25.0, "dS", "test"), None, "none", 1e7
    ),
}
FACTORS = 40


def a_block(seed: int) -> tuple[BlockStress, np.ndarray]:
    """Three points of two modes, one of them in tension, one at rest; 300 samples."""
    rng = np.random.default_rng(seed)
    q = np.concatenate([rng.standard_normal((2, 300)), np.ones((1, 300))])
    membrane = np.array([[20.0, 5.0, 0.0], [15.0, -9.0, 90.0], [0.0, 0.0, 0.0]])
    bending = np.array([[5.0, -3.0, 0.0], [-6.0, 2.0, 20.0], [0.0, 0.0, 0.0]])
    return BlockStress(membrane, bending, np.array([1.3, 1.5, 1.0]), np.full((3, 2), 0.2)), q


@pytest.mark.parametrize("residue", ["repeat", "half"])
@pytest.mark.parametrize("mean_stress", [False, True])
@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS.keys())
def test_every_factor_is_a_count_of_the_scaled_stress(law: DamageLaw, mean_stress: bool, residue: str) -> None:
    """Both faces, factors of their own; f_M begins and ends within the factors; what is not wanted stays 0."""
    rule = CycleRule(law, True, 250.0, mean_stress)
    block, q = a_block(1)
    record = CountedRecord(q, residue)
    first, step = np.array([[0.3, 0.5], [0.2, 0.0], [1.0, 1.0]]), np.array([[0.1, 0.05], [0.08, 0.0], [0.1, 0.1]])
    found = count_at_factors(block, record, rule, first, step, FACTORS)
    in_chunks = trials(first, step, FACTORS)
    try_chunks(block, record, rule, in_chunks, chunk=37)
    np.testing.assert_allclose(in_chunks.damage, found, rtol=1e-12)
    for i in range(0, FACTORS, 3):
        for row in range(3):
            for face in range(2):
                f = first[row, face] * np.exp(i * step[row, face])
                scaled = BlockStress(f * block.membrane, f * block.bending, block.size, block.same_ratio)
                for counter in (count_rows, count_chunks):
                    expected = counter(scaled, record, rule).damage[row, face] if f > 0.0 else 0.0
                    assert found[row, face, i] == pytest.approx(expected, rel=1e-11)
    assert (found[0] > 0.0).any()
    assert not found[2].any()
    assert not found[1, 1].any()


@pytest.mark.parametrize("mean_stress", [False, True])
@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS.keys())
def test_a_shear_factor_is_on_the_equivalent_range(law: DamageLaw, mean_stress: bool) -> None:
    """As a size factor would be; f_M, of the normal stress, stays. A straight law needs no sum of its own."""
    rule = CycleRule(law, True, 150.0, mean_stress)
    block, q = a_block(2)
    record, factor = CountedRecord(q, "repeat"), np.array([1.3, 1.1, 1.0])
    with_shear = replace(block, shear_factor=np.repeat(factor[:, None], 2, axis=1))
    expected = count_rows(replace(block, size=factor * block.size), record, rule).damage
    for counter in (count_rows, count_chunks):
        found = counter(with_shear, record, rule)
        np.testing.assert_array_equal(found.damage, counter(block, record, rule).damage)
        np.testing.assert_allclose(found.damage_with_shear, 0.0 if law.is_straight else expected, rtol=1e-12)
