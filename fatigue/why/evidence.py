"""All that a diagnosis finds, in numbers: its tables and its words are made from it."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.life.mission import Plan
from fatigue.pipeline.solve.body import Body
from fatigue.readers.neutral.body.coordinates import Coordinates
from fatigue.why.attribute import Attribution
from fatigue.why.formation.formation import Formation
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
    formation : how resonances form, at the points of the levers
    """

    body: Body
    plan: Plan
    attribution: Attribution
    levers: Levers
    verdicts: tuple[EventVerdicts, ...]
    formation: Formation


def ids(coordinates: Coordinates) -> tuple[NDArray[np.object_], NDArray[np.object_]]:
    """Mode id and name of the unit load of every coordinate, (c,) each; None where it is the other."""
    is_mode = coordinates.is_mode
    mode, unit_load = np.array([coordinates.number, coordinates.unit_load], dtype=object)
    mode[~is_mode] = unit_load[is_mode] = None
    return mode, unit_load
