"""The assessment as a story: files, modal stress, cycles and spectra, damage, kilometres, tables.

The small files of the case are read and checked, and its welds are cut into groups, so that memory does not grow with
the body. Group after group, the forces become the stress that one unit of each mode makes, and the records of the
events turn this stress into cycles, damage and life. What is finished lies beside the result until everything is; then
it is put in place in one step, so that a folder never holds half a result.
"""

import json
import logging
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import partial
from numbers import Integral, Real
from pathlib import Path
from typing import Any, TypeAlias, get_args

from threadpoolctl import threadpool_limits

from fatigue.case import Case, given_case
from fatigue.errors import CaseError, Problem, given_path, refuse
from fatigue.life.mission import Plan
from fatigue.pipeline.checks.apart import checks_apart
from fatigue.pipeline.count.worst import HistogramPoints
from fatigue.pipeline.forecast.needs import job_needs
from fatigue.pipeline.forecast.size import JobSize, job_size
from fatigue.pipeline.forecast.spare import shortage_warnings
from fatigue.pipeline.mission.counted import event_counts, listed
from fatigue.pipeline.mission.gravity import gravity_audit
from fatigue.pipeline.mission.offsets import MeanLevel, mean_level
from fatigue.pipeline.mission.plan import mission_plan
from fatigue.pipeline.mission.precision import Precision
from fatigue.pipeline.multiaxial.method import DECIDING
from fatigue.pipeline.run.checkpoint import Checkpoint
from fatigue.pipeline.run.inputs import with_inputs
from fatigue.pipeline.run.orders import Order
from fatigue.pipeline.run.work import ScreeningOptions, Work, input_paths, key_of, open_work
from fatigue.pipeline.run.workers import by_orders, by_threads
from fatigue.pipeline.solve.body import Body, read_body
from fatigue.pipeline.solve.point_stress import point_stress
from fatigue.pipeline.solve.rated.curve_warnings import unverified_problems
from fatigue.pipeline.solve.weld_groups import check_forces, weld_groups
from fatigue.pipeline.tables.provenance import provenance_record
from fatigue.pipeline.tables.tally import Progress, Tally, body_warnings
from fatigue.pipeline.tables.written import write_tables
from fatigue.readers.neutral.spare_memory import give_back
from fatigue.report.files.vtp import write_vtp
from fatigue.report.identity.identity import identity_of, issued
from fatigue.results import (
    PAGE,
    PICTURE,
    RECOUNT,
    recorded,
    write_json,
    write_list,
    write_provenance,
)
from fatigue.results.folder import refuse_foreign, remember_case, result_log, stale_files
from fatigue.results.lock import claimed, settle_folder
from fatigue.results.publish import publish
from fatigue.stages import stage

log = logging.getLogger(__name__)

SCREEN = "Leave out --screen (share), or give method = 'report'"

Recounting: TypeAlias = Callable[[Path, Path], Mapping[str, Any]]
Verification: TypeAlias = Sequence[Mapping[str, Any]] | Callable[[], Sequence[Mapping[str, Any]]]


@dataclass(frozen=True, slots=True, eq=False)
class Assessment:
    """What a finished assessment says at a glance; the numbers are in the tables of ``folder``.

    ``groups`` of welds were assessed, ``groups_reused`` of them by an earlier run that was interrupted. Of
    ``warnings`` of one code the first are there one by one; one more stands for the others, ``count`` of them, and
    names their welds. ``recount_passed`` says whether a recount by independent code agreed, None where none was made.
    """

    folder: Path
    fulfilled: bool
    warnings: tuple[Problem, ...]
    groups: int
    groups_reused: int
    recount_passed: bool | None = None


def assess(
    case: Case | Path | str,
    folder: Path | str,
    *,
    threads: int | None = None,
    executor: Executor | None = None,
    share: float | None = None,
    proves_worst: bool = True,
    histogram: HistogramPoints = "worst",
    precision: Precision = "auto",
    strict: bool = False,
    require_verified: bool = False,
    force: bool = False,
    report: bool = True,
    no_lock: bool = False,
    recount: Recounting | None = None,
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
    precision : of counting: ``auto``, single precision for jobs of more than 3e7 stress samples, within 1e-6 of the
        damage; ``double`` for all
    strict : take unknown columns in the tables for errors
    require_verified : refuse a case that rests on an S-N curve of the status ``unverified``
    force : replace the result of another case, and files of these names that fatigue did not write
    report : write the report and the ParaView file as well
    no_lock : for a file system without locks: trust that no other run writes to the folder, and that a lock file left
        by a run that was killed is removed by hand
    recount : counts points of the result once more by independent code, as ``fatigue.verify.recount.outcome_of``; what
        it returns is kept beside the result and shown in the report
    verification : checks of the program to show in the report, as ``fatigue.verify`` gives them, or what computes them
    progress : called with a label, stations done and stations in all

    Raises
    ------
    CaseError, DataError : the case or its files are wrong, or an argument makes no sense; nothing has been written then
    NumericalError : a computation lost its footing
    """
    refuse(CaseError, _senseless(threads, share, executor, histogram, precision))
    case, folder = given_case(case), given_path(folder, "folder")
    refuse(CaseError, _screened_shear(case, share))
    settle_folder(folder, no_lock=no_lock)
    own, identity = input_paths(case), identity_of(case)  # a logo that is unfit is refused before hours are spent
    refuse_foreign(folder, force=force, case_file=case.path, inputs=own)
    stage("reading and checking the case")
    (body, plan, record_warnings), inputs = with_inputs(
        case, partial(read_case, case, threads, strict=strict, require_verified=require_verified)
    )
    options = ScreeningOptions(share, proves_worst, histogram, precision)
    key = key_of(case, inputs.register, options)

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
            size = job_size(
                body, plan, share=share, threads=threads, report=report, histogram=histogram, precision=precision
            )
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
            writers = _writers(case, verification, recount, report=report)
            write_records(unpublished, record | issued({"result": key}, identity), writers)
            stage("putting the result in place")
            inputs.refuse_replaced()
            refuse_foreign(folder, force=force, case_file=case.path, inputs=own)  # edited while this run was going on
            publish(unpublished, folder, stale_files(folder, own))
            log.info("the result is complete")
    fulfilled = done.fulfilled and done.checks.fulfilled
    return Assessment(folder, fulfilled, warnings, done.groups, done.reused, _has_passed(folder) if recount else None)


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


def _senseless(
    threads: object, share: object, executor: object, histogram: object, precision: object
) -> Iterator[Problem]:
    """Arguments that make no sense."""
    if threads is not None and not (isinstance(threads, Integral) and int(threads) >= 1):
        yield Problem("argument", "threads", f"{threads!r} is no number of threads", "Give a whole number from 1 on")
    if share is not None and not (isinstance(share, Real) and 0.0 <= float(share) <= 1.0):
        yield Problem("argument", "share", f"{share!r} is no share of the damage limit", "Give a number from 0 to 1")
    if executor is not None and not callable(getattr(executor, "submit", None)):
        what = f"{type(executor).__name__} is no executor"
        yield Problem("argument", "executor", what, "Give a concurrent.futures.Executor")
    for name, given, known, what in (
        ("histogram", histogram, get_args(HistogramPoints), "are no points to keep"),
        ("precision", precision, get_args(Precision), "is no precision of counting"),
    ):
        if not (isinstance(given, str) and given in known):
            yield Problem("argument", name, f"{given!r} {what}", f"Give one of {', '.join(map(repr, known))}")


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


def _writers(
    case: Case, verification: Verification, recount: Recounting | None, *, report: bool
) -> Iterator[Callable[[Path], list[Path]]]:
    """What writes the documents of a result, a recount before the page that shows it."""
    if recount is not None:
        yield partial(write_recount, case=case, recount=recount)
    if report:
        yield partial(write_page_and_picture, case=case, verification=verification)


def write_records(folder: Path, record: Mapping[str, Any], writers: Iterable[Callable[[Path], list[Path]]]) -> None:
    """Write provenance, documents and their list beside the tables of a result that is not published yet.

    The documents are made from tables and provenance, which has their hashes, too, in the end.
    """
    record = recorded(record, sorted(folder.glob("*.parquet")))
    write_provenance(folder, record)
    documents: list[Path] = []
    for write in writers:
        documents += write(folder)
        write_provenance(folder, recorded(record, documents))
    listed = write_list(folder, documents, record["result"])
    write_provenance(folder, recorded(record, [*documents, listed]))


def write_recount(folder: Path, case: Case, recount: Recounting) -> list[Path]:
    """Recount a result that is not published yet, and write the outcome beside its tables."""
    stage("recounting from the input files")
    write_json(folder / RECOUNT, recount(folder, case.path))
    return [folder / RECOUNT]


def _has_passed(folder: Path) -> bool:
    """Whether the recount that was kept beside a result agreed with it."""
    return bool(json.loads((folder / RECOUNT).read_text(encoding="utf-8"))["passed"])


def write_page_and_picture(folder: Path, case: Case, verification: Verification) -> list[Path]:
    """Write page and picture beside the tables of a result that is not published yet, and return their paths."""
    from fatigue.report.page import write_report  # noqa: PLC0415 - its figures take a while to load, tables need none

    checks = verification() if callable(verification) else verification
    stage("writing %s and %s", PAGE, PICTURE)
    return [write_vtp(folder, folder), write_report(folder, case.path, checks, folder)]


def one_blas_thread() -> threadpool_limits:
    """Keep BLAS to one thread: the workers are outside it, and the bytes do not depend on the processor."""
    return threadpool_limits(limits=1, user_api="blas")
