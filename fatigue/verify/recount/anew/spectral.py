"""Dirlik (1985) and Tovo-Benasciutti (2005) once more, for one point: straight from the formulas."""

import numpy as np
from numpy.typing import NDArray

from fatigue.verify.recount.anew.curve import RecountCurve

NEARLY_ALL = 0.9  # of the damage from above the upper frequency: no life from the spectrum
NARROW = 1e-7  # of 1 - alpha2: below, both are the narrow-band formula to rounding


def dirlik(moments: NDArray[np.float64], curve: RecountCurve) -> float:
    """Damage per second from moments 0, 1, 2, 4 of the stress times its factor to the equivalent range."""
    m0, m1, m2, m4 = moments
    if m0 <= 0 or m2 <= 0 or m4 <= 0:
        return 0.0
    spread = 2 * np.sqrt(m0)
    a2 = min(m2 / (np.sqrt(m0) * np.sqrt(m4)), 1.0)
    xm = min(max(m1 / (np.sqrt(m0) * np.sqrt(m2)), a2), 1.0) * a2
    if 1 - a2 < NARROW:
        return float(np.sqrt(m4 / m2) * curve.mean_damage(np.sqrt(2) * spread, 2.0))
    D1 = 2 * (xm - a2**2) / (1 + a2**2)
    R = (a2 - xm - D1**2) / (1 - a2 - D1 + D1**2)
    D2 = (1 - a2 - D1 + D1**2) / (1 - R)
    D3 = 1 - D1 - D2
    Q = 1.25 * (a2 - D3 - D2 * R) / D1 if D1 > 1e-12 else 0.0
    return float(
        np.sqrt(m4 / m2)
        * (
            D1 * curve.mean_damage(Q * spread, 1.0)
            + D2 * curve.mean_damage(abs(R) * np.sqrt(2) * spread, 2.0)
            + D3 * curve.mean_damage(np.sqrt(2) * spread, 2.0)
        )
    )


def tovo_benasciutti(moments: NDArray[np.float64], curve: RecountCurve) -> float:
    """Damage per second, arguments as in ``dirlik``."""
    m0, m1, m2, m4 = moments
    if m0 <= 0 or m2 <= 0 or m4 <= 0:
        return 0.0
    rayleigh = 2 * np.sqrt(2 * m0)
    a2 = min(m2 / (np.sqrt(m0) * np.sqrt(m4)), 1.0)
    a1 = min(max(m1 / (np.sqrt(m0) * np.sqrt(m2)), a2), 1.0)
    if 1 - a2 < NARROW:
        return float(np.sqrt(m2 / m0) * curve.mean_damage(rayleigh, 2.0))
    b = (a1 - a2) * (1.112 * (1 + a1 * a2 - (a1 + a2)) * np.exp(2.11 * a2) + (a1 - a2)) / (a2 - 1) ** 2
    b = min(max(b, 0.0), 1.0)
    return float(
        np.sqrt(m2 / m0) * b * curve.mean_damage(rayleigh, 2.0)
        + np.sqrt(m4 / m2) * (1 - b) * curve.mean_damage(a2 * rayleigh, 2.0)
    )
