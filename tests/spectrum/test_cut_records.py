"""What becomes of damage when a record is cut, shifted or reversed: the table of the page how-it-works, computed."""

from pathlib import Path

import numpy as np
import pytest

from fatigue.life.counting.rainflow import rainflow
from fatigue.life.records.history import ModalHistory
from fatigue.spectrum.methods import dirlik_damage_rate
from fatigue.spectrum.moments import moment_matrices, point_moments, segment_spectra
from tests.naive_spectrum import modal_spectrum, straight_law
from tests.synthetic_records import RATE, gaussian

K, SEGMENT_S, RECORDS = 3.6, 4.0, 6
LENGTHS = (29, 51, 205)  # s
THEORY = Path(__file__).parents[2] / "docs" / "how-it-works.md"


def counted(x, residue="repeat"):
    """Damage of a record by its cycles, but for a constant."""
    cycles = rainflow(x, residue)
    return float(np.sum(cycles.count * cycles.range**K))


def density(x):
    """Moments of a record by Welch's method as the program has it."""
    history = ModalHistory("e", np.array([1]), x[None], 1 / RATE, 0.0)
    return point_moments(np.ones((1, 1)), moment_matrices(segment_spectra(history, SEGMENT_S, 80.0)))


def dirlik(x):
    """Damage of a record by its spectrum, but for a constant."""
    return float(dirlik_damage_rate(density(x), straight_law(K))[0]) * len(x) / RATE


def evenly(x):
    """The same from segments a quarter apart, round the end of the record: every sample weighs the same."""
    n = round(SEGMENT_S * RATE)
    around, many = np.concatenate([x, x[:n]]), round(4 * len(x) / n)
    segments = [around[start : start + n] for start in np.rint(np.arange(many) * len(x) / many).astype(int)]
    moments = np.mean([density(segment)[:, 0] for segment in segments], axis=0)
    return float(dirlik_damage_rate(moments[:, None], straight_law(K))[0]) * len(x) / RATE


def changes(length):
    """Largest change of each kind in a few records of a length [%]."""
    found = {name: [] for name in ("halves", "shifted", "reversed", "evenly")}
    for seed in range(RECORDS):
        x = gaussian(np.random.default_rng(seed), modal_spectrum(), int(length * RATE))
        half, third, whole = len(x) // 2, np.roll(x, len(x) // 3), dirlik(x)
        found["halves"].append((counted(x[:half]) + counted(x[half:])) / counted(x))
        found["shifted"].append(dirlik(third) / whole)
        found["reversed"].append(dirlik(x[::-1].copy()) / whole)
        found["evenly"].append(evenly(third) / evenly(x))
    return {name: 100 * float(np.abs(np.array(ratios) - 1).max()) for name, ratios in found.items()}


@pytest.mark.parametrize("length", LENGTHS)
def test_numbers_of_the_page(length):
    """The row of each length in the table, to the digits it has."""
    row = next(line for line in THEORY.read_text(encoding="utf-8").splitlines() if line.startswith(f"| {length} s |"))
    *told, below = [float(cell.strip(" %<")) for cell in row.split("|")[2:-1]]
    found = changes(length)
    assert [found[name] for name in ("halves", "shifted", "reversed")] == pytest.approx(told, rel=0.05)
    assert found["evenly"] < below


def test_a_count_that_recurs_does_not_know_where_the_record_begins():
    """Shifted, the record is the same ring of cycles: equal to rounding; reversed, the same ranges."""
    x = gaussian(np.random.default_rng(1), modal_spectrum(), int(29 * RATE))
    whole = counted(x)
    assert counted(np.roll(x, 5000)) == pytest.approx(whole, rel=1e-12)
    assert counted(x[::-1]) == pytest.approx(whole, rel=1e-12)


def test_halves_miss_the_ranges_between_them():
    """What two halves lack is the range from the top of one to the bottom of the other, once; the rest is the same."""
    x = np.array([0.0, 9.0, 1.0, 5.0, 0.0, -9.0, -1.0, -5.0])
    assert sorted(rainflow(x, "repeat").range) == [4.0, 4.0, 18.0]
    assert sorted([*rainflow(x[:4], "repeat").range, *rainflow(x[4:], "repeat").range]) == [4.0, 4.0, 9.0, 9.0]
