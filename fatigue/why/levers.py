"""Which mode or unit load, if 10 % smaller, buys most kilometres: estimated for all, counted again for the best."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.life.mission import Plan, life_km
from fatigue.life.records.history import stress_record
from fatigue.life.records.spool import Samples
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.why.across_events import loop_damages
from fatigue.why.attribute import Attribution, count_credit
from fatigue.why.long_record import Row, is_long, long_damage
from fatigue.why.points import Points

Floats = NDArray[np.float64]

SMALLER = 0.9  # factor on the amplitude of a mode
CANDIDATES = 3  # modes counted again at each point


@dataclass(frozen=True, slots=True, eq=False)
class Levers:
    """What smaller modes would buy at some points, best first; arrays are (w, c): points by candidates.

    Attributes
    ----------
    point : (w,) index into the points of the attribution
    mode : index into the coordinates of the body, its modes and unit loads
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
    """Modes and unit loads ranked by what 10 % less buys at some points that have damage; the best counted again."""
    points, exponents = attribution.points.of(point), attribution.mode_exponent[point]
    mode = np.argsort(exponents, axis=1, kind="stable")[:, :CANDIDATES]
    exponent = np.take_along_axis(exponents, mode, axis=1)
    damage = np.zeros(mode.shape)
    for load, one_pass in zip(loads, plan.passes, strict=True):
        scale = load.stress_factor * np.where(mode[:, :, None] == np.arange(exponents.shape[1]), SMALLER, 1.0)
        q = load.counted.q if is_long(load.counted.q) else np.asarray(load.counted.q)
        for w in range(len(point)):
            counted = _damages(points.of(slice(w, w + 1)), scale[w], q, load)
            damage[w] += one_pass.passes_per_km * np.array(counted)
    for w in range(len(point)):
        scale = np.where(mode[w][:, None] == np.arange(exponents.shape[1]), SMALLER, 1.0)
        damage[w] += loop_damages(points.of(slice(w, w + 1)), scale, loads, plan)
    life = life_km(attribution.damage[point], points.damage_limit)
    again = life_km(damage, points.damage_limit[:, None])
    return Levers(point, mode, exponent, life[:, None] * SMALLER**exponent, again)


def _damages(point: Points, scale: Floats, q: Samples, load: EventLoad) -> list[float]:
    """Miner sums of a point in one pass, its coordinates scaled in some ways (w, c)."""
    membrane, bending = scale * point.membrane, scale * point.bending
    side, size, rule, residue = float(point.side[0]), float(point.size[0]), point.rule[0], load.residue
    offset = (membrane + side * bending) @ load.offset
    if is_long(q):
        stress = stress_record(np.stack([membrane, bending], axis=1).reshape(-1, q.shape[0]), q)
        rows = [Row(2 * i, side, size, rule, offset[i]) for i in range(len(scale))]
        return [long_damage(stress, row, residue, vertex=load.vertex) for row in rows]
    sigma_m, sigma_b = membrane @ np.asarray(q), bending @ np.asarray(q)
    return [
        count_credit(m, b, side, size, rule, residue, constant, vertex=load.vertex).damage
        for m, b, constant in zip(sigma_m, sigma_b, offset, strict=True)
    ]
