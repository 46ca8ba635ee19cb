"""Utilisation under another assumption that follows in closed form from what was counted, or an upper bound of it.

On one slope k the damage of every cycle scales with the k-th power of its range, so another thickness rule or another
survival level are factors, and another damage limit always is. Beyond a knee they are not: then the first slope bounds
the damage from above, and what may decide is counted again (``recount``).
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from fatigue.life.curves import DamageLaw
from fatigue.life.mission import REFERENCE_CYCLES, Plan
from fatigue.life.rule import CycleRule
from fatigue.pipeline.sensitivity.notes import NOTHING
from fatigue.pipeline.solve.rated.rated_curves import RatedCurve

Floats = NDArray[np.float64]

LEVEL = "mean-3sigma"
KNEE = 1e7
LIMIT = 0.5


@dataclass(frozen=True, slots=True, eq=False)
class Varied:
    """Some stations under one variant.

    Attributes
    ----------
    exact : (n, 2) utilisation where it is known, else NaN
    upper : (n, 2) what it does not exceed where it is not known; +inf: nothing is known
    lower : (n, 2) what it is at least where it is not known; None: nothing is known
    rule, size : the rule of cycles and the factor of each thickness (n,) to count again with; None: nothing to count
    note : code of what limits every number of it
    tells_counted : whether the largest number that is known says more than the bound of the others
    """

    exact: Floats
    upper: Floats
    rule: CycleRule | None = None
    size: Floats | None = None
    note: int = NOTHING
    lower: Floats | None = None
    tells_counted: bool = False


def scaled(utilisation: Floats, factor: Floats | float, counted: NDArray[np.bool_]) -> Varied:
    """Damage times a factor: exact where it was ``counted`` (n, 2), else a bound as what is there is one."""
    value = utilisation * factor
    return Varied(np.where(counted, value, np.nan), value)


def stronger(law: DamageLaw, factor: float) -> DamageLaw:
    """The law of ranges that are a factor larger, whose knees stay at their number of cycles."""
    log = np.log(factor)
    return DamageLaw(law.slopes, law.log_constants - law.slopes * log, law.knees / factor, law.cutoff / factor)


def first_slope(law: DamageLaw) -> DamageLaw:
    """The first slope of a law for all ranges."""
    return DamageLaw(law.slopes[:1], law.log_constants[:1], law.knees[:0], 0.0)


def with_haibach(law: DamageLaw, knee_cycles: float = KNEE) -> DamageLaw:
    """The first slope of a law, and 2 k - 1 below the range of ``knee_cycles`` (Haibach 1970)."""
    k, log_a, log_knee = law.slopes[0], law.log_constants[0], np.log(knee_cycles)
    knee = np.exp((log_a - log_knee) / k)
    below = 2.0 * k - 1.0
    return DamageLaw(
        np.array([k, below]),
        np.array([log_a, log_knee + below * (log_a - log_knee) / k]),
        np.array([knee]),
        0.0,
    )


def survival_factor(rated: RatedCurve) -> float:
    """Factor on all ranges that stands for mean - 3 sigma in place of the level of the assessment."""
    ranges = rated.curve.reference_range
    return float(ranges[rated.survival] / ranges[LEVEL])


def first_slope_bound(equivalent_range: Floats, size: Floats, rule: CycleRule, plan: Plan) -> Floats:
    """Utilisation (n, 2) of all cycles on the first slope, or more, from the constant range (n, 2) at 2e6 cycles [MPa].

    The bending ratio of each cycle is taken as that of pure
    membrane, which damages most. +inf where f_M may add to it, or where later slopes are flatter than the first.
    """
    law = rule.law
    if rule.mean_stress or (law.slopes < law.slopes[0]).any():
        return np.full_like(equivalent_range, np.inf)
    k, log_a = float(law.slopes[0]), float(law.log_constants[0])
    I_0 = float(rule.ratio_factor(np.zeros(1))[0])
    damage = REFERENCE_CYCLES * (equivalent_range * size[:, None] / I_0) ** k * np.exp(-log_a)
    return np.where(np.isnan(damage), np.inf, damage / plan.damage_limit)


def steepened(utilisation: Floats, factor: Floats, law: DamageLaw) -> Floats:
    """Utilisation that ranges ``factor`` times as large do not exceed; +inf with a cut-off, over which damage jumps."""
    if law.cutoff > 0.0:
        return np.full_like(utilisation, np.inf)
    return np.asarray(utilisation * np.where(factor >= 1.0, factor ** law.slopes.max(), factor ** law.slopes.min()))


def with_law(rule: CycleRule, law: DamageLaw) -> CycleRule:
    """The same rule with another law."""
    return replace(rule, law=law)
