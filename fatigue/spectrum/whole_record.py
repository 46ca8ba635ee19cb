"""What a record holds that no spectrum of it can: content slower than ten cycles per record, and steady tones.

Both are shares of the variance, so again one matrix each serves all points.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.life.history import ModalHistory
from fatigue.spectrum.moments import hann

SLOWEST_HZ = 0.3
SLOWEST_CYCLES = 10.0  # per record; fewer are an event, not a spectrum
LINE_OVER_MEDIAN = 20.0  # one bin of noise in a million stands out so far
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
    """Split the covariance of the whole record; lines are looked for between the slow part and ``upper_hz`` [Hz]."""
    samples = history.q.shape[1]
    frequency = np.fft.rfftfreq(samples, history.step)
    slow_hz = max(SLOWEST_HZ, SLOWEST_CYCLES / history.duration)
    slow = (frequency > 0) & (frequency < slow_hz)
    fast = (frequency >= slow_hz) & (frequency <= upper_hz)

    no_taper, taper = np.ones(samples), hann(samples)
    slow_part = np.stack([_line_amplitudes(q, no_taper)[slow] for q in history.q])
    stands_out = np.zeros(np.count_nonzero(fast), dtype=np.bool_)
    for q in history.q:
        stands_out |= _stands_out(np.abs(_line_amplitudes(q, taper)[fast]) ** 2)
    lines = np.flatnonzero(fast)[stands_out]
    # A tapered tone reaches into the bins beside it, whether or not they stand out themselves.
    beside = np.intersect1d(np.unique(lines[:, None] + np.arange(-1, 2)), np.flatnonzero(fast))
    line_part = np.stack([_line_amplitudes(q, taper)[beside] for q in history.q])

    centred = history.q.astype(np.float64)
    centred -= centred.mean(axis=1, keepdims=True)
    return RecordMatrices(
        covariance=centred @ centred.T / samples,
        slow=(slow_part @ slow_part.conj().T).real,
        lines=(line_part @ line_part.conj().T).real,
        slow_hz=slow_hz,
    )


def _line_amplitudes(q: NDArray[np.floating], taper: NDArray[np.float64]) -> NDArray[np.complex128]:
    """Spectrum of one coordinate over the whole record; squared magnitudes sum to its variance."""
    centred = (q - q.mean(dtype=np.float64)) * taper
    return np.asarray(np.fft.rfft(centred) * np.sqrt(2 / (len(q) * np.sum(taper**2))))


def _stands_out(power: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Bins far above the medians of their block and of those beside it, so that the edge of a band is no tone."""
    blocks = len(power) // LINE_BLOCK
    if blocks == 0:
        return np.zeros(len(power), dtype=np.bool_)
    median = np.pad(np.median(power[: blocks * LINE_BLOCK].reshape(blocks, LINE_BLOCK), axis=1), 1, mode="edge")
    around = np.maximum(np.maximum(median[:-2], median[1:-1]), median[2:])
    block = np.minimum(np.arange(len(power)) // LINE_BLOCK, blocks - 1)  # the last, incomplete one joins its neighbour
    return np.asarray(power > LINE_OVER_MEDIAN * around[block])
