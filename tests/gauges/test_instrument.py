"""What a gauge makes of the stress under it: transverse sensitivity, stand-ins, bridges."""

import numpy as np
import pytest

from fatigue.gauges.instrument import bridge, grid_reading, normal_strain, normal_stress, strain_reading


def test_transverse_sensitivity_of_the_oracles():
    """measured_oracles.json, small_element.transverse."""
    assert float(grid_reading(np.array(100.0), np.array(-30.0), 0.01)) == pytest.approx(99.9849571, abs=5e-8)
    assert float(grid_reading(np.array(100.0), np.array(-30.0), 0.0)) == 100.0


def test_on_the_steel_of_its_calibration_a_grid_shows_the_strain_along_it():
    """In uniaxial stress on a material of nu = 0.285 the transverse sensitivity does nothing, as it is calibrated."""
    stress = np.array([100.0, 0.0, 0.0])
    plain = normal_strain(stress, 0.0, 210000.0, 0.285)
    assert float(strain_reading(stress, 0.0, 210000.0, 0.285, 0.03)) == pytest.approx(float(plain), rel=1e-12)


def test_normal_stress_turns_with_the_direction():
    """Uniaxial: cos^2; shear: sin 2 a."""
    assert float(normal_stress(np.array([8.0, 0.0, 0.0]), 30.0)) == pytest.approx(6.0)
    assert float(normal_stress(np.array([0.0, 0.0, 5.0]), -45.0)) == pytest.approx(-5.0)


def test_a_bridge_is_a_weighted_sum_and_knows_its_gauges():
    """Bending is doubled and tension cancelled by two grids on either face."""
    rows = np.array([[10.0, 3.0], [-10.0, 3.0]])  # bending, tension
    assert bridge(rows, ("top", "bottom"), [("top", 1.0), ("bottom", -1.0)]) == pytest.approx([20.0, 0.0])
    with pytest.raises(ValueError, match="no gauge 'side'"):
        bridge(rows, ("top", "bottom"), [("side", 1.0)])
