"""Scatter over seeds and ratios between variants, against sums by hand."""

import math

import numpy as np
import pytest

from fatigue.study.quantities import Number, Variant
from fatigue.study.variants.ratios import ratio_rows
from fatigue.study.variants.scatter import scatter_rows

BASE, OTHER = Variant("base", {"fe": 9.2}), Variant("fe=14", {"fe": 14.0})


def numbers(variant, quantity, values, weld="", reason=""):
    """Numbers of one variant under the seeds 1, 2, ..."""
    return [Number(variant, seed, quantity, weld, value, "km", reason) for seed, value in enumerate(values, 1)]


def test_scatter():
    """Mean and standard deviation as numpy has them; of lives those of the logarithm."""
    rms, life = [1.0, 2.0, 4.0], [1e5, 2e5, 8e5]
    rows = scatter_rows([*numbers("base", "rms", rms), *numbers("base", "life_km", life, "A")])
    assert (rows[0].mean, rows[0].sd) == pytest.approx((np.mean(rms), np.std(rms, ddof=1)))
    assert math.isnan(rows[0].sd_log10)
    assert rows[1].mean == pytest.approx(np.exp(np.log(life).mean()))
    assert rows[1].sd_log10 == pytest.approx(np.log10(life).std(ddof=1))
    assert (rows[1].min, rows[1].max, rows[1].n, rows[1].weld) == (1e5, 8e5, 3, "A")


def test_one_seed_has_no_scatter():
    """And its mean is itself."""
    (row,) = scatter_rows(numbers("base", "life_km", [3e5]))
    assert row.mean == pytest.approx(3e5)
    assert math.isnan(row.sd)
    assert math.isnan(row.sd_log10)


def test_numbers_without_part():
    """Infinite lives and empty numbers are left out, and counted."""
    rows = scatter_rows(
        [*numbers("base", "life_km", [1e5, math.inf]), *numbers("base", "x", [math.nan, 2.0], reason="why")]
    )
    assert (rows[0].n, rows[0].mean) == (1, pytest.approx(1e5))
    assert rows[0].reason == "1 of 2 seeds have no part: it is infinite"
    assert (rows[1].n, rows[1].reason) == (1, "1 of 2 seeds have no part: why")


def test_ratios_are_taken_seed_by_seed():
    """Geometric of lives; the seeds on either side of 1 are named."""
    found = ratio_rows(
        [BASE, OTHER],
        [
            *numbers("base", "life_km", [1e5, 2e5, 4e5]),
            *numbers("base", "rms", [1.0, 2.0, 4.0]),
            *numbers("fe=14", "life_km", [2e5, 1e5, 1.6e6]),
            *numbers("fe=14", "rms", [2.0, 1.0, 4.0]),
        ],
    )
    life, rms = found
    assert life.ratio == pytest.approx((2.0 * 0.5 * 4.0) ** (1 / 3))
    assert (life.seeds_above, life.seeds_below, life.agree, life.changed) == ("1, 3", "2", 2, "fe=14 / 9.2")
    assert rms.ratio == pytest.approx((2.0 + 0.5 + 1.0) / 3)
    assert (rms.seeds_above, rms.seeds_below, rms.agree) == ("1", "2", 1)
    assert (rms.min, rms.max, rms.n) == (0.5, 2.0, 3)


def test_ratios_that_cannot_be_had():
    """Each has a reason: an empty number, an infinite life, nothing to divide by, a quantity of one variant only."""
    base = [*numbers("base", "x", [0.0]), *numbers("base", "life_km", [math.inf])]
    base += [*numbers("base", "y", [math.nan], reason="the run failed"), *numbers("base", "z", [1.0])]
    other = [n for quantity in ("x", "life_km", "y", "u") for n in numbers("fe=14", quantity, [1.0])]
    reasons = {row.quantity: row.reason for row in ratio_rows([BASE, OTHER], base + other)}
    assert reasons == {
        "x": "seed 1: it would be divided by 0",
        "life_km": "seed 1: it is infinite",
        "y": "seed 1: the run failed",
        "u": "seed 1: the other variant has no such number",
    }
    assert all(row.n == 0 and math.isnan(row.ratio) for row in ratio_rows([BASE, OTHER], base + other))
