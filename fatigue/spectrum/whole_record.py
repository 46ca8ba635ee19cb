"""What a record holds that no spectrum of it can: content slower than ten cycles per record, and steady tones.

Both are shares of the variance, so again one matrix each serves all points.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.life.history import ModalHistory, mean_and_covariance
from fatigue.life.spool import Samples
from fatigue.spectrum.moments import hann

SLOWEST_HZ = 0.3
SLOWEST_CYCLES = 10.0  # per record; fewer are an event, not a spectrum
LINE_OVER_MEDIAN = 20.0  # one bin of noise in a million stands out so far
NUMBERS_AT_ONCE = 2_000_000  # of the whole record's spectra: 32 MB
LINE_BLOCK = 16  # bins of a local median: narrow against resonances, wide against the four bins of a tapered tone


@dataclass(frozen=True, slots=True, eq=False)
class RecordMatrices:
    """Covariance of the modal coordinates over a whole record and two parts of it; matrices are (m, m).

    Attributes
    ----------
    covariance : of the record, mean removed
    slow : part below ``slow_hz``
    lines : part in spectral lines, bins of the whole record's spectrum that stand out of their neighbours
    slow_hz : frequency below which the record holds too few cycles for a spectrum [Hz]
    """

    covariance: NDArray[np.float64]
    slow: NDArray[np.float64]
    lines: NDArray[np.float64]
    slow_hz: float


def record_matrices(history: ModalHistory, upper_hz: float) -> RecordMatrices:
    """Split the covariance of the whole record; lines are looked for between the slow part and ``upper_hz`` [Hz].

    One mode is transformed at a time, in about seven times the memory of its samples in double precision.
    """
    samples = history.q.shape[1]
    frequency = np.fft.rfftfreq(samples, history.step)
    slow_hz = max(SLOWEST_HZ, SLOWEST_CYCLES / history.duration)
    slow = np.flatnonzero((frequency > 0) & (frequency < slow_hz))
    fast = slice(*np.searchsorted(frequency, [slow_hz, np.nextafter(upper_hz, np.inf)]).tolist())
    del frequency

    taper = hann(samples)
    stands_out = np.zeros(max(0, fast.stop - fast.start), dtype=np.bool_)
    for mode in range(history.q.shape[0]):
        stands_out |= _stands_out(np.abs(_line_amplitudes(history.q, mode, taper)[fast]) ** 2)
    lines = fast.start + np.flatnonzero(stands_out)
    # A tapered tone reaches into the bins beside it, whether or not they stand out themselves.
    beside = np.unique(lines[:, None] + np.arange(-1, 2))
    beside = beside[(beside >= fast.start) & (beside < fast.stop)]
    return RecordMatrices(
        covariance=mean_and_covariance(history.q)[1],
        slow=_part(history.q, np.ones(samples), slow),
        lines=_part(history.q, taper, beside),
        slow_hz=slow_hz,
    )


def _part(q: Samples, taper: NDArray[np.float64], bins: NDArray[np.intp]) -> NDArray[np.float64]:
    """Part of the covariance in some bins of the whole record's spectrum, a bounded number of them at a time."""
    modes = q.shape[0]
    part = np.zeros((modes, modes))
    at_once = max(1, NUMBERS_AT_ONCE // modes)
    for first in range(0, len(bins), at_once):
        some = bins[first : first + at_once]
        amplitude = np.stack([_line_amplitudes(q, mode, taper)[some] for mode in range(modes)])
        part += (amplitude @ amplitude.conj().T).real
    return part


def _line_amplitudes(q: Samples, mode: int, taper: NDArray[np.float64]) -> NDArray[np.complex128]:
    """Spectrum of one coordinate over the whole record; squared magnitudes sum to its variance."""
    coordinate = q[mode : mode + 1, :][0]
    centred = (coordinate - coordinate.mean(dtype=np.float64)) * taper
    spectrum = np.fft.rfft(centred)
    spectrum *= np.sqrt(2 / (len(taper) * np.sum(taper**2)))
    return spectrum


def _stands_out(power: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Bins far above the medians of their block and of those beside it, so that the edge of a band is no tone."""
    blocks = len(power) // LINE_BLOCK
    if blocks == 0:
        return np.zeros(len(power), dtype=np.bool_)
    median = np.pad(np.median(power[: blocks * LINE_BLOCK].reshape(blocks, LINE_BLOCK), axis=1), 1, mode="edge")
    around = np.maximum(np.maximum(median[:-2], median[1:-1]), median[2:])
    block = np.minimum(np.arange(len(power)) // LINE_BLOCK, blocks - 1)  # the last, incomplete one joins its neighbour
    return np.asarray(power > LINE_OVER_MEDIAN * around[block])
