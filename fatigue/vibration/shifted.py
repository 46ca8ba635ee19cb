"""A modal coordinate as it would be with another frequency or damping of its mode, under the same modal force.

The modal force of a record is Q / H. The mode at its new setting answers it with H' Q / H, which is exact as long as
the force stays what it was: nothing that the structure does acts back on it. Above both frequencies the ratio tends to
1, so noise is not amplified; at rest it is (f / f')^2.

A record is not periodic, though a transform takes it so. The jump between its last and its first sample reads as a blow
that nobody struck; it rings as a free vibration of the new setting, for 1 / (2 pi z' f') seconds, and far from the old
resonance it may be most of what is left. So the free vibration at the start is replaced. What it has to be follows from
that of the record at its start: the least white force before the record that explains the one makes the other.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.linalg import solve_sylvester

from fatigue.vibration.oscillator import receptance

Floats = NDArray[np.float64]

START_PERIODS = 3.0  # of the mode, from which the free vibration at the start is read
FEWEST_SAMPLES = 8  # of that start: four unknowns are fitted to them


class Setting(NamedTuple):
    """Frequency [Hz] and damping ratio [-] of a mode, both above 0, the damping below 1."""

    frequency_hz: float
    damping: float


def shifted(q: Floats, step: float, before: Setting, after: Setting) -> Floats:
    """Modal coordinate of the mode moved from one setting to another at constant modal mass.

    Shape (t,) of ``q``, in its unit. Linear in ``q``; nothing changes where the settings are the same (source: the
    receptance of an oscillator, Craig and Kurdila, Fundamentals of Structural Dynamics, ch. 3).

    Parameters
    ----------
    q : (t,) modal coordinate on a uniform time grid
    step : time step [s]
    before, after : settings of the mode, as it was recorded and as it is wanted
    """
    if before == after:
        return q.astype(np.float64)
    ratio = transfer(np.fft.rfftfreq(q.size, step), before, after)
    response = np.fft.irfft(ratio * np.fft.rfft(q), q.size)
    if q.size < max(_start(before, step), _start(after, step)):
        return response  # too short to tell a free vibration: taken to recur
    start = _explained(before, after) @ _free_state(q, step, before)
    start -= _free_state(response, step, after)
    return np.asarray(response + _free_vibration(start, q.size, step, after))


def transfer(f_hz: ArrayLike, before: Setting, after: Setting) -> NDArray[np.complex128]:
    """Ratio of receptances, H' / H, at some frequencies [Hz]."""
    return receptance(f_hz, *after) / receptance(f_hz, *before)


def _free_vibration(state: Floats, samples: int, step: float, of: Setting) -> Floats:
    """Free vibration (t,) from a state: displacement, and velocity over w_i."""
    (f, z), t = of, np.arange(samples) * step
    w, sine = 2.0 * np.pi * f, np.sqrt(1.0 - of.damping**2)
    x, v = state
    turning = x * np.cos(w * sine * t) + (v + z * x) / sine * np.sin(w * sine * t)
    return np.asarray(np.exp(-z * w * t) * turning)


def _free_state(q: Floats, step: float, of: Setting) -> Floats:
    """State of the free vibration that a record begins with: displacement, and velocity over w_i.

    A least-squares fit beside a constant and a slope, which are quasi-static; what is faster than the mode averages
    out, which a derivative at the first sample would amplify.
    """
    samples = _start(of, step)
    along = np.linspace(-1.0, 1.0, samples)
    free = (_free_vibration(np.array(state), samples, step, of) for state in ((1.0, 0.0), (0.0, 1.0)))
    fitted, *_ = np.linalg.lstsq(np.stack([*free, np.ones(samples), along], axis=1), q[:samples], rcond=None)
    return np.asarray(fitted[:2])


def _start(of: Setting, step: float) -> int:
    """Samples from which the free vibration at the start is read."""
    return max(FEWEST_SAMPLES, round(START_PERIODS / (of.frequency_hz * step)))


def _explained(before: Setting, after: Setting) -> Floats:
    """Matrix (2, 2) from the state before to the expected state after, under the least white force that explains it.

    The product of the cross-Gramian of both oscillators and the inverse Gramian of the first, A' X + X A^T + B B^T = 0
    (source: Anderson and Moore, Optimal Filtering, ch. 2: the conditional mean of a Gaussian state).
    """
    (A, B), (A_after, B_after) = _system(before), _system(after)
    own = solve_sylvester(A, A.T, -np.outer(B, B))
    cross = solve_sylvester(A_after, A.T, -np.outer(B_after, B))
    return np.asarray(np.linalg.solve(own.T, cross.T).T)


def _system(of: Setting) -> tuple[Floats, Floats]:
    """State matrix and input of an oscillator; the state is displacement, and velocity over w_i."""
    w = 2.0 * np.pi * of.frequency_hz
    return np.array([[0.0, w], [-w, -2.0 * of.damping * w]]), np.array([0.0, 1.0 / w])
