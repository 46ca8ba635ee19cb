"""The Miner sum with the ASME factor for shear at stations that bounds of the normal stress have settled."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from fatigue.life.mission import Plan
from fatigue.pipeline.count.block import Block
from fatigue.pipeline.count.event_block import factor_with_shear
from fatigue.pipeline.mission.event_load import EventLoad, without_spectrum
from fatigue.pipeline.multiaxial.toes import Toes

Floats = NDArray[np.float64]

AT_ONCE = 128  # stations, whose products with the covariance stay in the cache


def asme_bound(toes: Toes, rows: NDArray[np.intp], loads: Sequence[EventLoad], passes: Floats) -> Floats:
    """Bound of the sum at some stations (r, 2), over the limit at the target.

    A factor F of 1 or more on all ranges raises the damage by F^k at most, k the largest slope. A cut-off lets cycles
    in; as long as the largest stays below it there are none.
    """
    some = (rows[first : first + AT_ONCE] for first in range(0, len(rows), AT_ONCE))
    return np.concatenate([_asme_bound(toes, of_some, loads, passes) for of_some in some])


def _asme_bound(toes: Toes, rows: NDArray[np.intp], loads: Sequence[EventLoad], passes: Floats) -> Floats:
    stress, law = toes.stress.at(rows), toes.stress.rule.law
    total = toes.transitions[rows].copy()
    for number, (load, weight) in enumerate(zip(loads, passes, strict=True)):
        factor = factor_with_shear(stress, load)
        damage = toes.of_events[number, rows] * factor ** float(law.slopes.max())
        if law.cutoff > 0.0:
            damage = np.where(toes.largest[number, rows] * factor < law.cutoff, 0.0, np.inf)
        total += weight * damage
    return total


def asme_counted(
    toes: Toes, rows: NDArray[np.intp], loads: Sequence[EventLoad], plan: Plan, names: str
) -> tuple[Floats, Floats]:
    """Sums by normal stress and with the factor (r, 2) at some stations, their cycles counted."""
    few = [without_spectrum(load) for load in loads]
    block = Block(toes.stress.at(rows), np.zeros(len(rows), np.int64), toes.toe[rows], few, plan, names)
    found = np.empty((2, len(rows), 2))
    for settled in block.all_counted():
        mission, of_target = settled.mission, plan.target_km / plan.damage_limit
        found[0, settled.rows] = mission.utilisation
        transitions = np.nan_to_num(mission.transitions)
        found[1, settled.rows] = (mission.damage_with_shear + transitions) * of_target
    return found[0], found[1]
