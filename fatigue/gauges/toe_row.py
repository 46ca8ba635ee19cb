"""A stand-in for a gauge at a weld toe: the raw structural stress of a face, across the line, in plane strain.

It is for planning. A real grid sits beside the toe and sees another strain, so a stand-in proves nothing about it.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem
from fatigue.gauges.gauge_file import Gauge
from fatigue.pipeline.solve.model import Model
from fatigue.shown import few
from fatigue.weld.line_geometry import local_axes

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class AtToe:
    """Raw structural stress of a face (c,) [MPa], axes y' (across the line), x', z' as rows, place and plate."""

    stress: Floats
    axes: Floats
    xyz: Floats
    thickness: float
    part: int


def at_toe(gauge: Gauge, models: Mapping[str, Model]) -> AtToe:
    """Stress before the treatment of weld ends at the station of a gauge; ``models``: solved welds by their names.

    Raises
    ------
    DataError : there is no such station, or there are several
    """
    if gauge.weld not in models:
        what = f"there is no weld {gauge.weld!r} that is assessed"
        raise DataError(Problem("unknown_id", gauge.where, what, "Correct weld, or have it assessed"))
    stations, lines = models[gauge.weld].stations, models[gauge.weld].lines
    number = stations.names.index(gauge.weld)
    of_weld = np.flatnonzero(stations.weld == number)
    found = of_weld[stations.order[of_weld] == gauge.order]
    if not found.size:
        orders = stations.order[of_weld]
        what = f"weld {gauge.weld} has no node of order {gauge.order}, but {orders.min()} to {orders.max()}"
        raise DataError(Problem("unknown_id", gauge.where, what, "Correct order"))
    parts = stations.part[found]
    if gauge.part is not None:
        found = found[parts == gauge.part]
    if found.size != 1:
        what = f"order {gauge.order} of weld {gauge.weld} is in part {few(parts.tolist())}"
        what += f", and not in {gauge.part}" if gauge.part is not None else ""
        raise DataError(Problem("part", gauge.where, what, "Give one of these as part"))
    at, sign = int(found[0]), 1.0 if gauge.surface == "top" else -1.0
    membrane, bending = stations.treated.membrane[at], stations.treated.bending[at]
    if (end := np.flatnonzero(stations.raw_ends.rows == at)).size:
        raw = stations.raw_ends.stress
        membrane, bending = raw.membrane[end[0]], raw.bending[end[0]]
    x, y, z = local_axes(lines)[at]
    return AtToe(
        stress=membrane + sign * bending,
        axes=np.stack([y, -x, z]),
        xyz=stations.xyz[at],
        thickness=float(stations.thickness[at]),
        part=int(stations.part[at]),
    )
