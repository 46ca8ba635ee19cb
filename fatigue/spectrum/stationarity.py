"""Is the event one stationary Gaussian case? The scatter of its variance over time against the scatter chance allows."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.life.history import ModalHistory
from fatigue.spectrum.moments import (
    Spectra,
    hann,
    moment_matrices,
    quadratic_forms,
    samples_per_segment,
    segment_spectra,
    segment_starts,
)

MOST_PERIODS = 32  # periods into which a long record is cut; more would cost time and tell no more
LONGEST_LAG = 0.4  # of the segment behind an autocovariance: beyond, the taper leaves too little of it
NEGLIGIBLE = 1e-4  # part of the scatter that the principal spectra may miss


@dataclass(frozen=True, slots=True, eq=False)
class PeriodMatrices:
    """The variance of modal coordinates period by period, and the scatter to be expected of it.

    A period is one segment of the spectrum, or some consecutive ones in a long record. The variance of a point's stress
    in period j is ``s' variance[j] s``. Were q stationary and Gaussian, it would scatter from period to period with the
    squared coefficient of variation ``sum over j of (s' scatter[j] s)**2 / (s' mean_variance s)**2``.

    Attributes
    ----------
    variance : (p, m, m)
    mean_variance : (m, m)
    scatter : (r, m, m) principal spectra
    period_s : effective length of a period under its taper [s]
    segments : segments of the spectrum in each period
    """

    variance: NDArray[np.float64]
    mean_variance: NDArray[np.float64]
    scatter: NDArray[np.float64]
    period_s: float
    segments: int


def period_matrices(history: ModalHistory, spectra: Spectra) -> PeriodMatrices:
    segments = -(-len(spectra.amplitude) // MOST_PERIODS)
    starts = range(0, len(spectra.amplitude) - segments + 1, segments)
    variance = np.stack([_variance(spectra, slice(i, i + segments)) for i in starts])

    long = segment_spectra(history, 2 * spectra.segment_s, spectra.upper_hz)
    mean_variance = moment_matrices(long, (0,)).matrix[0]
    density = np.matmul(long.amplitude.conj().transpose(1, 2, 0), long.amplitude.transpose(1, 0, 2)).real
    density /= len(long.amplitude)

    taper = _period_taper(samples_per_segment(history.step, spectra.segment_s), segments)
    window = hann(samples_per_segment(history.step, long.segment_s))
    stride = max(1, int(1 / (2.5 * long.upper_hz * history.step)))
    lag = np.arange(0, int(LONGEST_LAG * len(window)), stride)
    overlap = _autocorrelation(taper)
    overlap = np.pad(overlap, (0, max(0, lag[-1] + 1 - len(overlap))))[lag]
    seen = _autocorrelation(window)[lag] / np.sum(window**2)
    weight = 2.0 * stride * np.where(lag == 0, 1.0, 2.0) * overlap / seen**2
    to_lags = np.cos(2 * np.pi * np.outer(lag * history.step, long.frequency)) * long.weight
    rms = np.sqrt(np.diag(mean_variance))
    rms[rms == 0] = 1.0
    scaled = density / np.outer(rms, rms)
    rows = (np.sqrt(weight)[:, None] * to_lags) @ scaled.reshape(len(scaled), -1)
    energy, direction = np.linalg.eigh(rows @ rows.T)
    tail = np.cumsum(energy)
    first = int(np.searchsorted(tail, NEGLIGIBLE * tail[-1]))
    scatter = (direction[:, first:].T @ rows).reshape(-1, *mean_variance.shape) * np.outer(rms, rms)
    period_s = history.step / np.sum(taper**2)
    scatter /= np.sqrt(1 + period_s / history.duration)
    return PeriodMatrices(variance, mean_variance, scatter, float(period_s), segments)


def _variance(spectra: Spectra, segments: slice) -> NDArray[np.float64]:
    rows = (spectra.amplitude[segments] * np.sqrt(spectra.weight)[:, None]).reshape(-1, spectra.amplitude.shape[2])
    return np.asarray((rows.conj().T @ rows).real / (segments.stop - segments.start))


def _period_taper(length: int, segments: int):
    starts = segment_starts(length + (segments - 1) * (length - length // 2), length)
    taper = np.zeros(starts[-1] + length)
    for start in starts:
        taper[start : start + length] += hann(length) ** 2
    return taper / taper.sum()


def _autocorrelation(x):
    n = len(x)
    return np.fft.irfft(np.abs(np.fft.rfft(x, 2 * n)) ** 2)[:n]
