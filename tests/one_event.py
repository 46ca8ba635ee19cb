"""One event at a block of stations in one call, as tests want it: estimated, then counted."""

from dataclasses import fields

import numpy as np
from numpy.typing import NDArray

from fatigue.pipeline.count.estimate import estimate_event, member_variances
from fatigue.pipeline.count.event_block import EventBlock, count_event, judged
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.solve.modal_stress import ModalStress
from fatigue.weld.structural_stress import RawEnds, StructuralStress

NO_RAW_ENDS = {  # as ModalStress takes them
    "raw_ends": RawEnds(np.zeros(0, np.intp), StructuralStress(*np.zeros((5, 0, 0)))),
    "raw_end_matters": np.zeros(0, np.bool_),
}


def assess_event_block(stress: ModalStress, load: EventLoad) -> EventBlock:
    """Damage of one pass of an event at every station of a block, in the time and in the frequency domain."""
    estimate = estimate_event(stress, load, member_variances(stress, load))
    return judged(count_event(stress, load, estimate), stress, load)


def numbers_of(event: EventBlock) -> dict[str, NDArray[np.float64]]:
    """Every array of an event by name: those of its estimate, those of its count, and its own."""
    parts = {"estimate.": event.estimate, "count.": event.count, "": event}
    named = {where + field.name: getattr(part, field.name) for where, part in parts.items() for field in fields(part)}
    return {name: value for name, value in named.items() if isinstance(value, np.ndarray)}
