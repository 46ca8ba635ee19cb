"""Reversals read at the vertex of the parabola through their three samples: ``reversals = "vertex"``.

A peak falls between samples. The parabola through a sample that is larger than both of its neighbours, and through
these, has its vertex within half a step of it::

    p = (s_before - s_after) / (2 (s_before - 2 s + s_after))         -1/2 < p < 1/2, in steps from the sample
    s(p) = s + p (s_after - s_before) / 2 + p^2 (s_before - 2 s + s_after) / 2

Membrane and bending stress are read on their own parabolas at the same instant p, so that they still add up to s. With
a and b the steps to both neighbours, the vertex lies ``(a - b)^2 / (8 (a + b))`` beyond the sample, at most an eighth
of the larger one. Peaks rise and valleys fall: the reversals are those of the samples, and their order stays. What has
no neighbour on one side, the ends of a single pass, stays where it is, and so does a plateau, whose peak is known. Of a
record that recurs the first and the last sample are neighbours.

``shifts`` (t,) of a history are p, 0 where nothing moves. A history in which each reversal is replaced by its vertex is
counted like any other. The three samples have the parts ``p (p - 1) / 2``, ``1 - p^2``, ``p (p + 1) / 2`` in a vertex.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fatigue.compiled import compiled

Floats = NDArray[np.float64]


class VertexHistory(NamedTuple):
    """Membrane and bending stress (t,), each reversal replaced by its vertex, and the ``shifts`` (t,) in steps."""

    membrane: Floats
    bending: Floats
    shift: Floats


def vertex_history(membrane: Floats, bending: Floats, side: float, *, recurs: bool) -> VertexHistory:
    """Histories (t,) in which each reversal of ``membrane + side * bending`` is replaced by its vertex.

    Whoever wants the reversals of a point as they are counted (structural, membrane and bending stress) finds them in
    these histories, at the same samples as before.
    """
    moved = VertexHistory(membrane.copy(), bending.copy(), np.zeros(len(membrane)))
    shifts(membrane + side * bending, recurs, moved.shift)
    move(np.ascontiguousarray(membrane), moved.shift, moved.membrane)
    move(np.ascontiguousarray(bending), moved.shift, moved.bending)
    return moved


def spread(laid: Floats, shift: Floats) -> Floats:
    """Lay what is laid on reversals (t,) on the samples they are read from: the transpose of replacing them."""
    before, after = 0.5 * shift * (shift - 1.0), 0.5 * shift * (shift + 1.0)
    on_samples = laid * (1.0 - shift**2)
    on_samples += np.roll(laid * before, -1) + np.roll(laid * after, 1)  # ends that have no neighbour do not move
    return np.asarray(on_samples)


@compiled()
def shift_of(before: float, s: float, after: float) -> float:
    """Where the vertex lies, in steps from the sample in the middle; 0 of what is no peak or valley of one sample."""
    if not ((s > before and s > after) or (s < before and s < after)):
        return 0.0
    down, up = s - before, s - after  # of one sign
    return 0.5 * (down - up) / (down + up)


@compiled()
def at_shift(before: float, x: float, after: float, p: float) -> float:
    """Value of the parabola through three samples, p steps from the one in the middle."""
    return x + 0.5 * p * (after - before) + 0.5 * p * p * ((before - x) + (after - x))


@compiled()
def shifts(s: Floats, recurs: bool, shift: Floats) -> None:
    """Write the shifts of the reversals of s (t,)."""
    t = s.size
    for i in range(t):
        if recurs or 0 < i < t - 1:
            shift[i] = shift_of(s[i - 1], s[i], s[(i + 1) % t])
        else:
            shift[i] = 0.0


@compiled()
def move(x: Floats, shift: Floats, moved: Floats) -> None:
    """Write x (t,) at the shifted instants."""
    t = x.size
    for i in range(t):
        moved[i] = x[i] if shift[i] == 0.0 else at_shift(x[i - 1], x[i], x[(i + 1) % t], shift[i])
