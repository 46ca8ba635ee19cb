"""Which of two neighbouring samples is the extreme, where rounding in single precision may have decided it.

The larger one of two samples that are equal within rounding hardly matters for the range of a cycle, but its membrane
stress is the one that counts, and that of the other one may be quite different. The order of the two in double
precision is worked out for such a pair alone; then both samples are made the one that is the extreme.
"""

import numpy as np
from numpy.typing import NDArray

from fatigue.life.rainflow import compiled

Floats = NDArray[np.float64]
Numbers = NDArray[np.floating]
Pairs = NDArray[np.int64]

MOST = 4  # pairs of a surface in a chunk; a surface with more is counted again


@compiled()
def list_pairs(
    m: Numbers, b: Numbers, steps: int, samples: int, at: tuple[int, int], flat: np.float32, pairs: Pairs, found: int
) -> int:
    """Append the steps of a surface that are as small as rounding to ``pairs``, or none if they cannot be settled.

    They can be if they are few, and each between two larger steps of the samples 1 to ``samples`` or 0. ``pairs``
    (n, 3) are point, surface and first sample; returns how many there are now.
    """
    side = np.float32(1 - 2 * at[1])
    listed = found
    for i in range(steps):
        s = m[i] + side * b[i]
        ds = (m[i + 1] + side * b[i + 1]) - s
        if abs(ds) <= flat + flat * abs(s) and m[i + 1] != m[i]:
            follows = listed > found and pairs[listed - 1, 2] == i - 1
            if follows or i == 0 or i + 2 > samples or listed - found == MOST:
                return found
            pairs[listed, 0], pairs[listed, 1], pairs[listed, 2] = at[0], at[1], i
            listed += 1
    return listed


@compiled()
def directions(
    membrane: Floats, bending: Floats, q: NDArray[np.floating], scale: Floats, pairs: Pairs
) -> NDArray[np.int64]:
    """Tell in double precision whether the steps of `list_pairs` go up (1), nowhere (0) or down (-1).

    ``membrane`` and ``bending`` (n, m) are the shapes of the points for coordinates over ``scale`` (m,), ``q`` (m, t)
    the coordinates themselves, samples 1 to t.
    """
    found = np.empty(len(pairs), np.int64)
    for k in range(len(pairs)):
        row, surface, sample = pairs[k, 0], pairs[k, 1], pairs[k, 2]
        m = m_next = b = b_next = 0.0
        for mode in range(len(q)):
            w_m, w_b = membrane[row, mode] / scale[mode], bending[row, mode] / scale[mode]
            m += w_m * q[mode, sample - 1]
            b += w_b * q[mode, sample - 1]
            m_next += w_m * q[mode, sample]
            b_next += w_b * q[mode, sample]
        side = 1.0 - 2.0 * surface
        step = (m_next + side * b_next) - (m + side * b)
        found[k] = int(step > 0.0) - int(step < 0.0)
    return found


@compiled()
def settle_pair(m: Numbers, b: Numbers, side: np.float32, i: int, direction: int) -> bool:
    """Make the samples i and i + 1 of a row the one that is the extreme, given the direction of the step between them.

    Returns whether the surface turns now as it does in double precision.
    """
    rise_before = (m[i] + side * b[i]) - (m[i - 1] + side * b[i - 1])
    rise_after = (m[i + 2] + side * b[i + 2]) - (m[i + 1] + side * b[i + 1])
    goes_on = direction == 0 or (direction > 0) == (rise_before > 0)  # a plateau turns at its last sample
    turns = rise_before * rise_after < 0
    if turns and not goes_on:
        m[i + 1], b[i + 1] = m[i], b[i]
    else:
        m[i], b[i] = m[i + 1], b[i + 1]
    return bool(turns or (goes_on and rise_before * rise_after > 0))
