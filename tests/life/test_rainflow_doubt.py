"""Pairs of samples that single precision cannot tell apart."""

import numpy as np
import pytest
from numpy.typing import NDArray

from fatigue.life import rainflow_doubt
from fatigue.life.rainflow_doubt import directions, list_pairs, settle_pair

FLAT = np.float32(1e-3)
TOP, BOTTOM = 0, 1


def listed(s: list[float], surface: int = TOP) -> NDArray[np.int64]:
    """List the pairs of a row whose stress at one surface is s, in a chunk without a step beyond its last sample."""
    m = np.arange(len(s), dtype=np.float32)
    b = (1 - 2 * surface) * (np.array(s, np.float32) - m)
    pairs = np.zeros((20, 3), np.int64)
    found = list_pairs(m, b, len(s) - 1, len(s) - 1, (7, surface), FLAT, pairs, 1)
    return pairs[1:found]


@pytest.mark.parametrize("surface", [TOP, BOTTOM])
def test_a_pair_between_larger_steps_is_listed(surface: int) -> None:
    """With point and surface, behind what was listed before."""
    assert listed([0, 1, 2, 2.0005, 1, 0, 1, 1.0001, 2], surface).tolist() == [[7, surface, 2], [7, surface, 6]]


@pytest.mark.parametrize(
    "s",
    [
        [0, 1, 2, 2.0005, 2.001, 0],
        [1, 1.0005, 2, 3, 2, 1],
        [0, 1, 2, 1, 3, 3.0005],
        [0, 1, 1.0001] * (rainflow_doubt.MOST + 1) + [0],
    ],
    ids=["three in a row", "at the first sample", "at the last sample", "too many"],
)
def test_none_is_listed_where_one_cannot_be_settled(s: list[float]) -> None:
    """Then the surface is counted again as a whole."""
    assert listed(s).size == 0


@pytest.mark.parametrize(
    ("s", "direction", "winner"),
    [
        ([0, 2, 2, 0], -1, 1),
        ([0, 2, 2, 0], 1, 2),
        ([0, 2, 2, 0], 0, 2),
        ([2, 0, 0, 2], 1, 1),
        ([2, 0, 0, 2], -1, 2),
        ([2, 0, 0, 2], 0, 2),
    ],
    ids=["peak first", "peak second", "level peak", "valley first", "valley second", "level valley"],
)
def test_both_samples_become_the_one_that_is_the_extreme(s: list[float], direction: int, winner: int) -> None:
    """Of a level pair the last one, as of every plateau."""
    m = np.array([0, 10, 20, 30], np.float32)
    b = np.array(s, np.float32) - m
    kept = m[winner], b[winner]
    assert settle_pair(m, b, np.float32(1), 1, direction)
    assert (m[1], b[1]) == (m[2], b[2]) == kept


def test_a_turn_in_the_middle_of_a_rise_is_not_settled() -> None:
    """In double precision there is a tiny cycle, which has to be counted."""
    for direction, settled in ((1, True), (0, True), (-1, False)):
        m, b = np.array([0, 1, 1, 2], np.float32), np.zeros(4, np.float32)
        assert settle_pair(m, b, np.float32(1), 1, direction) == settled


def test_directions_are_those_of_double_precision() -> None:
    """Steps of 1e-12 of the stress, at both surfaces, of coordinates over powers of 2."""
    rng = np.random.default_rng(0)
    membrane, bending, scale = rng.normal(size=(5, 4)), rng.normal(size=(5, 4)), np.array([1.0, 2.0, 0.5, 4.0])
    q = np.repeat(rng.normal(size=(4, 20)), 2, axis=1) * (1 + 1e-12 * rng.normal(size=(4, 40)))
    pairs = np.array([[row, surface, 2 * k + 1] for row in range(5) for surface in (0, 1) for k in range(20)])
    s = np.stack([membrane + bending, membrane - bending], axis=1) / scale @ q
    row, surface, sample = pairs.T
    expected = np.sign(s[row, surface, sample] - s[row, surface, sample - 1])
    np.testing.assert_array_equal(directions(membrane, bending, q, scale, pairs), expected)
