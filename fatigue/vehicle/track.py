"""Irregularities of the rail, ERRI B176: their spectra, and one realisation of them under four axles.

Three independent signals: lateral, vertical and roll (cross-level over gauge). Spectra are **one-sided**: the variance
is their integral over wavenumbers from 0. (Syntheses that take the same coefficients for two-sided ones give 0.56 of
the standard deviation.) Source: ERRI B176, the coefficients of open simulators; wavelengths that are left out or
weakened are those of ``Track``.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fatigue.errors import CaseError, Problem, refuse
from fatigue.vehicle.definition import Track

Floats = NDArray[np.float64]

SIGNALS = ("lateral", "vertical", "roll")
LATERAL, VERTICAL, ROLL = range(3)

CRITICAL, REFERENCE, SECOND = 0.8246, 0.0206, 0.4380  # W_c, W_r, W_s [rad/m]
HALF_DISTANCE_M = 0.75  # b of the roll spectrum


class Level(NamedTuple):
    """Roughness of a track: A_l, A_v [m rad]."""

    lateral: float
    vertical: float


LEVELS = {"low": Level(2.119e-7, 4.032e-7), "high": Level(6.125e-7, 1.080e-6)}

GRID_M = 0.05  # of a realisation
LONGEST_RIDE_M = 1e6  # whose realisation takes 2 GB of memory
BEYOND_M = 200.0  # what a realisation is longer than the ride, at least
BEFORE_M = 50.0  # where the middle of the vehicle begins, from the first point of the realisation
RISE_M = 50.0  # over which the irregularities grow from nothing at the begin of a ride


def spectra(wavenumber: ArrayLike, track: Track) -> Floats:
    """One-sided spectra (3, n) over wavenumbers W (n,) [rad/m]: lateral, vertical [m2/(rad/m)], roll [rad2/(rad/m)].

    ``S_l = A_l W_c^2 / ((W^2 + W_r^2)(W^2 + W_c^2))``, ``S_v`` with ``A_v``, and
    ``S_roll = A_v/b^2 W_c^2 W^2 / ((W^2 + W_r^2)(W^2 + W_c^2)(W^2 + W_s^2))``. Nothing is longer than ``longest_m``;
    what is shorter than ``weakened_below_m`` is multiplied by ``(2 pi / weakened_below_m / W)^2``.

    >>> [f"{S:.4g}" for S in spectra([0.05, 0.1, 1.0, 4.0], Track())[0]]
    ['0', '2.003e-05', '8.573e-08', '1.48e-10']
    """
    W = np.asarray(wavenumber, np.float64)
    level = LEVELS[_known(track).quality]
    shape = CRITICAL**2 / ((W**2 + REFERENCE**2) * (W**2 + CRITICAL**2))
    roll = shape * W**2 / (W**2 + SECOND**2) / HALF_DISTANCE_M**2
    S = np.stack([level.lateral * shape, level.vertical * shape, level.vertical * roll])
    S[:, track.longest_m * W < 2.0 * np.pi] = 0.0
    shorter = np.maximum(track.weakened_below_m * W / (2.0 * np.pi), 1.0)
    return np.asarray(S / shorter**2)


def spectra_per_hz(hz: ArrayLike, speed_m_s: float, track: Track) -> Floats:
    """One-sided spectra (3, n) as an axle meets them at a speed: ``S_f(f) = (2 pi/V) S(2 pi f/V)`` [m2/Hz, rad2/Hz].

    Axle i meets them ``(x_1 - x_i)/V`` after axle 1.
    """
    wavenumber_per_hz = 2.0 * np.pi / speed_m_s
    return wavenumber_per_hz * spectra(wavenumber_per_hz * np.asarray(hz, np.float64), track)


@dataclass(frozen=True, slots=True, eq=False)
class Realisation:
    """One track: ``value`` and ``slope`` (3, n) of lateral, vertical, roll every ``GRID_M`` [m, rad; 1, rad/m]."""

    value: Floats
    slope: Floats


def realised(track: Track, seed: int) -> Realisation:
    """One realisation of a track; the same seed gives the same track, bit for bit.

    The generator is PCG64. Phases are drawn for lateral, then vertical, then roll, n/2 + 1 uniform numbers r_k each:
    ``c_k = (n/2) sqrt(2 S(W_k) W_1) exp(2 pi i r_k)``, without mean and Nyquist line. The signal is their inverse real
    transform, its slope that of ``i W_k c_k``. The grid has the smallest power of two of points that holds the ride.

    Raises
    ------
    CaseError : a quality nobody knows, or lengths that no track has
    """
    n = 1 << int(np.ceil(np.log2((_known(track).distance_m + BEYOND_M) / GRID_M)))
    first = 2.0 * np.pi / (GRID_M * n)
    W = first * np.arange(n // 2 + 1)
    size = (n / 2) * np.sqrt(2.0 * spectra(W, track) * first)
    size[:, [0, -1]] = 0.0
    phase = np.random.Generator(np.random.PCG64(seed)).random((len(SIGNALS), n // 2 + 1))
    c = size * np.exp(2j * np.pi * phase)
    return Realisation(np.fft.irfft(c, n), np.fft.irfft(1j * W * c, n))


@dataclass(frozen=True, slots=True, eq=False)
class UnderAxles:
    """What axles meet at some instants: ``value`` [m, rad] and ``rate`` [m/s, rad/s] (3, axles, n)."""

    value: Floats
    rate: Floats


def under_axles(of: Realisation, axle_x_m: Floats, distance_m: Floats, speed_m_s: float) -> UnderAxles:
    """What axles meet when the middle of the vehicle has come some distances (n,) [m] from where the ride began.

    Axle i reads the track at ``50 m + V t + x_i``, linearly between its points; the rate is V times the slope. Both
    grow from nothing over the first 50 m.
    """
    place = (BEFORE_M + distance_m + axle_x_m[:, None]) / GRID_M
    grid = np.arange(of.value.shape[1])
    if place.min() < 0.0 or place.max() > grid[-1]:
        raise ValueError("the ride is longer than the track")
    rise = np.clip(distance_m / RISE_M, 0.0, 1.0)
    value, slope = (np.stack([np.interp(place, grid, signal) for signal in part]) for part in (of.value, of.slope))
    return UnderAxles(value * rise, speed_m_s * slope * rise)


def _known(track: Track) -> Track:
    """Give a track back, or refuse what none can be."""
    problems = []
    if track.quality not in LEVELS:
        remedy = f"Choose one of {', '.join(LEVELS)}"
        problems.append(Problem("track", "[track] quality", f"{track.quality!r} is no known quality", remedy))
    for key, most, remedy in (
        ("longest_m", np.inf, "Give a length above 0"),
        ("distance_m", LONGEST_RIDE_M, f"Give a length above 0, {LONGEST_RIDE_M:g} m at most"),
    ):
        if not 0.0 < getattr(track, key) < np.nextafter(most, np.inf):
            what = f"{getattr(track, key)} m is no such length"
            problems.append(Problem("track", f"[track] {key}", what, remedy))
    if not 0.0 <= track.weakened_below_m < np.inf:
        what = f"{track.weakened_below_m} m is no wavelength"
        problems.append(Problem("track", "[track] weakened_below_m", what, "Give a length, 0 to weaken nothing"))
    refuse(CaseError, problems)
    return track
