"""Cycles of a stress history by the ``rainflow`` package, each with its own two instants."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import rainflow
from numpy.typing import NDArray

Floats = NDArray[np.float64]

PIECES = 30  # of a record, for the scatter of its damage
_AT_ONCE = 1 << 16  # samples
_CYCLE = np.dtype([("start", np.int64), ("end", np.int64), ("count", np.float64)])


@dataclass(frozen=True, slots=True, eq=False)
class RecountCycles:
    """Sample indices of the two reversals of each cycle, and its count, 1 or 0.5."""

    start: NDArray[np.int64]
    end: NDArray[np.int64]
    count: Floats


def count_cycles(stress: Floats, *, recurs: bool) -> RecountCycles:
    """Cycles of a single pass with half cycles (ASTM E1049-85 5.4.4), of a block that recurs with whole ones (5.4.5).

    A block that recurs is turned to begin at its largest sample and closed there; what the package then leaves as two
    halves between the same two reversals is one cycle.
    """
    n = len(stress)
    first = _last_of_maximum(stress) if recurs else 0
    length = n + 1 if recurs else n
    cycles = ((i, j, count) for _, _, count, i, j in rainflow.extract_cycles(_path(stress, first, length)))
    found = np.fromiter(cycles, dtype=_CYCLE)  # a list would take ten times the memory
    found = found[stress[(found["start"] + first) % n] != stress[(found["end"] + first) % n]]
    if not len(found) and length == 2 and stress[0] != stress[-1]:
        found = np.array([(0, 1, 0.5)], dtype=_CYCLE)  # the package wants three samples
    if recurs:
        found = _halves_joined(found)
    return RecountCycles((found["start"] + first) % n, (found["end"] + first) % n, found["count"])


def in_pieces(cycles: RecountCycles, damage: Floats, samples: int) -> Floats:
    """Damage of cycles in ``PIECES`` parts of a record, half of each where it begins and half where it ends."""
    begins, ends = (np.bincount(PIECES * at // samples, damage, PIECES) for at in (cycles.start, cycles.end))
    return np.asarray(0.5 * (begins + ends), dtype=np.float64)


def _path(stress: Floats, first: int, length: int) -> Iterator[float]:
    """So many samples from one on, behind the last one the first; of order 1, for products must not underflow."""
    exponent = -int(np.frexp(max(stress.max(), -stress.min()))[1])
    for begin in range(0, length, _AT_ONCE):
        at = (first + np.arange(begin, min(begin + _AT_ONCE, length))) % len(stress)
        yield from np.ldexp(stress[at], exponent).tolist()


def _last_of_maximum(stress: Floats) -> int:
    """Index of the largest sample, the last one of its plateau."""
    at = int(np.argmax(stress))
    for _ in range(len(stress)):
        if stress[(at + 1) % len(stress)] != stress[at]:
            break
        at = (at + 1) % len(stress)
    return at


def _halves_joined(found: NDArray[np.void]) -> NDArray[np.void]:
    """Cycles with the two halves from a reversal to another and back joined."""
    halves = found[found["count"] == 0.5]
    joined = halves[::2].copy()
    assert 2 * len(joined) == len(halves)
    joined["count"] = 1.0
    return np.concatenate([found[found["count"] == 1.0], joined])
