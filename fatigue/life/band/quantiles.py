"""Lives at a survival: all parts of the scatter together, on one slope or with knees."""

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtr, ndtri

Floats = NDArray[np.float64]

SURVIVALS: Mapping[str, float] = MappingProxyType({"p50": 0.5, "p90": 0.9, "p97_7": float(ndtr(2.0)), "p99": 0.99})
STEP, FAR = 0.025, 9.0  # of a trapezoid of normal integrals, good to 1e-11


def normal_grid(step: float) -> tuple[Floats, Floats]:
    """Strengths z from -9 to 9 in steps that divide 9, and the weight of each in an integral over ``phi(z) dz``."""
    half = round(FAR / step)
    z = np.arange(-half, half + 1) * step
    weight = np.exp(-0.5 * z**2)
    return np.asarray(z, np.float64), np.asarray(weight / weight.sum())


STRENGTHS, WEIGHTS = normal_grid(STEP)


def combined_sigma(*parts: Floats | float) -> Floats:
    """Standard deviation of the ln of a life from those of its independent parts: the root of the sum of squares."""
    return np.asarray(np.sqrt(np.sum([np.square(part) for part in np.broadcast_arrays(*parts)], axis=0)))


def lognormal_life(median_km: Floats | float, sigma_ln: Floats | float, survival: float) -> Floats:
    """Life that a share of all reach, ``median exp(-z_p sigma)`` [km].

    >>> float(lognormal_life(1e7, 0.8374910908440345, 0.9).round())
    3418826.0
    """
    return np.asarray(median_km * np.exp(-ndtri(survival) * sigma_ln))


def life_of_strengths(log_life: Floats, sigma_other: float, survival: float) -> float:
    """Life that a share of all reach where the life is known at each of the ``STRENGTHS`` [km].

    ``int phi(z) Phi((ln L(z) - ln L) / sigma_other) dz = survival``, solved for L; for curves with knees, on which the
    ln of the life is not normal.

    Parameters
    ----------
    log_life : (721,) ln of the life [km] at each strength, ascending; +inf where nothing damages any more
    sigma_other : standard deviation of ln life of the other parts, load and Miner sum
    """
    if sigma_other == 0.0:
        return float(np.exp(_at(log_life, float(-ndtri(survival)))))
    finite = log_life[np.isfinite(log_life)]
    if len(finite) == 0 or _survival(log_life, finite[-1] + 9.0 * sigma_other, sigma_other) >= survival:
        return float(np.inf)
    from scipy.optimize import brentq  # noqa: PLC0415 - a fifth of a second that few runs have to wait for

    low, high = finite[0] - 9.0 * sigma_other, finite[-1] + 9.0 * sigma_other
    found = brentq(lambda at: _survival(log_life, at, sigma_other) - survival, low, high, xtol=1e-13, rtol=1e-14)
    return float(np.exp(found))


def _survival(log_life: Floats, at: float, sigma_other: float) -> float:
    """Share of all that live longer than ``exp(at)``."""
    return float(WEIGHTS @ ndtr((log_life - at) / sigma_other))


def _at(log_life: Floats, z: float) -> float:
    """Ln of the life at a strength, between those of the grid."""
    place = int(np.clip(np.floor((z - STRENGTHS[0]) / STEP), 0, len(STRENGTHS) - 2))
    low, high = log_life[place], log_life[place + 1]
    part = (z - STRENGTHS[place]) / STEP
    if part <= 1e-9 or low == high:
        return float(low)
    return float(np.inf if np.isinf(high) else low + part * (high - low))
