"""What the histories of few points say of their paths, chunk by chunk of a record of any length."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.life.bounds.path_bound import power_integrals
from fatigue.life.records.history import Residue, cached_chunks, stress_chunks
from fatigue.life.records.spool import Samples

Floats = NDArray[np.float64]

POINTS_AT_ONCE = 64  # whose stress in a chunk takes 2 MB with 60 modes, 16 MB with few
STRESSES_AT_ONCE = 256  # in single precision
IN_DOUBT = 1e-4  # of a range in single precision


@dataclass(frozen=True, slots=True, eq=False)
class Traced:
    """Paths of k points: their length in the plane of normal stress and weighted shear, and both ranges (k,) [MPa].

    ``integrals`` (2, k) are the ``power_integrals`` of the paths about a point of that plane [MPa^3, MPa^4].
    """

    length: Floats
    normal_range: Floats
    shear_range: Floats
    integrals: Floats


def traced(weights: Floats, mean: Floats, q: Samples, residue: Residue, beta: float) -> Traced:
    """Trace the paths of k points; ``weights`` (2, k, m) are normal stress and shear per unit coordinate [MPa].

    The coordinates at ``mean`` (m,) give the point that the integrals are about. A record that recurs goes back from
    its last sample to its first one.
    """
    parts = [weights[:, first : first + POINTS_AT_ONCE] for first in range(0, weights.shape[1], POINTS_AT_ONCE)]
    found = [_traced(part, mean, q, residue, beta) for part in parts]
    return Traced(*(np.concatenate([getattr(one, name) for one in found], axis=-1) for name in Traced.__slots__))


def _traced(weights: Floats, mean: Floats, q: Samples, residue: Residue, beta: float) -> Traced:
    k, centre = weights.shape[1], (weights @ mean)[..., None]
    length, high, low = np.zeros(k), np.full((2, k), -np.inf), np.full((2, k), np.inf)
    first = last = np.empty((2, k, 0))
    integrals, scale = np.zeros((2, k)), np.array([1.0, np.sqrt(beta)])[:, None, None]
    for chunk in stress_chunks(weights.reshape(2 * k, -1), q):
        stress = chunk.reshape(2, k, -1)
        high, low = np.maximum(high, stress.max(axis=2)), np.minimum(low, stress.min(axis=2))
        path = np.concatenate([last, stress], axis=2)
        length += _length(path, beta)
        integrals += power_integrals(scale * (path - centre))
        last = stress[:, :, -1:].copy()
        first = first if first.size else stress[:, :, :1].copy()
    if residue == "repeat":
        path = np.concatenate([last, first], axis=2)
        length += _length(path, beta)
        integrals += power_integrals(scale * (path - centre))
    normal_range, shear_range = high - low
    return Traced(length, normal_range, shear_range, integrals)


def _length(path: Floats, beta: float) -> Floats:
    step = np.diff(path, axis=2)
    return np.asarray(np.sqrt(step[0] ** 2 + beta * step[1] ** 2).sum(axis=1))


def ranges(weights: Floats, q: Samples, limit: Floats) -> Floats:
    """Range (k,) of k stresses, ``weights`` (k, m) [MPa per unit coordinate].

    In single precision, but where that leaves in doubt whether a range is above its ``limit`` (k,), or is too coarse
    for a stress that is very small or very large.
    """
    reach, lost = _reach(weights, q)
    with np.errstate(over="ignore", under="ignore", invalid="ignore"):  # these are in doubt
        single = [
            _ranges(weights[first : first + STRESSES_AT_ONCE], q, np.dtype(np.float32))
            for first in range(0, len(weights), STRESSES_AT_ONCE)
        ]
        found = np.concatenate(single)
        is_clear = np.abs(found - limit) > IN_DOUBT * reach + 2.0 * lost  # of both ends
    doubt = np.flatnonzero(~is_clear)
    if doubt.size:
        found[doubt] = _ranges(weights[doubt], q, np.dtype(np.float64))
    return found


def _ranges(weights: Floats, q: Samples, precision: np.dtype[np.floating]) -> Floats:
    high, low = np.full(len(weights), -np.inf), np.full(len(weights), np.inf)
    some = weights.astype(precision)
    for chunk in cached_chunks(q):
        stress = some @ chunk.astype(precision, copy=False)
        high, low = np.maximum(high, stress.max(axis=1)), np.minimum(low, stress.min(axis=1))
    return np.asarray(high - low, dtype=np.float64)


def _reach(weights: Floats, q: Samples) -> tuple[Floats, Floats]:
    """Largest sum of the sizes of all terms of each stress (k,), and how far off it is in single precision."""
    largest = np.zeros(q.shape[0])
    for chunk in cached_chunks(q):
        largest = np.maximum(largest, np.abs(chunk).max(axis=1))
    size = np.abs(weights)
    reach = size @ largest
    with np.errstate(over="ignore", under="ignore", invalid="ignore"):
        single = size.astype(np.float32) @ largest.astype(np.float32)
        return reach, np.nan_to_num(np.abs(single - reach), nan=np.inf)
