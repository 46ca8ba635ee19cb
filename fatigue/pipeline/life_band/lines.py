"""Survival of a whole line of weld to the target, and the life that half of all such lines reach.

Every face with a toe is a line of its own. Load and Miner sum are common to a line: those of its worst point. On one
slope the median life of each station follows from its life; that of a station that a bound has settled is a lower one,
so the line survives at least so often. On a curve with knees only a histogram tells how the life of a station follows
the strength, so that there all of them need one.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.case import LifeBand
from fatigue.life.band.line import line_survival, median_life, straight_line_survival
from fatigue.life.band.quantiles import STRENGTHS
from fatigue.pipeline.life_band.lives import LifeOfPoint, median_km
from fatigue.pipeline.life_band.points import WeldLine

Floats = NDArray[np.float64]

NOT_ASKED, NO_SCATTER, HISTOGRAMS, NO_TOE = "not_asked", "no_scatter", "histograms", "no_toe"


@dataclass(frozen=True, slots=True)
class LineSurvival:
    """Survival of a line at the target, the life half of all lines reach [km], and why there is neither."""

    at_target: float
    median_km: float
    reason: str

    @classmethod
    def none(cls, reason: str) -> "LineSurvival":
        """Neither, and why."""
        return cls(float("nan"), float("nan"), reason)


def survival_of_line(on_line: Sequence[LifeOfPoint], asked: LifeBand, target_km: float) -> LineSurvival:
    """Survival of the line that some points with a histogram are on, the worst of them among them."""
    worst = min(on_line, key=lambda found: found.point.life_km)
    line, length, dependence = worst.point.line, asked.reference_length_mm, asked.dependence
    if length is None or dependence is None:
        return LineSurvival.none(NOT_ASKED)
    if line is None:
        return LineSurvival.none(NO_TOE)
    if worst.strength is None:
        return LineSurvival.none(NO_SCATTER)
    if not worst.has_band:
        return LineSurvival.none(worst.reason)
    lengths, other = line.length_mm / length, worst.sigma_other
    if worst.log_life is None:
        sigma_N = worst.strength.sigma_ln
        log_median = np.log(median_km(line.life_km, worst.point, worst.strength, asked))
        begin = float(log_median.min())

        def survival(log_life: float) -> float:
            return straight_line_survival(log_life, log_median, sigma_N, lengths, dependence, other)

    else:
        curves = _curves(line, on_line)
        if curves is None:
            return LineSurvival.none(HISTOGRAMS)
        begin = float(np.log(worst.lives_km["p50"])) if np.isfinite(worst.lives_km["p50"]) else np.log(target_km)

        def survival(log_life: float) -> float:
            return line_survival(log_life, lambda x: _strengths(x, curves), lengths, dependence, other)

    return LineSurvival(survival(float(np.log(target_km))), median_life(survival, begin, begin), "")


def _curves(line: WeldLine, on_line: Sequence[LifeOfPoint]) -> list[Floats] | None:
    """Ln of the life of every station of a line over its strength; None where one has no histogram."""
    curves: dict[int, Floats] = {}
    for found in on_line:
        if found.log_life is not None:
            curves[line.place[found.point.part, found.point.order]] = found.log_life
        elif found.reason == "no_damage":
            curves[line.place[found.point.part, found.point.order]] = np.full(len(STRENGTHS), np.inf)
    return [curves[i] for i in range(len(line.life_km))] if len(curves) == len(line.life_km) else None


def _strengths(log_life: float, curves: Sequence[Floats]) -> Floats:
    """Strength at which each station just reaches a life; below all that are looked at where any strength does."""
    found = np.empty(len(curves))
    for i, curve in enumerate(curves):
        finite = int(np.count_nonzero(np.isfinite(curve)))
        found[i] = np.interp(log_life, curve[:finite], STRENGTHS[:finite]) if finite else STRENGTHS[0]
    return found
