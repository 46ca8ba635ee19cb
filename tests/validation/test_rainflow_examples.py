"""Sequences with known counts, published as the examples or tests of other rainflow programs."""

import numpy as np
import pytest

from fatigue.life.counting.rainflow import Cycles, rainflow

TEST_CASE_2 = [-1.5, 1, -3, 10, -1, 3, -8, 4, -2, 6, -1, -4, -8, 2, 1, -5, 0, 2.5, -4, 1, 0, 2, -0.5]
WIKIPEDIA = [2, -14, 10, 0, 13, -9, 11, -8, 8, -9, 15, -4, 10, 0, 13, 0]


def spectrum(cycles: Cycles) -> dict[float, float]:
    """Add up the counts of each range."""
    return {float(x): float(cycles.count[cycles.range == x].sum()) for x in np.unique(cycles.range)}


@pytest.mark.parametrize(
    ("sequence", "residue", "expected"),
    [
        pytest.param(
            TEST_CASE_2,
            "half",
            {1: 1, 2.5: 1, 4: 1.5, 6: 1.5, 6.5: 0.5, 7: 1, 10.5: 0.5, 13: 0.5, 14: 1, 18: 0.5},
            id="rainflow, TEST_CASE_2",
        ),
        pytest.param(
            WIKIPEDIA,
            "half",
            {10: 2, 13: 0.5, 16: 1.5, 17: 0.5, 19: 0.5, 20: 1, 22: 1, 29: 0.5},
            id="Wikipedia; fatpack, issue 21",
        ),
        pytest.param(WIKIPEDIA, "repeat", {2: 1, 10: 2, 16: 1, 17: 1, 20: 1, 22: 1, 29: 1}, id="Wikipedia, repeated"),
        pytest.param([2, 5, 3, 7], "half", {2: 1, 5: 0.5}, id="rfcnt, residue as half cycles"),
        pytest.param([2, 5, 3, 7], "repeat", {2: 1, 5: 1}, id="rfcnt, residue repeated"),
    ],
)
def test_counts(sequence: list[float], residue: str, expected: dict[float, float]) -> None:
    """Count of each range."""
    assert spectrum(rainflow(np.array(sequence), residue)) == expected


def test_closed_cycles_and_residue_of_the_pylife_lecture_example() -> None:
    """Three closed cycles, 3-4, 5-3 and 2-6; the residue 1 7 1 2 as half cycles."""
    cycles = rainflow(np.array([1, 7, 4, 3, 4, 2, 5, 3, 6, 1, 2]), "half")
    rows = sorted(zip(cycles.range.tolist(), cycles.mean.tolist(), cycles.count.tolist(), strict=True))
    assert rows == [(1, 1.5, 0.5), (1, 3.5, 1), (2, 4, 1), (4, 4, 1), (6, 4, 0.5), (6, 4, 0.5)]


def test_two_sines() -> None:
    """0.8 sin(0.01 pi i) + 0.2 sin(0.032 pi i), TEST_CASE_3 of the `rainflow` package."""
    i = np.arange(1001)
    cycles = rainflow(0.8 * np.sin(0.01 * np.pi * i) + 0.2 * np.sin(0.032 * np.pi * i), "half")
    largest = cycles.range.argmax()
    assert cycles.range[largest] == pytest.approx(1.9942872896932382, rel=1e-14)
    assert (cycles.start[largest], cycles.end[largest]) == (452, 548)
    whole = np.sort(cycles.range[cycles.count == 1.0])
    np.testing.assert_allclose(whole, [0.0255598505] * 2 + [0.0902063199] * 2, rtol=1e-8)
    binned, _ = np.histogram(cycles.range, bins=np.arange(0, 2.1, 0.2), weights=cycles.count)
    np.testing.assert_array_equal(binned, [4, 0, 0, 1, 0, 0, 0, 0, 2, 2.5])


@pytest.mark.parametrize("direction", [1, -1])
def test_a_growing_or_decaying_zigzag_closes_nothing(direction: int) -> None:
    """25 000 points, the deepest stack there is (pyyeti): amplitudes k + 1/2, means +1/2 and -1/2 in turn."""
    i = np.arange(25_000)
    cycles = rainflow(np.where(i % 2 == 0, -i, i)[::direction], "half")
    k = np.arange(24_999)[::direction]
    np.testing.assert_array_equal(cycles.range / 2, k + 0.5)
    np.testing.assert_array_equal(cycles.mean, np.where(k % 2 == 0, 0.5, -0.5))
    assert set(cycles.count) == {0.5}
