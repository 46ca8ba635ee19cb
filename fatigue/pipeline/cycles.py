"""Every cycle of the points that govern: the table behind a weld's life, with the instants of each cycle."""

from typing import Any

import numpy as np

from fatigue.life.damage import bending_ratio, cycle_damage, mean_stress_factor, ratio_factor, size_factor
from fatigue.life.rainflow import rainflow
from fatigue.pipeline.event_load import EventLoad
from fatigue.pipeline.model import Model
from fatigue.pipeline.register import WorstPoint
from fatigue.pipeline.rows import FACES


def point_cycles(model: Model, load: EventLoad, point: WorstPoint) -> dict[str, Any]:
    """Count one event at one point and keep every cycle, with the stress ranges between its own two instants."""
    stations, at = model.stations, point.station
    rated = model.curves[model.curve_of_weld[point.weld]]
    q = load.counted.q.astype(np.float64, copy=False)
    membrane = load.stress_factor * stations.treated.membrane[at] @ q
    bending = load.stress_factor * stations.treated.bending[at] @ q
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
    return {
        "weld": np.full(n, model.welds[point.weld].name, dtype=object),
        "part": np.full(n, stations.part[at]),
        "node": np.full(n, stations.node[at]),
        "order": np.full(n, stations.order[at]),
        "surface": np.full(n, FACES[point.face], dtype=object),
        "event": np.full(n, load.counted.event, dtype=object),
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
