"""Utilisation of some stations, their cycles counted again with another rule, size or record."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from fatigue.life.counting.block import BlockStress
from fatigue.life.counting.count import count, count_and_residue
from fatigue.life.mission import Plan
from fatigue.life.rule import CycleRule
from fatigue.pipeline.count.joined.loops import PassResidue, joined_events, pass_residue
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.mission.offsets import face_offset
from fatigue.pipeline.solve.modal_stress import ModalStress


def counted_again(
    stress: ModalStress,
    rule: CycleRule,
    size: NDArray[np.float64],
    loads: Sequence[EventLoad],
    plan: Plan,
) -> NDArray[np.float64]:
    """Utilisation (n, 2) of the whole mission at both faces of some stations, cycles across events included.

    Raises
    ------
    NumericalError : a stress is not finite
    """
    stress = replace(stress, rule=rule, size=size)
    damage = np.zeros((len(stress), 2))
    residues = []
    for number, (load, one_pass) in enumerate(zip(loads, plan.passes, strict=True)):
        membrane, bending = load.stress_factor * stress.membrane, load.stress_factor * stress.bending
        offset = face_offset(membrane, bending, load)
        block = BlockStress(membrane, bending, size, np.zeros((len(stress), 2)), offset=offset)
        if plan.loops and plan.joins(number):
            found, open_end = count_and_residue(block, load.record, rule)
            residues.append(pass_residue(open_end, block, load))
        else:
            found = count(block, load.record, rule)
            residues.append(PassResidue.nothing(len(stress)))
        damage += one_pass.passes_per_km * found.damage
    if plan.loops:
        joined = joined_events(stress, plan, residues, residues)
        for loop, block_of_loop in zip(plan.loops, joined.loops, strict=True):
            damage += loop.runs_per_km * block_of_loop.count.damage
    return damage * (plan.target_km / plan.damage_limit)
