"""Checks at stress points: they belong to no group of welds, and are there before the first group is written."""

from collections.abc import Sequence

from fatigue.life.mission import Plan
from fatigue.pipeline.checks.endurance import point_endurance
from fatigue.pipeline.checks.points import point_checks
from fatigue.pipeline.checks.rows import CheckRows, joined
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.solve.body import Body
from fatigue.readers.neutral.points.modal_stresses import PointStress


def checks_apart(
    body: Body, stress: PointStress | None, loads: Sequence[EventLoad], plan: Plan, threads: int | None
) -> CheckRows:
    """Rows of all checks at stress points; some of them name a weld, whose verdict they may decide.

    ``stress`` is that of the points, None of a body without points; ``threads`` are by default one per processor core.

    Raises
    ------
    NumericalError : stress or damage exceeds double precision
    """
    return joined([point_checks(body, stress, loads, plan, threads), point_endurance(body, stress)])
