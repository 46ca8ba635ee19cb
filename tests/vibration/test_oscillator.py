"""The receptance of a mode of modal mass 1, and its reciprocal."""

import numpy as np
import pytest

from fatigue.vibration.oscillator import dynamic_stiffness, memory_s, receptance


def test_static_resonant_and_high_limits() -> None:
    """1 / w_i^2 at rest, 1 / (2 z w_i^2) with 90 degrees lag in resonance, -1 / w^2 far above."""
    w_i = 2.0 * np.pi * 9.2
    H = receptance([0.0, 9.2, 9.2e4], 9.2, 0.015)
    assert H[0] == pytest.approx(1.0 / w_i**2, rel=1e-14)
    assert H[1] == pytest.approx(-1j / (2.0 * 0.015 * w_i**2), rel=1e-12)
    assert H[2] == pytest.approx(-1.0 / (2.0 * np.pi * 9.2e4) ** 2, rel=1e-6)


def test_inverse_is_the_equation_of_motion() -> None:
    """The receptance of e^(iwt) solves q'' + 2 z w_i q' + w_i^2 q = f."""
    f, f_i, z = np.array([0.3, 4.0, 11.0, 60.0]), 11.7, 0.05
    w, w_i = 2.0 * np.pi * f, 2.0 * np.pi * f_i
    q = receptance(f, f_i, z)
    np.testing.assert_allclose((1j * w) ** 2 * q + 2.0 * z * w_i * 1j * w * q + w_i**2 * q, 1.0, rtol=1e-12)


def test_dynamic_stiffness_and_receptance() -> None:
    """H^-1 at 0 Hz is w_k^2, at w_k it is 2 i zeta w_k^2; H is its reciprocal, also of many modes at once."""
    w2 = (2.0 * np.pi * 9.2) ** 2
    at = dynamic_stiffness(np.array([0.0, 9.2, 18.4]), 9.2, 0.05)
    assert at / w2 == pytest.approx([1.0, 0.1j, -3.0 + 0.2j])
    assert receptance(np.array([0.0, 9.2]), 9.2, 0.05) * w2 == pytest.approx([1.0, -10.0j])
    many = dynamic_stiffness(np.array([1.0, 2.0]), np.array([[8.0], [9.0]]), np.array([[0.01], [0.02]]))
    assert many[1] == pytest.approx(dynamic_stiffness(np.array([1.0, 2.0]), 9.0, 0.02))


def test_memory() -> None:
    """A free oscillation of 1 Hz and 1 / (2 pi) damping decays by e in one second, an undamped one never."""
    assert memory_s(1.0, 0.5 / np.pi) == pytest.approx(1.0)
    assert memory_s(9.2, 0.0) == np.inf
