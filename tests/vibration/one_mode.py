"""An oscillator of one mode, simulated exactly under forces that are straight between samples; and one it carries."""

import numpy as np
from scipy.linalg import expm
from scipy.signal import lfilter

from fatigue.life.counting.rainflow import rainflow

STEP = 0.004
BEFORE, KEPT = 20.0, 29.0  # s


def simulated(force, frequency_hz, damping, step=STEP):
    """Displacement per unit modal mass from rest: first-order hold, exact (Franklin, Powell and Workman, ch. 4)."""
    w = 2.0 * np.pi * frequency_hz
    return _response(np.array([[0.0, 1.0], [-(w**2), -2.0 * damping * w]]), np.array([0.0, 1.0]), 0, force, step)


def with_absorber(force, frequency_hz, damping, mass_ratio, absorber_hz, absorber_damping, step=STEP):
    """Displacement of a mode that carries a second oscillator, which takes part of its motion up: two-way coupled."""
    w, wa, za = 2.0 * np.pi * frequency_hz, 2.0 * np.pi * absorber_hz, absorber_damping
    ka, ca = mass_ratio * wa**2, mass_ratio * 2.0 * za * wa  # per unit modal mass of the mode
    A = np.zeros((4, 4))
    A[0, 1] = A[2, 3] = 1.0
    A[1] = [-(w**2) - ka, -2.0 * damping * w - ca, ka, ca]
    A[3] = [wa**2, 2.0 * za * wa, -(wa**2), -2.0 * za * wa]
    return _response(A, np.array([0.0, 1.0, 0.0, 0.0]), 0, force, step)


def _response(A, B, row, force, step):
    """One state under a force that is straight between samples, by the exact step."""
    n = len(A)
    M = np.zeros((n + 2, n + 2))
    M[:n, :n], M[:n, n], M[n, n + 1] = A * step, B * step, 1.0
    E = expm(M)
    Ad, held, ramp = E[:n, :n], E[:n, n], E[:n, n + 1]
    eigenvalues, V = np.linalg.eig(Ad)
    inputs = np.linalg.solve(V, np.stack([held - ramp, ramp], axis=1))  # x+ = Ad x + (held - ramp) u + ramp u+
    x = np.zeros(len(force), dtype=complex)
    for i in range(n):
        driven = inputs[i, 0] * np.append(force[:-1], 0.0)[:-1] + inputs[i, 1] * force[1:]
        x[1:] += V[row, i] * lfilter([1.0], [1.0, -eigenvalues[i]], driven)
    return x.real


def broadband(seed, seconds=BEFORE + KEPT, upper_hz=60.0):
    """Gaussian noise, flat up to a frequency."""
    n = round(seconds / STEP)
    spectrum = np.fft.rfft(np.random.default_rng(seed).standard_normal(n))
    return np.fft.irfft(spectrum * (np.fft.rfftfreq(n, STEP) < upper_hz), n)


def hunting(seed, around_hz=9.2, width_hz=0.3):
    """Noise in a narrow band, as of wheels that hunt."""
    n = round((BEFORE + KEPT) / STEP)
    spectrum = np.fft.rfft(np.random.default_rng(seed).standard_normal(n))
    return np.fft.irfft(spectrum / np.hypot(1.0, (np.fft.rfftfreq(n, STEP) - around_hz) / width_hz), n)


def bursts(seed):
    """Two bursts of noise on a quiet record."""
    t = np.arange(round((BEFORE + KEPT) / STEP)) * STEP
    return broadband(seed) * (0.05 + np.exp(-((t - 25.0) ** 2)) + np.exp(-(((t - 38.0) / 2.0) ** 2)))


def kept(q):
    """The record without what came before it."""
    return q[round(BEFORE / STEP) :]


def damage(q, slope=3.0):
    """Sum of range^slope over all cycles of a single pass."""
    cycles = rainflow(q, "half")
    return float((cycles.count * cycles.range**slope).sum())
