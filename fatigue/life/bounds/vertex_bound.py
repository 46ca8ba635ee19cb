"""Bounds for histories whose reversals are read at their vertices, from bounds for the samples.

A vertex lies at most an eighth of the larger step beside it beyond its sample (``fatigue.life.counting.vertex``), so
the range grows by a quarter of itself at most. For ``f(s) = s |s|^(q-1)`` let

    rho_q = largest of (f(x + 1/8) - f(x)) / (f(x) - f(x - 1))     over all x.

By it, with the larger step as the unit, a reversal moves f by no more than ``rho_q`` times what f changes over that
step. Each move changes two steps of f(s), and a step is the larger one of two reversals at most. Hence

    TV(f(vertices)) <= (1 + 4 rho_q) TV(f(samples)),

and what bounds ``sum n S^q`` of the samples by TV (``screening``) bounds it for the vertices times ``1 + 4 rho_q``.
"""

from functools import cache

import numpy as np
from numpy.typing import NDArray

from fatigue.life.bounds.screening import PowerSums

Floats = NDArray[np.float64]

BEYOND = 1.0 / 8.0  # of the larger step
_SPACING = 1e-4  # of the x that are tried
_ABOVE = 1.001  # what lies between them is smaller than that


def vertex_bound(stress_range: Floats, power_sums: PowerSums) -> tuple[Floats, PowerSums]:
    """Bounds of range and sums n S^q at vertices, from those by the total variation of the samples, arrays alike."""
    return (1.0 + 2.0 * BEYOND) * stress_range, {q: growth(q) * power_sum for q, power_sum in power_sums.items()}


@cache
def growth(q: int) -> float:
    """Bound of TV(f(vertices)) over TV(f(samples)) for the power q, at least 1.

    >>> [round(growth(q), 2) for q in (1, 2, 3, 4)]
    [1.5, 2.32, 3.41, 4.81]
    """
    x = np.arange(-2.0, 3.0, _SPACING)
    after, here, before = (s * np.abs(s) ** (q - 1) for s in (x + BEYOND, x, x - 1.0))
    largest = float(((after - here) / (here - before)).max())
    return 1.0 + 4.0 * largest * (1.0 if q == 1 else _ABOVE)
