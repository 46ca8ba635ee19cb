"""ASTM E1049-85 (2017), figure 6: the worked example of rainflow counting (5.4.4) and of its repeating form (5.4.5)."""

import numpy as np
import pytest

from fatigue.life.counting.rainflow import Cycles, rainflow

FIGURE_6 = np.array([-2, 1, -3, 5, -1, 3, -4, 4, -2])


def spectrum(cycles: Cycles) -> dict[float, float]:
    """Add up the counts of each range."""
    return {float(x): float(cycles.count[cycles.range == x].sum()) for x in np.unique(cycles.range)}


def test_the_ranges_of_figure_6() -> None:
    """Count of each range as printed in the standard."""
    assert spectrum(rainflow(FIGURE_6, "half")) == {3: 0.5, 4: 1.5, 6: 0.5, 8: 1.0, 9: 0.5}


def test_the_cycles_of_figure_6_in_the_order_of_the_standard() -> None:
    """Range, mean, count and the two reversals of every cycle, A-B first, then as the steps of the example go on."""
    cycles = rainflow(FIGURE_6, "half")
    rows = list(zip(cycles.range, cycles.mean, cycles.count, cycles.start, cycles.end, strict=True))
    assert rows == [
        (3, -0.5, 0.5, 0, 1),
        (4, -1.0, 0.5, 1, 2),
        (4, 1.0, 1.0, 4, 5),
        (8, 1.0, 0.5, 2, 3),
        (9, 0.5, 0.5, 3, 6),
        (8, 0.0, 0.5, 6, 7),
        (6, 1.0, 0.5, 7, 8),
    ]


def test_the_repeating_history_closes_every_cycle() -> None:
    """Figure 6 as a block that recurs, 5.4.5: whole cycles only."""
    cycles = rainflow(FIGURE_6, "repeat")
    assert spectrum(cycles) == {3: 1, 4: 1, 7: 1, 9: 1}
    assert set(cycles.count) == {1.0}


@pytest.mark.parametrize(("residue", "expected"), [("half", 1094.0), ("repeat", 1163.0)])
def test_the_cubic_damage_sum(residue: str, expected: float) -> None:
    """Sum of n S^3 of figure 6."""
    cycles = rainflow(FIGURE_6, residue)
    assert np.sum(cycles.count * cycles.range**3) == expected


def test_the_closed_cycles_alone() -> None:
    """The one closed cycle of the example is the range of 4, with n S^3 = 64."""
    cycles = rainflow(FIGURE_6, "half")
    assert np.sum(cycles.range[cycles.count == 1.0] ** 3) == 64
