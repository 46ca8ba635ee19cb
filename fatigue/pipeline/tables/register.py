"""The weld register: every weld with its worst point, which alone decides its verdict."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from fatigue.life.mission import Plan
from fatigue.pipeline.count.group import GroupResult
from fatigue.pipeline.count.mission_block import MissionBlock
from fatigue.pipeline.solve.model import Model, toe_faces
from fatigue.pipeline.tables.rows import FACES
from fatigue.readers.neutral.register.weld_register import RegisterRow, description_of
from fatigue.results import WELDS
from fatigue.weld.line_geometry import lengths

EQUAL = 1.0 - 1e-12  # what is so close to the worst point is as bad: only the order of sums differs


@dataclass(frozen=True, slots=True)
class WorstPoint:
    """The toe point of a weld with the shortest life: index of weld, station and face."""

    weld: int
    station: int
    face: int


def worst_points(model: Model, result: GroupResult) -> tuple[WorstPoint, ...]:
    """Find the worst toe point of every weld; the first along the line where several are equal.

    A point that a bound has settled is never worse than the worst one that was counted.
    """
    counted = (result.tier == 0)[:, None]
    utilisation = np.where(counted & toe_faces(model), result.mission.utilisation, -1.0)
    worst = []
    for weld, (first, end) in enumerate(pairwise(_first_stations(model))):
        of_weld = utilisation[first:end]
        at, face = divmod(int((of_weld >= EQUAL * of_weld.max()).argmax()), 2)
        worst.append(WorstPoint(weld, first + at, face))
    return tuple(worst)


def _first_stations(model: Model) -> list[int]:
    """First station of every weld, and the number of stations."""
    found: list[int] = np.searchsorted(model.stations.weld, np.arange(len(model.welds) + 1)).tolist()
    return found


def weld_rows(model: Model, plan: Plan, mission: MissionBlock, worst: Sequence[WorstPoint]) -> dict[str, Any]:
    """Rows of ``welds.parquet``: every weld of the case."""
    first = _first_stations(model)
    part_of_weld = model.stations.weld[model.lines.begin[:-1]]
    part_lengths = lengths(model.lines)
    stations, at = model.stations, [(p.station, p.face) for p in worst]
    life = np.array([mission.life_km[i] for i in at])
    events = [*(p.event for p in plan.passes), None]
    of_toes = np.where(toe_faces(model), mission.utilisation, -1.0).max(axis=1)
    largest = np.maximum.reduceat(of_toes, first[:-1])  # or a bound of it
    proven = [bool(EQUAL * largest[p.weld] <= mission.utilisation[p.station, p.face]) for p in worst]
    curves = [model.curves[name] for name in model.curve_of_weld]
    return {
        "weld": [weld.name for weld in model.welds],
        "status": ["assessed"] * len(model.welds),
        "reason": [""] * len(model.welds),
        "description": [weld.description for weld in model.welds],
        "closed": [weld.closed for weld in model.welds],
        "parts": np.bincount(part_of_weld),
        "nodes": [np.unique(stations.node[a:b]).size for a, b in pairwise(first)],
        "length_mm": np.bincount(part_of_weld, part_lengths),
        "thickness_min_mm": np.minimum.reduceat(stations.thickness, first[:-1]),
        "thickness_max_mm": np.maximum.reduceat(stations.thickness, first[:-1]),
        "surface": [weld.surface for weld in model.welds],
        "curve": [rated.curve.name for rated in curves],
        "survival": [rated.survival for rated in curves],
        "end_length_mm": [np.nan if weld.end_length is None else weld.end_length for weld in model.welds],
        "life_km": life,
        "life_years": life / plan.km_per_year,
        "utilisation": [mission.utilisation[i] for i in at],
        "fulfilled": [bool(mission.utilisation[i] <= 1.0) for i in at],
        "load_factor": [mission.load_factor[i] for i in at],
        "worst_is_proven": proven,
        "worst_part": [stations.part[p.station] for p in worst],
        "worst_order": [stations.order[p.station] for p in worst],
        "worst_node": [stations.node[p.station] for p in worst],
        "worst_surface": [FACES[p.face] for p in worst],
        "worst_arc_length_mm": [stations.arc_length[p.station] for p in worst],
        "governing_event": [events[mission.governing[i]] for i in at],
    }


def excluded_rows(excluded: Sequence[RegisterRow]) -> dict[str, Any]:
    """Rows of ``welds.parquet`` for the lines that are listed and not assessed, with the reason."""
    rows: dict[str, Any] = {column.name: [None] * len(excluded) for column in WELDS}
    return rows | {
        "weld": [row.weld for row in excluded],
        "status": ["excluded"] * len(excluded),
        "reason": [_reason(row) for row in excluded],
        "description": [description_of([row]) for row in excluded],
        "nodes": [row.nodes or None for row in excluded],
        "length_mm": [row.length for row in excluded],
    }


def _reason(row: RegisterRow) -> str:
    """Say why a line is not assessed, and that it might be where the register calls it a candidate."""
    return f"candidate: {row.reason}" if row.reason and row.status == "candidate" else row.reason or row.status
