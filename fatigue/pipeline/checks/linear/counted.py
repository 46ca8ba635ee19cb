"""What the counted mission of some stresses says in the rows of their check."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.life.mission import Plan, stress_utilisation
from fatigue.life.rule import CycleRule
from fatigue.pipeline.checks.linear.signals import Signals, counted_mission
from fatigue.pipeline.count.mission_block import MissionBlock
from fatigue.pipeline.mission.event_load import EventLoad

ALL = slice(None)  # rows of a mission


def counted_columns(
    mission: MissionBlock, row: slice | NDArray[np.intp], face: int | NDArray[np.intp], plan: Plan
) -> dict[str, NDArray[Any]]:
    """Columns of ``check_rows`` (n,) for n counted points: some rows of a mission, at one face or each at its own."""
    per_km = mission.damage_per_km[row, face]
    return {
        "range_max_MPa": mission.max_range[row, face],
        "damage_per_km": per_km,
        "damage_sum": per_km * plan.target_km,
        "damage_limit": np.full(len(per_km), plan.damage_limit),
        "utilisation_stress": stress_utilisation(mission.load_factor[row, face]),
        "fulfilled": (mission.utilisation[row, face] <= 1.0).astype(np.int64),
        "governing_event": np.array([*plan.names, ""])[mission.governing[row, face]],
    }


def counted_each(
    stresses: Sequence[NDArray[np.float64]],
    size: NDArray[np.float64],
    rule: CycleRule,
    loads: Sequence[EventLoad],
    plan: Plan,
    names: str,
) -> list[dict[str, NDArray[Any]]]:
    """Columns of ``check_rows`` (n,) for each of some stresses (n, c) without bending, at n points of these sizes.

    Two stresses are counted side by side, unless the damage of a cycle depends on its bending ratio: two stresses are
    no membrane and bending stress.

    Raises
    ------
    NumericalError : stress or damage exceeds double precision
    """
    found = []
    at_once = 1 if rule.depends_on_bending else 2
    for first in range(0, len(stresses), at_once):
        some = stresses[first : first + at_once]
        nothing = np.zeros_like(some[0])
        if at_once == 1:
            signals = Signals(some[0], nothing, size, rule)
        else:
            signals = Signals.of_pairs(some[0], some[1] if len(some) == 2 else nothing, size, rule)
        mission = counted_mission(signals, loads, plan, names)
        found += [counted_columns(mission, ALL, face, plan) for face in range(len(some))]
    return found
