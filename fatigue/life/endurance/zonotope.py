"""Independent loads that alternate: the stresses they can make are the corners of a zonotope about the static stress.

k loads v_i with signs of their own make the 2^k stresses s_0 + sum of +-v_i. Of one linear component the largest range
is 2 sum |v_i|. In a plane the largest distance of two corners is the diameter of the zonotope. It is symmetric about
s_0, so the diameter joins two opposite corners, and every corner of its hull is the sum of the v_i with the signs of
v_i . n for some direction n: sorted by angle, the v_i change their signs one after the other.
"""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Signs = NDArray[np.int8]


def corner_signs(k: int) -> Signs:
    """Signs (2^k, k) of all corners, the last load changing first.

    >>> corner_signs(2).tolist()
    [[-1, -1], [-1, 1], [1, -1], [1, 1]]
    """
    number = np.arange(2**k)[:, None]
    return ((number >> np.arange(k)[::-1] & 1) * 2 - 1).astype(np.int8)


def corners(static: Floats, loads: Floats) -> Floats:
    """Stress (n, 2^k, c) at all corners of static stress (n, c) and alternating loads (n, k, c)."""
    return np.asarray(static[:, None] + np.einsum("sk,nkc->nsc", corner_signs(loads.shape[1]).astype(float), loads))


def extremes(static: Floats, loads: Floats) -> tuple[Floats, Floats, Signs]:
    """Least and largest value (n,) of a linear component, and the signs (n, k) of the loads at the largest.

    ``static`` is (n,), ``loads`` (n, k). The least value has the opposite signs.

    >>> extremes(np.array([7.2]), np.array([[33.0, -2.4]]))
    (array([-28.2]), array([42.6]), array([[ 1, -1]], dtype=int8))
    """
    reach = np.abs(loads).sum(axis=1)
    return static - reach, static + reach, np.where(loads < 0.0, -1, 1).astype(np.int8)


def diameter(loads: Floats) -> tuple[Floats, Signs]:
    """Largest distance (n,) of two corners in a plane, and the signs (n, k) at one of them; loads are (n, k, 2).

    The other corner has the opposite signs.

    >>> length, signs = diameter(np.array([[[33.0, 0.0], [2.4, 20.0]]]))
    >>> float(length[0].round(4)), signs.tolist()
    (81.3181, [[1, 1]])
    """
    n = len(loads)
    fold = np.where((loads[..., 1] < 0.0) | ((loads[..., 1] == 0.0) & (loads[..., 0] < 0.0)), -1, 1)
    half = fold[..., None] * loads  # all within half a turn
    order = np.argsort(np.arctan2(half[..., 1], half[..., 0]), axis=1, kind="stable")
    turned = np.take_along_axis(half, order[..., None], axis=1)
    before = np.concatenate([np.zeros((n, 1, 2)), np.cumsum(turned, axis=1)[:, :-1]], axis=1)
    hull = turned.sum(axis=1)[:, None] - 2.0 * before  # corner j: the first j of them are turned round
    length = np.hypot(hull[..., 0], hull[..., 1])
    first = length.argmax(axis=1)
    place = np.argsort(order, axis=1)
    signs = np.where(place < first[:, None], -1, 1) * fold
    return 2.0 * length[np.arange(n), first], signs.astype(np.int8)
