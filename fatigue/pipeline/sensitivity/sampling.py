"""The records of the events, sampled otherwise than they were counted: as they were given, or upsampled by ``auto``."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from fatigue.life.mission import Plan
from fatigue.life.records.spool import time_slices
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.mission.events import event_load
from fatigue.pipeline.mission.upsampling import automatic_factors
from fatigue.pipeline.sensitivity.notes import FINE_ENOUGH, LONG_RECORDS, NOT_UPSAMPLED, NOTHING
from fatigue.pipeline.solve.weld_groups import WeldGroups

MOST_BYTES = 64e6  # of all records that are upsampled for it


@dataclass(frozen=True, slots=True, eq=False)
class OtherSampling:
    """What the variant of the sampling counts.

    Attributes
    ----------
    variant : ``upsample_1`` where records were upsampled, ``upsample_auto`` where they were counted as they are
    loads : the events so sampled; None: as assessed, or not to be had, as ``note`` says
    factors : by how much each record is upsampled in the variant
    """

    variant: str
    loads: tuple[EventLoad, ...] | None
    factors: tuple[int, ...]
    note: int = NOTHING


def other_sampling(
    groups: WeldGroups,
    loads: Sequence[EventLoad],
    plan: Plan,
    threads: int | None,
    factors: Sequence[int] | None = None,
) -> OtherSampling:
    """The other sampling of a job; ``factors``: those of ``upsample_auto`` where they are known.

    Records of more than ``MOST_BYTES``, or counted in single precision, are not sampled anew: the job is large.
    """
    as_given = tuple(one.factor(1) for one in plan.passes)
    times = [load.upsample // max(1, given) for load, given in zip(loads, as_given, strict=True)]
    if max(times) > 1:
        if _is_large(loads, [1.0 / by for by in times]):
            return OtherSampling("upsample_1", None, as_given, LONG_RECORDS)
        return OtherSampling("upsample_1", tuple(map(_thinned, loads, times)), as_given)
    if groups.body.case.counting.upsample == "auto":
        return OtherSampling("upsample_1", None, as_given, NOT_UPSAMPLED)
    return _upsampled(groups, loads, plan, threads, factors)


def _is_large(loads: Sequence[EventLoad], times: Sequence[float]) -> bool:
    """Whether the records, so many times as long as they are, are too large, or are of a job that is."""
    sizes = [8.0 * factor * np.prod(load.counted.q.shape) for load, factor in zip(loads, times, strict=True)]
    return float(sum(sizes)) > MOST_BYTES or any(load.single is not None for load in loads)


def _thinned(load: EventLoad, times: int) -> EventLoad:
    """An event with every so many-th sample only, in memory: those that the others were interpolated between."""
    if times == 1:
        return load
    history = load.counted
    q = np.concatenate(
        [history.q[:, part][:, -part.start % times :: times] for part in time_slices(history.q.shape)], 1
    )
    counted = replace(history, q=np.ascontiguousarray(q), step=history.step * times)
    return replace(load, counted=counted, upsample=load.upsample // times)


def _upsampled(
    groups: WeldGroups, loads: Sequence[EventLoad], plan: Plan, threads: int | None, factors: Sequence[int] | None
) -> OtherSampling:
    """The events upsampled as ``auto`` would, of records that were counted as they are; they are read again."""
    as_given = tuple(one.factor(1) for one in plan.passes)
    if factors is None and not _is_large(loads, [1.0] * len(loads)):
        found = automatic_factors(groups, loads, threads)
        factors = [p.factor(factor * max(1, p.refined)) for p, factor in zip(plan.passes, found, strict=True)]
    if factors is None:
        return OtherSampling("upsample_auto", None, as_given, LONG_RECORDS)
    if tuple(factors) == as_given:
        return OtherSampling("upsample_auto", None, as_given, FINE_ENOUGH)
    if _is_large(loads, [factor / max(1, given) for factor, given in zip(factors, as_given, strict=True)]):
        return OtherSampling("upsample_auto", None, tuple(factors), LONG_RECORDS)
    events = zip(groups.body.case.mission.event, loads, factors, as_given, strict=True)
    upsampled = [load if by == given else event_load(groups.body, event, by) for event, load, by, given in events]
    return OtherSampling("upsample_auto", tuple(upsampled), tuple(factors))
