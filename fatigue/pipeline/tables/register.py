"""The weld register as a table: every weld with its worst point, and the lines that are not assessed."""

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from fatigue.case import stress_categories
from fatigue.life.mission import Plan, stress_utilisation
from fatigue.life.quality import StressCategories
from fatigue.pipeline.checks.verdict import Verdicts
from fatigue.pipeline.count.result import GroupResult
from fatigue.pipeline.count.worst import EQUAL, WorstPoint
from fatigue.pipeline.solve.model import Model
from fatigue.pipeline.tables.rows import FACES
from fatigue.readers.neutral.body.welds import QUALITY, Weld
from fatigue.readers.neutral.register.weld_register import RegisterRow, description_of
from fatigue.results import WELDS
from fatigue.weld.line_geometry import lengths


def weld_rows(
    model: Model, plan: Plan, result: GroupResult, worst: Sequence[WorstPoint], checks: Verdicts | None = None
) -> dict[str, Any]:
    """Rows of ``welds.parquet``: every weld of the case, with what its ``checks`` say where there are any.

    The worst point is not always the first to miss the target when the load rises: where damage does not scale with one
    power of the load, another one may come to a knee or to the tension at which f_M begins.
    """
    mission = result.mission
    stations, welds, at = model.stations, model.welds, [(p.station, p.face) for p in worst]
    first = stations.first
    part_of_weld = stations.weld[model.lines.begin[:-1]]
    part_lengths = lengths(model.lines)
    life = np.array([mission.life_km[i] for i in at])
    events = [*plan.names, None]
    of_toes = np.where(stations.toe, mission.utilisation, -1.0).max(axis=1)
    largest = np.maximum.reduceat(of_toes, first[:-1])  # or a bound of it
    proven = [bool(EQUAL * largest[p.weld] <= mission.utilisation[p.station, p.face]) for p in worst]
    curves = model.curve_of_weld
    counted_toes = stations.toe & (result.tier == 0)[:, None]
    of_points = np.where(counted_toes, mission.load_factor, np.inf).min(axis=1)
    of_worst = np.array([mission.load_factor[i] for i in at])
    smallest = np.minimum.reduceat(of_points, first[:-1])
    load_factor = np.where(smallest < EQUAL * of_worst, smallest, of_worst)
    failed = np.zeros(len(welds), np.bool_) if checks is None else checks.failed
    fulfilled = np.array([mission.utilisation[i] <= 1.0 for i in at]) & ~failed
    return {
        "weld": stations.names,
        "status": ["assessed"] * len(welds),
        "reason": [""] * len(welds),
        "description": [weld.description for weld in welds],
        "closed": [weld.closed for weld in welds],
        "parts": np.bincount(part_of_weld),
        "nodes": [np.unique(stations.node[a:b]).size for a, b in pairwise(first)],
        "length_mm": np.bincount(part_of_weld, part_lengths),
        "thickness_min_mm": np.minimum.reduceat(stations.thickness, first[:-1]),
        "thickness_max_mm": np.maximum.reduceat(stations.thickness, first[:-1]),
        "surface": [weld.surface for weld in welds],
        "curve": [rated.curve.name for rated in curves],
        "curve_status": [rated.curve.status for rated in curves],
        "edition": [rated.curve.edition for rated in curves],
        "survival": [rated.survival for rated in curves],
        "end_length_mm": [np.nan if weld.end_length is None else weld.end_length for weld in welds],
        "attachment_mm": [np.nan if weld.attachment is None else weld.attachment for weld in welds],
        "damage_limit": [rated.damage_limit(plan.damage_limit) for rated in curves],
        "life_km": life,
        "life_years": life / plan.km_per_year,
        "utilisation": [mission.utilisation[i] for i in at],
        "fulfilled": fulfilled,
        "load_factor": load_factor,
        "worst_is_proven": proven,
        "worst_part": [stations.part[p.station] for p in worst],
        "worst_order": [stations.order[p.station] for p in worst],
        "worst_node": [stations.node[p.station] for p in worst],
        "worst_surface": [FACES[p.face] for p in worst],
        "worst_arc_length_mm": [stations.arc_length[p.station] for p in worst],
        "worst_summed_corner": [bool(stations.summed_corner[p.station]) for p in worst],
        "governing_event": [events[mission.governing[i]] for i in at],
        **_of_checks(checks, len(welds)),
        **quality_rows(
            welds,
            load_factor,
            None if checks is None else checks.utilisation,
            stress_categories(model.case.checks.stress_category),
        ),
    }


def _of_checks(checks: Verdicts | None, welds: int) -> dict[str, Any]:
    """Columns of what is checked beside the normal stress at the toe; without a check in a case that asks for none."""
    if checks is None:
        none, zero = [None] * welds, np.zeros(welds, np.int64)
        return {"worst_check": none, "worst_check_utilisation": none, "checks_not_assessed": zero}
    return {
        "worst_check": [check or None for check in checks.worst],
        "worst_check_utilisation": checks.utilisation,
        "checks_not_assessed": checks.not_assessed,
    }


def quality_rows(
    welds: Sequence[Weld], load_factor: ArrayLike, of_checks: ArrayLike | None, categories: StressCategories
) -> dict[str, Any]:
    """Columns of the quality data.

    ``load_factor`` (w,) is that of the welds' toes, NaN where there is none; ``of_checks`` (w,) the largest stress
    utilisation of their other checks, NaN where nothing else is checked, None: nowhere.
    """
    utilisation = stress_utilisation(np.asarray(load_factor, np.float64))
    if of_checks is not None:
        utilisation = np.fmax(utilisation, np.asarray(of_checks, np.float64))
    return {
        **{name: [getattr(weld, name) or None for weld in welds] for name in QUALITY},
        "stress_utilisation": utilisation,
        "stress_category": categories.of(utilisation),
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
        **{name: [getattr(row, name) or None for row in excluded] for name in QUALITY},
    }


def _reason(row: RegisterRow) -> str:
    """Why a line is not assessed; the register may call it a candidate."""
    return f"candidate: {row.reason}" if row.reason and row.status == "candidate" else row.reason or row.status
