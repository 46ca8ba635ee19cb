"""How much more a cycle can do under another law: the extremes of d'(g x) / d(x) over all ranges up to the largest.

Where of a point only its damage is known and the largest of its ranges, the damage under the new law lies between
these two multiples of it. Both laws are powers between knees, so the extremes are at knees, at the ends, or at 0.
"""

from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fatigue.life.curves import DamageLaw
from fatigue.life.rule import segment

Floats = NDArray[np.float64]


class Ratios(NamedTuple):
    """Smallest and largest multiple of the damage, of any shape; 0 and +inf where there is no bound."""

    least: Floats
    most: Floats


class _Piece(NamedTuple):
    """Damage of ranges between two knees: ``exp(slope ln x + constant)``, 0 where it ``damages`` not; (n,) each."""

    slope: Floats
    constant: Floats
    damages: NDArray[np.bool_]


def ratio_extremes(old: DamageLaw, new: DamageLaw, factor: Floats, largest: Floats) -> Ratios:
    """Extremes of ``new(factor x) / old(x)`` over 0 < x <= ``largest``, arrays (n,) of any number of points.

    Ranges that damage under neither law do not count. 1 where nothing is left.

    >>> from fatigue.life.curves import catalogue, damage_law
    >>> curve = catalogue()["master-aluminium"]
    >>> straight, haibach = (damage_law(curve, "mean", extension, 1e7) for extension in ("none", "haibach"))
    >>> found = ratio_extremes(straight, haibach, np.ones(2), np.array([10.0, 500.0]))
    >>> found.least, found.most.round(3)
    (array([0., 0.]), array([0.027, 1.   ]))
    """
    n = len(largest)
    ends = [np.zeros(n), largest]
    ends += [np.full(n, end) for end in (*old.knees, old.cutoff)]
    ends += [end / factor for end in (*new.knees, new.cutoff)]
    places = np.sort(np.clip(np.stack(ends), 0.0, largest), axis=0)
    least, most = np.full(n, np.inf), np.zeros(n)
    for low, high in pairwise(places):
        inside = np.where(low > 0.0, np.sqrt(low * high), 0.5 * high)
        a, b = _piece(old, np.ones(n), inside), _piece(new, factor, inside)
        some = (high > low) & (a.damages | b.damages)
        slope, constant = b.slope - a.slope, b.constant - a.constant
        for end in (low, high):
            with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
                ratio = np.exp(np.where(slope == 0.0, constant, slope * np.log(end) + constant))
            ratio = np.where(b.damages, np.where(a.damages, ratio, np.inf), 0.0)
            least = np.where(some, np.minimum(least, ratio), least)
            most = np.where(some, np.maximum(most, ratio), most)
    nothing = least > most
    known = np.where(np.isfinite(least), least, 0.0)  # else all of them damage under the new law alone
    return Ratios(np.where(nothing, 1.0, known), np.where(nothing, 1.0, most))


def _piece(law: DamageLaw, factor: Floats, x: Floats) -> _Piece:
    """The law of ``factor`` times a range, as it is around x."""
    j = np.zeros(len(x), dtype=np.intp) + segment(factor * x, law.knees)
    slope = law.slopes[j]
    return _Piece(slope, slope * np.log(factor) - law.log_constants[j], factor * x >= law.cutoff)
