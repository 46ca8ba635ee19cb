"""Linear stresses of some points, counted over the mission as the stress at a toe is."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from fatigue.life.mission import Plan
from fatigue.life.rule import CycleRule
from fatigue.pipeline.count.block import Block
from fatigue.pipeline.count.mission_block import MissionBlock
from fatigue.pipeline.mission.event_load import EventLoad, without_spectrum
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


def counted_mission(signals: Signals, loads: Sequence[EventLoad], plan: Plan, names: str) -> MissionBlock:
    """The whole mission of some signals, every cycle counted; the arrays are (n, 2), one column a face.

    ``names`` says in messages whose stresses they are. Two stresses of ``Signals.of_pairs`` are the two columns.

    Raises
    ------
    NumericalError : stress or damage exceeds double precision
    """
    n, shape = len(signals.size), signals.membrane.shape
    no_shear, no_rows = np.zeros(shape), np.zeros((0, shape[1]))
    stress = ModalStress(
        membrane=signals.membrane,
        bending=signals.bending,
        in_plane_shear=no_shear,
        twist_shear=no_shear,
        size=signals.size,
        rule=signals.rule,
        raw_ends=RawEnds(np.zeros(0, dtype=np.intp), StructuralStress(*(no_rows,) * 5)),
        raw_end_matters=np.zeros(0, dtype=np.bool_),
    )
    counted = [without_spectrum(load) for load in loads]
    block = Block(stress, np.zeros(n, dtype=np.int64), np.ones((n, 2), dtype=np.bool_), counted, plan, names)
    settled = sorted(block.all_counted(), key=lambda one: int(one.rows[0]) if one.rows.size else 0)
    missions = [one.mission for one in settled]
    if len(missions) == 1:
        return missions[0]
    fields = MissionBlock.__dataclass_fields__
    return MissionBlock(**{name: np.concatenate([getattr(one, name) for one in missions]) for name in fields})
