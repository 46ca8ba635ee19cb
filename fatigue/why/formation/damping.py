"""Damping ratios of the modes: their own, else the one that was assumed for all others, else none."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.readers.neutral.body.modes import Modes

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Damping:
    """Damping of the modes.

    Attributes
    ----------
    ratio : (m,) damping ratio, NaN where there is none
    source : (m,) ``modes``, ``assumed`` or nothing
    assumed : what was given for modes without their own; None: nothing
    """

    ratio: Floats
    source: NDArray[np.object_]
    assumed: float | None

    @property
    def used(self) -> Floats:
        """Ratio in the dynamic stiffness: 0 where there is none, which only resonance can tell from a small one."""
        return np.nan_to_num(self.ratio)


def damping_of(modes: Modes, assumed: float | None) -> Damping:
    """Damping of the modes of a body, ``assumed`` for those whose table has none."""
    own = modes.damping_ratio
    given = np.isfinite(own)
    ratio = own if assumed is None else np.where(given, own, assumed)
    source = np.full(len(own), None if assumed is None else "assumed", dtype=object)
    source[given] = "modes"
    return Damping(np.asarray(ratio, np.float64), source, assumed)
