"""The spectrum of ranges of the points that decide: how many cycles of which range one pass has, in narrow classes.

A point that was counted is counted again in double precision, and its cycles are sorted into 64 classes per decade,
once by the range S and once by the equivalent range dS, so that other curves and other loads need no records any more.
Points wait until there are enough of them to read a record for. Only classes with cycles make rows. Of the cycles
across events those that close count as they are, and those that they replace below 0.

The same count gives the damage of each point in pieces of the record, for the table of bands beside this one.
"""

from collections.abc import Sequence
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from fatigue.life.band.load import PIECES
from fatigue.life.counting.block import BINS_PER_DECADE, HISTOGRAM_BINS, BlockStress
from fatigue.life.counting.count import count_top_and_pieces
from fatigue.life.mission import Plan
from fatigue.pipeline.life_band.lives import MissionHistogram
from fatigue.pipeline.life_band.points import BandPoint
from fatigue.pipeline.life_band.rows import BandRows
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.mission.offsets import face_offset
from fatigue.pipeline.tables.batches import Batches
from fatigue.pipeline.tables.cycle_rows import KeptPoint
from fatigue.pipeline.tables.rows import FACES
from fatigue.pipeline.tables.sequence_cycles import sequence_rows
from fatigue.results import TableWriter, coded
from fatigue.side_by_side import in_order

KINDS = ("S", "dS")
POINTS_AT_ONCE = 512  # that wait for each other
_POINTS = 128  # counted at a time by one thread,
_POINTS_OF_LOOPS = 32  # whose residues one thread finds at a time
_SAMPLES = 2_000_000  # or fewer, with so many samples of stress in all: 32 MB

_ROW = np.dtype(
    [*((name, np.int32) for name in ("point", "event", "kind", "bin")), ("count", float), ("power_sum", float)]
)


class BinnedPoint(NamedTuple):
    """A point whose histogram is kept, and what its band takes over from the assessment."""

    kept: KeptPoint
    band: BandPoint


def histogram_writer(
    table: TableWriter, bands: BandRows, loads: Sequence[EventLoad], plan: Plan, threads: int | None
) -> Batches[BinnedPoint]:
    """Writer of the histograms of points that come a few at a time, ``POINTS_AT_ONCE`` of them at once.

    Their bands go into ``bands``.
    """
    return Batches(POINTS_AT_ONCE, partial(_write, table, bands, loads, plan, threads))


def _write(
    table: TableWriter,
    bands: BandRows,
    loads: Sequence[EventLoad],
    plan: Plan,
    threads: int | None,
    binned: Sequence[BinnedPoint],
) -> None:
    points = [one.kept for one in binned]
    jobs = [
        (event, of_curve[first : first + _at_once(load)])
        for event, load in enumerate(loads)
        for of_curve in _by_curve(points)
        for first in range(0, len(of_curve), _at_once(load))
    ]
    counted = in_order(lambda job: _filled(points, loads, *job), jobs, threads)
    found, pieces = [rows for rows, _ in counted], np.zeros((len(points), len(loads), PIECES))
    for (event, places), (_, of_places) in zip(jobs, counted, strict=True):
        pieces[places, event] = of_places
    loops = np.zeros((len(points), len(plan.loops)))
    if plan.loops:
        firsts = range(0, len(points), _POINTS_OF_LOOPS)
        of_loops = in_order(lambda first: _of_loops(points, loads, plan, first), firsts, threads)
        found += [rows for rows, _ in of_loops]
        loops = np.concatenate([damage for _, damage in of_loops])
    rows = np.concatenate(found)
    rows = rows[np.lexsort([rows[name] for name in ("bin", "kind", "event", "point")])]
    table.write(_columns(rows, points, plan.names))
    bands.add([one.band for one in binned], pieces, loops, _of_mission(rows, points, plan))


def _by_curve(points: Sequence[KeptPoint]) -> list[list[int]]:
    """Places of points that share a curve, and what it knows of their welds."""
    curves: dict[tuple[str, float], list[int]] = {}
    for place, point in enumerate(points):
        curves.setdefault((point.rated.curve.name, point.rated.attachment), []).append(place)
    return list(curves.values())


def _at_once(load: EventLoad) -> int:
    """How many points are counted at a time: of the record only, so that the bytes do not depend on the machine."""
    return max(1, min(_POINTS, _SAMPLES // max(1, int(load.counted.q.shape[1]))))


def _filled(
    points: Sequence[KeptPoint], loads: Sequence[EventLoad], event: int, places: Sequence[int]
) -> tuple[NDArray[np.void], NDArray[np.float64]]:
    """Classes with cycles of one pass of an event at some points of one curve, and their damage in pieces of time."""
    load, some = loads[event], [points[place] for place in places]
    rated = some[0].rated
    membrane = load.stress_factor * np.stack([point.membrane for point in some])
    bending = load.stress_factor * np.stack([point.side * point.bending for point in some])
    size = rated.size(np.array([point.thickness for point in some]))
    offset = face_offset(membrane, bending, load)
    block = BlockStress(membrane, bending, size, np.zeros((len(some), 2)), offset=offset)
    histogram, pieces = count_top_and_pieces(block, load.record, rated.rule, PIECES)
    at, kind, bin_ = np.nonzero(histogram[..., 0])
    rows = np.empty(len(at), _ROW)
    rows["point"], rows["event"], rows["kind"], rows["bin"] = np.asarray(places)[at], event, kind, bin_
    rows["count"], rows["power_sum"] = histogram[at, kind, bin_].T
    return rows, pieces


def _of_loops(
    points: Sequence[KeptPoint], loads: Sequence[EventLoad], plan: Plan, first: int
) -> tuple[NDArray[np.void], NDArray[np.float64]]:
    """Classes of the cycles across events, loop by loop, at some points from ``first`` on, and damage of one run."""
    some, found = points[first : first + _POINTS_OF_LOOPS], [np.empty(0, _ROW)]
    damage = np.zeros((len(some), len(plan.loops)))
    for number, cycles in enumerate(sequence_rows(some, loads, plan)):  # all points of a loop, then those of the next
        loop, place = divmod(number, len(some))
        k = float(some[place].rated.rule.law.slopes[0])
        damage[place, loop] = cycles["damage"].sum()
        for kind, x in enumerate((cycles["range_MPa"], cycles["equivalent_range_dS"])):
            decades = np.log10(np.maximum(x, 1e-3)) + 3.0
            bins = np.minimum((decades * BINS_PER_DECADE).astype(np.intp), HISTOGRAM_BINS - 1)
            used = np.unique(bins)
            rows = np.empty(len(used), _ROW)
            rows["point"], rows["event"], rows["kind"], rows["bin"] = first + place, len(loads) + loop, kind, used
            rows["count"] = np.bincount(bins, cycles["count"], HISTOGRAM_BINS)[used]
            rows["power_sum"] = np.bincount(bins, cycles["count"] * x**k, HISTOGRAM_BINS)[used]
            found.append(rows[(rows["count"] != 0.0) | (rows["power_sum"] != 0.0)])
    return np.concatenate(found), damage


def _of_mission(rows: NDArray[np.void], points: Sequence[KeptPoint], plan: Plan) -> dict[int, MissionHistogram]:
    """Classes of dS in one km of the mission of the points on curves with knees, by their place."""
    found = {}
    for place in (place for place, point in enumerate(points) if not point.rated.rule.law.is_straight):
        own = rows[slice(*np.searchsorted(rows["point"], [place, place + 1]))]
        own = own[own["kind"] == KINDS.index("dS")]
        weight = plan.weights[own["event"]]
        count, power_sum = (
            np.asarray(np.bincount(own["bin"], weight * own[name], HISTOGRAM_BINS), np.float64)
            for name in ("count", "power_sum")
        )
        found[place] = MissionHistogram(count, power_sum)
    return found


def _columns(rows: NDArray[np.void], points: Sequence[KeptPoint], events: Sequence[str]) -> dict[str, Any]:
    """Rows of ``histogram.parquet``."""
    welds = list(dict.fromkeys(point.weld for point in points))
    of_point = np.array([(welds.index(p.weld), p.part, p.node, p.order, p.face) for p in points]).reshape(-1, 5)
    weld, part, node, order, face = of_point[rows["point"]].T
    return {
        "weld": coded(weld, welds),
        "part": part,
        "node": node,
        "order": order,
        "surface": coded(face, FACES),
        "event": coded(rows["event"], events),
        "kind": coded(rows["kind"], KINDS),
        "bin": rows["bin"].astype(np.int64),
        "count_per_pass": rows["count"].copy(),
        "power_sum_per_pass": rows["power_sum"].copy(),
    }
