"""Is an event one stationary Gaussian case? Its variance over time, beside the scatter that chance allows.

The record is cut into periods. The variance of a point's stress in each of them is a quadratic form in its shape, so
is the autocovariance at each lag, and the variance of a Gaussian process' variance is a sum of squared autocovariances
(Bendat and Piersol, Random Data, section 8.3). Both need matrices of the modal coordinates only.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.life.history import ModalHistory
from fatigue.quotient import quotient
from fatigue.spectrum.moments import (
    MomentMatrices,
    Spectra,
    cross_densities,
    hann,
    moment_matrices,
    point_moments,
    quadratic_forms,
    samples_per_segment,
    segment_spectra,
    segment_starts,
)

FEWEST_PERIODS = 8  # below, a scatter between periods says nothing
MOST_PERIODS = 32  # into which a long record is cut: more would cost time and tell no more
LONGEST_LAG = 0.4  # of the segment an autocovariance comes from: beyond, its taper leaves too little
NEGLIGIBLE = 0.01  # share of the scatter energy the principal spectra may miss: a few per cent at a single point


@dataclass(frozen=True, slots=True, eq=False)
class PeriodMatrices:
    """Variance of the modal coordinates period by period, and the scatter to be expected of it by chance.

    The matrices are those of coordinates scaled to unit variance, in single precision: they take ``shapes * rms``.
    The expected squared coefficient of variation of a point's variance from period to period, were the record Gaussian
    and stationary, is ``sum over j of (s' scatter[j] s)**2 / (s' mean s)**2``.

    Attributes
    ----------
    rms : (m,) [unit modal coordinate]
    variance : (p, m, m), of each period
    mean : (1, m, m), of the record
    scatter : (r, m, m) principal spectra
    period_s : effective length of a period under its taper [s]
    segments : segments of the spectrum in one period
    """

    rms: NDArray[np.float64]
    variance: NDArray[np.float32]
    mean: NDArray[np.float32]
    scatter: NDArray[np.float32]
    period_s: float
    segments: int


@dataclass(frozen=True, slots=True, eq=False)
class Stationarity:
    """How the variance of every point behaves over time; arrays are (n,), (p, n) for ``relative_variance``.

    Attributes
    ----------
    relative_variance : variance of each period over their mean
    modulation_index : coefficient of variation of the variance over that expected by chance: 1 in the mean
    lower, upper : bounds between which chance keeps the modulation index in 98 of 100 records
    bandwidth_hz : statistical bandwidth B_s: the variance over a time T scatters by ``1 / sqrt(T B_s)`` [Hz]
    expected_cov : coefficient of variation of the variance of one period expected by chance
    """

    relative_variance: NDArray[np.float64]
    modulation_index: NDArray[np.float64]
    lower: NDArray[np.float64]
    upper: NDArray[np.float64]
    bandwidth_hz: NDArray[np.float64]
    expected_cov: NDArray[np.float64]


def period_matrices(history: ModalHistory, spectra: Spectra) -> PeriodMatrices | None:
    """Cut an event into periods of one or, in a long record, some segments; None if there are fewer than eight."""
    if len(spectra.starts) < FEWEST_PERIODS:
        return None
    long = segment_spectra(history, 2 * spectra.segment_s, spectra.upper_hz)
    mean = moment_matrices(long, (0,)).matrix
    rms = np.sqrt(np.diag(mean[0]))
    scale = np.where(rms > 0, rms, 1.0)  # a mode that is never excited stays zero
    unit = 1 / np.outer(scale, scale)

    segments = segments_per_period(spectra)
    variance = np.concatenate([m.matrix for m in moments_by_period(spectra, (0,))])
    taper = _period_taper(samples_per_segment(history.step, spectra.segment_s), segments)
    period_s = history.step / float(np.sum(taper**2))
    scatter = _principal_scatter(long, unit, taper, history.step)
    scatter /= np.sqrt(1 + period_s / history.duration)  # the autocovariances have their own scatter, which adds
    single = np.float32
    return PeriodMatrices(
        rms, (variance * unit).astype(single), (mean * unit).astype(single), scatter.astype(single), period_s, segments
    )


def segments_per_period(spectra: Spectra) -> int:
    """Segments that make one period, so that there are no more than `MOST_PERIODS`."""
    return -(-len(spectra.starts) // MOST_PERIODS)


def moments_by_period(spectra: Spectra, orders: tuple[float, ...]) -> list[MomentMatrices]:
    """Moment matrices of each period; segments that do not fill a last period are left out."""
    segments = segments_per_period(spectra)
    starts = range(0, len(spectra.starts) - segments + 1, segments)
    return [moment_matrices(spectra.part(first, first + segments), orders) for first in starts]


def stationarity(shapes: NDArray[np.float64], periods: PeriodMatrices) -> Stationarity:
    """Judge the variance over time of the stress at every point; ``shapes`` is (n, m). NaN where the stress is zero."""
    unit = shapes * periods.rms
    variance = quadratic_forms(unit, periods.variance).astype(np.float64)
    mean = quadratic_forms(unit, periods.mean)[0].astype(np.float64)
    scatter = np.sqrt(np.sum(quadratic_forms(unit, periods.scatter).astype(np.float64) ** 2, axis=0))
    expected_cov = quotient(scatter, mean)
    relative = quotient(variance, variance.mean(axis=0))
    count = len(relative)
    # The variance of a sample variance grows with the kurtosis of what is sampled, here close to a chi-square variable:
    # its upper tail gets heavier, the lower one stays.
    freedom = (count - 1) / (1 + 3 * expected_cov**2 * (count - 1) / count)
    return Stationarity(
        relative_variance=relative,
        modulation_index=quotient(relative.std(axis=0, ddof=1), expected_cov),
        lower=np.sqrt(_chi_square_over_freedom(-2.576, np.full_like(freedom, count - 1))),  # normal quantile of 0.5 %
        upper=np.sqrt(_chi_square_over_freedom(2.326, freedom)),  # 99 %
        bandwidth_hz=quotient(1.0 / periods.period_s, expected_cov**2),
        expected_cov=expected_cov,
    )


def modulation_factor(of: Stationarity, k: float) -> NDArray[np.float64]:
    """Damage of the periods, each at its own variance, over that at their mean variance: (n,), 1 when stationary.

    ``mean(v**(k/2)) / mean(v)**(k/2)``, over the value it has by chance, ``1 + (k/2)(k/2 - 1)/2 cov**2``.
    """
    by_chance = 1 + 0.5 * (k / 2) * (k / 2 - 1) * of.expected_cov**2
    return np.asarray(np.mean(of.relative_variance ** (k / 2), axis=0) / by_chance)


def damage_rate_by_period(
    shapes: NDArray[np.float64],
    spectra: Spectra,
    damage_rate: Callable[[NDArray[np.float64]], NDArray[np.float64]],
) -> NDArray[np.float64]:
    """Mean over the periods of the damage rate of each: (n,) [1/s], for points where modulation is what is wrong.

    ``damage_rate`` maps moments (4, n) of orders 0, 1, 2, 4 of one period to damage per second. A sum over Gaussian
    portions in the sense of Wolfsteiner (2017); short portions scatter, which adds some per cent of damage.
    """
    rates = [damage_rate(point_moments(shapes, m)) for m in moments_by_period(spectra, (0.0, 1.0, 2.0, 4.0))]
    return np.asarray(np.mean(rates, axis=0))


def _principal_scatter(
    spectra: Spectra, unit: NDArray[np.float64], taper: NDArray[np.float64], step: float
) -> NDArray[np.float64]:
    """Find matrices H_j (r, m, m) with ``sum (s' H_j s)**2`` the variance of a Gaussian process' tapered variance.

    That variance is ``2 sum over lags of overlap(lag) (s' R(lag) s)**2`` with the autocovariance R of the coordinates
    and the autocorrelation of the taper. Most of the hundreds of lags repeat each other: the few principal directions
    of the stack of matrices hold all but `NEGLIGIBLE` of its energy.
    """
    density = cross_densities(spectra)
    density *= unit

    window = hann(round(spectra.segment_s / step))
    stride = max(1, int(1 / (2.5 * spectra.upper_hz * step)))  # R**2 has twice the bandwidth of the stress
    lag = np.arange(0, min(int(LONGEST_LAG * len(window)), len(taper)), stride)
    both_signs = np.where(lag == 0, 1.0, 2.0)
    overlap = stride * both_signs * _autocorrelation(taper)[lag]
    seen = _autocorrelation(window)[lag] / np.sum(window**2)  # of R, through the taper of the spectrum
    to_lags = np.cos(2 * np.pi * np.outer(lag * step, spectra.frequency)) * spectra.weight
    stack = (np.sqrt(2 * overlap) / seen)[:, None] * to_lags @ density.reshape(len(density), -1)

    if len(stack) > stack.shape[1]:
        stack = np.asarray(np.linalg.qr(stack, mode="r"))  # the same sums of squares from as many rows as columns
    energy, direction = np.linalg.eigh(stack @ stack.T)
    first = int(np.searchsorted(np.cumsum(energy), NEGLIGIBLE * energy.sum()))
    return np.asarray((direction[:, first:].T @ stack).reshape(-1, *unit.shape))


def _period_taper(length: int, segments: int) -> NDArray[np.float64]:
    """Weight with which each squared sample enters the variance of a period; sums to 1."""
    hop = length - length // 2
    taper = np.zeros(length + (segments - 1) * hop)
    for start in segment_starts(len(taper), length):
        taper[start : start + length] += hann(length) ** 2
    return np.asarray(taper / taper.sum())


def _autocorrelation(x: NDArray[np.float64]) -> NDArray[np.float64]:
    """``sum of x(i) x(i + lag)`` for lags 0 to len(x) - 1."""
    return np.fft.irfft(np.abs(np.fft.rfft(x, 2 * len(x))) ** 2, 2 * len(x))[: len(x)]


def _chi_square_over_freedom(normal: float, freedom: NDArray[np.float64]) -> NDArray[np.float64]:
    """Quantile of chi-square over its degrees of freedom, from the normal quantile (Wilson and Hilferty, 1931)."""
    spread = 2 / (9 * freedom)
    return np.asarray(np.maximum(1 - spread + normal * np.sqrt(spread), 0) ** 3)
