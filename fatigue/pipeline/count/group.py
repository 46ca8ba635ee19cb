"""One group of welds under all events of the mission, curve by curve."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from fatigue.life.mission import Plan
from fatigue.pipeline.count.block import Block
from fatigue.pipeline.count.bounds import Screening
from fatigue.pipeline.count.result import GroupResult
from fatigue.pipeline.count.settle import settle
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.solve.model import Model
from fatigue.pipeline.solve.stations import Stations, modal_stress


def assess_group(model: Model, loads: Sequence[EventLoad], plan: Plan, screening: Screening | None) -> GroupResult:
    """Result of a group of welds: every event counted at every station, or at the stations that screening leaves.

    Raises
    ------
    NumericalError : stress or damage exceeds double precision
    """
    stations = model.stations
    result = GroupResult.empty(len(loads), len(stations), len(plan.loops))
    for rated, rows in model.by_curve():
        stress, names = modal_stress(stations, rows, rated), weld_names(stations, rows)
        block = Block(stress, stations.weld[rows], stations.toe[rows], loads, rated.plan(plan), names)
        for settled in block.all_counted() if screening is None else settle(block, screening):
            result.put(settled, rows[settled.rows])
    return result


def weld_names(stations: Stations, rows: NDArray[np.intp]) -> str:
    """Welds of some stations in words."""
    names = sorted({stations.welds[i].name for i in stations.weld[rows]})
    return f"welds {names[0]} to {names[-1]}"
