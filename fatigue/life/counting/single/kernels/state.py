"""What is known between two chunks of time, and its work space, in forms that compiled code can read."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Numbers = NDArray[np.floating]  # single precision, or double where a surface is counted again

PAD = 32  # room behind a row for vector instructions that read and write more than they keep

SIDE = np.dtype(
    [
        *((name, np.bool_) for name in ("wanted", "doubtful", "crowded")),
        *((name, np.int64) for name in ("first_up", "up", "waiting", "kept")),
        *((name, np.float64) for name in ("mean", "plateau_m", "maximum", "minimum", "largest")),
        *((name, np.float64) for name in ("cycles", "power_sum", "damage", "second", "fourth")),
    ],
    align=True,
)
"""What is known of one surface of a point.

``wanted``: to be counted; ``doubtful``: rounding may have decided, nothing else is of use; ``crowded``: there was no
room for all that waits. ``first_up`` and ``up`` are the directions of the first step and of the last one, -1 before
there is any; ``waiting`` reversals have not closed a cycle, and ``kept`` are the residue of the record. ``mean`` is the
mean of the normalised stress, 0 in single precision; ``plateau_m`` the membrane stress before the first step. The rest
are the sums and extremes of ``BlockCount``, for normalised stress.
"""


class State(NamedTuple):
    """What is known of n points; few arrays, because compiled code counts the references to each at every call.

    ``sides`` (n, 2) of type ``SIDE``; ``ends`` (n, 2, 2) the first sample and the last one so far, membrane and
    bending; ``waiting`` (n, 2, 2, r) the reversals of the surface that wait, and their membrane part. ``residue``
    (n, 2, 2, r) the stresses of the residue in the end, and their membrane part; r is 0 where it is not wanted.
    """

    sides: NDArray[np.void]
    ends: Numbers
    waiting: Numbers
    residue: Numbers


class Stage(NamedTuple):
    """Where in the record a chunk is, whether the record recurs, and up to what difference rounding may decide."""

    begins: bool
    ends: bool
    recurs: bool
    flat: np.float32


class Room(NamedTuple):
    """Work space of one surface.

    The rows of ``numbers`` (6, w) are signed reversals and their membrane part, the ranges of full cycles and their
    membrane part, the ranges of half cycles; ``marks`` (2, w) are directions and places of reversals.
    """

    numbers: Numbers
    marks: NDArray[np.int32]


def fresh_state(points: int, residue: int, precision: type[np.floating], kept: int = 0) -> State:
    """Nothing counted yet, every surface wanted, with room for the ``residue`` that waits and the one that is kept."""
    sides = np.zeros((points, 2), SIDE)
    sides["wanted"] = True
    sides["up"] = sides["first_up"] = -1
    ends, rows = np.empty((points, 2, 2), precision), (points, 2, 2)
    return State(sides, ends, np.empty((*rows, residue), precision), np.zeros((*rows, kept), precision))


def room_for(width: int, residue: int, precision: type[np.floating]) -> Room:
    """Work space for the samples of a chunk and the reversals that waited for it."""
    width += residue + PAD
    return Room(np.empty((6, width), precision), np.empty((2, width), np.int32))
