"""Trigonometric interpolation of a long record in scratch files: shifted by parts of a sample, each shift by itself.

The value p / f of a sample behind every sample is the inverse transform of ``X[k] exp(2 pi i k p / (f n))``, with k
from -n/2 to n/2 and half the Nyquist line at either end. Two real shifts are found at a time, one in the imaginary
part.
"""

import numpy as np
from numpy.typing import NDArray

from fatigue.life.records.long_transform import AT_ONCE, Values, long_transform
from fatigue.life.records.spool import Samples, Spool

Complex = NDArray[np.complex128]


def interpolate_long(q: Samples, fine: Spool, mode: int, factor: int, period: int) -> None:
    """Write one mode of a record, interpolated ``factor`` times finer, to a file.

    ``period`` is the number of samples of the record, or that of the record and its mirror image (2 t - 2). A sample of
    the record stays as it is.

    Raises
    ------
    DataError : the disk is full
    """
    samples = q.shape[1]
    steps = samples if fine.shape[1] == samples * factor else samples - 1
    scratch = fine.path.with_name(f"{fine.path.name}-transform")

    def given(first: int, end: int) -> NDArray[np.float64]:
        """Samples of the record, and behind them of its mirror image."""
        there: NDArray[np.float64] = q[mode : mode + 1, first : min(end, samples)][0].astype(np.float64)
        if end <= samples:
            return there
        back = q[mode : mode + 1, period - end + 1 : period - max(first, samples) + 1][0].astype(np.float64)
        return np.concatenate([there, back[::-1]])

    width = max(1, AT_ONCE // factor)
    with long_transform(given, period, scratch) as spectrum:
        for shift in range(1, factor, 2):
            second = shift + 1 if shift + 1 < factor else None
            turned = _turned(spectrum, period, factor, shift, second)
            with long_transform(turned, period, scratch.with_name(f"{scratch.name}-back")) as found:
                for first in range(0, steps, width):
                    end = min(first + width, steps)
                    values = found(first, end).conj() / period
                    _put(fine, mode, slice(first * factor, end * factor), factor, shift, values.real)
                    if second is not None:
                        _put(fine, mode, slice(first * factor, end * factor), factor, second, values.imag)
    for first in range(0, samples, width):
        end = min(first + width, samples)
        own = slice(first * factor, min(end * factor, fine.shape[1]))
        _put(fine, mode, own, factor, 0, q[mode : mode + 1, first:end][0].astype(np.float64))


def _turned(spectrum: Values, period: int, factor: int, shift: int, second: int | None) -> Values:
    """Conjugate spectrum of one shift, plus i times that of a second one: the transform of a conjugate turns back."""

    def values(first: int, end: int) -> Complex:
        k = np.arange(first, end)
        bins = spectrum(first, end)
        found = bins * _phase(k, period, factor * period, shift)
        if second is not None:
            found = found + 1j * bins * _phase(k, period, factor * period, second)
        return np.asarray(found.conj())

    return values


def _phase(k: NDArray[np.int64], period: int, fine: int, shift: int) -> Complex:
    """Factor that shifts each line; the Nyquist line stands for both +f and -f."""
    turns = np.where(2 * k > period, k - period, k) * shift / fine
    return np.where(2 * k == period, np.cos(2.0 * np.pi * turns), np.exp(2j * np.pi * turns))


def _put(fine: Spool, mode: int, part: slice, factor: int, shift: int, values: NDArray[np.float64]) -> None:
    """Write every factor-th sample of a part."""
    block = np.array(fine[mode : mode + 1, part])
    block[0, shift::factor] = values
    fine[mode : mode + 1, part] = block
