"""An oscillator of one mode under a known force: the exact step of a linear system, the force linear in between."""

import numpy as np
from scipy.linalg import expm
from scipy.signal import lfilter

FINER = 16  # steps of the simulation in one of the record, so that the force is linear between them to 1e-4


def response(force, step, hz, damping_ratio):
    """Coordinate of a mode of modal mass 1 at rest at first, under a force sampled every ``step`` seconds."""
    w = 2.0 * np.pi * hz
    M = np.zeros((4, 4))  # x' = A x + B u, u linear within a step (van Loan, 1978)
    M[:2, :2] = np.array([[0.0, 1.0], [-w * w, -2.0 * damping_ratio * w]]) * step
    M[1, 2], M[2, 3] = step, 1.0
    E = expm(M)
    A, B1, B0 = E[:2, :2], E[:2, 3], E[:2, 2] - E[:2, 3]

    def adjugate(v):
        return np.array([v[0], A[0, 1] * v[1] - A[1, 1] * v[0]])

    n0, n1 = adjugate(B0), adjugate(B1)
    return lfilter([n1[0], n0[0] + n1[1], n0[1]], [1.0, -np.trace(A), np.linalg.det(A)], force)


def band_limited_noise(samples, step, top_hz, seed=0):
    """Noise of unit variance below ``top_hz``."""
    rng = np.random.default_rng(seed)
    X = np.fft.rfft(rng.standard_normal(2 * samples))
    X[np.fft.rfftfreq(2 * samples, step) > top_hz] = 0.0
    x = np.fft.irfft(X)[:samples]
    return x / x.std()
