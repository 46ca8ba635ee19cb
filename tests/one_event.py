"""One event at a block of stations in one call, as tests want it: estimated, then counted."""

from fatigue.pipeline.count.estimate import estimate_event, member_variances
from fatigue.pipeline.count.event_block import EventBlock, count_event, judged
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.solve.modal_stress import Shapes


def assess_event_block(shapes: Shapes, load: EventLoad) -> EventBlock:
    """Damage of one pass of an event at every station of a block, in the time and in the frequency domain."""
    estimate = estimate_event(shapes, load, member_variances(shapes, load))
    return judged(count_event(shapes, load, estimate), shapes, load, estimate)
