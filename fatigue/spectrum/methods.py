"""Damage of a stationary Gaussian stress from four spectral moments: Dirlik, Tovo-Benasciutti, narrow band.

Every method here is a sum of cycle densities of Weibull type (exponential and Rayleigh), so damage on a curve with
knees and a cut-off has a closed form in incomplete gamma functions, whatever the number of segments.

**What the moments are of.** ``moments`` is (4, n), orders 0, 1, 2, 4, of the stress in the variable of the damage law:
the stress times the factor that turns a stress range into the law's equivalent range x. A cycle of amplitude a has the
range x = 2 a, and the methods put that 2 in: laws want ranges, the literature below gives amplitudes.

Sources: Dirlik, PhD thesis, University of Warwick, 1985; Benasciutti and Tovo, International Journal of Fatigue 27,
2005; Rice, Bell System Technical Journal 24, 1945 (rates); Lutes and Sarkani, Random Vibrations, 2004.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.life.curves import DamageLaw
from fatigue.quotient import quotient

NARROW = 1e-7  # below this 1 - alpha2 the narrow-band result is exact to 2e-7, and Dirlik's Q is 0 / 0
VANISHING = 1e-12  # a weight of the exponential part too small to determine its scale
EXPONENTIAL, RAYLEIGH = 1.0, 2.0  # Weibull shapes


@dataclass(frozen=True, slots=True, eq=False)
class SpectralShape:
    """Rates and bandwidth that spectral moments stand for; all (n,).

    Attributes
    ----------
    zero_crossings : upward crossings of the mean [1/s]
    peaks : maxima [1/s]
    alpha1 : m1 / sqrt(m0 m2)
    alpha2 : irregularity, m2 / sqrt(m0 m4) = crossings over peaks; 1 is narrow band
    """

    zero_crossings: NDArray[np.float64]
    peaks: NDArray[np.float64]
    alpha1: NDArray[np.float64]
    alpha2: NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class DirlikDensity:
    """Dirlik's density of the amplitude over its standard deviation, z, at the rate of peaks; all (n,).

    ``p(z) = d1/q exp(-z/q) + d2 z/r^2 exp(-z^2/2r^2) + d3 z exp(-z^2/2)``
    """

    d1: NDArray[np.float64]
    d2: NDArray[np.float64]
    d3: NDArray[np.float64]
    q: NDArray[np.float64]
    r: NDArray[np.float64]


def spectral_shape(moments: NDArray[np.float64]) -> SpectralShape:
    """Rates and bandwidth from moments (4, n) of orders 0, 1, 2, 4.

    A point without stress counts as a narrow band at 0 Hz. Rounding may carry the bandwidth parameters outside
    Hoelder's ``alpha2 <= alpha1 <= 1``; they are put back.

    Examples
    --------
    A flat band between 10 and 40 Hz:

    >>> shape = spectral_shape(np.array([[(40.0**n - 10.0**n) / n] for n in (1, 2, 3, 5)]))
    >>> print(f"{shape.zero_crossings[0]:.3f} and {shape.peaks[0]:.3f} per second, alpha2 {shape.alpha2[0]:.4f}")
    26.458 and 31.214 per second, alpha2 0.8476
    """
    m0, m1, m2, m4 = moments
    still = (m0 <= 0) | (m2 <= 0) | (m4 <= 0)  # written so that a NaN stays a NaN and is seen
    m0, m1, m2, m4 = (np.where(still, 1.0, m) for m in (m0, m1, m2, m4))
    crossings = np.sqrt(m2 / m0)
    peaks = np.sqrt(m4 / m2)
    alpha2 = np.minimum(crossings / peaks, 1.0)
    alpha1 = np.clip(m1 / m0 / crossings, alpha2, 1.0)
    return SpectralShape(np.where(still, 0.0, crossings), np.where(still, 0.0, peaks), alpha1, alpha2)


def dirlik_density(shape: SpectralShape) -> DirlikDensity:
    """Coefficients of Dirlik (1985), Eq. 20; r may be negative, and only its magnitude has a meaning.

    Towards a narrow band the coefficients tend to the Rayleigh density, which they become at ``1 - alpha2 < NARROW``.
    """
    narrow = 1.0 - shape.alpha2 < NARROW
    a2 = np.where(narrow, 0.5, shape.alpha2)
    xm = np.where(narrow, 0.5, shape.alpha1) * a2
    d1 = 2.0 * (xm - a2**2) / (1.0 + a2**2)
    r = (a2 - xm - d1**2) / (1.0 - a2 - d1 + d1**2)
    d2 = (1.0 - a2 - d1 + d1**2) / (1.0 - r)
    d3 = 1.0 - d1 - d2
    weightless = d1 < VANISHING
    q = np.where(weightless, 0.0, 1.25 * (a2 - d3 - d2 * r) / np.where(weightless, 1.0, d1))
    return DirlikDensity(
        d1=np.where(narrow, 0.0, d1),
        d2=np.where(narrow, 0.0, d2),
        d3=np.where(narrow, 1.0, d3),
        q=np.where(narrow, 0.0, np.maximum(q, 0.0)),
        r=np.where(narrow, 0.0, r),
    )


def dirlik_damage_rate(moments: NDArray[np.float64], law: DamageLaw) -> NDArray[np.float64]:
    """Damage per second by Dirlik (1985), Eq. 20: (n,) [1/s] from moments (4, n) as the module says.

    Examples
    --------
    A flat band of 30 MPa^2/Hz between 10 and 40 Hz, ``N = 2e12 / S^3``:

    >>> moments = np.array([[30 * (40.0**n - 10.0**n) / n] for n in (1, 2, 3, 5)])
    >>> law = DamageLaw(np.array([3.0]), np.array([math.log(2e12)]), np.array([]), 0.0)
    >>> print(f"{dirlik_damage_rate(moments, law)[0]:.6e}")
    9.883754e-06
    """
    shape = spectral_shape(moments)
    density = dirlik_density(shape)
    spread = 2.0 * np.sqrt(np.maximum(moments[0], 0.0))  # range of a cycle whose amplitude is one standard deviation
    per_cycle = (
        density.d1 * damage_per_cycle(spread * density.q, EXPONENTIAL, law)
        + density.d2 * damage_per_cycle(spread * np.abs(density.r) * math.sqrt(2.0), RAYLEIGH, law)
        + density.d3 * damage_per_cycle(spread * math.sqrt(2.0), RAYLEIGH, law)
    )
    return np.asarray(shape.peaks * per_cycle)


def tovo_benasciutti_damage_rate(moments: NDArray[np.float64], law: DamageLaw) -> NDArray[np.float64]:
    """Damage per second by Benasciutti and Tovo (2005), Eq. 21: (n,) [1/s] from moments (4, n) as the module says.

    A share b of narrow-band cycles and a share 1 - b of range counting, whose cycles are Rayleigh, smaller by alpha2.

    Examples
    --------
    The flat band of ``dirlik_damage_rate``:

    >>> moments = np.array([[30 * (40.0**n - 10.0**n) / n] for n in (1, 2, 3, 5)])
    >>> law = DamageLaw(np.array([3.0]), np.array([math.log(2e12)]), np.array([]), 0.0)
    >>> print(f"{tovo_benasciutti_damage_rate(moments, law)[0]:.6e}")
    9.659460e-06
    """
    shape = spectral_shape(moments)
    a1, a2 = shape.alpha1, shape.alpha2
    narrow = 1.0 - a2 < NARROW
    wide = np.where(narrow, 1.0, 1.0 - a2)
    b = (a1 - a2) * (1.112 * (1.0 + a1 * a2 - a1 - a2) * np.exp(2.11 * a2) + (a1 - a2)) / wide**2
    b = np.where(narrow, 1.0, np.clip(b, 0.0, 1.0))
    rayleigh = 2.0 * np.sqrt(2.0 * np.maximum(moments[0], 0.0))
    return np.asarray(
        shape.zero_crossings * b * damage_per_cycle(rayleigh, RAYLEIGH, law)
        + shape.peaks * (1.0 - b) * damage_per_cycle(a2 * rayleigh, RAYLEIGH, law)
    )


def narrow_band_damage_rate(moments: NDArray[np.float64], law: DamageLaw) -> NDArray[np.float64]:
    """Damage per second if every upward crossing of the mean began a Rayleigh cycle: (n,) [1/s] from moments (4, n).

    Examples
    --------
    The flat band of ``dirlik_damage_rate``:

    >>> moments = np.array([[30 * (40.0**n - 10.0**n) / n] for n in (1, 2, 3, 5)])
    >>> law = DamageLaw(np.array([3.0]), np.array([math.log(2e12)]), np.array([]), 0.0)
    >>> print(f"{narrow_band_damage_rate(moments, law)[0]:.6e}")
    1.074370e-05
    """
    rayleigh = 2.0 * np.sqrt(2.0 * np.maximum(moments[0], 0.0))
    return np.asarray(spectral_shape(moments).zero_crossings * damage_per_cycle(rayleigh, RAYLEIGH, law))


def dirlik_over_narrow_band(shape: SpectralShape, k: float) -> NDArray[np.float64]:
    """Dirlik's damage over the narrow-band damage on a straight curve of slope k, (n,); NaN without stress.

    This is the ratio of ``dirlik_damage_rate`` and ``narrow_band_damage_rate``: no stress is left in it, only rates and
    bandwidth.
    """
    density = dirlik_density(shape)
    exponential = math.gamma(1.0 + k) / (2.0 ** (k / 2) * math.gamma(1.0 + k / 2))
    per_peak = density.d1 * density.q**k * exponential + density.d2 * np.abs(density.r) ** k + density.d3
    return quotient(shape.peaks * per_peak, shape.zero_crossings)


def damage_per_cycle(scale: NDArray[np.float64], weibull_shape: float, law: DamageLaw) -> NDArray[np.float64]:
    """Mean damage (n,) of a cycle whose equivalent range x has ``P(X > x) = exp(-(x / scale)**weibull_shape)``.

    One segment of the law between the ranges a and b contributes ``scale**k / A Gamma(1 + k/h)`` times the regularised
    incomplete gamma function between ``(a / scale)**h`` and ``(b / scale)**h``, h being the Weibull shape.

    Examples
    --------
    Rayleigh cycles of scale 10 and ``N = 1 / x^2``: the mean of x^2 is 100.

    >>> law = DamageLaw(np.array([2.0]), np.array([0.0]), np.array([]), 0.0)
    >>> float(damage_per_cycle(np.array([10.0]), RAYLEIGH, law)[0].round(9))
    100.0
    """
    with np.errstate(divide="ignore"):  # a scale of 0 has the logarithm -inf and the damage 0
        log_scale = np.log(scale)
    if law.is_straight:
        (k,), (log_constant,) = law.slopes, law.log_constants
        return np.asarray(np.exp(k * log_scale + (math.lgamma(1.0 + k / weibull_shape) - log_constant)))
    upper = np.concatenate([[np.inf], np.maximum(law.knees, law.cutoff)])
    lower = np.concatenate([np.maximum(law.knees, law.cutoff), [law.cutoff]])
    damage = np.zeros_like(scale)
    for k, log_constant, a, b in zip(law.slopes, law.log_constants, lower, upper, strict=True):
        order = 1.0 + k / weibull_shape
        whole = np.exp(k * log_scale + (math.lgamma(order) - log_constant))
        damage += whole * _gamma_between(order, _reduced(a, scale, weibull_shape), _reduced(b, scale, weibull_shape))
    return damage


def _reduced(x: float, scale: NDArray[np.float64], weibull_shape: float) -> NDArray[np.float64]:
    """``(x / scale)**weibull_shape``, with 0 at x = 0 and infinity where the scale vanishes."""
    if x == 0.0:
        return np.zeros_like(scale)
    with np.errstate(divide="ignore", over="ignore"):
        return np.asarray((x / scale) ** weibull_shape)


def _gamma_between(order: float, a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    """Regularised incomplete gamma function between a and b, from the tail that keeps its digits."""
    from scipy.special import gammainc, gammaincc  # noqa: PLC0415 - only laws with knees pay for the import

    return np.asarray(
        np.where(a > order, gammaincc(order, a) - gammaincc(order, b), gammainc(order, b) - gammainc(order, a))
    )
