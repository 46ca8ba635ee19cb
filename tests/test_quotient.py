"""Division where the divisor may be nothing."""

import numpy as np

from fatigue.quotient import quotient


def test_nothing_to_divide_by_is_nan():
    """Zero, negative by rounding and NaN divisors give NaN; the others divide; a number stands for all."""
    found = quotient(np.array([1.0, 1.0, 1.0, 3.0]), np.array([0.0, -1e-300, np.nan, 2.0]))
    assert np.isnan(found[:3]).all()
    assert found[3] == 1.5
    assert quotient(1.0, np.array([4.0])).tolist() == [0.25]
