"""How far two right programs may differ where the points of a path are known but for rounding.

A point of the path is ``e`` off at most, a distance ``2 e``, a step ``2 e``. So the length of n steps is ``2 n e`` off,
and what they sweep about the first point 6 n e times the range. What counts as length is another matter: the path is
real where it is as far from its first point as never before. Where it turns back, rounding decides how far it was, and
which part of it gets beyond this: all that lies within ``4 e`` of that distance is in doubt.
"""

import numpy as np
from numpy.typing import NDArray

from fatigue.verify.recount.anew.rounding import LOST

Floats = NDArray[np.float64]


def walk_bounds(points: Floats, moment: float, e: float) -> tuple[float, float]:
    """Bounds on length and moment of the half cycle from the first point to the last one, of points (n, 2)."""
    seen = points - points[0]
    R, steps, doubt = float(np.hypot(*seen[-1])), len(points) - 1, in_doubt(seen, e)
    if 2.0 * e >= LOST * R:
        return np.inf, np.inf
    swept = (doubt + 6.0 * e * steps) * R
    return doubt + 2.0 * e * steps, swept / (np.pi * R**2 / 4.0) + 5.0 * e / R * moment


def in_doubt(seen: Floats, e: float) -> float:
    """Length of a path ``seen`` from its first point (n, 2) that rounding may take from its real part, or add to it.

    It turns back at a point where the next step leads no farther, but for rounding; of a step that much is in doubt
    that is as far, but for rounding, as the farthest such point before.
    """
    a, d = seen[:-1], np.diff(seen, axis=0)
    r, size = np.hypot(*a.T), np.hypot(*d.T)
    ad = (a * d).sum(axis=1)
    begin = np.divide(ad, size, out=np.zeros_like(size), where=size > 0.0)  # along the step, from its point nearest by
    nearest = r**2 - begin**2
    turns = (ad <= 2.0 * e * (r + size)) & (r >= np.maximum.accumulate(r) - 4.0 * e)
    farthest = np.maximum.accumulate(np.where(turns, r, 0.0))
    low, high = (np.sqrt(np.maximum(np.maximum(farthest + by, 0.0) ** 2 - nearest, 0.0)) for by in (-4.0 * e, 4.0 * e))
    parts = [np.minimum(begin + size, b) - np.maximum(begin, a) for a, b in ((low, high), (-high, -low))]
    return float(np.maximum(parts, 0.0).sum())
