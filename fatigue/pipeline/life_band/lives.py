"""Lives of one point at the survivals that are told, from the scatter of its load, its curve and the Miner sum."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.case import LifeBand
from fatigue.life.band.knees import log_life_factors
from fatigue.life.band.quantiles import STRENGTHS, SURVIVALS, combined_sigma, life_of_strengths, lognormal_life
from fatigue.life.band.strength import StrengthScatter, strength_scatter
from fatigue.pipeline.life_band.points import BandPoint
from fatigue.pipeline.life_band.scatter import WITH_BAND

Floats = NDArray[np.float64]

_NO_LIVES = dict.fromkeys(SURVIVALS, float("nan"))


@dataclass(frozen=True, slots=True, eq=False)
class MissionHistogram:
    """Classes of the equivalent ranges of one point in one km of the mission: sum n and sum n x^k, (b,) each."""

    count: Floats
    power_sum: Floats


@dataclass(frozen=True, slots=True, eq=False)
class LifeOfPoint:
    """The life of one point as a band; NaN where there is none.

    Attributes
    ----------
    point : it
    se, dof : relative standard error of its damage and its degrees of freedom
    reason : one of ``scatter.REASONS``
    low_km, high_km : 90 % band of the life by the load alone
    lives_km : life at every one of ``SURVIVALS``, by all parts; NaN on a curve without scatter
    strength : scatter of its curve, None without
    log_life : (721,) ln of the life with half of all Miner sums, at every one of ``STRENGTHS``; None on one slope
    sigma_other : standard deviation of ln life by load and Miner sum
    """

    point: BandPoint
    se: float
    dof: float
    reason: str
    low_km: float
    high_km: float
    lives_km: dict[str, float]
    strength: StrengthScatter | None
    log_life: Floats | None
    sigma_other: float

    @property
    def has_band(self) -> bool:
        """Whether the scatter of the load is known."""
        return self.reason in WITH_BAND


def life_of_point(
    point: BandPoint, load: tuple[float, float, float, float], reason: str, of: MissionHistogram, asked: LifeBand
) -> LifeOfPoint:
    """The band of one point; ``load`` are se, degrees of freedom, t se and se_t of its damage."""
    strength = strength_scatter(point.rated.curve, point.rated.survival)
    if reason not in WITH_BAND:
        nan = float("nan")
        return LifeOfPoint(point, nan, nan, reason, nan, nan, _NO_LIVES, strength, None, nan)
    se, dof, half_width, sigma_load = load
    low, high = point.life_km * np.exp(-half_width), point.life_km * np.exp(half_width)
    sigma_other = float(combined_sigma(sigma_load, asked.miner_sigma_ln))
    known = point, se, dof, reason, float(low), float(high)
    if strength is None:
        return LifeOfPoint(*known, _NO_LIVES, None, None, sigma_other)
    if point.rated.rule.law.is_straight:
        sigma = combined_sigma(strength.sigma_ln, sigma_other)
        middle = median_km(point.life_km, point, strength, asked)
        lives = {name: float(lognormal_life(middle, sigma, p)) for name, p in SURVIVALS.items()}
        return LifeOfPoint(*known, lives, strength, None, sigma_other)
    factors = log_life_factors(of.count, of.power_sum, point.rated.rule.law, strength.range_factor(STRENGTHS))
    log_life = np.log(point.life_km * miner_factor(point, asked)) + factors
    lives = {name: life_of_strengths(log_life, sigma_other, p) for name, p in SURVIVALS.items()}
    return LifeOfPoint(*known, lives, strength, log_life, sigma_other)


def miner_factor(point: BandPoint, asked: LifeBand) -> float:
    """Damage sum at which half have failed over the allowed one."""
    return 1.0 if asked.miner_median is None else asked.miner_median / point.damage_limit


def median_km(life_km: Floats | float, point: BandPoint, strength: StrengthScatter, asked: LifeBand) -> Floats:
    """Lives on the mean curve with half of all Miner sums, of lives on a curve with one slope [km]."""
    to_mean = strength.range_factor(np.zeros(())) ** strength.slope
    return np.asarray(life_km * to_mean * miner_factor(point, asked))


def slope_of_damage(point: BandPoint, of: MissionHistogram) -> float:
    """Slope k where the damage of a point is done: d ln(damage) / d ln(load)."""
    law = point.rated.rule.law
    if law.is_straight or not of.count.any():
        return float(law.slopes[0])
    weaker, stronger = log_life_factors(of.count, of.power_sum, law, np.array([0.99, 1.01]))
    if not np.isfinite([weaker, stronger]).all():  # no cycle damages
        return float(law.slopes[0])
    return float((stronger - weaker) / np.log(1.01 / 0.99))
