"""All checks of the welds of a group that the case asks for, beside the normal stress at their toes."""

from collections.abc import Sequence

from fatigue.case import Case
from fatigue.life.mission import Plan
from fatigue.pipeline.checks.endurance import weld_endurance
from fatigue.pipeline.checks.interaction import weld_interaction
from fatigue.pipeline.checks.rows import CheckRows, joined
from fatigue.pipeline.checks.throats import throat_checks
from fatigue.pipeline.checks.toe_multiaxial import toe_multiaxial_rows
from fatigue.pipeline.count.result import GroupResult
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.multiaxial.method import DECIDING
from fatigue.pipeline.solve.model import Model


def has_checks(case: Case) -> bool:
    """Whether a case asks for anything that goes into ``checks.parquet``."""
    counts_shear = case.multiaxial.method in DECIDING
    return counts_shear or bool(
        case.body.weld_throats or case.body.stress_points or case.checks.interaction or case.checks.endurance
    )


def group_checks(model: Model, result: GroupResult, loads: Sequence[EventLoad], plan: Plan) -> CheckRows:
    """Rows of all checks of a group of welds, in the order of the welds for each check.

    Raises
    ------
    NumericalError : stress or damage exceeds double precision
    """
    rows = []
    method = model.case.multiaxial.method
    if method in DECIDING:
        rows.append(toe_multiaxial_rows(method, model, result, plan))
    if model.body.throats:
        rows.append(throat_checks(model, loads, plan))
    if model.case.checks.interaction:
        rows.append(weld_interaction(model, result, loads, plan))
    if model.case.checks.endurance:
        rows.append(weld_endurance(model))
    return joined(rows)
