"""Every cycle of the points that govern: the table behind a weld's life, with the instants of each cycle."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.life.damage import bending_ratio, cycle_damage, mean_stress_factor, ratio_factor, size_factor
from fatigue.life.history import stress_history
from fatigue.life.rainflow import rainflow
from fatigue.pipeline.event_load import EventLoad
from fatigue.pipeline.model import Model
from fatigue.pipeline.register import WorstPoint
from fatigue.pipeline.rows import FACES
from fatigue.results import coded

_SAMPLES_AT_ONCE = 4_000_000  # of membrane and bending stress: 32 MB


def point_cycles(model: Model, load: EventLoad, points: Sequence[WorstPoint]) -> Iterator[dict[str, Any]]:
    """Count one event at some points and keep every cycle, with the stress ranges between its own two instants.

    Gives the rows of ``cycles.parquet`` of one point after the other, in their order.
    """
    treated = model.stations.treated
    at_once = max(1, _SAMPLES_AT_ONCE // (2 * load.counted.q.shape[1]))
    for first in range(0, len(points), at_once):
        some = points[first : first + at_once]
        at = [point.station for point in some]
        shapes = load.stress_factor * np.concatenate([treated.membrane[at], treated.bending[at]])
        membrane, bending = np.split(stress_history(shapes, load.counted.q), 2)
        for i, point in enumerate(some):
            yield _cycle_rows(model, load, point, membrane[i], bending[i])


def _cycle_rows(
    model: Model, load: EventLoad, point: WorstPoint, membrane: NDArray[np.float64], bending: NDArray[np.float64]
) -> dict[str, Any]:
    """Count at one point with these stress histories (t,) [MPa]."""
    stations, at = model.stations, point.station
    rated = model.curves[model.body.curve_of(model.welds[point.weld])]
    stress = membrane + bending if point.face == 0 else membrane - bending

    cycles = rainflow(stress, load.residue)
    dm, db = (np.abs(s[cycles.end] - s[cycles.start]) for s in (membrane, bending))
    r = bending_ratio(dm, db)
    size = size_factor(stations.thickness[at : at + 1], rated.curve, model.case.curve.thickness_rule)
    dS = cycles.range * size / (ratio_factor(r) if rated.curve.applies == "dS" else 1.0)
    if model.case.curve.mean_stress == "asme" and model.case.curve.yield_MPa is not None:
        low = np.minimum(stress[cycles.start], stress[cycles.end])
        dS = dS / mean_stress_factor(low, low + cycles.range, model.case.curve.yield_MPa)

    n = len(cycles.range)
    step, start = load.counted.step, load.counted.start
    same = np.zeros(n, dtype=np.int32)
    return {
        "weld": coded(same, [model.welds[point.weld].name]),
        "part": np.full(n, stations.part[at]),
        "node": np.full(n, stations.node[at]),
        "order": np.full(n, stations.order[at]),
        "surface": coded(same, [FACES[point.face]]),
        "event": coded(same, [load.counted.event]),
        "start_s": start + step * cycles.start,
        "end_s": start + step * cycles.end,
        "range_MPa": cycles.range,
        "mean_MPa": cycles.mean,
        "count": cycles.count,
        "membrane_range_MPa": dm,
        "bending_range_MPa": db,
        "bending_ratio": r,
        "equivalent_range_dS": dS,
        "damage": cycles.count * cycle_damage(dS, rated.law),
    }
