"""Ranges of stresses in single precision are above a limit where they are in double precision, whatever their size."""

import numpy as np
import pytest

from fatigue.pipeline.multiaxial.histories import ranges


@pytest.mark.parametrize("of_stress", [1e-40, 1e-25, 1.0, 1e25, 1e45])
@pytest.mark.parametrize("of_record", [1e-60, 1e-25, 1.0, 1e25, 1e45])
def test_single_precision_decides_as_double_precision_does(of_stress, of_record):
    """Limits a little and far above and below the range, of very small stresses and of very large ones."""
    rng = np.random.default_rng(2)
    weights, q = of_stress * rng.normal(size=(60, 4)), of_record * rng.normal(size=(4, 300))
    exact = np.ptp(weights @ q, axis=1)
    limit = exact * rng.choice([0.01, 0.6, 1.0 - 1e-6, 1.0 + 1e-6, 1.5, 100.0], 60)
    assert np.array_equal(ranges(weights, q, limit) > limit, exact > limit)


def test_a_range_about_a_large_mean_is_found():
    """Single precision loses a range that is a ten-millionth of the stress."""
    q = 1e8 + np.random.default_rng(3).normal(size=(1, 200))
    exact = np.ptp(q, axis=1)
    for factor in (0.99, 1.01):
        assert (ranges(np.ones((1, 1)), q, factor * exact) > factor * exact) == (factor < 1.0)
