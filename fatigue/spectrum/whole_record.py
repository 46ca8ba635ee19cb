"""What a record holds that no spectrum of it can: content slower than ten cycles per record, and steady tones.

Both are shares of the variance, so again one matrix each serves all points. For long records see ``long_record``.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.life.records.history import LONGEST_TRANSFORM, ModalHistory, mean_and_covariance
from fatigue.life.records.spool import Samples, Spool
from fatigue.spectrum.long_record import slow_and_lines
from fatigue.spectrum.taper import tapered
from fatigue.spectrum.tones import stands_out_of_neighbours

SLOWEST_HZ = 0.3
SLOWEST_CYCLES = 10.0  # per record; fewer are an event, not a spectrum
NUMBERS_AT_ONCE = 2_000_000  # of the whole record's spectra: 32 MB
UNDER_WINDOW = 8 / 3  # variance of a tone over that under the Hann window, whose mean square is 3/8
CACHED_NUMBERS = 250_000  # samples in double precision: 2 MB


@dataclass(frozen=True, slots=True, eq=False)
class RecordMatrices:
    """Covariance of the modal coordinates over a whole record and two parts of it; matrices are (m, m).

    Attributes
    ----------
    mean : (m,) time mean
    covariance : of the record, mean removed
    slow : part below ``slow_hz``
    lines : part in spectral lines, bins of the whole record's spectrum that stand out of their neighbours
    slow_hz : frequency below which the record holds too few cycles for a spectrum [Hz]
    """

    mean: NDArray[np.float64]
    covariance: NDArray[np.float64]
    slow: NDArray[np.float64]
    lines: NDArray[np.float64]
    slow_hz: float


def record_matrices(history: ModalHistory, upper_hz: float) -> RecordMatrices:
    """Covariance of the whole record and its parts; lines are looked for between the slow part and ``upper_hz`` [Hz].

    Some modes are transformed at a time, at least one, in about seven times the memory of their samples in double
    precision; a long record on disk is transformed in files beside it.
    """
    modes, samples = history.q.shape
    if isinstance(history.q, Spool) and samples > LONGEST_TRANSFORM:
        slow_hz = max(SLOWEST_HZ, SLOWEST_CYCLES / history.duration)
        mean, covariance = mean_and_covariance(history.q)
        slow_part, line_part = slow_and_lines(history.q, mean, history.step, slow_hz, upper_hz)
        return RecordMatrices(mean, covariance, slow_part, UNDER_WINDOW * line_part, slow_hz)
    frequency = np.fft.rfftfreq(samples, history.step)
    slow_hz = max(SLOWEST_HZ, SLOWEST_CYCLES / history.duration)
    slow = slice(1, max(1, int(np.searchsorted(frequency, slow_hz))))
    begin, end = np.searchsorted(frequency, [slow_hz, np.nextafter(upper_hz, np.inf)]).tolist()
    fast = slice(begin, max(begin, end))
    del frequency

    mean, covariance = mean_and_covariance(history.q)
    slowly = np.empty((modes, slow.stop - slow.start), dtype=np.complex128)  # some hundredths of the record
    stands_out = np.zeros(fast.stop - fast.start, dtype=np.bool_)
    for some in _few_modes(modes, samples):
        spectrum = _spectrum(history.q, some, mean)
        slowly[some] = spectrum[:, slow]
        amplitude = tapered(spectrum, samples, fast)
        stands_out |= stands_out_of_neighbours(amplitude.real**2 + amplitude.imag**2).any(axis=0)
    # A tapered tone reaches into the bins beside it, whether or not they stand out themselves.
    lines = stands_out.copy()
    lines[1:] |= stands_out[:-1]
    lines[:-1] |= stands_out[1:]
    return RecordMatrices(
        mean=mean,
        covariance=covariance,
        slow=_products(slowly),
        lines=_in_bins(history.q, mean, fast, np.flatnonzero(lines)),
        slow_hz=slow_hz,
    )


def _in_bins(q: Samples, mean: NDArray[np.float64], bins: slice, chosen: NDArray[np.intp]) -> NDArray[np.float64]:
    """Part of the covariance in some chosen bins of the tapered record's spectrum, a bounded number of them at a time.

    ``chosen`` counts from the first of ``bins``.
    """
    modes, samples = q.shape
    part = np.zeros((modes, modes))
    at_once = max(1, NUMBERS_AT_ONCE // modes)
    for first in range(0, len(chosen), at_once):
        now = chosen[first : first + at_once]
        amplitude = np.empty((modes, len(now)), dtype=np.complex128)
        for some in _few_modes(modes, samples):
            amplitude[some] = tapered(_spectrum(q, some, mean), samples, bins)[:, now]
        part += UNDER_WINDOW * _products(amplitude)
    return part


def _products(amplitude: NDArray[np.complex128]) -> NDArray[np.float64]:
    """Real parts of the products of all modes, summed over bins: (m, m) from (m, bins)."""
    parts = np.ascontiguousarray(amplitude).view(np.float64)
    return np.asarray(parts @ parts.T)


def _few_modes(modes: int, samples: int) -> list[slice]:
    """Slices of the modes, so few each that their records stay in the processor's cache."""
    few = max(1, CACHED_NUMBERS // samples)
    return [slice(first, first + few) for first in range(0, modes, few)]


def _spectrum(q: Samples, some: slice, mean: NDArray[np.float64]) -> NDArray[np.complex128]:
    """Spectra of some coordinates over the whole record; squared magnitudes of one sum to its variance."""
    coordinates = q[some, :].astype(np.float64)
    coordinates -= mean[some, None]
    spectrum = np.fft.rfft(coordinates, axis=1)
    spectrum *= np.sqrt(2) / coordinates.shape[1]
    return spectrum
