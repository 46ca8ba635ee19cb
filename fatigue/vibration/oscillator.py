"""One mode as an oscillator of modal mass 1: its dynamic stiffness, its receptance, and how long it remembers.

``q'' + 2 z w_k q' + w_k^2 q = f`` under ``e^(iwt)`` (source: Craig and Kurdila, Fundamentals of Structural Dynamics,
ch. 3). Frequencies in Hz and damping ratios are broadcast together.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

Complex = NDArray[np.complex128]


def dynamic_stiffness(hz: ArrayLike, natural_hz: ArrayLike, damping_ratio: ArrayLike) -> Complex:
    """Modal force per modal coordinate at some frequencies, ``H^-1 = w_k^2 - w^2 + 2 i z w_k w`` [1/s^2].

    >>> float((abs(dynamic_stiffness(9.2, 9.2, 0.05)) / (2 * np.pi * 9.2) ** 2).round(12))
    0.1
    """
    w, w_k = (2.0 * np.pi * np.asarray(f, np.float64) for f in (hz, natural_hz))
    return np.asarray(w_k**2 - w**2 + 2j * np.asarray(damping_ratio, np.float64) * w_k * w)


def receptance(hz: ArrayLike, natural_hz: ArrayLike, damping_ratio: ArrayLike) -> Complex:
    """Modal coordinate per modal force, H [s^2]. An undamped mode has none at its own frequency."""
    return np.asarray(1.0 / dynamic_stiffness(hz, natural_hz, damping_ratio))


def memory_s(natural_hz: float, damping_ratio: float) -> float:
    """Time in which a free oscillation decays by the factor e, 1 / (2 pi z f_k) [s]; infinite without damping."""
    rate = 2.0 * np.pi * damping_ratio * natural_hz
    return 1.0 / rate if rate > 0.0 else np.inf
