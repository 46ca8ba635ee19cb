"""The records of the events, sampled otherwise than they were counted: as they were given, or upsampled by ``auto``."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from threading import Lock

import numpy as np

from fatigue.case import Event
from fatigue.life.mission import Plan
from fatigue.life.records.spool import time_slices
from fatigue.pipeline.mission.event_load import EventLoad, as_counted
from fatigue.pipeline.mission.events import how_counted
from fatigue.pipeline.mission.unit_loads import event_files
from fatigue.pipeline.mission.upsampling import automatic_factors
from fatigue.pipeline.solve.body import Body
from fatigue.pipeline.solve.weld_groups import WeldGroups
from fatigue.readers.neutral.event.event_record import read_event

MOST_BYTES = 64e6  # of all records that are sampled otherwise

Loads = tuple[EventLoad, ...]


@dataclass(frozen=True, slots=True, eq=False)
class OtherSampling:
    """What the variant of the sampling counts; the records are sampled when a weld asks for them first.

    Records of more than ``MOST_BYTES``, or counted in single precision, are not sampled anew: the job is large.

    Attributes
    ----------
    groups, loads, plan : the job as it is counted
    variant : ``upsample_1`` where records are upsampled, ``upsample_auto`` where they are counted as they are
    times : how many samples one of each record has become
    """

    groups: WeldGroups
    loads: Loads
    plan: Plan
    variant: str
    times: tuple[int, ...]
    _sampled: list[Loads | None] = field(default_factory=list)
    _lock: Lock = field(default_factory=Lock)

    @property
    def changes_nothing(self) -> bool:
        """Whether no record is upsampled although all would be that need it."""
        return self.variant == "upsample_1" and max(self.times) == 1

    def sampled(self) -> Loads | None:
        """The events sampled otherwise, in memory; None where they are too large for it."""
        with self._lock:
            if not self._sampled:
                is_thinned = self.variant == "upsample_1"
                self._sampled.append(self._thinned() if is_thinned else self._upsampled())
            return self._sampled[0]

    def _thinned(self) -> Loads | None:
        if _is_large(self.loads, [1.0 / by for by in self.times]):
            return None
        return tuple(map(_thinned, self.loads, self.times))

    def _upsampled(self) -> Loads | None:
        """The events as ``auto`` upsamples them: as many times as the fastest point of the body asks for."""
        if _is_large(self.loads, self.times):
            return None
        found = automatic_factors(self.groups, self.loads, threads=1)
        refined = [max(1, one.refined) for one in self.plan.passes]
        factors = [p.factor(by * r) for p, by, r in zip(self.plan.passes, found, refined, strict=True)]
        if _is_large(self.loads, [by / r for by, r in zip(factors, refined, strict=True)]):
            return None
        body = self.groups.body
        events = zip(body.case.mission.event, self.loads, factors, refined, strict=True)
        return tuple(load if by <= r else _read_again(body, event, load, by) for event, load, by, r in events)


def other_sampling(groups: WeldGroups, loads: Sequence[EventLoad], plan: Plan) -> OtherSampling:
    """The other sampling of a job, whose events are counted as ``loads``."""
    as_given = [one.factor(1) for one in plan.passes]
    times = tuple(load.upsample // max(1, given) for load, given in zip(loads, as_given, strict=True))
    is_upsampled = max(times) > 1 or groups.body.case.counting.upsample == "auto"
    return OtherSampling(groups, tuple(loads), plan, "upsample_1" if is_upsampled else "upsample_auto", times)


def _is_large(loads: Sequence[EventLoad], times: Sequence[float]) -> bool:
    """Whether the records, so many times as long as they are, are too large, or are of a job that is."""
    sizes = [8.0 * factor * np.prod(load.counted.q.shape) for load, factor in zip(loads, times, strict=True)]
    return float(sum(sizes)) > MOST_BYTES or any(load.single is not None for load in loads)


def _thinned(load: EventLoad, times: int) -> EventLoad:
    """An event with every so many-th sample only: those that the others were interpolated between."""
    if times == 1:
        return load
    history = load.counted
    parts = [history.q[:, part][:, -part.start % times :: times] for part in time_slices(history.q.shape)]
    counted = replace(history, q=np.concatenate(parts, axis=1), step=history.step * times)
    return replace(load, counted=counted, upsample=load.upsample // times)


def _read_again(body: Body, event: Event, load: EventLoad, factor: int) -> EventLoad:
    """An event upsampled in memory; its statistics are those of the samples as they are."""
    return as_counted(load, read_event(event_files(body, event)), how_counted(body, event, factor))
