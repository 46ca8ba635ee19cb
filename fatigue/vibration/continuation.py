"""A record continued beyond its ends as it would have gone on, so that a filter finds something there.

A record is cut out of a run: its end does not meet its start, and a transform that takes it for periodic finds a jump
there, which the square of the frequency makes large. A taper of the record itself would take its ends away. So the
record is continued by linear prediction, ``x[n] = -sum over j of a[j] x[n - j]`` with the coefficients of Burg (1975),
which never grow, and the taper lies on the continuation. A mirrored extension has no jump either, but a kink, of which
the second derivative makes a blow.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

TAPER = 0.05  # of the record, at each end
SHORTEST, LONGEST = 32, 4096  # samples of a continuation
ORDER = 16  # of the prediction: 8 lines
LEARNT_FROM = 32 * ORDER  # samples next to an end
LARGEST = 2.0  # times what was learnt from: rounding can make a prediction grow
ROUND_OFF = 1e-12  # of the power of a record: errors of the prediction below it are not learnt from


class Continued(NamedTuple):
    """Records with their continuations.

    ``x`` (..., t + 2 ahead) is tapered to zero outside the record, ``kept`` is where the record is in it.
    """

    x: Floats
    kept: slice


def continued(x: Floats) -> Continued:
    """Records (..., t) about zero, continued at either end by 5 % of their length, tapered to zero there.

    >>> t = np.arange(400)
    >>> found = continued(np.sin(0.3 * t))
    >>> found.x.shape, found.kept
    ((464,), slice(32, 432, None))
    >>> float(abs(found.x[433:437] - np.sin(0.3 * (t[-1] + np.arange(2, 6)))).max()) < 0.1
    True
    """
    samples = x.shape[-1]
    ahead = int(np.clip(TAPER * samples, SHORTEST, LONGEST))
    rows = x.reshape(-1, samples)
    taper = 0.5 + 0.5 * np.cos(np.pi * np.arange(1, ahead + 1) / (ahead + 1))
    before = _predicted(rows[:, LEARNT_FROM - 1 :: -1] if samples >= LEARNT_FROM else rows[:, ::-1], ahead) * taper
    after = _predicted(rows[:, -LEARNT_FROM:], ahead) * taper
    whole = np.concatenate([before[:, ::-1], rows, after], axis=1)
    return Continued(whole.reshape(*x.shape[:-1], -1), slice(ahead, ahead + samples))


def _predicted(x: Floats, ahead: int) -> Floats:
    """The next samples of each of some rows (m, t): (m, ahead); they bend no more sharply than the row did."""
    a = burg(x, min(ORDER, x.shape[1] // 3))
    order = a.shape[1]
    found = np.concatenate([x[:, x.shape[1] - order :], np.zeros((len(x), ahead))], axis=1)
    back, largest = a[:, ::-1], LARGEST * np.abs(x).max(axis=1)
    sharpest = np.abs(np.diff(x, 2, axis=1)).max(axis=1)
    for n in range(order, order + ahead):
        straight = 2.0 * found[:, n - 1] - found[:, n - 2]
        going_on = -np.vecdot(back, found[:, n - order : n])
        found[:, n] = np.clip(np.clip(going_on, straight - sharpest, straight + sharpest), -largest, largest)
    return found[:, order:]


def burg(x: Floats, order: int) -> Floats:
    """Coefficients a[1..order] of the linear prediction of each of some rows (m, t): (m, order); 0 of a row of zeros.

    Forward and backward errors f and b of the prediction become as small as they can together, reflection by
    reflection, ``k = -2 sum f b / sum (f^2 + b^2)``, so that no ``|k|`` exceeds 1 and no prediction grows.
    """
    f, b = x[:, 1:].astype(np.float64), x[:, :-1].astype(np.float64)
    a = np.zeros((len(x), 0))
    least = ROUND_OFF * (np.vecdot(f, f) + np.vecdot(b, b))
    for _ in range(order):
        power = np.vecdot(f, f) + np.vecdot(b, b)
        k = np.divide(-2.0 * np.vecdot(f, b), power, out=np.zeros(len(x)), where=power > least)[:, None]
        a = np.concatenate([a + k * a[:, ::-1], k], axis=1)
        f, b = (f + k * b)[:, 1:], (b + k * f)[:, :-1]
    return a
