"""Scatter of the strength: how far specimens lie from the mean curve, and where the headline curve is among them.

A strength z, in standard deviations of ln N, is a curve: 0 the mean curve, -2 mean-2sigma. Knees stay at their number
of cycles, so that every z is the same curve on ranges times one factor.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.life.curves import SNCurve

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class StrengthScatter:
    """Scatter of a curve, and the strength z it is used at.

    ``sigma_ln`` is the standard deviation of ln N on the slope k, ``slope``, on which the curve is given.
    """

    sigma_ln: float
    slope: float
    used_at: float

    def range_factor(self, z: Floats) -> Floats:
        """Range that a strength z bears for as many cycles, over that of the curve used.

        >>> from fatigue.life.curves import catalogue
        >>> aluminium = strength_scatter(catalogue()["master-aluminium"], "mean-2sigma")
        >>> aluminium.range_factor(np.array([-2.0, 0.0])).round(4)
        array([1.    , 1.5088])
        """
        return np.asarray(np.exp((z - self.used_at) * self.sigma_ln / self.slope))


def strength_scatter(curve: SNCurve, survival: str) -> StrengthScatter | None:
    """Scatter of a curve used at a survival level; None of a curve that has none.

    Half of what lies between the mean and the mean-2sigma curve, so that 97.725 % live by the latter.
    """
    if not curve.has_scatter:
        return None
    k = curve.slopes[sum(curve.reference_cycles > knee for knee in curve.knees_cycles[: len(curve.slopes) - 1])]
    mean = curve.reference_range["mean"]
    sigma_ln = 0.5 * k * float(np.log(mean / curve.reference_range["mean-2sigma"]))
    if sigma_ln <= 0.0:
        return None
    below = k * float(np.log(mean / curve.reference_range[survival]))
    return StrengthScatter(sigma_ln=sigma_ln, slope=k, used_at=-below / sigma_ln)
