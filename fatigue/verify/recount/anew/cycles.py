"""Cycles of a stress history by the ``rainflow`` package, each with its own two instants."""

from dataclasses import dataclass

import numpy as np
import rainflow
from numpy.typing import NDArray

Floats = NDArray[np.float64]


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
    stress = np.ldexp(stress, -int(np.frexp(np.abs(stress).max())[1]))  # products of differences must not underflow
    first = _last_of_maximum(stress) if recurs else 0
    path = np.append(np.roll(stress, -first), stress[first]) if recurs else stress
    found = [[i, j, count] for _, _, count, i, j in rainflow.extract_cycles(path) if path[i] != path[j]]
    if not found and len(path) == 2 and path[0] != path[1]:
        found = [[0, 1, 0.5]]  # the package wants three samples
    if recurs:
        found = _halves_joined(found, path)
    table = np.array(found, dtype=float).reshape(-1, 3)
    start, end = ((table[:, k].astype(np.int64) + first) % n for k in (0, 1))
    return RecountCycles(start, end, table[:, 2])


def _last_of_maximum(stress: Floats) -> int:
    """Index of the largest sample, the last one of its plateau."""
    at = int(np.argmax(stress))
    for _ in range(len(stress)):
        if stress[(at + 1) % len(stress)] != stress[at]:
            break
        at = (at + 1) % len(stress)
    return at


def _halves_joined(found: list[list[float]], path: Floats) -> list[list[float]]:
    """Cycles with the two halves from a reversal to another and back joined."""
    halves = [cycle for cycle in found if cycle[2] == 0.5]
    there, back = halves[::2], halves[1::2]
    joined = [[a[0], a[1], 1.0] for a in there]
    assert len(there) == len(back)
    return [cycle for cycle in found if cycle[2] == 1.0] + joined
