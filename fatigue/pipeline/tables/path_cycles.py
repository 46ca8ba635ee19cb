"""Half cycles of the paths of normal stress and shear that matter, with the instants of each.

Kept is of every weld the point with the largest sum by range, from a tenth of the damage limit on, of those that only
the counter could settle, or of all where a method of the path counter decides: what the other points have are sums, in
``nodes.parquet``. Paths are counted again here, a few points at a time.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from fatigue.life.path.count import COUNT
from fatigue.life.rule import cycle_damage
from fatigue.pipeline.count.worst import ABOVE, EQUAL
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.multiaxial.counted import PathParts, Point, paths_of
from fatigue.pipeline.multiaxial.found import STATUSES
from fatigue.pipeline.run.workers import Group
from fatigue.pipeline.tables.batches import Batches
from fatigue.pipeline.tables.rows import FACES
from fatigue.results import TableWriter, coded

POINTS_AT_ONCE = 16  # a record is read once for so many


@dataclass(frozen=True, slots=True, eq=False)
class KeptPath:
    """A toe point whose half cycles are kept, without the stations it is one of."""

    weld: str
    part: int
    node: int
    order: int
    point: Point


def path_writer(table: TableWriter, loads: Sequence[EventLoad], beta: float) -> Batches[KeptPath]:
    """Writer of the half cycles of points that come a few at a time, ``POINTS_AT_ONCE`` of them at once."""
    return Batches(POINTS_AT_ONCE, partial(_write, table, loads, beta))


def _write(table: TableWriter, loads: Sequence[EventLoad], beta: float, points: Sequence[KeptPath]) -> None:
    for load in loads:
        found = paths_of([kept.point for kept in points], load, beta)
        for kept, parts in zip(points, found, strict=True):
            table.write(path_rows(kept, load, parts))


def kept_paths(group: Group, *, everything: bool) -> list[KeptPath]:
    """The points of a group of welds whose half cycles go into ``path_cycles.parquet``; the first of equal ones.

    With ``everything`` any counted point may be one of them.
    """
    stations, found = group.model.stations, group.result.multiaxial
    open_ = np.isin(found["status"], (STATUSES.index("fails"), STATUSES.index("counted"))) | everything
    by_range = np.where(stations.toe & open_, np.nan_to_num(found["range"], nan=-1.0), -1.0)
    kept = []
    for weld, rated in enumerate(group.model.curve_of_weld):
        first, end = stations.first[weld : weld + 2]
        of_weld = by_range[first:end]
        if of_weld.max() < ABOVE:
            continue
        at, face = divmod(int((of_weld >= EQUAL * of_weld.max()).argmax()), 2)
        station, treated = int(first) + at, stations.treated
        parts = (treated.membrane, treated.bending, treated.in_plane_shear, treated.twist_shear)
        size = float(rated.size(stations.thickness[station : station + 1])[0])
        point = Point(np.stack([part[station] for part in parts]), face, size, rated.rule)
        part, node, order = (int(column[station]) for column in (stations.part, stations.node, stations.order))
        kept.append(KeptPath(stations.names[weld], part, node, order, point))
    return kept


def path_rows(kept: KeptPath, load: EventLoad, parts: PathParts) -> dict[str, Any]:
    """Rows of ``path_cycles.parquet``: the half cycles of a point in one event."""
    cycles, n = parts.cycles, len(parts.x)
    same = np.zeros(n, dtype=np.int32)
    return {
        "weld": coded(same, [kept.weld]),
        "part": np.full(n, kept.part),
        "node": np.full(n, kept.node),
        "order": np.full(n, kept.order),
        "surface": coded(same, [FACES[kept.point.face]]),
        "event": coded(same, [load.counted.event]),
        "start_s": load.counted.start + load.counted.step * cycles.start,
        "end_s": load.counted.start + load.counted.step * cycles.end,
        "range_MPa": cycles.range,
        "path_factor": cycles.factor,
        "path_moment": cycles.moment,
        "normal_range_MPa": parts.between.normal,
        "shear_range_MPa": parts.between.shear,
        "bending_ratio": parts.between.bending_ratio,
        "shear_bending_ratio": parts.between.shear_bending_ratio,
        "equivalent_range_dS": parts.x,
        "damage": COUNT * cycle_damage(parts.x, kept.point.rule.law),
    }
