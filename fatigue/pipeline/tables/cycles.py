"""Every cycle of the points that govern: the table behind a weld's life, with the instants of each cycle."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.life.counting.long_rainflow import long_cycles
from fatigue.life.counting.rainflow import Cycles, rainflow
from fatigue.life.counting.signal import middle
from fatigue.life.records.history import stress_chunks, stress_history
from fatigue.life.rule import bending_ratio, cycle_damage, equivalent_range
from fatigue.pipeline.count.worst import WorstPoint
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.mission.offsets import face_offset
from fatigue.pipeline.solve.model import Model
from fatigue.pipeline.solve.rated_curves import RatedCurve
from fatigue.pipeline.tables.rows import FACES
from fatigue.results import TableWriter, coded

POINTS_AT_ONCE = 16  # a record is read once for so many, whatever groups of welds they are from
_SAMPLES_AT_ONCE = 4_000_000  # of membrane and bending stress: 32 MB


@dataclass(frozen=True, slots=True, eq=False)
class KeptPoint:
    """A point whose cycles are kept, without the stations it is one of.

    ``membrane`` and ``bending`` (m,) are its modal stress, of the top face [MPa per unit modal coordinate];
    ``thickness`` is the thickness of its plate [mm].
    """

    weld: str
    part: int
    node: int
    order: int
    face: int
    thickness: float
    membrane: NDArray[np.float64]
    bending: NDArray[np.float64]
    rated: RatedCurve


class CycleWriter:
    """Writes the cycles of points that come a few at a time, always ``POINTS_AT_ONCE`` of them at once."""

    def __init__(self, table: TableWriter, loads: Sequence[EventLoad]) -> None:
        self._table, self._loads = table, loads
        self._waiting: list[KeptPoint] = []

    def add(self, points: Sequence[KeptPoint]) -> None:
        """Have the cycles of some more points written, sooner or later."""
        self._waiting += points
        while len(self._waiting) >= POINTS_AT_ONCE:
            self._write(self._waiting[:POINTS_AT_ONCE])
            self._waiting = self._waiting[POINTS_AT_ONCE:]

    def flush(self) -> None:
        """Write what is waiting."""
        self._write(self._waiting)
        self._waiting = []

    def _write(self, points: Sequence[KeptPoint]) -> None:
        for load in self._loads:
            for rows in point_cycles(points, load):
                self._table.write(rows)


def kept_point(model: Model, point: WorstPoint) -> KeptPoint:
    """What the cycles of a point need of the stations of its group of welds."""
    stations, at = model.stations, point.station
    treated = stations.treated
    return KeptPoint(
        weld=stations.welds[point.weld].name,
        part=int(stations.part[at]),
        node=int(stations.node[at]),
        order=int(stations.order[at]),
        face=point.face,
        thickness=float(stations.thickness[at]),
        membrane=treated.membrane[at].copy(),
        bending=treated.bending[at].copy(),
        rated=model.curve_of_weld[point.weld],
    )


def point_cycles(points: Sequence[KeptPoint], load: EventLoad) -> Iterator[dict[str, Any]]:
    """Rows of ``cycles.parquet``: every cycle of one event, of one point after the other.

    A cycle has the stress ranges between its own two instants.
    """
    at_once = _SAMPLES_AT_ONCE // (2 * load.counted.q.shape[1])
    if at_once < 2:
        for point in points:
            yield from _long_rows(point, load)
        return
    for first in range(0, len(points), at_once):
        some = points[first : first + at_once]
        stress = load.stress_factor * np.stack([*(p.membrane for p in some), *(p.bending for p in some)])
        membrane, bending = np.split(stress_history(stress, load.counted.q), 2)
        for i, point in enumerate(some):
            yield _cycle_rows(point, load, membrane[i], bending[i])


def _long_rows(point: KeptPoint, load: EventLoad) -> Iterator[dict[str, Any]]:
    """Rows of one point in a record whose stress is not held in memory, some cycles at a time."""
    modal = load.stress_factor * np.stack([point.membrane, point.bending])

    def chunks() -> Iterator[tuple[NDArray[np.float64], NDArray[np.float64]]]:
        return ((membrane, bending) for membrane, bending in stress_chunks(modal, load.counted.q))

    for piece in long_cycles(chunks, 1.0 if point.face == 0 else -1.0, load.residue):
        (start, end), (s_i, s_j) = piece.at.T, piece.stress.T
        cycles = Cycles(np.abs(s_j - s_i), middle(s_i, s_j), piece.weight, start, end)
        dm, db = (np.abs(np.diff(part, axis=1)[:, 0]) for part in (piece.membrane, piece.bending))
        yield _rows(point, load, cycles, dm, db, np.minimum(s_i, s_j))


def _cycle_rows(
    point: KeptPoint, load: EventLoad, membrane: NDArray[np.float64], bending: NDArray[np.float64]
) -> dict[str, Any]:
    """Rows of one point with these stress histories (t,) [MPa]."""
    stress = membrane + bending if point.face == 0 else membrane - bending
    cycles = rainflow(stress, load.residue)
    dm, db = (np.abs(s[cycles.end] - s[cycles.start]) for s in (membrane, bending))
    return _rows(point, load, cycles, dm, db, np.minimum(stress[cycles.start], stress[cycles.end]))


def _rows(
    point: KeptPoint,
    load: EventLoad,
    cycles: Cycles,
    dm: NDArray[np.float64],
    db: NDArray[np.float64],
    minimum: NDArray[np.float64],
) -> dict[str, Any]:
    """Rows of some cycles (c,), with their ranges of membrane and bending stress and their smallest stress [MPa]."""
    rated, rule = point.rated, point.rated.rule
    r = bending_ratio(dm, db)
    size = rated.size(np.array([point.thickness]))
    modal = load.stress_factor * np.stack([point.membrane, point.bending])
    of_faces = face_offset(modal[:1], modal[1:], load)
    offset = 0.0 if of_faces is None else float(of_faces[0, point.face])
    f_M = rule.mean_stress_factor(minimum + offset, minimum + offset + cycles.range)
    dS = equivalent_range(cycles.range, size, rule.ratio_factor(r), f_M)

    n = len(cycles.range)
    step, start = load.counted.step, load.counted.start
    same = np.zeros(n, dtype=np.int32)
    return {
        "weld": coded(same, [point.weld]),
        "part": np.full(n, point.part),
        "node": np.full(n, point.node),
        "order": np.full(n, point.order),
        "surface": coded(same, [FACES[point.face]]),
        "event": coded(same, [load.counted.event]),
        "start_s": start + step * cycles.start,
        "end_s": start + step * cycles.end,
        "range_MPa": cycles.range,
        "mean_MPa": cycles.mean + offset,
        "count": cycles.count,
        "membrane_range_MPa": dm,
        "bending_range_MPa": db,
        "bending_ratio": r,
        "equivalent_range_dS": dS,
        "damage": cycles.count * cycle_damage(dS, rule.law),
    }
