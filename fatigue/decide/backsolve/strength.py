"""Points under another load, curve or plate thickness: what each does to their stresses and the size factor.

A plate of x times the thickness under the same nodal forces has 1/x of the membrane and 1/x^2 of the bending stress;
its size factor follows from the rule of its curve. A curve with x times the ranges, its knees at the same numbers of
cycles, is a range over x. A load of 1/x is stress over x, also where the mean stress counts.
"""

from collections.abc import Callable
from dataclasses import replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from fatigue.why.points import Points

Floats = NDArray[np.float64]
SizeOf = Callable[[Floats], Floats]
Kind = Literal["load", "curve", "thickness"]


def under(points: Points, kind: Kind, x: Floats, size_of: SizeOf | None = None) -> Points:
    """Points with ``x`` (p,) times their strength; ``size_of`` is their size factor at ``x`` times their thickness."""
    if kind == "curve":
        return replace(points, size=points.size / x)
    if kind == "load":
        return replace(points, membrane=points.membrane / x[:, None], bending=points.bending / x[:, None])
    assert size_of is not None
    membrane, bending = points.membrane / x[:, None], points.bending / (x * x)[:, None]
    return replace(points, membrane=membrane, bending=bending, size=size_of(x))
