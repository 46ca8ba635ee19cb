"""Chunks of a long record in which each reversal is replaced by its vertex, see ``fatigue.life.counting.vertex``."""

from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import NDArray

from fatigue.life.counting.vertex import move, shifts

Floats = NDArray[np.float64]
Stresses = tuple[Floats, Floats]


def moved(
    chunks: Callable[[], Iterator[tuple[Floats, ...]]], side: float, *, recurs: bool
) -> Callable[[], Iterator[tuple[Floats, ...]]]:
    """Chunks of membrane and bending stress with the reversals of ``membrane + side * bending`` at their vertices.

    The shifts come with them. One sample is held back until its neighbour is there; of a record that recurs the last
    one is the neighbour of the first.
    """

    def vertices() -> Iterator[tuple[Floats, ...]]:
        first = last = np.zeros((2, 0))
        if recurs:
            first, last = _ends(chunks)
        before = last  # (2, 0 or 1), or none
        held = np.zeros((2, 0))
        for chunk in chunks():
            x = np.concatenate([before, held, np.stack(chunk[:2])], axis=1)
            yield from _inner(x, side, begin=before.shape[1])
            if x.shape[1] > 1:
                before, held = x[:, -2:-1], x[:, -1:]
            else:
                held = x
        yield from _last(np.concatenate([before, held, first], axis=1), side, held=held.shape[1], ends=recurs)

    return vertices


def _inner(x: Floats, side: float, begin: int) -> Iterator[tuple[Floats, ...]]:
    """Samples of x (2, t) from ``begin`` on, the last one held back."""
    if x.shape[1] - 1 > begin:
        yield tuple(part[begin:-1] for part in _moved(x, side))


def _last(x: Floats, side: float, held: int, *, ends: bool) -> Iterator[tuple[Floats, ...]]:
    """The sample that is held back, behind which the first one follows, or nothing."""
    if held:
        at = -2 if ends else -1
        yield tuple(part[at : x.shape[1] + at + 1] for part in _moved(x, side))


def _moved(x: Floats, side: float) -> tuple[Floats, ...]:
    """Membrane, bending and shifts of some samples (2, t), those at both ends where they are."""
    membrane, bending = np.ascontiguousarray(x)
    found = np.empty((3, x.shape[1]))
    shifts(membrane + side * bending, False, found[2])
    move(membrane, found[2], found[0])
    move(bending, found[2], found[1])
    return found[0], found[1], found[2]


def _ends(chunks: Callable[[], Iterator[tuple[Floats, ...]]]) -> tuple[Floats, Floats]:
    """First and last sample, (2, 1) each."""
    first = last = np.zeros((2, 0))
    for chunk in chunks():
        x = np.stack(chunk[:2])
        if x.shape[1]:
            first, last = first if first.size else x[:, :1].copy(), x[:, -1:].copy()
    return first, last
