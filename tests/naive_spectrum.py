"""Slow, obviously right versions of the spectral methods, and the spectra they are tried on."""

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import quad
from scipy.signal import welch

from fatigue.life.curves import DamageLaw
from fatigue.spectrum.methods import dirlik_density, spectral_shape

Spectrum = tuple[NDArray[np.float64], NDArray[np.float64]]


def straight_law(k: float, constant: float = 1.0) -> DamageLaw:
    """Make the law N = constant / range**k."""
    return DamageLaw(np.array([k]), np.array([np.log(constant)]), np.array([]), 0.0)


def bent_law(slopes: list[float], knees: list[float], constant: float = 1.0, cutoff: float = 0.0) -> DamageLaw:
    """Make the law N = constant / range**slopes[0] above the first knee, continuous with the other slopes below."""
    log_constants = [np.log(constant)]
    for k, k_next, knee in zip(slopes[:-1], slopes[1:], knees, strict=True):
        log_constants.append(log_constants[-1] + (k_next - k) * np.log(knee))
    return DamageLaw(np.array(slopes), np.array(log_constants), np.array(knees), cutoff)


def damage_of_range(x: float, law: DamageLaw) -> float:
    """Find the damage of one cycle, read off the law segment by segment."""
    if x < law.cutoff or x == 0:
        return 0.0
    segment = sum(x < knee for knee in law.knees)
    return float(x ** law.slopes[segment] / np.exp(law.log_constants[segment]))


def moments_of(spectrum: Spectrum, orders: tuple[float, ...] = (0, 1, 2, 4)) -> NDArray[np.float64]:
    """Integrate moments (p, 1) of a one-sided density by the trapezoid rule."""
    f, density = spectrum
    return np.array([[np.trapezoid(f**p * density, f)] for p in orders])


def welch_moments(
    stress: NDArray[np.float64], step: float, segment: int, upper_hz: float, orders: tuple[float, ...]
) -> NDArray[np.float64]:
    """Estimate moments (p, n) of stress histories (n, t) by Welch's method, point by point."""
    f, density = welch(stress, fs=1 / step, window="hann", nperseg=segment, noverlap=segment // 2, detrend="constant")
    kept = f <= upper_hz * (1 + 1e-9)
    return np.array([np.trapezoid(f[kept] ** p * density[:, kept], f[kept]) for p in orders])


def dirlik_by_quadrature(moments: NDArray[np.float64], law: DamageLaw) -> float:
    """Integrate Dirlik's density times the damage of each range: damage per second of one point, moments (4, 1)."""
    shape = spectral_shape(moments)
    density = dirlik_density(shape)
    d1, d2, d3, q, r = (float(c[0]) for c in (density.d1, density.d2, density.d3, density.q, density.r))
    deviation = float(np.sqrt(moments[0, 0]))

    def integrand(z: float) -> float:
        p = d1 / q * np.exp(-z / q) + d2 * z / r**2 * np.exp(-(z**2) / 2 / r**2) + d3 * z * np.exp(-(z**2) / 2)
        return float(p * damage_of_range(2 * deviation * z, law))

    corners = sorted({x / 2 / deviation for x in (*law.knees, law.cutoff) if 0 < x / 2 / deviation < 40})
    edges = [0.0, *corners, *(z for z in (1.0, 3.0, 8.0, 40.0) if not corners or z > corners[-1])]
    pieces = (quad(integrand, a, b, epsabs=1e-200, epsrel=1e-11, limit=200)[0] for a, b in pairwise(edges))
    return float(shape.peaks[0] * sum(pieces))


def narrow_spectrum() -> Spectrum:
    """Return P1: flat from 8 to 12 Hz."""
    f = np.linspace(8, 12, 4001)
    return f, np.full_like(f, 25.0)


def two_band_spectrum() -> Spectrum:
    """Return P2: a strong band at 1 to 2 Hz and a weak one at 20 to 24 Hz."""
    f = np.arange(1000, 24001) / 1000
    return f, np.where(f <= 2, 64.0, np.where(f >= 20, 9.0, 0.0))


def modal_spectrum() -> Spectrum:
    """Return P3: three modes at 1.2, 9.3 and 36 Hz."""
    f = np.arange(100, 40001) / 500
    density = np.zeros_like(f)
    for f0, zeta, a in ((1.2, 0.20, 20.0), (9.3, 0.02, 0.40), (36.0, 0.015, 0.004)):
        r = f / f0
        density += a / ((1 - r**2) ** 2 + (2 * zeta * r) ** 2)
    return f, density
