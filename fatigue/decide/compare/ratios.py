"""Lives of matched points over each other, and what a ratio is worth where a bound stands for a count.

The damage of a screened point is an upper bound, so its life is a lower one. Whatever is one-sided in either life makes
the ratio one-sided, in the direction that the side it stands on gives it.
"""

import numpy as np
from numpy.typing import NDArray

from fatigue.decide.compare.causes import log_ratio

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]
Texts = NDArray[np.object_]

EXACT, AT_LEAST, AT_MOST, UNKNOWN = "exact", "at_least", "at_most", "unknown"


def life_ratio(life_a: Floats, life_b: Floats, bound_a: Flags, bound_b: Flags) -> tuple[Floats, Texts]:
    """``ln(life_B / life_A)`` of points (n,) and its basis; NaN where nothing is known.

    Both infinite: 0; one of them: +inf or -inf. ``bound``: the life is at least this. A bound on nothing is exact: its
    point takes no damage. ``at_most +inf`` and ``at_least -inf`` say nothing and are ``unknown``.
    """
    endless_a, endless_b = np.isinf(life_a), np.isinf(life_b)
    found = log_ratio(np.where(endless_b, 1.0, life_b), np.where(endless_a, 1.0, life_a))
    found = np.where(endless_b & ~endless_a, np.inf, found)
    found = np.where(endless_a & ~endless_b, -np.inf, found)
    bound_a, bound_b = bound_a & ~endless_a, bound_b & ~endless_b
    basis = np.full(len(found), EXACT, object)
    basis[bound_b] = AT_LEAST
    basis[bound_a] = AT_MOST
    says_nothing = (bound_a & bound_b) | (bound_a & (found == np.inf)) | (bound_b & (found == -np.inf))
    says_nothing |= np.isnan(found)
    basis[says_nothing] = UNKNOWN
    return np.where(says_nothing, np.nan, found), basis
