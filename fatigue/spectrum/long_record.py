"""Slow content and steady tones of a long record on disk: one mode at a time, its transform in a scratch file.

The transform wants a length with a factor: the last samples, fewer than ``ROWS`` of more than a million, are left out.
"""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.life.records.long_transform import ROWS, Values, long_transform
from fatigue.life.records.spool import Spool
from fatigue.spectrum.tones import LINE_BLOCK, stands_out_of_neighbours

Floats = NDArray[np.float64]
Complex = NDArray[np.complex128]

BLOCKS_AT_ONCE = 1 << 14  # of bins whose medians are compared: 4 MB of them, some times over
CHOSEN_AT_ONCE = 1_000_000  # numbers in bins of tones: 16 MB


def slow_and_lines(q: Spool, mean: Floats, step: float, slow_hz: float, upper_hz: float) -> tuple[Floats, Floats]:
    """Products of all modes (m, m) below ``slow_hz``, and those in lines up to ``upper_hz`` under the Hann window."""
    modes = q.shape[0]
    samples = q.shape[1] - q.shape[1] % ROWS
    begin, end = (int(np.ceil(f * samples * step)) for f in (slow_hz, np.nextafter(upper_hz, np.inf)))
    end = max(begin, min(end, samples // 2 + 1))
    slowly = np.empty((modes, begin - 1), dtype=np.complex128)
    stands_out = np.zeros(end - begin, dtype=np.bool_)
    for mode in range(modes):
        with long_transform(_centred(q, mode, mean), samples, _scratch(q)) as bins:
            slowly[mode] = _scaled(bins, 1, begin, samples)
            for first, last, inner in _pieces(end - begin):
                amplitude = _tapered(bins, begin + first, begin + last, samples)
                found = stands_out_of_neighbours((amplitude.real**2 + amplitude.imag**2)[None])[0]
                stands_out[first + inner.start : first + inner.stop] |= found[inner]
    lines = stands_out.copy()  # a tapered tone reaches into the bins beside it
    lines[1:] |= stands_out[:-1]
    lines[:-1] |= stands_out[1:]
    chosen = begin + np.flatnonzero(lines)

    of_lines = np.zeros((modes, modes))
    at_once = max(1, CHOSEN_AT_ONCE // modes)
    for start in range(0, len(chosen), at_once):
        now = chosen[start : start + at_once]
        amplitudes = np.empty((modes, len(now)), dtype=np.complex128)
        for mode in range(modes):
            with long_transform(_centred(q, mode, mean), samples, _scratch(q)) as bins:
                amplitudes[mode] = _in_bins(bins, now, samples)
        of_lines += _products(amplitudes)
    return _products(slowly), of_lines


def _centred(q: Spool, mode: int, mean: Floats) -> Values:
    return lambda first, end: q[mode : mode + 1, first:end][0] - mean[mode]


def _scratch(q: Spool) -> Path:
    return q.path.with_name(f"{q.path.name}-transform")


def _scaled(bins: Values, first: int, end: int, samples: int) -> Complex:
    """Bins of a transform; squared magnitudes of all positive ones sum to the variance."""
    return np.asarray(bins(first, end) * (np.sqrt(2) / samples))


def _tapered(bins: Values, first: int, end: int, samples: int) -> Complex:
    """Bins of the transform under the Hann window, from those without it; see ``taper``."""
    around = _scaled(bins, first - 1, end + 1, samples)
    return np.asarray(0.5 * (around[1:-1] - 0.5 * (around[:-2] + around[2:])))


def _pieces(bins: int) -> Iterator[tuple[int, int, slice]]:
    """Cut bins into pieces of blocks, each with a block more on either side; and which of its bins are its own.

    The bins behind the last whole block belong to it.
    """
    blocks = bins // LINE_BLOCK
    for block in range(0, blocks, BLOCKS_AT_ONCE):
        before = max(0, block - 1)
        own_end, last = min(blocks, block + BLOCKS_AT_ONCE), min(blocks, block + BLOCKS_AT_ONCE + 1)
        end = bins if last == blocks else LINE_BLOCK * last
        own = bins if own_end == blocks else LINE_BLOCK * own_end
        yield LINE_BLOCK * before, end, slice(LINE_BLOCK * (block - before), own - LINE_BLOCK * before)


def _in_bins(bins: Values, chosen: NDArray[np.intp], samples: int) -> Complex:
    """Bins of the transform under the window that are chosen, ascending; neighbours are read together."""
    found = np.empty(len(chosen), dtype=np.complex128)
    width = LINE_BLOCK * BLOCKS_AT_ONCE
    for piece in np.unique(chosen // width):
        a, b = np.searchsorted(chosen, [piece * width, (piece + 1) * width])
        few = chosen[a:b]
        found[a:b] = _tapered(bins, int(few[0]), int(few[-1]) + 1, samples)[few - few[0]]
    return found


def _products(amplitude: Complex) -> Floats:
    """Real parts of the products of all modes, summed over bins: (m, m) from (m, bins)."""
    parts = np.ascontiguousarray(amplitude).view(np.float64)
    return np.asarray(parts @ parts.T)
