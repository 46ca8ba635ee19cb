"""Is a record one stationary Gaussian case: how its mean square scatters from segment to segment, kurtosis, crest.

For a stationary Gaussian record the mean square of a segment of T seconds has the variance ``(1/T)`` times the integral
of the squared one-sided density (Bendat and Piersol). A record with bursts scatters more. Reverse arrangements and runs
about the median miss bursts: they look for trends.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import fft, signal, stats

SHORTEST_SEGMENT_S = 2.0
BANDWIDTHS = 3.0  # segment times statistical bandwidth, at least: for an oscillator 3 / (2 pi zeta f)
FEWEST_SEGMENTS = 8
LEAST_DAMPING = 0.01  # of what noise comes through: a record that is narrower is a tone with a beginning and an end
ROUNDING = 1e-11  # rms below this share of the largest value is rounding, not vibration


@dataclass(frozen=True, slots=True)
class Dispersion:
    """How the mean square of a record scatters over its segments.

    Attributes
    ----------
    ratio : variance of the mean squares over that expected by chance; about 1 when stationary and Gaussian
    p : probability of a ratio at least as large by chance
    segments : how many
    segment_s : how long each is [s]
    bandwidth_hz : statistical bandwidth, (integral G)^2 / integral G^2 [Hz]
    """

    ratio: float
    p: float
    segments: int
    segment_s: float
    bandwidth_hz: float


@dataclass(frozen=True, slots=True)
class Peakedness:
    """How far a record reaches beyond its rms, its mean taken off.

    Attributes
    ----------
    kurtosis : fourth moment over the squared variance; 3 of a Gaussian record
    crest : largest absolute value over the rms
    expected_crest : of a Gaussian record as long and with as many zero up-crossings
    """

    kurtosis: float
    crest: float
    expected_crest: float


def dispersion(values: NDArray[np.float64], step: float) -> Dispersion | None:
    """Dispersion test of a record (n,), step [s]; None where it holds fewer than eight segments, or nothing vibrates.

    Segments last 2 s, or three times the reciprocal of the bandwidth. The expected variance is
    ``(2 / T) * integral from -T to T of (1 - |tau| / T) C^2(tau)``, of the autocovariance C, which is ``(1/T) integral
    G^2 df`` for long segments and right for short ones, too; C is that of the record, whose own scatter adds
    ``1 / segments``. ``(K - 1) ratio`` is chi-square with ``(K - 1) / (1 + 3 cov^2 (K - 1) / K)`` degrees: mean squares
    of narrow-band noise are skew, and their variance scatters more than that of Gaussian ones.

    A burst of one frequency makes the spectrum of a record as narrow as it is long. So no record is taken for narrower
    than an oscillator of 1 % damping at its frequency, of bandwidth ``2 pi zeta f``.
    """
    moving = signal.detrend(values)
    variance = float(np.mean(moving**2))
    if np.sqrt(variance) <= ROUNDING * np.max(np.abs(values)):
        return None
    duration = values.size * step
    longest = int(duration / FEWEST_SEGMENTS / step + 1e-9)
    if longest * step < SHORTEST_SEGMENT_S * (1 - 1e-9):
        return None
    correlation = _autocovariance(moving, longest) / variance
    bandwidth = 1 / (4 * step * (np.sum(correlation**2) - 0.5))
    narrowest = 2 * np.pi * LEAST_DAMPING * _up_crossings(moving) / duration
    size = round(max(SHORTEST_SEGMENT_S, BANDWIDTHS / max(bandwidth, narrowest)) / step)
    if size > longest:
        return None
    segments = values.size // size
    mean_square = np.mean(moving[: segments * size].reshape(segments, size) ** 2, axis=1)
    lag = np.arange(size)
    weight = np.where(lag == 0, 1.0, 2.0) * (1 - lag / size)
    squared_cov = 2 / size * float(weight @ correlation[:size] ** 2) / (1 + 1 / segments)
    if bandwidth < narrowest:
        squared_cov = min(squared_cov, _squared_cov_of_oscillator(narrowest * size * step))
    ratio = float(np.var(mean_square, ddof=1)) / (squared_cov * variance**2)
    freedom = (segments - 1) / (1 + 3 * squared_cov * (segments - 1) / segments)
    return Dispersion(ratio, float(stats.chi2.sf(freedom * ratio, freedom)), segments, size * step, float(bandwidth))


def peakedness(values: NDArray[np.float64]) -> Peakedness | None:
    """Kurtosis and crest of a record (n,), and the crest to be expected; None where nothing vibrates.

    Of n independent Gaussian peaks the largest is ``sqrt(2 ln n) + 0.577 / sqrt(2 ln n)`` on the average (Davenport,
    1964); n is the number of zero up-crossings, for either sign.
    """
    level = values - np.mean(values)
    rms = float(np.sqrt(np.mean(level**2)))
    if rms <= ROUNDING * np.max(np.abs(values)):
        return None
    reach = np.sqrt(2 * np.log(max(_up_crossings(level), 2)))
    return Peakedness(
        kurtosis=float(np.mean((level / rms) ** 4)),
        crest=float(np.max(np.abs(level))) / rms,
        expected_crest=float(reach + 0.577 / reach),
    )


def _up_crossings(values: NDArray[np.float64]) -> int:
    return int(np.count_nonzero((values[:-1] <= 0) & (values[1:] > 0)))


def _squared_cov_of_oscillator(bandwidths: float) -> float:
    """Squared coefficient of variation of the mean square of an oscillator, over a segment of so many 1 / bandwidth."""
    return float((1 - (1 - np.exp(-2 * bandwidths)) / (2 * bandwidths)) / bandwidths)


def _autocovariance(values: NDArray[np.float64], lags: int) -> NDArray[np.float64]:
    """Autocovariance at the lags 0 to ``lags`` - 1, of sums over the number of samples that overlap."""
    size = fft.next_fast_len(values.size + lags, real=True)
    sums = fft.irfft(np.abs(fft.rfft(values, size)) ** 2, size)[:lags]
    return np.asarray(sums / (values.size - np.arange(lags)))
