"""One mode as an oscillator of constant modal mass: its receptance, and how long it remembers."""

import numpy as np
from numpy.typing import ArrayLike, NDArray


def receptance(f_hz: ArrayLike, frequency_hz: float, damping: float) -> NDArray[np.complex128]:
    """Response of a modal coordinate per modal force of unit modal mass, H(w) = 1 / (w_i^2 - w^2 + 2i z w_i w).

    Shape of ``f_hz``, in s^2: of q'' + 2 z w_i q' + w_i^2 q = f (source: Craig and Kurdila, Fundamentals of
    Structural Dynamics, ch. 3). An undamped mode has none at its own frequency.

    Parameters
    ----------
    f_hz : frequencies at which it is wanted [Hz]
    frequency_hz : natural frequency f_i of the mode, above 0 [Hz]
    damping : damping ratio z [-]
    """
    w, w_i = 2.0 * np.pi * np.asarray(f_hz, dtype=np.float64), 2.0 * np.pi * frequency_hz
    return np.asarray(1.0 / (w_i**2 - w**2 + 2j * damping * w_i * w), dtype=np.complex128)


def memory_s(frequency_hz: float, damping: float) -> float:
    """Time in which a free oscillation decays by the factor e, 1 / (2 pi z f_i) [s]; infinite without damping."""
    rate = 2.0 * np.pi * damping * frequency_hz
    return 1.0 / rate if rate > 0.0 else np.inf
