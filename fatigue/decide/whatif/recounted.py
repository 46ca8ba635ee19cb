"""Points without a number counted again under the changed case, from its input files, as an assessment counts them."""

import tempfile
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from fatigue.case import Case
from fatigue.decide.of_result import shear_method
from fatigue.decide.whatif.asked import TwoCases
from fatigue.decide.whatif.difference import Differences
from fatigue.decide.whatif.forward import COUNTED, RECOUNT, Forward
from fatigue.decide.whatif.stored import Stored
from fatigue.errors import DataError, Problem, refuse
from fatigue.pipeline.mission.events import event_loads
from fatigue.pipeline.mission.plan import mission_plan
from fatigue.pipeline.solve.body import read_body
from fatigue.pipeline.solve.weld_groups import weld_groups
from fatigue.results import changed_inputs, upsampling_factors
from fatigue.shift.recounted import event_damage, sequence_damage
from fatigue.stages import stage
from fatigue.why.points import Chosen, gather_points

Floats = NDArray[np.float64]
Rows = NDArray[np.int64]
Which = Literal["worst", "all"]


def rows_to_count(stored: Stored, found: Forward, which: Which) -> Rows:
    """Toe points without a number: all, or in each weld the one with the largest damage as assessed."""
    rows = np.flatnonzero(stored.toe & (found.basis == RECOUNT))
    if which == "all" or not rows.size:
        return rows
    order = np.lexsort((-stored.damage_per_km[rows], stored.weld[rows]))
    _, first = np.unique(stored.weld[rows][order], return_index=True)
    return np.sort(rows[order][first])


def count_again(
    stored: Stored, cases: TwoCases, differs: Differences, found: Forward, rows: Rows, threads: int | None
) -> None:
    """Count points under the changed case and put their damage among what was ``found``, in place.

    Raises
    ------
    CaseError, DataError : a mistake in the changed case or its files; an input of the result is gone or has changed;
        the changed case has other points; a damage sum of shear decides, which is not counted here
    """
    refuse(DataError, _of_shear(stored.record))
    if cases.base.path.parent == cases.changed.path.parent:
        gone = changed_inputs(stored.record, cases.base.path)
        refuse(DataError, [p for p in gone if p.where != str(cases.base.path)])
    case = with_load(cases.changed, cases.load)
    stage("counting %d points again", len(rows))
    damage = _damage(stored.folder, case, rows, _factors(stored.record, case, differs), threads)
    for part in found.damage:
        part[rows] = damage
    found.basis[rows] = COUNTED


def _damage(folder: Path, case: Case, rows: Rows, factors: Sequence[int] | None, threads: int | None) -> Floats:
    """Miner sum per km (p,) of some points of a result under a case [1/km]."""
    body = read_body(case, strict=False)
    plan, _ = mission_plan(body, threads)
    chosen = Chosen(rows, np.full(len(rows), "", dtype=object), np.arange(len(rows)), "")
    with tempfile.TemporaryDirectory(prefix="fatigue-") as scratch, threadpool_limits(limits=1, user_api="blas"):
        groups = weld_groups(body, Path(scratch) / "forces")
        points = gather_points(folder, groups, chosen)
        loads = event_loads(groups, plan, Path(scratch) / "histories", threads, factors)
        damage = sequence_damage(points, loads, plan)
        for load, one in zip(loads, plan.passes, strict=True):
            if one.passes_per_km > 0.0:
                damage = damage + one.passes_per_km * event_damage(points, load, threads)
    return np.asarray(damage)


def with_load(case: Case, load: float) -> Case:
    """The case with all stresses of its events times a factor."""
    if load == 1.0:
        return case
    events = tuple(one.model_copy(update={"stress_factor": load * one.stress_factor}) for one in case.mission.event)
    return case.model_copy(update={"mission": case.mission.model_copy(update={"event": events})})


def _factors(record: Mapping[str, Any], case: Case, differs: Differences) -> list[int] | None:
    """By how much each record is upsampled: as in the result, None where records or counting are others."""
    if any(one.kind == "recount" and one.key[0] != "curve" for one in differs.keys):
        return None
    names = [event["event"] for event in record["mission"]["events"]]
    known = dict(zip(names, upsampling_factors(record), strict=True))
    return [known[event.name] for event in case.mission.event]


def _of_shear(record: Mapping[str, Any]) -> Iterator[Problem]:
    if method := shear_method(record):
        what = f"shear decides by multiaxial.method = '{method}', and only normal stress is counted again here"
        yield Problem("recount_of_shear", "--recount", what, "Assess the changed case with `fatigue assess`")
