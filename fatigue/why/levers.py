"""Which mode, if 10 % smaller, buys most kilometres: estimated for all modes, counted again for the best."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.life.mission import Plan, life_km
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.why.attribute import Attribution, count_credit

Floats = NDArray[np.float64]

SMALLER = 0.9  # factor on the amplitude of a mode
CANDIDATES = 3  # modes counted again at each point


@dataclass(frozen=True, slots=True, eq=False)
class Levers:
    """What smaller modes would buy at some points, best first; arrays are (w, c): points by candidates.

    Attributes
    ----------
    point : (w,) index into the points of the attribution
    mode : index into the modes of the model
    exponent : d ln(life) / d ln(amplitude)
    life_estimated : life by that exponent, ``life * 0.9**exponent`` [km]
    life_counted : life when the mode is scaled in every event and all cycles are counted again [km]
    """

    point: NDArray[np.int64]
    mode: NDArray[np.int64]
    exponent: Floats
    life_estimated: Floats
    life_counted: Floats


def best_levers(attribution: Attribution, loads: Sequence[EventLoad], plan: Plan, point: NDArray[np.int64]) -> Levers:
    """Rank the modes of some points, which must have damage, by what 10 % less buys; count the best ones again."""
    points, exponents = attribution.points.of(point), attribution.mode_exponent[point]
    mode = np.argsort(exponents, axis=1, kind="stable")[:, :CANDIDATES]
    exponent = np.take_along_axis(exponents, mode, axis=1)
    damage = np.zeros(mode.shape)
    for load, one_pass in zip(loads, plan.passes, strict=True):
        q = np.asarray(load.counted.q)
        scale = load.stress_factor * np.where(mode[:, :, None] == np.arange(exponents.shape[1]), SMALLER, 1.0)
        for w, (side, size, rule) in enumerate(zip(points.side, points.size, points.rule, strict=True)):
            sigma_m, sigma_b = ((scale[w] * modal_stress[w]) @ q for modal_stress in (points.membrane, points.bending))
            counted = [
                count_credit(m, b, side, size, rule, load.residue) for m, b in zip(sigma_m, sigma_b, strict=True)
            ]
            damage[w] += one_pass.passes_per_km * np.array([c.damage for c in counted])
    life = life_km(attribution.damage[point], plan.damage_limit)
    return Levers(point, mode, exponent, life[:, None] * SMALLER**exponent, life_km(damage, plan.damage_limit))
