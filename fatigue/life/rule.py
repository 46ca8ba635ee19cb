"""The master equation: what one rainflow cycle of structural stress does to a weld.

A cycle with the structural stress range dsigma_s in a plate of thickness t has the equivalent range

    dS = dsigma_s t^((m-2)/(2m)) / (I(r)^(1/m) f_M),    m = 3.6,

and the life and the damage

    N = (C / dS)^(1/h),    d = 1 / N.

r is its bending ratio, f_M its mean-stress factor, C and h belong to the material (ASME VIII-2 5.5.5.2; Dong, 2001).
Other S-N curves have the same form: a factor of the thickness, no I(r), and several segments d = x^k / A, k = 1 / h.

Functions that take numbers as well as arrays are also compiled as they stand, for the counters.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import CaseError, Problem
from fatigue.life.allowances import (
    RATIO_LEVELS,
    BendingFactor,
    StressRatio,
    bending_allowance,
    effective_thickness,
    log_bending_allowance_slope,
    stress_ratio_factors,
    stress_ratio_slopes,
)
from fatigue.life.curves import DamageLaw, SNCurve, ThicknessRule

Floats = NDArray[np.float64]
Numbers = Any  # a number, as in compiled code, or an array of them

M_SS = 3.6  # m, crack-growth exponent of the master curve
SIZE_EXPONENT = (M_SS - 2.0) / (2.0 * M_SS)
ASME_THICKNESS_LIMITS = (16.0, 150.0)  # [mm], ASME VIII-2 5.5.5.2: 0.625 in and 6 in
A_0, A_1, A_2 = 1.23, 0.364, 0.17  # of I(r)^(1/m), load controlled
B_0, B_1, B_2 = 1.007, 0.306, 0.178


@dataclass(frozen=True, slots=True, eq=False)
class CycleRule:
    """How the damage of a cycle follows from its structural stress range.

    Attributes
    ----------
    law : damage of a cycle by its equivalent range
    uses_bending_ratio : False for a law in plain structural stress, where I(r)^(1/m) is 1
    yield_MPa : yield stress for f_M [MPa]; None: f_M is 1
    mean_stress : whether the damage contains f_M; otherwise the damage with f_M is only shown beside it
    bending_factor : the allowance for bending that stands in the place of I(r)^(1/m) on a law in plain stress
    stress_ratio : f(R), by which every range is divided; it is in the damage, and f_M is not beside it

    Raises
    ------
    CaseError : ``mean_stress`` without a yield stress, or two allowances for the same
    """

    law: DamageLaw
    uses_bending_ratio: bool
    yield_MPa: float | None = None  # noqa: N815
    mean_stress: bool = False
    bending_factor: BendingFactor = "none"
    stress_ratio: StressRatio = "none"

    def __post_init__(self) -> None:
        """Refuse f_M without a yield stress, and what would be allowed for twice."""
        if self.stress_ratio != "none" and self.yield_MPa is not None:
            what = f"f_M of ASME and f(R) of '{self.stress_ratio}' both allow for the mean stress of a cycle"
            raise CaseError(Problem("twice", "mean stress", what, "Take one of them"))
        if self.bending_factor != "none" and self.uses_bending_ratio:
            what = f"I(r) of the master curve and '{self.bending_factor}' both allow for bending"
            raise CaseError(Problem("twice", "bending", what, "Take one of them"))
        if self.mean_stress and self.yield_MPa is None:
            raise CaseError(
                Problem("yield", "mean stress", "f_M needs the yield stress, none is given", "Give yield_MPa")
            )

    @property
    def yield_of_damage(self) -> float | None:
        """Yield stress [MPa] where the damage contains f_M, which depends on it; else None."""
        return self.yield_MPa if self.mean_stress else None

    @property
    def depends_on_bending(self) -> bool:
        """Whether the damage of a cycle depends on its bending ratio."""
        return self.uses_bending_ratio or self.bending_factor != "none"

    @property
    def is_of_range_alone(self) -> bool:
        """Whether the allowances of the curve leave the damage to range and, on the master curve, I(r) and f_M."""
        return self.bending_factor == "none" and self.stress_ratio == "none"

    def ratio_factor(self, r: Floats) -> Floats:
        """``I(r)^(1/m)`` of the bending ratios of cycles, or the allowance of the curve; 1 where there is none.

        It is smallest in pure membrane, r = 0.
        """
        if self.bending_factor != "none":
            return np.asarray(bending_allowance(r))
        return np.asarray(ratio_factor(r)) if self.uses_bending_ratio else np.ones_like(r)

    def log_ratio_factor_slope(self, r: Floats) -> Floats:
        """Slope d ln / dr of ``ratio_factor``."""
        if self.bending_factor != "none":
            return log_bending_allowance_slope(r)
        return log_ratio_factor_slope(r) if self.uses_bending_ratio else np.zeros_like(r)

    def mean_stress_factor(self, minimum: Floats, maximum: Floats) -> Floats:
        """``f_M`` or f(R) of cycles between two stresses [MPa]; 1 where the damage does not contain it."""
        if self.stress_ratio != "none":
            return stress_ratio_factors(minimum, maximum, RATIO_LEVELS[self.stress_ratio])
        limit = self.yield_of_damage
        return np.ones_like(maximum) if limit is None else mean_stress_factor(minimum, maximum, limit)

    def mean_stress_slopes(self, minimum: Floats, maximum: Floats) -> tuple[Floats, Floats]:
        """Slopes d ln x / d ln S, and d ln x / d maximum [1/MPa], of cycles between two stresses.

        x is the equivalent range, S the range; as ``f_M = (S / maximum)^(1/m)``.
        """
        if self.stress_ratio != "none":
            return stress_ratio_slopes(minimum, maximum, RATIO_LEVELS[self.stress_ratio])
        applies = self.mean_stress_factor(minimum, maximum) < 1.0
        by_maximum = np.divide(1.0 / M_SS, maximum, out=np.zeros_like(maximum), where=applies)
        return np.where(applies, 1.0 - 1.0 / M_SS, 1.0), by_maximum


def bending_ratio(membrane_range: Floats, bending_range: Floats) -> Floats:
    """``r = |d sigma_b| / (|d sigma_m| + |d sigma_b|)`` of ranges of equal shape [MPa]; 0 where both are 0 (Eq. 7).

    >>> bending_ratio(np.array([60.0]), np.array([-40.0]))
    array([0.4])
    """
    bending = np.abs(bending_range)
    total = np.abs(membrane_range) + bending
    return np.asarray(np.divide(bending, total, out=np.zeros_like(total), where=total > 0.0))


def ratio_factor(r: Numbers) -> Numbers:
    """``I(r)^(1/m)`` of the load-controlled edge crack, 1.221 in pure membrane to 1.331 in pure bending.

    Eq. 9; source: ASME VIII-2 5.5.5.2.

    >>> round(ratio_factor(0.5), 7)
    1.2421248
    """
    return (A_0 - A_1 * r - A_2 * r**2) / (B_0 - B_1 * r - B_2 * r**2)


def log_ratio_factor_slope(r: Floats) -> Floats:
    """Slope d ln(I(r)^(1/m)) / dr of ``ratio_factor``.

    >>> round(log_ratio_factor_slope(0.5), 6)
    0.066821
    """
    return (-A_1 - 2.0 * A_2 * r) / (A_0 - A_1 * r - A_2 * r**2) - (-B_1 - 2.0 * B_2 * r) / (B_0 - B_1 * r - B_2 * r**2)


def size_factor(thickness: Floats, curve: SNCurve, rule: ThicknessRule, attachment: Floats | float = np.inf) -> Floats:
    """Factor of the plate thickness [mm] on the range, ``t^((m-2)/(2m))`` for the master curve.

    Master curve: with the actual thickness, or with the one that ASME VIII-2 5.5.5.2 limits to 16 to 150 mm. Other
    curves: ``(t / t_ref)^n`` for t above the reference thickness of the curve, t the effective thickness at an
    ``attachment`` of some length [mm] where the curve asks for it.

    >>> from fatigue.life.curves import catalogue
    >>> size_factor(np.array([10.0]), catalogue()["master-steel"], "asme").round(6)
    array([1.851749])
    """
    if curve.applies == "dS":
        t_ess = np.clip(thickness, *ASME_THICKNESS_LIMITS) if rule == "asme" else thickness
        return np.asarray(t_ess**SIZE_EXPONENT)
    if curve.thickness_reference is None:
        return np.ones_like(thickness)
    if curve.allowances.thickness_effective == "L_half":
        thickness = effective_thickness(thickness, np.asarray(attachment))
    return np.asarray(np.maximum(thickness / curve.thickness_reference, 1.0) ** curve.thickness_exponent)


def size_exponent(thickness: float, curve: SNCurve, rule: ThicknessRule, attachment: float = np.inf) -> float:
    """Exponent d ln(size) / d ln(t) of ``size_factor`` at a thickness [mm]; 0 where the rule holds it fixed."""
    if curve.applies == "dS":
        low, high = ASME_THICKNESS_LIMITS if rule == "asme" else (0.0, np.inf)
        return SIZE_EXPONENT if low <= thickness < high else 0.0
    if curve.thickness_reference is None or thickness < curve.thickness_reference:
        return 0.0
    if curve.allowances.thickness_effective == "L_half" and 0.5 * attachment < thickness:
        return 0.0
    return curve.thickness_exponent


def has_mean_stress(minimum: Numbers, maximum: Numbers, yield_MPa: float) -> Numbers:
    """Whether f_M applies to a cycle between two stresses [MPa].

    Its mean is at least half the yield stress, R = minimum / maximum is above 0, and its range is at most twice the
    yield stress (ASME VIII-2 5.5.5.2).
    """
    return (
        (minimum > 0.0)
        & (minimum < maximum)
        & (minimum + maximum >= yield_MPa)
        & (maximum - minimum <= 2.0 * yield_MPa)
    )


def factor_of_stress_ratio(R: Numbers) -> Numbers:
    """``f_M = (1 - R)^(1/m)`` of the stress ratio R = minimum / maximum (ASME VIII-2 5.5.5.2)."""
    return (1.0 - R) ** (1.0 / M_SS)


def mean_stress_factor(minimum: Floats, maximum: Floats, yield_MPa: float) -> Floats:
    """``f_M = (1 - R)^(1/m)`` where ``has_mean_stress`` says so, else 1; the range is divided by it (Eq. 10).

    ``minimum`` and ``maximum`` are the structural stresses at the two reversals, dead load included [MPa].

    >>> mean_stress_factor(np.array([100.0]), np.array([200.0]), 250.0).round(6)
    array([0.824861])
    """
    applies = has_mean_stress(minimum, maximum, yield_MPa)
    R = np.divide(minimum, maximum, out=np.zeros_like(maximum), where=applies)
    return np.asarray(factor_of_stress_ratio(R))


def equivalent_range(S: Numbers, size: Numbers, ratio_factor: Numbers, f_M: Numbers) -> Numbers:
    """``dS = dsigma_s t^((m-2)/(2m)) / (I(r)^(1/m) f_M)`` (Eq. 8), the factors already evaluated.

    >>> round(equivalent_range(100.0, 20.0**SIZE_EXPONENT, ratio_factor(0.4), 1.0), 5)
    157.57788
    """
    return S * size / ratio_factor / f_M


def segment(x: Numbers, knees: Floats) -> Numbers:
    """Index of the segment of a law on which each equivalent range x lies: how many ``knees`` are above it."""
    above: Numbers = 0
    for j in range(len(knees)):
        above = above + (x < knees[j])
    return above


def damage_on_segment(x: Numbers, k: Numbers, log_A: Numbers) -> Numbers:
    """``d = x^k / A`` of equivalent ranges above 0 on a segment of the slope k (Eq. 11).

    >>> round(2e6 * float(damage_on_segment(60.0, 3.0, np.log(2e6 * 90.0**3))), 6)
    0.296296
    """
    return np.exp(k * np.log(x) - log_A)


def cycle_damage(x: Floats, law: DamageLaw) -> Floats:
    """Damage ``d = 1 / N`` of one cycle of each equivalent range x, Eq. 11; 0 below the cut-off.

    >>> from fatigue.life.curves import catalogue, damage_law
    >>> steel = damage_law(catalogue()["master-steel"], "mean-2sigma", "none", 1e7)
    >>> (1.0 / cycle_damage(np.array([157.57788]), steel)).round(-1)
    array([1221480.])
    """
    x = np.asarray(x, dtype=np.float64)
    damaging = (x > 0.0) & (x >= law.cutoff)
    j = segment(x, law.knees)
    return np.where(damaging, damage_on_segment(np.where(damaging, x, 1.0), law.slopes[j], law.log_constants[j]), 0.0)


def local_slope(x: Floats, law: DamageLaw) -> Floats:
    """Slope k = d ln(damage) / d ln(x) of the segment on which each equivalent range x lies."""
    return np.asarray(law.slopes[segment(x, law.knees)])
