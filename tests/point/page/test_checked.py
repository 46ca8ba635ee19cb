"""What counts as a difference from the result: relative, but for what is rounding beside its kind."""

import numpy as np
import pandas as pd
import pytest

from fatigue.point.page.checked import _largest

STORED = pd.Series({"max_range_MPa": 50.0, "mean_stress_MPa": 1e-14, "damage_per_km": 2e-9, "life_km": 5e8})


@pytest.mark.parametrize(
    ("changed", "difference"),
    [
        ({}, 0.0),
        ({"mean_stress_MPa": -1e-14}, 4e-13),  # rounding of a mean, beside a thousandth of the range
        ({"max_range_MPa": 50.005}, 1e-4),
        ({"damage_per_km": 2.02e-9}, 0.02 / 2.02),
        ({"life_km": np.inf}, np.inf),
    ],
)
def test_relative_differences(changed, difference):
    """Of the number that differs most."""
    now = pd.Series(STORED.to_dict() | changed)
    assert _largest(now, STORED) == pytest.approx(difference, rel=1e-3)


def test_what_the_result_does_not_have_is_not_compared():
    """A life without end treatment that screening left out; an infinite life that is infinite again."""
    stored = pd.Series({"life_km_raw_end": np.nan, "life_km": np.inf})
    assert _largest(pd.Series({"life_km_raw_end": 3e7, "life_km": np.inf}), stored) == 0.0
    assert _largest(pd.Series({"life_km_raw_end": np.nan}), pd.Series({"life_km_raw_end": 1.0})) != 0.0
