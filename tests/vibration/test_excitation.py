"""The force on an oscillator is found from its motion; the parts that follow and that swing add up to the motion."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatigue.vibration.excitation import (
    CUT,
    SHORTEST,
    excitation,
    is_differentiated,
    pass_band,
    quasi_static,
    split,
)
from tests.vibration.oscillator import FINER, band_limited_noise, response

STEP, SAMPLES = 0.005, 4000
TIME = STEP / FINER * np.arange(SAMPLES * FINER)
RNG = np.random.default_rng(5)
FORCES = {
    "noise": 80.0 * band_limited_noise(len(TIME), STEP / FINER, 30.0),
    "hunting": 60.0 * np.sin(2.0 * np.pi * 9.2 * TIME),
    "lines": sum(100.0 * np.sin(2.0 * np.pi * f * TIME + f * f) for f in (1.1, 3.3, 9.2, 14.7, 22.1)),
    "slow with hunting": 300.0 * np.sin(0.8 * TIME + 1.0) + 50.0 * np.sin(2.0 * np.pi * 9.2 * TIME) + 500.0,
}


def simulated(force, hz, zeta, dtype=np.float64, start_s=1.0):
    """Coordinate (1, t) of an oscillator and the force on it, at the samples of the record from ``start_s`` on."""
    kept = slice(round(start_s / STEP) * FINER, None, FINER)
    return response(FORCES[force], STEP / FINER, hz, zeta)[None, kept].astype(dtype), FORCES[force][kept]


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
@pytest.mark.parametrize(("hz", "zeta"), [(8.07, 0.015), (9.2, 0.015), (22.66, 0.02), (2.0, 0.01), (9.2, 0.2)])
@pytest.mark.parametrize("force", list(FORCES))
def test_the_force_on_an_oscillator_is_recovered(force, hz, zeta, dtype):
    """Everywhere to 1 % of its rms, the ends of the record included, and to 0.1 % inside."""
    q, f = simulated(force, hz, zeta, dtype)
    error = excitation(q, STEP, np.array([hz]), np.array([zeta]))[0] - f
    inside = slice(SAMPLES // 20, -SAMPLES // 20)
    assert error.std() < 0.01 * f.std()
    assert error[inside].std() < 1e-3 * f.std()
    assert abs(error.mean()) < 0.01 * f.std()


def test_a_force_switched_on_is_only_missed_at_first():
    """A record that begins with the jump of the force: 1 % within a tenth of a second, less further on."""
    q, f = simulated("slow with hunting", 9.2, 0.015, start_s=0.0)
    error = excitation(q, STEP, np.array([9.2]), np.array([0.015]))[0] - f
    assert np.abs(error[20:-20]).max() < 0.01 * f.std()


def test_the_wrong_damping_only_counts_in_resonance():
    """Without damping the excitation of a load off resonance is the same; in resonance it is lost."""
    for hz, most, least in ((22.66, 0.02, 0.0), (9.2, 1.1, 0.9)):
        q, f = simulated("hunting", hz, 0.015)
        settled = slice(SAMPLES // 2, -SAMPLES // 20)
        error = (excitation(q, STEP, np.array([hz]), np.zeros(1))[0] - f)[settled].std() / f.std()
        assert least <= error < most


@pytest.mark.parametrize("r", [0.1, 0.5, 0.9, 1.0, 1.3, 2.5])
@pytest.mark.parametrize("zeta", [0.0, 0.015, 0.1])
def test_the_parts_of_a_sine(r, zeta):
    """q_qs = (1 - r^2 + 2 i zeta r) q and q_dyn = (r^2 - 2 i zeta r) q, by amplitude and phase."""
    hz, t = 9.2, STEP * np.arange(SAMPLES)
    q = np.exp(2j * np.pi * r * hz * t)
    found = [split(part[None], STEP, np.array([hz]), np.array([zeta])) for part in (q.real, q.imag)]
    follows = found[0].quasi_static[0] + 1j * found[1].quasi_static[0]
    swings = found[0].dynamic[0] + 1j * found[1].dynamic[0]
    inside = slice(SAMPLES // 20, -SAMPLES // 20)
    assert follows[inside] == pytest.approx((1.0 - r**2 + 2j * zeta * r) * q[inside], abs=1e-3 * (1.0 + r**2))
    assert swings[inside] == pytest.approx((r**2 - 2j * zeta * r) * q[inside], abs=1e-3 * (1.0 + r**2))


def test_the_dynamic_part_is_inertia_and_damping():
    """q_dyn = -(q'' + 2 zeta w q') / w^2, with the derivatives of a known motion."""
    hz, zeta, t = np.array([7.0, 11.0]), np.array([0.015, 0.05]), STEP * np.arange(SAMPLES)
    w, a = 2.0 * np.pi * hz[:, None], 2.0 * np.pi * np.array([[0.7, 3.1, 6.6, 13.0]]).T
    phase = np.array([[0.1, 1.2, 2.3, 3.4]]).T
    q = np.sum(np.sin(a * t + phase), axis=0) * np.ones((2, 1)) + 4.0
    speed = np.sum(a * np.cos(a * t + phase), axis=0)
    acceleration = -np.sum(a**2 * np.sin(a * t + phase), axis=0)
    expected = -(acceleration + 2.0 * zeta[:, None] * w * speed) / w**2
    inside = slice(SAMPLES // 20, -SAMPLES // 20)
    swings = split(q, STEP, hz, zeta).dynamic
    assert swings[:, inside] == pytest.approx(expected[:, inside], abs=2e-3 * np.abs(expected).max())


def test_a_constant_is_followed():
    """A mode under a constant load does not swing, whatever its frequency."""
    q = np.full((2, 500), -16.376)
    found = split(q, STEP, np.array([0.3, 12.0]), np.array([0.015, 0.0]))
    assert found.quasi_static == pytest.approx(q, abs=1e-12)


def test_a_mode_beyond_the_record_follows():
    """Above 0.4 of the sampling rate nothing is differentiated: the coordinate itself, to the last bit."""
    q = RNG.standard_normal((3, 500))
    hz = np.array([12.0, 0.41 / STEP, 3.0 / STEP])
    assert is_differentiated(hz, STEP).tolist() == [True, False, False]
    found = split(q, STEP, hz, np.full(3, 0.02))
    assert np.array_equal(found.quasi_static[1:], q[1:])
    assert not found.dynamic[1:].any()
    assert found.dynamic[0].std() > 1.0
    assert excitation(q, STEP, hz, np.full(3, 0.02))[2] == pytest.approx((6.0 * np.pi / STEP) ** 2 * q[2], rel=1e-14)


def test_what_is_above_the_cut_is_not_excitation():
    """A line above 0.45 of the sampling rate stays in the coordinate and in its dynamic part."""
    t = STEP * np.arange(2000)
    slow, fast = np.sin(2.0 * np.pi * 3.0 * t), 0.1 * np.sin(2.0 * np.pi * 0.47 / STEP * t)
    hz, zeta = np.array([9.0]), np.array([0.02])
    clean, noisy = (quasi_static(q[None], STEP, hz, zeta)[0] for q in (slow, slow + fast))
    assert noisy[100:-100] == pytest.approx(clean[100:-100], abs=2e-2)
    assert pass_band(np.array([0.0, CUT / STEP, 0.45 / STEP, 0.5 / STEP]), STEP) == pytest.approx([1, 1, 0, 0])


@pytest.mark.parametrize(
    ("samples", "hz", "said"),
    [
        (SHORTEST - 1, 5.0, "too few"),
        (500, 0.0, "without natural"),
        (500, -1.0, "without natural"),
        (500, np.nan, "without natural"),
    ],
)
def test_what_cannot_be_differentiated_is_refused(samples, hz, said):
    """A record that is too short, a mode without frequency."""
    with pytest.raises(ValueError, match=said):
        quasi_static(np.zeros((1, samples)), STEP, np.array([hz]), np.zeros(1))


MODES = st.tuples(st.floats(0.3, 200.0), st.floats(0.0, 0.5))


@given(MODES, st.integers(SHORTEST, 800), st.integers(0, 10_000), st.sampled_from([np.float32, np.float64]))
def test_the_parts_add_up(mode, samples, seed, dtype):
    """q_qs + q_dyn = q to 1e-12 of the largest part, whatever the record and the mode."""
    q = np.random.default_rng(seed).standard_normal((1, samples)).cumsum(axis=1).astype(dtype)
    found = split(q, STEP, np.array([mode[0]]), np.array([mode[1]]))
    size = max(np.abs(found.quasi_static).max(), np.abs(q).max())
    assert np.abs(found.quasi_static + found.dynamic - q).max() <= 1e-12 * size


@given(MODES, st.integers(0, 10_000), st.sampled_from([-1e3, -1.0, 1e-6, 7.3]), st.floats(-100.0, 100.0))
def test_scaled_and_lifted(mode, seed, factor, lift):
    """The excitation of a scaled record is scaled, that of a lifted one is lifted by w^2 times as much."""
    hz, zeta = np.array([mode[0]]), np.array([mode[1]])
    q = np.random.default_rng(seed).standard_normal((1, 300))
    one = quasi_static(q, STEP, hz, zeta)
    size = np.abs(one).max()
    assert quasi_static(factor * q, STEP, hz, zeta) == pytest.approx(factor * one, abs=1e-9 * abs(factor) * size)
    assert quasi_static(q + lift, STEP, hz, zeta) == pytest.approx(one + lift, abs=1e-9 * (size + abs(lift)))


@given(MODES, st.integers(0, 10_000))
def test_linear_and_backwards(mode, seed):
    """Away from the ends the excitation of a sum is the sum; undamped, the reversed record has the reversed one."""
    hz, zeta = np.array([mode[0]]), np.array([mode[1]])
    x, y = (band_limited_noise(1200, STEP, 40.0, seed + i)[None] for i in (0, 1))
    inside = slice(200, -200)
    a, b, both = (quasi_static(q, STEP, hz, zeta)[:, inside] for q in (x, y, x + y))
    assert both == pytest.approx(a + b, abs=0.01 * np.abs(both).max())
    there, back = (quasi_static(q, STEP, hz, np.zeros(1)) for q in (x, x[:, ::-1]))
    assert back[:, ::-1] == pytest.approx(there, abs=1e-8 * np.abs(there).max())  # rounding at the ends
