"""Half cycles of the paths of normal stress and shear that matter, with the instants of each.

Kept is of every weld the counted toe point with the largest sum by range, from a tenth of the damage limit on: what the
other points have are sums, in ``nodes.parquet``. Paths are counted again here, a few points at a time.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from fatigue.life.path.count import COUNT
from fatigue.life.rule import cycle_damage
from fatigue.pipeline.count.worst import ABOVE, EQUAL
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.multiaxial.counted import PathParts, Point, paths_of
from fatigue.pipeline.run.workers import Group
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


class PathWriter:
    """Writes the half cycles of points that come a few at a time, always ``POINTS_AT_ONCE`` of them at once."""

    def __init__(self, table: TableWriter, loads: Sequence[EventLoad], beta: float) -> None:
        self._table, self._loads, self._beta = table, loads, beta
        self._waiting: list[KeptPath] = []

    def add(self, points: Sequence[KeptPath]) -> None:
        """Have the half cycles of some more points written, sooner or later."""
        self._waiting += points
        while len(self._waiting) >= POINTS_AT_ONCE:
            self._write(self._waiting[:POINTS_AT_ONCE])
            self._waiting = self._waiting[POINTS_AT_ONCE:]

    def flush(self) -> None:
        """Write what is waiting."""
        self._write(self._waiting)
        self._waiting = []

    def _write(self, points: Sequence[KeptPath]) -> None:
        for load in self._loads:
            found = paths_of([kept.point for kept in points], load, self._beta)
            for kept, parts in zip(points, found, strict=True):
                self._table.write(path_rows(kept, load, parts))


def kept_paths(group: Group) -> list[KeptPath]:
    """The points of a group of welds whose half cycles go into ``path_cycles.parquet``; the first of equal ones."""
    stations, found = group.model.stations, group.result.multiaxial
    by_range = np.where(stations.toe, np.nan_to_num(found["range"], nan=-1.0), -1.0)
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
