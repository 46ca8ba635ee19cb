"""Load factors of a block of stations: by counting again under many factors, or lower bounds of them."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.life.counting.block import BINS_PER_DECADE, BlockStress
from fatigue.life.counting.count import count_at_factors
from fatigue.life.load_factor import ROUNDING, WIDE, load_factor_of_counts
from fatigue.life.mission import Plan, straight_load_factor
from fatigue.life.rule import CycleRule
from fatigue.pipeline.count.event_block import EventBlock
from fatigue.pipeline.count.joined.loops import LoopBlock, PassResidue, loops_at_factors
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.mission.offsets import face_offset
from fatigue.pipeline.solve.modal_stress import ModalStress
from fatigue.quotient import quotient

Floats = NDArray[np.float64]

AT_ONCE = 256  # stations, whose damage under all factors is 2 MB
BIN = np.log(10.0) / BINS_PER_DECADE  # of ln(dS)


def counted_load_factor(
    stress: ModalStress,
    loads: Sequence[EventLoad],
    plan: Plan,
    events: Sequence[EventBlock],
    loops: Sequence[LoopBlock],
    estimate: Floats,
) -> Floats:
    """Load factor (n, 2) of counted stations, exact where ``estimate`` may not be.

    ``loops`` are what the loops of the mission add to the events.

    ``estimate`` (n, 2) is in closed form on one slope, else from the stored spectrum, and takes f_M as it is at a
    factor of 1; +inf: nothing damages at any load.
    """
    low, width, wanted = _brackets(stress, plan, events, loops, estimate)
    factor = estimate.copy()
    jumps = stress.rule.law.cutoff > 0.0 or stress.rule.mean_stress
    for first in range(0, len(stress), AT_ONCE):
        rows = np.arange(first, min(first + AT_ONCE, len(stress)))
        if wanted[rows].any():
            residues = tuple(event.residues[0].at(rows) for event in events)
            tried = _Counted(stress.at(rows), loads, plan, residues)
            of_rows = np.where(wanted[rows], low[rows], np.nan)
            found = load_factor_of_counts(tried.utilisation, of_rows, width[rows], stress.rule.law, jumps=jumps)
            factor[rows] = np.where(wanted[rows], found, estimate[rows])
    return factor


def bounded_load_factor(
    rule: CycleRule, plan: Plan, events: Sequence[EventBlock], utilisation: Floats, loops: Sequence[LoopBlock] = ()
) -> Floats:
    """Lower bound (n, 2) of the load factor where bounds stand for counting, ``utilisation`` their bound.

    Damage rises with f^k at most, k the largest slope, and falls with f^k at least, k the smallest one. A cut-off only
    takes damage away; but it may let cycles in when the load rises, and none as long as the largest stays below it. A
    rise ends at the factor at which the largest stress may meet with f_M.
    """
    law, yield_MPa = rule.law, rule.yield_of_damage
    less = straight_load_factor(utilisation, float(law.slopes.min()))
    factor = np.where(utilisation > 1.0, less, straight_load_factor(utilisation, float(law.slopes.max())))
    if law.cutoff > 0.0:
        of_events = [event.count.max_equivalent_range for event in events]
        largest = _of_weighted([*of_events, *(loop.count.max_equivalent_range for loop in loops)], plan)
        below = quotient(np.full_like(largest, (1.0 - ROUNDING) * law.cutoff), largest)
        factor = np.maximum(np.minimum(less, 1.0), np.where(largest > 0.0, below, np.inf))
    if yield_MPa is not None:
        highest = _of_weighted([event.estimate.mean + event.count.max_range for event in events], plan)
        reached = quotient(np.full_like(highest, (1.0 - ROUNDING) * yield_MPa), 2.0 * highest)
        factor = np.where((highest > 0.0) & (utilisation <= 1.0), np.maximum(np.minimum(factor, reached), 1.0), factor)
    return factor


@dataclass(frozen=True, slots=True, eq=False)
class _Counted:
    """Stations under all events of the mission, counted under factors on their stress."""

    stress: ModalStress
    loads: Sequence[EventLoad]
    plan: Plan
    residues: Sequence[PassResidue]

    def utilisation(self, rows: NDArray[np.intp], first: Floats, step: Floats, factors: int) -> Floats:
        """Utilisation (r, 2, g) as ``load_factor_of_counts`` asks for it."""
        some = self.stress.at(rows)
        damage = np.zeros((*first.shape, factors))
        for load, one_pass in zip(self.loads, self.plan.passes, strict=True):
            if one_pass.passes_per_km > 0.0:
                f = load.stress_factor
                membrane, bending = f * some.membrane, f * some.bending
                offset = face_offset(membrane, bending, load)
                block = BlockStress(membrane, bending, some.size, np.zeros(first.shape), offset=offset)
                per_pass = count_at_factors(block, load.record, some.rule, first, step, factors)
                damage += one_pass.passes_per_km * per_pass
        if self.plan.loops:
            of_rows = [residue.at(rows) for residue in self.residues]
            damage += loops_at_factors(some, self.plan, of_rows, first, step, factors)
        return damage * (self.plan.target_km / self.plan.damage_limit)


def _brackets(
    stress: ModalStress, plan: Plan, events: Sequence[EventBlock], loops: Sequence[LoopBlock], estimate: Floats
) -> tuple[Floats, Floats, NDArray[np.bool_]]:
    """Where the factors are likely to be: from ``low`` up by ``width`` of ln(factor); and where they are wanted."""
    law, yield_MPa = stress.rule.law, stress.rule.yield_of_damage
    wanted = np.isfinite(estimate) & (estimate > 0.0)
    start = np.where(wanted, estimate, 1.0)
    low, width = start * np.exp(-BIN), np.full(start.shape, 2.0 * BIN)
    if yield_MPa is None:
        return low, width, wanted & (not law.is_straight)
    highest = _of_weighted([event.count.mean + event.count.max_range for event in events], plan)
    of_events = [event.count.max_range for event in events]
    largest = _of_weighted([*of_events, *(loop.count.max_range for loop in loops)], plan)
    in_reach = 2.0 * highest * np.maximum(start, 1.0) >= (1.0 - ROUNDING) * yield_MPa
    f_M_ends = np.where(largest > 0.0, quotient(np.full_like(largest, 2.0 * yield_MPa), largest), np.inf)
    low = np.where(in_reach, np.minimum(start * np.exp(-0.5 * WIDE), f_M_ends), low)
    width = np.where(in_reach, np.log(start / low) + 0.5 * WIDE, width)
    return low, width, wanted & (in_reach | (not law.is_straight))


def _of_weighted(of_events: Sequence[Floats], plan: Plan) -> Floats:
    """Largest value among the events, and the loops behind them, that occur; 0 where none does."""
    occurring = [value for value, weight in zip(of_events, plan.weights, strict=False) if weight > 0.0]
    return np.asarray(np.max(occurring, axis=0)) if occurring else np.zeros_like(of_events[0])
