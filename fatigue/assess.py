"""The assessment as a story: files, modal stress, cycles and spectra, damage, kilometres, tables.

The small files of the case are read and checked, and its welds are cut into groups, so that memory does not grow with
the body. Group after group, the forces become the stress that one unit of each mode makes, and the records of the
events turn this stress into cycles, damage and life. What is finished lies beside the result until everything is; then
it is put in place in one step, so that a folder never holds half a result.
"""

import logging
from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from concurrent.futures import Executor
from contextlib import closing
from dataclasses import dataclass, field
from functools import partial
from numbers import Integral, Real
from pathlib import Path
from typing import Any, TypeAlias, get_args

import numpy as np
from threadpoolctl import threadpool_limits

from fatigue.case import Case, given_case
from fatigue.errors import CaseError, Problem, given_path, refuse
from fatigue.life.mission import Plan
from fatigue.pipeline.checks.apart import checks_apart
from fatigue.pipeline.checks.group import has_checks
from fatigue.pipeline.checks.rows import CheckRows, joined
from fatigue.pipeline.checks.verdict import Decisive, verdicts
from fatigue.pipeline.count.block import TIERS
from fatigue.pipeline.count.joined.matters import Transitions
from fatigue.pipeline.count.outside_band import OutsideBand, bands_of, outside_of, spectra_of
from fatigue.pipeline.count.worst import HistogramPoints, WorstPoint, histogram_points, worst_points
from fatigue.pipeline.forecast.needs import job_needs
from fatigue.pipeline.forecast.size import JobSize, job_size
from fatigue.pipeline.forecast.spare import shortage_warnings
from fatigue.pipeline.mission.counted import event_counts, listed
from fatigue.pipeline.mission.gravity import gravity_audit
from fatigue.pipeline.mission.offsets import MeanLevel, mean_level
from fatigue.pipeline.mission.plan import mission_plan
from fatigue.pipeline.multiaxial.doubt import ShearTally
from fatigue.pipeline.multiaxial.method import DECIDING
from fatigue.pipeline.run.checkpoint import Checkpoint
from fatigue.pipeline.run.inputs import with_inputs
from fatigue.pipeline.run.orders import Order
from fatigue.pipeline.run.work import ScreeningOptions, Work, input_paths, key_of, open_work
from fatigue.pipeline.run.workers import Group, by_orders, by_threads
from fatigue.pipeline.solve.absent_loads import load_warnings
from fatigue.pipeline.solve.body import Body, read_body
from fatigue.pipeline.solve.curve_warnings import unverified_problems
from fatigue.pipeline.solve.point_stress import point_stress
from fatigue.pipeline.solve.weld_groups import check_forces, weld_groups
from fatigue.pipeline.tables.checks import check_table_rows
from fatigue.pipeline.tables.cycle_rows import KeptPoint, kept_point
from fatigue.pipeline.tables.cycles import CycleWriter
from fatigue.pipeline.tables.governing import worst_at_corners
from fatigue.pipeline.tables.histogram import HistogramWriter
from fatigue.pipeline.tables.path_cycles import PathWriter, kept_paths
from fatigue.pipeline.tables.provenance import provenance_record
from fatigue.pipeline.tables.register import excluded_rows, weld_rows
from fatigue.pipeline.tables.rows import damage_rows, node_rows, stress_rows
from fatigue.pipeline.tables.sampling_warnings import sampling_warnings
from fatigue.pipeline.tables.sensitivity import sensitivity_rows
from fatigue.pipeline.tables.stress_warnings import StressExtent
from fatigue.pipeline.tables.warnings import WarningSummary
from fatigue.readers.neutral.spare_memory import give_back
from fatigue.report.files.vtp import write_vtp
from fatigue.report.page import write_report
from fatigue.results import (
    ASSESSED,
    PAGE,
    PICTURE,
    TableWriter,
    recorded,
    result_tables,
    write_list,
    write_provenance,
)
from fatigue.results.folder import refuse_foreign, remember_case, result_log, stale_files
from fatigue.results.lock import claimed, settle_folder
from fatigue.results.publish import publish
from fatigue.stages import stage
from fatigue.weld.load_extent import LoadExtent

log = logging.getLogger(__name__)

ROWS_AT_ONCE = 512  # stations whose rows are made at a time, as many for each as there are events or modes

SCREEN = "Leave out share (--screen), or give method = 'report'"

Progress = Callable[[str, int, int], None]
Verification: TypeAlias = Sequence[Mapping[str, Any]] | Callable[[], Sequence[Mapping[str, Any]]]


@dataclass(frozen=True, slots=True, eq=False)
class Assessment:
    """What a finished assessment says at a glance; the numbers are in the tables of ``folder``.

    ``groups`` of welds were assessed, ``groups_reused`` of them by an earlier run that was interrupted. Of
    ``warnings`` of one code the first are there one by one; one more stands for the others, ``count`` of them, and
    names their welds.
    """

    folder: Path
    fulfilled: bool
    warnings: tuple[Problem, ...]
    groups: int
    groups_reused: int


def assess(
    case: Case | Path | str,
    folder: Path | str,
    *,
    threads: int | None = None,
    executor: Executor | None = None,
    share: float | None = None,
    proves_worst: bool = True,
    histogram: HistogramPoints = "worst",
    strict: bool = False,
    require_verified: bool = False,
    force: bool = False,
    report: bool = True,
    no_lock: bool = False,
    verification: Verification = (),
    progress: Progress = lambda label, done, total: None,
) -> Assessment:
    """Fatigue life, in km, of every point of every weld of one flexible body.

    Parameters
    ----------
    case : the checked case, or its file
    folder : where the result goes; an interrupted run in it is continued
    threads : worker threads, at least 1, by default one per processor core; the bytes of the tables do not depend on it
    executor : instead of threads, any executor whose workers see the same files: it is given names, not data
    share : of the damage limit; points proven to stay below it need no counting. 0: count every point; by default 0.1
        for jobs of more than 5e9 stress samples, and 0 for smaller ones
    proves_worst : whether the worst point of welds that stay below the share everywhere is proven as well, not only the
        point with the largest estimate counted
    histogram : of which counted points ``histogram.parquet`` has the ranges: ``worst``, those that are the worst of
        their weld or use up a tenth of the damage limit; ``all``; ``none``, and there is no such table
    strict : take unknown columns in the tables for errors
    require_verified : refuse a case that rests on an S-N curve of the status ``unverified``
    force : replace the result of another case, and files of these names that fatigue did not write
    report : write the report and the ParaView file as well
    no_lock : for a file system without locks: trust that no other run writes to the folder, and that a lock file left
        by a run that was killed is removed by hand
    verification : checks of the program to show in the report, as ``fatigue.verify`` gives them, or what computes them
    progress : called with a label, stations done and stations in all

    Raises
    ------
    CaseError, DataError : the case or its files are wrong, or an argument makes no sense; nothing has been written then
    NumericalError : a computation lost its footing
    """
    refuse(CaseError, _senseless(threads, share, executor, histogram))
    case, folder = given_case(case), given_path(folder, "folder")
    refuse(CaseError, _screened_shear(case, share))
    settle_folder(folder, no_lock=no_lock)
    own = input_paths(case)
    refuse_foreign(folder, force=force, case_file=case.path, inputs=own)
    stage("reading and checking the case")
    (body, plan, record_warnings), inputs = with_inputs(
        case, partial(read_case, case, threads, strict=strict, require_verified=require_verified)
    )
    options = ScreeningOptions(share, proves_worst, histogram)
    key = key_of(inputs.register, options)

    # another run may have been there meanwhile
    claim = claimed(folder, force=force, case_file=case.path, inputs=own, no_lock=no_lock)
    with claim, one_blas_thread(), Checkpoint(folder, key) as state, inputs.unchanged():
        remember_case(folder, case.path)
        groups = weld_groups(body, scratch=state.folder / "forces")
        check_forces(groups, threads)
        at_points, of_points = point_stress(body)
        with result_log(folder):
            log.info("assessing '%s': %d welds, %d events", case.path.name, len(body.welds), len(plan.passes))
            for line in listed(event_counts(case, plan)):
                log.info("event %s", line)
            size = job_size(body, plan, share=share, threads=threads, report=report, histogram=histogram)
            expected = foretold(size, folder)
            stage("preparing the records of the events (%d); %s expected", len(plan.passes), expected)
            work = open_work(groups, plan, options, state.folder, threads)
            gravity, of_gravity = gravity_audit(groups, levels_of(body, work), threads)
            apart = checks_apart(body, at_points, work.loads, plan, threads)
            del at_points
            give_back()
            if executor is None:
                assessed = by_threads(work, state, threads)
            else:
                assessed = by_orders(work, state, executor, order_of(case, work, options, key, strict=strict))
            done = Tally(total=int(body.lines.begin[-1]), progress=progress)
            done.warnings.add((*body.warnings, *of_points, *record_warnings, *of_gravity))
            stage("counting event by event (%d) at %d stations, and writing tables", len(plan.passes), done.total)
            unpublished = state.folder / "tables"
            write_tables(unpublished, key, assessed, work, apart, done, threads)
            log.info("%d of %d groups of welds were there from an earlier run", done.reused, done.groups)
            log.info("shear at the toes: %s", done.shear.as_text())
            done.warnings.add(body_warnings(body, work, done))
            warnings = done.warnings.listed()
            record = {"program": "fatigue", "result": key} | provenance_record(
                body, work, done.stations, folder, inputs.register, warnings, gravity, done.shear.statuses
            )
            documents = partial(write_page_and_picture, case=case, verification=verification)
            write_records(unpublished, record, documents if report else None)
            stage("putting the result in place")
            inputs.refuse_replaced()
            refuse_foreign(folder, force=force, case_file=case.path, inputs=own)  # edited while this run was going on
            publish(unpublished, folder, stale_files(folder, own))
            log.info("the result is complete")
    fulfilled = done.fulfilled and done.checks.fulfilled
    return Assessment(folder, fulfilled, warnings, done.groups, done.reused)


def foretold(size: JobSize, folder: Path) -> str:
    """What a job will take, in words; a warning is logged where the machine does not have it."""
    needs = job_needs(size)
    for problem in shortage_warnings(needs, folder):
        log.warning("%s", problem)
    log.info("about %s is expected, and %.0f s of processor time", needs.as_text(), needs.seconds)
    return needs.as_text()


def levels_of(body: Body, work: Work) -> list[MeanLevel]:
    """Means of every event, of its coordinates and constants."""
    return [mean_level(body, event, load.mean) for event, load in zip(body.case.mission.event, work.loads, strict=True)]


def _senseless(threads: object, share: object, executor: object, histogram: object) -> Iterator[Problem]:
    """Arguments that make no sense."""
    if threads is not None and not (isinstance(threads, Integral) and int(threads) >= 1):
        yield Problem("argument", "threads", f"{threads!r} is no number of threads", "Give a whole number from 1 on")
    if share is not None and not (isinstance(share, Real) and 0.0 <= float(share) <= 1.0):
        yield Problem("argument", "share", f"{share!r} is no share of the damage limit", "Give a number from 0 to 1")
    if executor is not None and not callable(getattr(executor, "submit", None)):
        what = f"{type(executor).__name__} is no executor"
        yield Problem("argument", "executor", what, "Give a concurrent.futures.Executor")
    known = get_args(HistogramPoints)
    if not (isinstance(histogram, str) and histogram in known):
        what, remedy = f"{histogram!r} are no points to keep", f"Give one of {', '.join(map(repr, known))}"
        yield Problem("argument", "histogram", what, remedy)


def _screened_shear(case: Case, share: float | None) -> Iterator[Problem]:
    """Refusal of a share beside a method for shear that decides: bounds of the normal stress say nothing of it."""
    method = case.multiaxial.method
    if share and method in DECIDING:
        where, what = f"{case.path.name}: multiaxial.method", f"method = {method!r} needs every point counted"
        yield Problem("argument", where, f"{what}, and points below {share:g} of the limit were not to be", SCREEN)


def read_case(
    case: Case, threads: int | None, *, strict: bool, require_verified: bool = False
) -> tuple[Body, Plan, tuple[Problem, ...]]:
    """Body and mission of a case, read and checked, and the warnings about its records."""
    body = read_body(case, strict=strict)
    if require_verified:
        refuse(CaseError, unverified_problems(case, body.welds, body.curves))
    return body, *mission_plan(body, threads)


def order_of(case: Case, work: Work, options: ScreeningOptions, key: str, *, strict: bool) -> Order:
    """Order of any group of welds of a job."""
    return Order(str(case.path.resolve()), strict, options, key, work.factors, group=0)


def write_records(
    folder: Path, record: Mapping[str, Any], write_documents: Callable[[Path], list[Path]] | None
) -> None:
    """Write provenance, documents and their list beside the tables of a result that is not published yet.

    The documents are made from tables and provenance, which has their hashes, too, in the end.
    """
    record = recorded(record, sorted(folder.glob("*.parquet")))
    write_provenance(folder, record)
    documents = write_documents(folder) if write_documents else []
    listed = write_list(folder, documents, record["result"])
    write_provenance(folder, recorded(record, [*documents, listed]))


def write_page_and_picture(folder: Path, case: Case, verification: Verification) -> list[Path]:
    """Write page and picture beside the tables of a result that is not published yet, and return their paths."""
    checks = verification() if callable(verification) else verification
    stage("writing %s and %s", PAGE, PICTURE)
    return [write_vtp(folder, folder), write_report(folder, case.path, checks, folder)]


@dataclass(slots=True, eq=False)
class Tally:
    """What adds up while groups of welds stream by.

    ``stations`` are counted by the tier that settled them. ``samples_per_peak`` is the smallest of each event.
    ``warnings`` has the warnings about the welds in the order of their groups, ``extents`` how large their
    forces are, ``stress`` how large their stress ranges, ``outside_band`` the points that the spectra miss,
    ``transitions`` those at which the order of the events may matter, ``shear`` those where the model of shear does,
    ``checks`` those that decide beside the toe.
    """

    total: int
    progress: Progress
    groups: int = 0
    reused: int = 0
    fulfilled: bool = True
    stations: dict[str, int] = field(default_factory=dict)
    warnings: WarningSummary = field(default_factory=WarningSummary)
    outside_band: OutsideBand = field(default_factory=OutsideBand)
    samples_per_peak: dict[str, float] = field(default_factory=dict)
    extents: list[LoadExtent] = field(default_factory=list)
    stress: StressExtent = field(default_factory=StressExtent)
    transitions: Transitions = field(default_factory=Transitions)
    checks: Decisive = field(default_factory=Decisive)
    shear: ShearTally = field(default_factory=ShearTally)

    def add(self, group: Group, work: Work, worst: Sequence[WorstPoint]) -> None:
        """Count a group of welds that has been written, ``worst`` the points that decide about them."""
        result = group.result
        self.groups += 1
        self.reused += group.reused
        self.fulfilled &= all(result.mission.utilisation[point.station, point.face] <= 1.0 for point in worst)
        for number, tier in enumerate(TIERS):
            settled = int(np.count_nonzero(result.tier == number))
            self.stations[tier or "counted"] = self.stations.get(tier or "counted", 0) + settled
        self.checks.add(result.checks, work.groups.body.case.checks.counts)
        self.warnings.add(group.model.warnings)
        self.warnings.add(worst_at_corners(group.model, result.mission, worst))
        self.extents += group.model.extents
        self.stress.add(group.model, result)
        self.transitions.add(group.model.stations, result)
        self.shear.add(group.model.stations, result)
        self.outside_band.add(group.model.stations, outside_of(result), spectra_of(result, work.plan))
        for passed, samples_per_peak in zip(work.plan.passes, result.of_events("samples_per_peak"), strict=True):
            fewest = float(np.nanmin(samples_per_peak, initial=np.inf))
            self.samples_per_peak[passed.event] = min(fewest, self.samples_per_peak.get(passed.event, np.inf))
        self.progress("assessing", min(sum(self.stations.values()), self.total), self.total)


def write_tables(
    folder: Path,
    key: str,
    assessed: Generator[Group],
    work: Work,
    apart: CheckRows,
    done: Tally,
    threads: int | None,
) -> None:
    """Write the tables of a result, group of welds by group as they come, and count in ``done`` what was written.

    ``apart`` are the checks at stress points, which belong to no group.
    """
    body = work.groups.body
    wants_histograms, wants_checks = work.histogram != "none", has_checks(body.case)
    optional = {"histogram": wants_histograms, "checks": wants_checks, "path_cycles": work.shear is not None}
    wanted = [*ASSESSED, "sensitivity", *(table for table, is_wanted in optional.items() if is_wanted)]
    with result_tables(folder, key, wanted) as tables, closing(assessed):
        cycles = CycleWriter(tables["cycles"], work.loads, work.plan)
        histograms = HistogramWriter(tables["histogram"], work.loads, work.plan, threads) if wants_histograms else None
        paths = PathWriter(tables["path_cycles"], work.loads, work.shear.beta) if work.shear else None
        done.checks.add(apart, body.case.checks.counts)
        for group in assessed:
            worst = write_group(tables, group, work, apart)
            cycles.add(points_kept_of(worst, group, work))
            if histograms:
                binned = histogram_points(group.model.stations, group.result, worst, everything=work.histogram == "all")
                histograms.add([kept_point(group.model, point) for point in binned])
            if paths:
                paths.add(kept_paths(group))
            done.add(group, work, worst)
            del group  # not to be held until the next one is there
            give_back()
        cycles.flush()
        if histograms:
            histograms.flush()
        if paths:
            paths.flush()
        if wants_checks:
            tables["checks"].write(check_table_rows(apart, body.curves, body.compared.lines))
        tables["welds"].write(excluded_rows(body.excluded))


def write_group(
    tables: Mapping[str, TableWriter], group: Group, work: Work, apart: CheckRows
) -> tuple[WorstPoint, ...]:
    """Write the rows of a group of welds to the tables, cycles left out, and return the worst point of each weld.

    ``apart`` are checks at points that are written elsewhere; those that name a weld belong to its verdict.
    """
    model, result, plan = group.model, group.result, work.plan
    stations, worst = model.stations, worst_points(model.stations, result)
    statuses = [rated.curve.status for rated in model.curve_of_weld]
    tables["nodes"].write(node_rows(stations, result, plan, statuses))
    for first in range(0, len(stations), ROWS_AT_ONCE):
        some = slice(first, first + ROWS_AT_ONCE)
        tables["damage"].write(damage_rows(stations, result, plan, some))
        tables["structural_stress"].write(stress_rows(stations, model.body.coordinates, some))
    of_checks = None
    if "checks" in tables:
        tables["checks"].write(check_table_rows(result.checks, model.body.curves, model.body.compared.lines))
        of_checks = verdicts(joined([result.checks, apart]), stations.names, model.case.checks.counts)
    tables["welds"].write(weld_rows(model, plan, result, worst, of_checks))
    tables["sensitivity"].write(sensitivity_rows(model, result, worst, work.sampling))
    return worst


def points_kept_of(worst: Sequence[WorstPoint], group: Group, work: Work) -> list[KeptPoint]:
    """The worst points of a group whose cycles go into ``cycles.parquet``."""
    used_up = group.result.mission.utilisation
    return [kept_point(group.model, p) for p in worst if used_up[p.station, p.face] >= work.kept_from]


def body_warnings(body: Body, work: Work, done: Tally) -> list[Problem]:
    """Warnings that only all welds together give: about loads that are not there, stress, sampling and spectra."""
    files = [event.history or body.case.path.name for event in body.case.mission.event]
    of_stress = done.stress.warnings(work.loads, body.coordinates, files)
    of_spectra = done.outside_band.warnings(bands_of(work.loads))
    of_order = done.transitions.warnings(work.plan)
    of_sampling = sampling_warnings(body, work.loads, done.samples_per_peak)
    of_shear = done.shear.warnings(work.loads)
    of_checks = done.checks.warnings(body.case.path.name)
    of_order = [*of_order, *of_shear, *of_checks]
    return [*load_warnings(body, done.extents), *of_stress, *of_sampling, *of_spectra, *of_order]


def one_blas_thread() -> threadpool_limits:
    """Keep BLAS to one thread: the workers are outside it, and the bytes do not depend on the processor."""
    return threadpool_limits(limits=1, user_api="blas")
