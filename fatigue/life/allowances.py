"""What stands between a stress range and the range that a curve is entered with, beside the thickness rule.

The design range of a cycle is

    x = gamma_Ff gamma_Mf f_t / (f_bending f(R)) * range,

with the thickness factor f_t, the allowance f_bending for bending through the thickness and f(R) for the stress ratio.
All of it is on the range, nothing on the damage: a factor of 1.1 on the range is 1.1^k in damage. What belongs to a
point (gammas, f_t and the thickness in f_bending) is one factor, ``size``; what belongs to a cycle is in ``rule``.
"""

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Numbers = Any  # a number, as in compiled code, or an array of them

ThicknessEffective = Literal["t", "L_half"]
BendingFactor = Literal["none", "bs7608"]
StressRatio = Literal["none", "iiw_low", "iiw_medium"]

BENDING_WEIGHT, BENDING_POWER = 0.18, 1.4  # of BS 7608:2014, ``1 + 0.18 Omega^1.4``
RATIO_SLOPE = 0.4  # of f(R) between its plateaus, IIW 2016 (recalled)
RATIO_LEVELS: dict[StressRatio, float] = {"iiw_low": 1.2, "iiw_medium": 0.9}  # f(0) of the slope


@dataclass(frozen=True, slots=True)
class Allowances:
    """What an S-N curve allows for, by default nothing.

    Attributes
    ----------
    thickness_effective : "t", or "L_half": half the length of the attachment where that is at most the thickness
    bending_factor : "bs7608": ranges are divided by ``(t_B / t)^b (1 + 0.18 Omega^1.4)``, Omega the bending ratio
    bending_reference, bending_exponent : t_B [mm] and b of it
    stress_ratio : f(R) of each cycle, "iiw_low" or "iiw_medium" residual stress; high residual stress is "none"
    gamma_Ff, gamma_Mf : partial factors on the range, of the action and of the resistance
    """

    thickness_effective: ThicknessEffective = "t"
    bending_factor: BendingFactor = "none"
    bending_reference: float | None = None
    bending_exponent: float = 0.0
    stress_ratio: StressRatio = "none"
    gamma_Ff: float = 1.0  # noqa: N815
    gamma_Mf: float = 1.0  # noqa: N815


NOTHING = Allowances()
ALLOWANCE_KEYS = {  # attribute of ``Allowances`` by the key of a curve entry
    "thickness_effective": "thickness_effective",
    "bending_factor": "bending_factor",
    "bending_reference_mm": "bending_reference",
    "bending_exponent": "bending_exponent",
    "mean_stress": "stress_ratio",
    "gamma_Ff": "gamma_Ff",
    "gamma_Mf": "gamma_Mf",
}


def effective_thickness(thickness: Floats, attachment: Floats) -> Floats:
    """Thickness [mm] of the thickness rule under ``L_half``: L / 2 where L / t is at most 2, else t.

    Source: IIW 2016, wall thickness (recalled).

    ``attachment`` is the length L of the attachment along the stress [mm].

    >>> effective_thickness(np.array([30.0, 30.0]), np.array([40.0, 100.0])).tolist()
    [20.0, 30.0]
    """
    return np.asarray(np.minimum(thickness, 0.5 * attachment))


def bending_allowance(r: Numbers) -> Numbers:
    """``1 + 0.18 Omega^1.4`` of bending ratios, by which ranges are divided (BS 7608:2014, recalled).

    >>> bending_allowance(1.0)
    1.18
    """
    return 1.0 + BENDING_WEIGHT * r**BENDING_POWER


def log_bending_allowance_slope(r: Floats) -> Floats:
    """Slope d ln / dr of ``bending_allowance``."""
    return np.asarray(BENDING_WEIGHT * BENDING_POWER * r ** (BENDING_POWER - 1.0) / bending_allowance(r))


def bending_thickness(thickness: Floats, curve: Allowances) -> Floats:
    """Factor ``(t / t_B)^b`` of the plate thickness [mm] on the range in the allowance for bending; else 1."""
    if curve.bending_factor == "none" or curve.bending_reference is None:
        return np.ones_like(thickness)
    return np.asarray((thickness / curve.bending_reference) ** curve.bending_exponent)


def stress_ratio_factor(minimum: Numbers, maximum: Numbers, level: float) -> Numbers:
    """f(R) of one cycle between two stresses [MPa], static stress included, by which its range is divided.

    ``level - 0.4 R``, but at least 1 and at most ``level + 0.4``: that of R = -1, below which, and in compression,
    it stays. ``level`` is one of ``RATIO_LEVELS``.

    Source: IIW 2016, stress ratio (recalled; it is continuous where its parts meet).

    >>> round(stress_ratio_factor(-50.0, 100.0, 1.2), 12)
    1.4
    """
    if minimum + maximum <= 0.0:
        return level + RATIO_SLOPE
    return max(1.0, level - RATIO_SLOPE * minimum / maximum)


def stress_ratio_factors(minimum: Floats, maximum: Floats, level: float) -> Floats:
    """f(R) of many cycles, see ``stress_ratio_factor``."""
    tension = minimum + maximum > 0.0
    R = np.divide(minimum, maximum, out=np.full_like(maximum, -1.0), where=tension)
    return np.asarray(np.maximum(1.0, level - RATIO_SLOPE * R))


def stress_ratio_slopes(minimum: Floats, maximum: Floats, level: float) -> tuple[Floats, Floats]:
    """Slopes d ln x / d ln S and d ln x / d maximum [1/MPa] of cycles of the range S that f(R) is allowed for.

    1 and 0 on the plateaus of f(R).
    """
    f = stress_ratio_factors(minimum, maximum, level)
    slopes = (minimum + maximum > 0.0) & (f > 1.0)
    S = maximum - minimum
    of_range = np.divide(RATIO_SLOPE * S, f * maximum, out=np.zeros_like(S), where=slopes)
    return 1.0 - of_range, np.divide(of_range, maximum, out=np.zeros_like(S), where=slopes)
