"""Linear stresses of some points, counted over the mission as the stress at a toe is."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from fatigue.life.counting.block import BlockStress
from fatigue.life.counting.count import count_and_residue, count_at_factors
from fatigue.life.mission import Plan, mission_sum
from fatigue.life.rule import CycleRule
from fatigue.pipeline.count.block import Block
from fatigue.pipeline.count.joined.loops import PassResidue, joined_events, pass_residue
from fatigue.pipeline.count.mission_block import MissionBlock
from fatigue.pipeline.count.overflow import no_overflow
from fatigue.pipeline.mission.event_load import EventLoad, without_spectrum
from fatigue.pipeline.mission.offsets import face_offset
from fatigue.pipeline.solve.modal_stress import ModalStress
from fatigue.weld.structural_stress import RawEnds, StructuralStress


@dataclass(frozen=True, slots=True, eq=False)
class Signals:
    """Stress of n points at two faces each, per unit coordinate, and the rule of the cycles of their curve.

    Attributes
    ----------
    membrane, bending : (n, c) the stress at the faces is membrane + bending and membrane - bending [MPa per unit]
    size : (n,) factor on the range
    rule : how the damage of a cycle follows from its range
    """

    membrane: NDArray[np.float64]
    bending: NDArray[np.float64]
    size: NDArray[np.float64]
    rule: CycleRule

    @classmethod
    def of_pairs(
        cls, one: NDArray[np.float64], other: NDArray[np.float64], size: NDArray[np.float64], rule: CycleRule
    ) -> Self:
        """Two stresses (n, c) that have nothing to do with each other, on a curve that asks for no bending ratio."""
        return cls(0.5 * (one + other), 0.5 * (one - other), size, rule)

    @property
    def stress(self) -> ModalStress:
        """The same as stress of stations, without shear and without ends."""
        no_shear, no_rows = np.zeros(self.membrane.shape), np.zeros((0, self.membrane.shape[1]))
        return ModalStress(
            membrane=self.membrane,
            bending=self.bending,
            in_plane_shear=no_shear,
            twist_shear=no_shear,
            size=self.size,
            rule=self.rule,
            raw_ends=RawEnds(np.zeros(0, dtype=np.intp), StructuralStress(*(no_rows,) * 5)),
            raw_end_matters=np.zeros(0, dtype=np.bool_),
        )


def counted_mission(signals: Signals, loads: Sequence[EventLoad], plan: Plan, names: str) -> MissionBlock:
    """The whole mission of some signals, every cycle counted; the arrays are (n, 2), one column a face.

    ``names`` says in messages whose stresses they are. Two stresses of ``Signals.of_pairs`` are the two columns.

    Raises
    ------
    NumericalError : stress or damage exceeds double precision
    """
    n, stress = len(signals.size), signals.stress
    counted = [without_spectrum(load) for load in loads]
    block = Block(stress, np.zeros(n, dtype=np.int64), np.ones((n, 2), dtype=np.bool_), counted, plan, names)
    settled = sorted(block.all_counted(), key=lambda one: int(one.rows[0]) if one.rows.size else 0)
    missions = [one.mission for one in settled]
    if len(missions) == 1:
        return missions[0]
    fields = MissionBlock.__dataclass_fields__
    return MissionBlock(**{name: np.concatenate([getattr(one, name) for one in missions]) for name in fields})


def counted_damage(signals: Signals, loads: Sequence[EventLoad], plan: Plan, names: str) -> NDArray[np.float64]:
    """Damage per km (n, 2) of ``counted_mission`` alone, for the many signals of which but the worst is looked at.

    Raises
    ------
    NumericalError : stress or damage exceeds double precision
    """
    stress, none = signals.stress, np.zeros((len(signals.size), 2))
    damages, residues = [], []
    for number, load in enumerate(loads):
        with no_overflow(load.counted.event, names):
            membrane, bending = load.stress_factor * stress.membrane, load.stress_factor * stress.bending
            block = BlockStress(membrane, bending, stress.size, none, offset=face_offset(membrane, bending, load))
            residue = PassResidue.nothing(len(none))
            if plan.joins(number):
                count, left = count_and_residue(block, load.record, stress.rule)
                damages.append(count.damage)
                residue = pass_residue(left, block, load)
            else:  # at the factor of 1, as this makes no histogram
                damages.append(count_at_factors(block, load.record, stress.rule, none + 1.0, none, 1)[..., 0])
            residues.append(residue)
    damage = mission_sum(np.stack(damages), plan.passes)
    with no_overflow("mission", names):
        joined = joined_events(stress, plan, residues, residues)
    for loop, block_of_loop in zip(plan.loops, joined.loops, strict=True):
        damage += loop.runs_per_km * block_of_loop.count.damage
    return damage
