"""Load spectra as a story: a finished result, the points that matter, their cycles once more, sorted into classes.

The points are solved again, from inputs that may not have changed. Their cycles are counted twice: once to see how far
they reach, so that all rows of a table have the same classes, and once to sort them in. Then the coordinates
themselves are counted, mode by mode and load by load.
"""

import logging
import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack
from dataclasses import asdict, dataclass
from numbers import Integral, Real
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import CaseError, Problem, given_path, no_threads, refuse
from fatigue.files.hashes import sha256
from fatigue.life.mission import Plan
from fatigue.load_spectra.classes import MOST_CLASSES, Classes, Extent, check_edges, classes_over, outside_warnings
from fatigue.load_spectra.gathered import exponents_of, extents, spectra_of_points
from fatigue.load_spectra.measured import Measured, doubts, measured_spectra, read_measured, refuse_absent
from fatigue.load_spectra.points import listed_points, worst_of_welds
from fatigue.load_spectra.rows import rows_of_points, rows_of_signal
from fatigue.load_spectra.signals import all_signal_spectra
from fatigue.load_spectra.summary import LoadSpectra, PointLine, SignalLine, point_lines, signal_line
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.mission.events import event_loads
from fatigue.pipeline.mission.plan import mission_plan
from fatigue.pipeline.solve.assessed_body import assessed_body
from fatigue.pipeline.solve.weld_groups import weld_groups
from fatigue.results import ASSESSED, LOAD_SPECTRA, Addition, adding, finished_result, upsampling_factors
from fatigue.side_by_side import in_order
from fatigue.stages import stage
from fatigue.why.points import Points, gather_points

log = logging.getLogger(__name__)

Progress = Callable[[str, int, int], None]
Floats = NDArray[np.float64]

CLASSES = 64
POINTS_AT_ONCE = 16  # a record is read once for so many


def spectra(
    folder: Path | str,
    *,
    points: Path | str | None = None,
    classes: int = CLASSES,
    edges: Path | str | None = None,
    exponents: Sequence[float] | None = None,
    compare: Path | str | None = None,
    compare_km: float | None = None,
    case_file: Path | str | None = None,
    threads: int | None = None,
    no_lock: bool = False,
    progress: Progress = lambda label, done, total: None,
) -> LoadSpectra:
    """Load spectra of points of a finished result and of its coordinates; the tables are written into its folder.

    Parameters
    ----------
    folder : result of an assessment
    points : a table of the points, by default the worst of every weld
    classes : of equal width, over all cycles of a table
    edges : a table of edges instead, ``range_MPa`` and ``level_MPa``
    exponents : of equivalent ranges; by default the first slope of the curve of each point
    compare : a table of ``range_MPa`` and ``count``, which stands beside the mission as an event of its own
    compare_km : the distance that these counts are for [km]
    case_file : the case it was made from; by default where the provenance of the result says
    threads : that count points, by default one per processor core; the numbers do not depend on it
    no_lock : for a file system without locks, see ``fatigue.assess``
    progress : called with a label, points done and points in all

    Raises
    ------
    DataError : no finished result in the folder, its inputs are gone or have changed, or a table is none
    CaseError : arguments that make no sense
    """
    refuse(CaseError, _senseless(classes, exponents, compare, compare_km, threads))
    folder = given_path(folder, "folder")
    listed, of_edges, beside, named = _paths(points=points, edges=edges, compare=compare, case_file=case_file)
    given = None if exponents is None else np.asarray(exponents, dtype=np.float64)
    stage("reading the result and its case")
    record = finished_result(folder, ASSESSED, ("nodes", "welds"), no_lock=no_lock)
    check_edges(of_edges)
    chosen = worst_of_welds(folder) if listed is None else listed_points(folder, listed)
    measured = None if beside is None or compare_km is None else read_measured(folder, beside, float(compare_km))
    if measured is not None:
        refuse_absent(measured, chosen.rows)
    body = assessed_body(record, folder, named)
    plan, _ = mission_plan(body, threads)
    with adding(folder, record, LOAD_SPECTRA, no_lock=no_lock) as addition:
        stage("preparing the records of the events (%d)", len(plan.passes))
        groups = weld_groups(body, addition.scratch / "forces")
        found = gather_points(folder, groups, chosen)
        loads = event_loads(groups, plan, addition.scratch / "histories", threads, upsampling_factors(record))

        stage("counting the cycles of %d points", len(found))
        blocks = [slice(i, i + POINTS_AT_ONCE) for i in range(0, len(found), POINTS_AT_ONCE)]
        extent = Extent().over(in_order(lambda block: extents(found.of(block), loads, plan), blocks, threads))
        largest = Extent() if measured is None else Extent(range=float(measured.range.max(initial=0.0)))
        sorted_into = classes_over(extent.over([largest]), classes, of_edges)
        warnings = outside_warnings(extent.over([largest]), sorted_into, of_edges)
        if measured is not None:
            warnings += [*measured.warnings, *doubts(measured, found, chosen.rows, extent.range)]
        for problem in warnings:
            log.warning("%s", problem)
        counting = _Counting(found, chosen.rows, loads, plan, sorted_into, given, measured)
        at_points = _write_points(addition, counting, blocks, threads, progress)

        stage("counting the coordinates themselves")
        slope = float(body.curves[body.case.curve.name].rule.law.slopes[0])
        of_signals = np.array([slope]) if given is None else given
        signals: list[SignalLine] = []
        with addition.table("signals") as table:
            for of_signal in all_signal_spectra(body, loads, plan, classes, of_signals):
                table.write(rows_of_signal(of_signal, float(of_signals[0])))
                signals.append(signal_line(of_signal))

        stage("writing tables")
        said = {
            "points": chosen.what,
            "classes": len(sorted_into.ranges) - 1,
            "exponents": [] if given is None else given.tolist(),
            "files": _hashes(points=listed, edges=of_edges, compare=beside),
            "compare_km": compare_km,
            "warnings": [asdict(problem) for problem in warnings],
        }
        addition.publish({"load_spectra": said})
    return LoadSpectra(
        title=body.case.title,
        points=chosen.what,
        classes=len(sorted_into.ranges) - 1,
        exponents=() if given is None else tuple(given.tolist()),
        target_km=plan.target_km,
        at_points=tuple(sorted(at_points, key=lambda point: -point.damage_per_km)),
        signals=tuple(signals),
        warnings=tuple(warnings),
    )


@dataclass(frozen=True, slots=True, eq=False)
class _Counting:
    """What the spectra of a point follow from; ``rows`` are those of the points in ``nodes.parquet``."""

    points: Points
    rows: NDArray[np.int64]
    loads: Sequence[EventLoad]
    plan: Plan
    classes: Classes
    exponents: Floats | None
    measured: Measured | None

    def of(self, block: slice) -> tuple[dict[str, dict[str, Any]], list[PointLine]]:
        """Rows of all tables for some points, and what is said of them."""
        some, given, target_km = self.points.of(block), self.exponents, self.plan.target_km
        found = list(spectra_of_points(some, self.loads, self.plan, self.classes, given))
        exponents = [exponents_of(some, i, given) for i in range(len(some))]
        for i, (own, row) in enumerate(zip(found, self.rows[block].tolist(), strict=True)):
            here = None if self.measured is None else self.measured.at(row)
            if here is not None:
                own.append(measured_spectra(here, some, i, own[-1], self.classes, given))
        rows = rows_of_points(some, found, exponents, self.classes, target_km)
        return rows, point_lines(some, found, exponents, target_km)


def _write_points(
    addition: Addition,
    counting: _Counting,
    blocks: Sequence[slice],
    threads: int | None,
    progress: Progress,
) -> list[PointLine]:
    """Write the tables of points, as many blocks at a time as there are threads; what is said of each point."""
    at_once = threads or os.cpu_count() or 1
    lines: list[PointLine] = []
    with ExitStack() as stack:
        tables = {name: stack.enter_context(addition.table(name)) for name in LOAD_SPECTRA if name != "signals"}
        for first in range(0, len(blocks), at_once):
            progress("spectra", len(lines), len(counting.points))
            for rows, said in in_order(counting.of, blocks[first : first + at_once], threads):
                for name, table in tables.items():
                    table.write(rows[name])
                lines += said
        progress("spectra", len(lines), len(counting.points))
    return lines


def _paths(**given: Path | str | None) -> list[Path | None]:
    """Path of each file that was given."""
    return [None if path is None else given_path(path, argument) for argument, path in given.items()]


def _hashes(**files: Path | None) -> dict[str, dict[str, str]]:
    """Name and SHA-256 of each file that was given."""
    return {use: {"file": path.name, "sha256": sha256(path)} for use, path in files.items() if path is not None}


def _senseless(
    classes: int, exponents: Sequence[float] | None, compare: object, compare_km: float | None, threads: int | None
) -> Iterator[Problem]:
    if not (isinstance(classes, Integral) and 1 <= classes <= MOST_CLASSES):
        yield Problem("bad_classes", "classes", f"{classes!r} is no number of classes", f"Give 1 to {MOST_CLASSES}")
    if exponents is not None and not _are_exponents(exponents):
        what = f"{exponents!r} are no exponents of S-N curves"
        yield Problem("bad_exponents", "exponents", what, "Give one or more numbers above 0, for instance 3 and 5")
    if compare is None and compare_km is not None:
        yield Problem("compare_km", "compare_km", "there is nothing to compare", "Give the table as compare")
    if compare is not None and compare_km is None:
        what = "nothing says what distance the counts of the table are for"
        yield Problem("compare_km", "compare_km", what, "Give it in km")
    if compare_km is not None and not (isinstance(compare_km, Real) and 0.0 < compare_km < np.inf):
        yield Problem("compare_km", "compare_km", f"{compare_km!r} km is no distance", "Give a distance above 0")
    yield from no_threads(threads)


def _are_exponents(exponents: Sequence[float]) -> bool:
    try:
        values = np.array([float(m) for m in exponents])
    except (TypeError, ValueError):
        return False
    return bool(values.size and np.isfinite(values).all() and (values > 0.0).all())
