"""Every cycle of the points that govern: the table behind a weld's life, with the instants of each cycle."""

from collections.abc import Iterator, Sequence
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.life.counting.long_rainflow import long_cycles
from fatigue.life.counting.rainflow import Cycles, rainflow
from fatigue.life.counting.signal import middle
from fatigue.life.counting.vertex import vertex_history
from fatigue.life.mission import Plan
from fatigue.life.records.history import stress_chunks, stress_history
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.mission.offsets import face_offset
from fatigue.pipeline.tables.batches import Batches
from fatigue.pipeline.tables.cycle_rows import CycleParts, KeptPoint, cycle_rows
from fatigue.pipeline.tables.sequence_cycles import sequence_rows
from fatigue.results import TableWriter

POINTS_AT_ONCE = 16  # a record is read once for so many, whatever groups of welds they are from
_SAMPLES_AT_ONCE = 2_000_000  # of membrane and bending stress: 16 MB


def cycle_writer(table: TableWriter, loads: Sequence[EventLoad], plan: Plan | None = None) -> Batches[KeptPoint]:
    """Writer of the cycles of points that come a few at a time, ``POINTS_AT_ONCE`` of them at once."""
    return Batches(POINTS_AT_ONCE, partial(_write, table, loads, plan))


def _write(table: TableWriter, loads: Sequence[EventLoad], plan: Plan | None, points: Sequence[KeptPoint]) -> None:
    for load in loads:
        for rows in point_cycles(points, load):
            table.write(rows)
    if plan is not None and plan.loops:
        for rows in sequence_rows(points, loads, plan):
            table.write(rows)


def point_cycles(points: Sequence[KeptPoint], load: EventLoad) -> Iterator[dict[str, Any]]:
    """Rows of ``cycles.parquet``, some points at a time: every cycle of one event, of one point after the other.

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
        parts = [_cycles_of(point, load, membrane[i], bending[i]) for i, point in enumerate(some)]
        yield cycle_rows(some, load.counted.event, parts)


def _long_rows(point: KeptPoint, load: EventLoad) -> Iterator[dict[str, Any]]:
    """Rows of one point in a record whose stress is not held in memory, some cycles at a time."""
    modal = load.stress_factor * np.stack([point.membrane, point.bending])

    def chunks() -> Iterator[tuple[NDArray[np.float64], NDArray[np.float64]]]:
        return ((membrane, bending) for membrane, bending in stress_chunks(modal, load.counted.q))

    for piece in long_cycles(chunks, point.side, load.residue, vertex=load.vertex):
        (start, end), (s_i, s_j) = piece.at.T, piece.stress.T
        cycles = Cycles(np.abs(s_j - s_i), middle(s_i, s_j), piece.weight, start, end)
        dm, db = (np.abs(np.diff(part, axis=1)[:, 0]) for part in (piece.membrane, piece.bending))
        at = piece.at.astype(np.float64) + piece.shift
        parts = _parts_of(point, load, cycles, dm, db, np.minimum(s_i, s_j), at)
        yield cycle_rows([point], load.counted.event, [parts])


def _cycles_of(
    point: KeptPoint, load: EventLoad, membrane: NDArray[np.float64], bending: NDArray[np.float64]
) -> CycleParts:
    """Cycles of one point with these stress histories (t,) [MPa]."""
    side, shift = point.side, np.zeros(membrane.size if load.vertex else 0)
    if load.vertex:
        membrane, bending, shift = vertex_history(membrane, bending, side, recurs=load.record.recurs)
    stress = membrane + side * bending
    cycles = rainflow(stress, load.residue)
    at = np.stack([cycles.start, cycles.end], axis=1).astype(np.float64)
    at += shift[at.astype(np.intp)] if load.vertex else 0.0
    dm, db = (np.abs(s[cycles.end] - s[cycles.start]) for s in (membrane, bending))
    return _parts_of(point, load, cycles, dm, db, np.minimum(stress[cycles.start], stress[cycles.end]), at)


def _parts_of(
    point: KeptPoint,
    load: EventLoad,
    cycles: Cycles,
    dm: NDArray[np.float64],
    db: NDArray[np.float64],
    minimum: NDArray[np.float64],
    at: NDArray[np.float64],
) -> CycleParts:
    """Some cycles (c,), with their ranges of membrane and bending stress and their smallest stress [MPa].

    ``at`` (c, 2) are their two instants, in steps from the first sample.
    """
    modal = load.stress_factor * np.stack([point.membrane, point.bending])
    of_faces = face_offset(modal[:1], modal[1:], load)
    offset = 0.0 if of_faces is None else float(of_faces[0, point.face])
    step, start = load.counted.step, load.counted.start
    times = start + step * at[:, 0], start + step * at[:, 1]
    return CycleParts(cycles.range, cycles.mean + offset, cycles.count, dm, db, minimum + offset, *times)
