"""All that a diagnosis finds, in numbers: its tables and its words are made from it."""

from dataclasses import dataclass

from fatigue.life.mission import Plan
from fatigue.pipeline.solve.body import Body
from fatigue.why.attribute import Attribution
from fatigue.why.levers import Levers
from fatigue.why.verdicts import EventVerdicts


@dataclass(frozen=True, slots=True, eq=False)
class Evidence:
    """What was found at the points of a diagnosis.

    Attributes
    ----------
    body, plan : the body and its mission
    attribution : the damage of the points, shared out
    levers : what smaller modes would buy at the worst points
    verdicts : whether the frequency domain may be trusted, of every event
    """

    body: Body
    plan: Plan
    attribution: Attribution
    levers: Levers
    verdicts: tuple[EventVerdicts, ...]
