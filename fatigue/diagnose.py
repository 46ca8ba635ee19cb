"""The diagnosis as a story: a finished result, its records once more, and what makes the damage, where and when.

Of a finished result the points that matter are chosen and solved again, from inputs that may not have changed. Their
cycles are counted once more, and the damage of each cycle is shared out to the modes, frequency bands and places that
make it. What that leaves open is counted again: with smaller modes, to see what they buy, and on Gaussian records, to
see why Dirlik and rainflow differ.
"""

import logging
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from numbers import Real
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.errors import CaseError, DataError, Problem, given_path, refuse
from fatigue.life.mission import Plan
from fatigue.pipeline.forecast.needs import diagnosis_memory
from fatigue.pipeline.forecast.size import job_size
from fatigue.pipeline.forecast.spare import memory_warnings
from fatigue.pipeline.mission.events import event_loads
from fatigue.pipeline.mission.plan import mission_plan
from fatigue.pipeline.solve.assessed_body import assessed_body
from fatigue.pipeline.solve.weld_groups import weld_groups
from fatigue.results import (
    ASSESSED,
    DIAGNOSED,
    FORMED,
    adding,
    finished_result,
    read_rows,
    row_count,
    upsampling_factors,
)
from fatigue.spectrum.bands import third_octaves
from fatigue.stages import stage
from fatigue.why.across_events import attribute_loops
from fatigue.why.attribute import BIN_KM, Attribution, Bins, EventAttribution, attribute_event, numbers_of_point
from fatigue.why.evidence import Evidence
from fatigue.why.findings import Diagnosis, findings
from fatigue.why.formation.damping import damping_of
from fatigue.why.formation.formation import formation
from fatigue.why.levers import best_levers
from fatigue.why.points import choose_points, gather_points
from fatigue.why.rows import rows_of_tables
from fatigue.why.verdicts import EventVerdicts, event_verdicts

log = logging.getLogger(__name__)

Progress = Callable[[str, int, int], None]

SHARE_OF_LIMIT = 0.1  # utilisation from which a point is shared out when not all points are


def diagnose(
    folder: Path | str,
    *,
    case_file: Path | str | None = None,
    share_of_limit: float = SHARE_OF_LIMIT,
    edges_hz: Sequence[float] | None = None,
    bin_km: float = BIN_KM,
    damping: float | None = None,
    no_lock: bool = False,
    progress: Progress = lambda label, done, total: None,
) -> Diagnosis:
    """What makes the damage of a finished result; the tables that show it are written into its folder.

    Parameters
    ----------
    folder : result of an assessment
    case_file : the case it was made from; by default where the provenance of the result says
    share_of_limit : utilisation from which a point is included when there are too many for all of them
    edges_hz : ascending edges between frequency bands [Hz]; by default one-third octaves from 1 to 80 Hz
    bin_km : length of a bin of the track [km]
    damping : damping ratio of the modes whose table has none; None: they have none
    no_lock : for a file system without locks, see ``fatigue.assess``
    progress : called with a label, events done and events in all

    Raises
    ------
    DataError : no finished result in the folder, or its inputs are gone or have changed
    CaseError : band edges, bins or a damping ratio that make no sense
    """
    refuse(CaseError, [*_senseless(edges_hz, bin_km, share_of_limit), *_no_damping(damping)])
    folder = given_path(folder, "folder")
    case_file = None if case_file is None else given_path(case_file, "case_file")
    stage("reading the result and its case")
    record = finished_result(folder, ASSESSED, ("nodes", "damage"), no_lock=no_lock)
    body = assessed_body(record, folder, case_file)
    plan, _ = mission_plan(body)
    factors = upsampling_factors(record)
    needed = diagnosis_memory(job_size(body, plan, factors=factors))
    for problem in memory_warnings("the diagnosis", needed, "Use a machine with more memory, or shorter records"):
        log.warning("%s", problem)
    modes = replace(body.modes, damping_ratio=damping_of(body.modes, damping).ratio)
    bins = Bins(third_octaves() if edges_hz is None else np.asarray(edges_hz, dtype=np.float64), bin_km)
    with adding(folder, record, DIAGNOSED | FORMED, no_lock=no_lock) as addition:
        numbers = numbers_of_point(plan, len(body.coordinates), bins)
        samples = sum(factor * one.samples for factor, one in zip(factors, plan.passes, strict=True))
        chosen = choose_points(folder, samples, share_of_limit, numbers)
        log.info("diagnosing %s", chosen.what)
        stage("preparing the records of the events (%d)", len(plan.passes))
        groups = weld_groups(body, addition.scratch / "forces")
        points, worst = gather_points(folder, groups, chosen), chosen.worst
        assessed = assessed_rows(folder, chosen.rows, plan)
        loads = event_loads(groups, plan, addition.scratch / "histories", factors=factors)

        stage("sharing out the damage of %d points, event by event (%d)", len(points), len(plan.passes))
        events: list[EventAttribution] = []
        for load, one_pass in zip(loads, plan.passes, strict=True):
            progress("diagnosis", len(events), len(loads))
            events.append(attribute_event(points, load, one_pass, modes, bins))
        attribution = Attribution(points, (*events, *attribute_loops(points, loads, plan)))
        governing = attribution.event_share[worst, : len(events)].argmax(axis=1)
        verdicts: list[EventVerdicts] = []
        for number, (load, event, said) in enumerate(zip(loads, events, assessed, strict=True)):
            verdicts.append(event_verdicts(body, load, points, event, said, worst[governing == number]))
        damaged = worst[attribution.damage[worst] > 0.0]
        levers = best_levers(attribution, loads, plan, damaged)
        stage("splitting the records of the events into what follows and what swings (%d)", len(plan.passes))
        formed = formation(body, attribution, loads, plan, damaged, damping)
        evidence = Evidence(body, plan, attribution, levers, tuple(verdicts), formed)
        progress("diagnosis", len(loads), len(loads))

        stage("writing tables")
        for name, blocks in rows_of_tables(evidence).items():
            with addition.table(name) as table:
                for rows in blocks:
                    table.write(rows)
        addition.publish({"diagnosis": formed.on_record()})
    return findings(evidence, chosen.what)


def _senseless(edges_hz: Sequence[float] | None, bin_km: float, share_of_limit: float) -> Iterator[Problem]:
    if edges_hz is not None and not _ascends(edges_hz):
        shown = list(edges_hz) if isinstance(edges_hz, Iterable) and not isinstance(edges_hz, str) else edges_hz
        what = f"{shown} does not ascend from above 0 Hz"
        yield Problem("bad_edges", "edges_hz", what, "Give edges of bands, sorted")
    if not (isinstance(bin_km, Real) and 0.0 < bin_km < np.inf):
        given = f"{bin_km:g}" if isinstance(bin_km, int | float) else repr(bin_km)
        yield Problem("bad_bin", "bin_km", f"{given} km is not a length", "Give a length above 0")
    if not (isinstance(share_of_limit, Real) and 0.0 <= share_of_limit < np.inf):
        what = f"{share_of_limit} is no share of the damage limit"
        yield Problem("bad_share", "share_of_limit", what, "Give 0 or more, for instance 0.1")


def _no_damping(damping: float | None) -> Iterator[Problem]:
    if damping is not None and not (isinstance(damping, Real) and 0.0 <= damping < 1.0):
        what = f"{damping} is no damping ratio of a mode that swings"
        yield Problem("bad_damping", "damping", what, "Give the ratio to critical damping: 1.5 % are 0.015")


def _ascends(edges_hz: Sequence[float]) -> bool:
    """Whether edges of bands are finite numbers, at least one, each above the one before and above 0."""
    try:
        edges = np.array([0.0, *(float(edge) for edge in edges_hz)])
    except (TypeError, ValueError):
        return False
    return bool(edges.size > 1 and np.isfinite(edges).all() and (np.diff(edges) > 0.0).all())


def assessed_rows(folder: Path, rows: NDArray[np.int64], plan: Plan) -> list[pd.DataFrame]:
    """What ``damage.parquet`` says of some points, given by their rows in ``nodes.parquet``, event by event.

    Raises
    ------
    DataError : the table is missing, damaged, or belongs to other points
    """
    columns = [
        "damage_dirlik_per_pass", "damage_tb_per_pass", "damage_same_ratio_per_pass", "bending_ratio",
        "kurtosis", "samples_per_peak", "damage_tb_whole_per_pass", "outside_share",
    ]  # fmt: skip
    events, of_point = len(plan.passes), len(plan.names)
    expected, found = row_count(folder, "nodes") * of_point, row_count(folder, "damage")
    if found != expected:
        what = f"has {found} rows where the points and events of the result make {expected}"
        raise DataError(Problem("other_points", str(folder / "damage.parquet"), what, "Run the assessment again"))
    table = read_rows(folder, "damage", (rows[:, None] * of_point + np.arange(events)).ravel(), columns).to_pandas()
    return [table[number::events].reset_index(drop=True) for number in range(events)]
