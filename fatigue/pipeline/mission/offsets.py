"""Constants of an event, carried beside its samples: given ones, and the mean of q where it is removed.

A constant that is added to samples in single precision costs their ranges the last bits. So none ever is: the samples
stay as they are, and what is constant enters where the level of stress does, in means and stress ratios. Ranges,
counts and damage without a mean-stress factor are the same for every offset, bit by bit.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from fatigue.case import Event, MeanOfQ
from fatigue.life.records.history import cached_chunks
from fatigue.life.records.spool import Samples
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.mission.unit_loads import event_constants
from fatigue.pipeline.solve.body import Body
from fatigue.readers.neutral.event.event_record import EventRecord

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class MeanLevel:
    """Means of one event: of its coordinates over the kept samples (c,), and their constants (c,)."""

    event: str
    mean_of_q: MeanOfQ
    mean: Floats
    constant: Floats


def mean_level(body: Body, event: Event, mean: Floats) -> MeanLevel:
    """Means of an event, of which those over the kept samples are known."""
    return MeanLevel(event.name, body.case.mean_of_q(event), mean, event_constants(body, event))


def with_offset(body: Body, event: Event, load: EventLoad, record: EventRecord) -> EventLoad:
    """The same event with the constant of each coordinate: what is given, less the mean of q where it is removed.

    ``record`` is that of the event. The mean is that of its kept samples, whatever is counted between them. That of a
    unit load over time is left: the case gives it.
    """
    offset = event_constants(body, event)
    if body.case.mean_of_q(event) == "remove":
        mean = _mean_of_every(record.refined, record.history.q) if record.refined > 1 else load.mean
        offset = offset - np.where(body.coordinates.is_mode, mean, 0.0)
    return replace(load, offset=offset)


def face_offset(membrane: Floats, bending: Floats, load: EventLoad) -> Floats | None:
    """Constant stress (n, 2) at both faces [MPa] of some points, of their stresses (n, c) with the factor of the event.

    None where nothing is constant, which costs nothing.
    """
    if not load.offset.any():
        return None
    of_membrane, of_bending = membrane @ load.offset, bending @ load.offset
    return np.stack([of_membrane + of_bending, of_membrane - of_bending], axis=1)


def _mean_of_every(factor: int, q: Samples) -> Floats:
    """Mean (c,) of the samples 0, ``factor``, 2 ``factor`` ... of a record (c, t): those between were not kept."""
    total, samples, before = np.zeros(q.shape[0]), 0, 0
    for chunk in cached_chunks(q):
        some = chunk[:, -before % factor :: factor]
        total += some.sum(axis=1, dtype=np.float64)
        samples += some.shape[1]
        before += chunk.shape[1]
    return total / samples
