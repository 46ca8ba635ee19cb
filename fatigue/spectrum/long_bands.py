"""Coefficients of records too long for memory in the bases of ``bands``, two records at a time, in scratch files.

Two real records x and y have one complex transform Z, of x + i y: ``X[k] = (Z[k] + conj Z[n - k]) / 2`` and ``Y[k] =
(Z[k] - conj Z[n - k]) / 2i``. The cosine basis is the transform of the even samples, followed by the odd ones from the
last one back: ``sum over j of x_j cos(pi k (2 j + 1) / 2 n) = Re(exp(-i pi k / 2 n) V[k])`` (Makhoul, 1980).
"""

from bisect import bisect_left
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.life.records.history import LONGEST_TRANSFORM, Residue
from fatigue.life.records.long_transform import Values, long_transform
from fatigue.spectrum.bands import coefficients, frequency_of

Floats = NDArray[np.float64]
Complex = NDArray[np.complex128]
Rows = Callable[[int, int], NDArray[np.floating]]  # one or two records (n, w) between two samples


def long_band_slices(samples: int, step: float, residue: Residue, edges: Sequence[float] | Floats) -> list[slice]:
    """Slices of ``bands.band_slices``, without a list of all frequencies."""

    def hz(index: int) -> float:
        return float(frequency_of(np.asarray(index), samples, step, residue))

    at = [0, *(bisect_left(range(samples), edge, key=hz) for edge in edges), samples]
    return [slice(a, b) for a, b in pairwise(at)]


@contextmanager
def long_coefficients(pair: Rows, samples: int, residue: Residue, scratch: Path) -> Iterator[Rows]:
    """Coefficients of one or two records, as a call that gives those between two places, (n, w).

    The work is done in files named like ``scratch``, see ``long_transform``, but of a record short enough in memory.

    Raises
    ------
    DataError : the disk is full
    """
    if samples <= LONGEST_TRANSFORM:
        found = coefficients(pair(0, samples), residue)
        yield lambda first, end: found[:, first:end]
        return
    rows = len(pair(0, 1))
    values = _as_complex(pair if residue == "repeat" else _even_then_odd(pair, samples))
    of_basis = _fourier if residue == "repeat" else _cosine
    with long_transform(values, samples, scratch) as bins:
        yield lambda first, end: of_basis(bins, first, end, samples)[:rows]


def _as_complex(pair: Rows) -> Values:
    """The second record as the imaginary part of the first."""

    def values(first: int, end: int) -> Complex:
        rows = pair(first, end)
        found: Complex = rows[0].astype(np.complex128)
        if len(rows) == 2:
            found.imag = rows[1]
        return found

    return values


def _even_then_odd(pair: Rows, samples: int) -> Rows:
    """Even samples ascending, behind them the odd ones descending."""
    even = (samples + 1) // 2

    def rows(first: int, end: int) -> NDArray[np.floating]:
        parts = []
        if first < even:
            parts.append(pair(2 * first, 2 * min(end, even) - 1)[:, ::2])
        if end > even:
            begin = max(first, even)
            parts.append(pair(2 * (samples - end) + 1, 2 * (samples - begin))[:, ::2][:, ::-1])
        return np.concatenate(parts, axis=1)

    return rows


def _of_both(bins: Values, first: int, end: int, samples: int) -> Complex:
    """Transforms of the two real records in one complex one, (2, bins) between two places."""
    Z = bins(first, end)
    mirror = np.empty_like(Z)  # of bin k the bin -k
    begin = max(first, 1)
    if first == 0:
        mirror[0] = Z[0]
    if begin < end:
        mirror[begin - first :] = bins(samples - end + 1, samples - begin + 1)[::-1]
    mirror = mirror.conj()
    return np.stack([0.5 * (Z + mirror), -0.5j * (Z - mirror)])


def _fourier(bins: Values, first: int, end: int, samples: int) -> Floats:
    """Coefficients in the Fourier basis, in the order and to the norm of ``bands.coefficients``."""
    begin = (first + 1) // 2
    packed = _of_both(bins, begin, end // 2 + 1, samples).view(np.float64) / np.sqrt(samples)
    place = 2 * begin + np.arange(packed.shape[1])  # Re 0, Im 0, Re 1, Im 1, ...
    packed[:, (place >= 2) & (place < (samples if samples % 2 == 0 else samples + 1))] *= np.sqrt(2.0)
    if begin == 0:
        packed[:, 1] = packed[:, 0]
    return np.asarray(packed[:, first + 1 - 2 * begin : end + 1 - 2 * begin])


def _cosine(bins: Values, first: int, end: int, samples: int) -> Floats:
    """Coefficients in the cosine basis."""
    k = np.arange(first, end)
    found = (_of_both(bins, first, end, samples) * np.exp(-0.5j * np.pi * k / samples)).real
    return np.asarray(found * np.where(k == 0, np.sqrt(1.0 / samples), np.sqrt(2.0 / samples)))
