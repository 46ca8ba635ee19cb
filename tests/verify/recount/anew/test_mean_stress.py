"""The second f_M: known values, and none where rounding takes the range of a cycle."""

import numpy as np
import pytest

from fatigue.verify.recount.anew.mean_stress import MeanStress


def test_a_cycle_whose_range_is_lost_about_its_mean_has_no_factor():
    """Equal stresses are no cycle, whose factor would be 0; beside them a known one."""
    low, high = np.array([300.0, 100.0, 1e12]), np.array([300.0, 200.0, 1e12])
    assert MeanStress(250.0, counts=True).factor(low, high) == pytest.approx([1.0, 0.824861, 1.0], abs=1e-6)
