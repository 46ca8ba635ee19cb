"""Cycles across events at a block of stations: what the loops of the mission add, and the bound of an unknown order."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from fatigue.life.counting.block import BlockStress
from fatigue.life.counting.residue import BlockResidue
from fatigue.life.mission import Plan
from fatigue.life.sequence import LoopCount, Residues, count_loop, loop_at_factors, residues_of, unknown_order
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.solve.modal_stress import ModalStress

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class PassResidue:
    """Residue of one pass of an event at n stations, and its constant stresses (n,) beside the samples [MPa]."""

    residue: BlockResidue
    membrane: Floats
    bending: Floats

    @classmethod
    def nothing(cls, stations: int) -> Self:
        """Of an event that is not looked at: no reversals."""
        nothing, none = np.zeros(0), np.zeros((stations, 2), np.int64)
        return cls(BlockResidue(nothing, nothing, none, none), np.zeros(stations), np.zeros(stations))

    def at(self, rows: NDArray[np.intp] | slice) -> Self:
        """Take some stations."""
        return type(self)(self.residue.at(rows), self.membrane[rows], self.bending[rows])


@dataclass(frozen=True, slots=True, eq=False)
class LoopBlock:
    """One run of a loop at a block of stations; arrays are (n, 2), top and bottom face.

    ``count`` is what it adds; where bounds stand for counting, its damage and its ranges are upper bounds, and the
    others NaN. ``damage_raw_end`` is the damage without the end treatment, NaN where that was not counted.
    """

    count: LoopCount
    damage_raw_end: Floats

    def without_histogram(self) -> "LoopBlock":
        """The same without its histogram, which serves the load factor only."""
        of_count = {name: getattr(self.count, name) for name in LoopCount.__slots__}
        return LoopBlock(LoopCount(**(of_count | {"histogram": self.count.histogram[:, :, :0]})), self.damage_raw_end)


@dataclass(frozen=True, slots=True, eq=False)
class Joined:
    """What follows from events that join: each loop, and the bound of an unknown order (n, 2) per km, NaN without."""

    loops: tuple[LoopBlock, ...]
    bound: Floats

    @classmethod
    def nothing(cls, stations: int) -> Self:
        """Of events that stay apart."""
        return cls((), np.full((stations, 2), np.nan))


def pass_residue(residue: BlockResidue, stress: BlockStress, load: EventLoad) -> PassResidue:
    """Residue of a pass with the constant stresses of the event; ``stress`` contains its stress factor."""
    return PassResidue(residue, stress.membrane @ load.offset, stress.bending @ load.offset)


def joined_events(
    stress: ModalStress, plan: Plan, residues: Sequence[PassResidue], raw_ends: Sequence[PassResidue]
) -> Joined:
    """What joins the events at n stations, from the residues of every event, treated ends and raw ones.

    ``raw_ends`` are the same as the treated ones at stations without another raw end.
    """
    if not plan.joins_events:
        return Joined.nothing(len(stress))
    of_events, raw = _side_by_side(residues, plan), _side_by_side(raw_ends, plan)
    other = np.flatnonzero((raw.first != of_events.first).any(axis=(0, 2)))
    loops = []
    for loop in plan.loops:
        count = count_loop(of_events, loop.order, stress.size, stress.rule)
        damage_raw_end = count.damage.copy()
        damage_raw_end[other] = count_loop(raw.at(other), loop.order, stress.size[other], stress.rule).damage
        loops.append(LoopBlock(count, damage_raw_end))
    return Joined(tuple(loops), _bound_per_km(stress, plan, of_events))


def loops_at_factors(
    stress: ModalStress, plan: Plan, residues: Sequence[PassResidue], first: Floats, step: Floats, factors: int
) -> Floats:
    """Damage per km (n, 2, g) of all loops with all stresses times ``first exp(i step)``, i < g."""
    damage = np.zeros((*first.shape, factors))
    of_events = _side_by_side(residues, plan) if plan.loops else None
    for loop in plan.loops:
        assert of_events is not None
        damage += loop.runs_per_km * loop_at_factors(
            of_events, loop.order, stress.size, stress.rule, first, step, factors
        )
    return damage


def _side_by_side(residues: Sequence[PassResidue], plan: Plan) -> Residues:
    return residues_of(
        [one.residue for one in residues],
        [one.membrane for one in residues],
        [one.bending for one in residues],
        [one.half for one in plan.passes],
    )


def _bound_per_km(stress: ModalStress, plan: Plan, residues: Residues) -> Floats:
    """The bound of an unknown order of those events that say how often they follow on others; NaN where none does."""
    known = [i for i, one in enumerate(plan.passes) if one.stints_per_1000_km is not None]
    if not known:
        return np.full((len(stress), 2), np.nan)
    some = residues._replace(
        **{name: getattr(residues, name)[known] for name in ("first", "length", "constant_m", "constant_b", "half")}
    )
    stints = np.array([(plan.passes[i].stints_per_1000_km or 0.0) / 1000.0 for i in known])
    return unknown_order(some, stints, stress.size, stress.rule)


def nothing_known(damage: Floats, max_range: Floats, max_equivalent_range: Floats) -> LoopBlock:
    """A loop of which bounds are known: of its damage and of its largest ranges, (n, 2)."""
    unknown = np.full_like(damage, np.nan)
    count = LoopCount(
        damage=damage,
        damage_mean_stress=unknown,
        cycles=unknown,
        power_sum=unknown,
        max_range=max_range,
        r_largest=unknown,
        max_equivalent_range=max_equivalent_range,
        histogram=np.zeros((*damage.shape, 0, 2)),
    )
    return LoopBlock(count, damage.copy())
