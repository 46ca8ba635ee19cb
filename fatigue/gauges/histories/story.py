"""What virtual gauges read, as a story: a case, a table of gauges, their rows, and every event of the mission.

Each gauge becomes a row: its reading per unit of every modal coordinate and unit load. Rows times coordinates are
histories, at the samples of the files. Cycles are counted as an assessment counts them, and what the reading changes
with angle and place says how far a measurement may differ for no other reason than the glue.
"""

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from threadpoolctl import threadpool_limits

from fatigue.case import Case, given_case
from fatigue.errors import CaseError, Problem, given_names, given_path, refuse
from fatigue.files.recorded import refuse_foreign
from fatigue.gauges.case_files import case_files, input_hashes
from fatigue.gauges.exponent import exponent_of, exponent_problems
from fatigue.gauges.gauge_file import read_gauges
from fatigue.gauges.histories.counts import Counted, counted_cycles, gauge_spectra
from fatigue.gauges.histories.folder import FILLED, write_histories
from fatigue.gauges.histories.summary import Histories
from fatigue.gauges.histories.tables import event_table, gauge_table
from fatigue.gauges.instrument import Floats
from fatigue.gauges.rows import gauge_rows
from fatigue.gauges.simulated import counted as counted_reading
from fatigue.gauges.simulated import simulated
from fatigue.life.mission import Plan
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.mission.events import event_loads
from fatigue.pipeline.mission.plan import mission_plan
from fatigue.pipeline.solve.body import read_body
from fatigue.pipeline.solve.weld_groups import weld_groups
from fatigue.shown import few
from fatigue.stages import stage

Progress = Callable[[str, int, int], None]


def histories(
    case: Case | Path | str,
    gauges: Path | str,
    *,
    into: Path | str | None = None,
    events: Sequence[str] = (),
    counted: bool = False,
    exponent: float | None = None,
    csv: bool = False,
    force: bool = False,
    strict: bool = False,
    threads: int | None = None,
    progress: Progress = lambda label, done, total: None,
) -> Histories:
    """What every gauge reads in the events of a case, written into a folder where one is given.

    Parameters
    ----------
    case : the case or its file
    gauges : the table of gauges
    into : folder for tables, page and record; None: nothing is written
    events : only these; by default all
    counted : histories at the instants that are counted instead of the samples of the files
    exponent : k of the pseudo-damage; by default the first slope of the case's curve
    csv : write the tables as CSV as well
    force : overwrite files in the folder that are not ours
    strict : take unknown columns for errors
    threads : that prepare records, by default one per processor core
    progress : called with a label, events done and events in all

    Raises
    ------
    CaseError, DataError : a mistake in the case, its files or the table of gauges; files in the way in the folder
    """
    refuse(CaseError, exponent_problems(exponent))
    case, table = given_case(case), given_path(gauges, "gauges")
    folder = None if into is None else given_path(into, "into")
    wanted = _wanted(case, given_names(events, "events"))
    if folder is not None:
        refuse_foreign(folder, FILLED, force=force, inputs=[*case_files(case), table])
    stage("reading gauges and body")
    listed, warnings = read_gauges(table, strict=strict)
    body = read_body(case, strict=strict)
    k, k_source = exponent_of(case, exponent)
    plan, _ = mission_plan(body, threads)
    with TemporaryDirectory(prefix="fatigue-gauges-") as scratch, threadpool_limits(limits=1, user_api="blas"):
        groups = weld_groups(body, Path(scratch) / "forces")
        stage("rows of the gauges (%d)", len(listed))
        rows, of_rows = gauge_rows(groups, listed)
        warnings += of_rows
        stage("preparing the records of the events (%d)", len(plan.passes))
        loads = event_loads(groups, plan, Path(scratch) / "histories", threads)
        covariance = mission_covariance(loads, plan)
        stage("readings of the events (%d)", len(wanted))
        readings, counts = [], []
        for done, e in enumerate(wanted):
            progress("gauges", done, len(wanted))
            at_instants = counted_reading(rows, loads[e])
            cycles = counted_cycles(at_instants, vertex=loads[e].vertex)
            counts.append(Counted(at_instants.event, cycles, loads[e].duration, plan.passes[e].passes_per_km))
            readings.append(
                at_instants if counted else simulated(body, rows, case.mission.event[e], Path(scratch) / "record")
            )
        progress("gauges", len(wanted), len(wanted))
    spectra = [gauge_spectra(counts, g, k) for g in range(len(rows))]
    placed = gauge_table(body, rows, covariance)
    passes = [plan.passes[e] for e in wanted]
    found = Histories(
        title=case.title,
        table=table.name,
        gauges=tuple(placed),
        events=tuple(event_table(placed, readings, passes, spectra, k)),
        exponent=k,
        exponent_source=k_source,
        notes=tuple(_notes(case, plan, wanted)),
        warnings=tuple(warnings),
    )
    if folder is None:
        return found
    stage("writing tables and page")
    return write_histories(folder, found, body, rows, readings, counts, spectra, input_hashes(case, [table]), csv=csv)


def mission_covariance(loads: Sequence[EventLoad], plan: Plan) -> Floats:
    """Covariance (c, c) of the coordinates over the mission: that of each event by its share of the mileage.

    Where no event has a share, all events alike.
    """
    share = np.array([one.share or 0.0 for one in plan.passes])
    if not share.any():
        share = np.ones(len(share))
    return np.asarray(np.tensordot(share / share.sum(), np.stack([load.covariance for load in loads]), axes=1))


def _wanted(case: Case, names: Sequence[str]) -> list[int]:
    """Numbers of the events that are asked for, in the order of the case."""
    known = [event.name for event in case.mission.event]
    unknown = [name for name in names if name not in known]
    if unknown:
        what = f"there is no event {unknown[0]!r} in {case.path.name}"
        raise CaseError(Problem("unknown_event", "event", what, f"Name one of {few(known, 6)}"))
    return [i for i, name in enumerate(known) if not names or name in names]


def _notes(case: Case, plan: Plan, wanted: Sequence[int]) -> Iterator[str]:
    """What the numbers leave out."""
    factors = [case.mission.event[e].name for e in wanted if case.mission.event[e].stress_factor != 1.0]
    if factors:
        yield f"The stress factor of {few(factors)} is left out: it is an allowance, and on no strain that is measured."
    if plan.loops:
        yield "Cycles across events are not counted here: each event is counted by itself."
