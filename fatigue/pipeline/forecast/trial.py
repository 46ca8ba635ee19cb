"""What a job will take: its own pipeline, timed on one group of its welds under the first chunk of one record."""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TypeVar

import numpy as np
from threadpoolctl import threadpool_limits

from fatigue.life.mission import Pass, Plan
from fatigue.pipeline.count.group import assess_group
from fatigue.pipeline.count.result import GroupResult
from fatigue.pipeline.count.worst import histogram_points, worst_points
from fatigue.pipeline.forecast.needs import PER_STRESS_SAMPLE
from fatigue.pipeline.forecast.shear import shear_seconds
from fatigue.pipeline.forecast.throats import counted_throats, throat_seconds
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.mission.events import (
    load_of,
    shortened_record,
)
from fatigue.pipeline.mission.precision import counts_single, is_large
from fatigue.pipeline.multiaxial.method import DECIDING
from fatigue.pipeline.run.work import SHARE, screening_of
from fatigue.pipeline.solve.model import Model
from fatigue.pipeline.solve.stations import Stations
from fatigue.results.columns import TABLES

Result = TypeVar("Result")

TRIAL_SAMPLES = 1.6e7  # of stress, one face, that are counted for the trial: below a second
LONGEST_TRIAL, SHORTEST_TRIAL = 16_384, 2048  # samples of the record
ROUNDS = 3  # of which the best counts

# Processor time [s] of what is not timed, measured by ``python -m benchmarks.estimate``
START = 2.0  # imports and the known values
SETTLED_LATE = 1.5  # bounds of several events settle fewer points than bounds of one
CELL, CYCLE = 0.12e-6, 0.5e-6  # written in a table; counted and written
DETAIL, PAGE = 0.19, 0.6  # a weld shown in detail, the rest of the page
MOST_DETAILED = 40
STATION_ON_PAGE = 5e-5
COLUMNS = {table: len(TABLES[table]) for table in ("nodes", "damage", "structural_stress")}


@dataclass(frozen=True, slots=True)
class JobTime:
    """Processor time [s] of an assessment by what it is spent on; on n idle cores all but the first and last shrink.

    ``start``: imports, reading and checking; ``events``: records prepared; ``counting``: all events at all stations,
    ``counting_exact`` with ``--exact``, and once more at the points of histograms; ``tables`` and ``report``: written.
    ``screened`` says whether bounds settle points by default, ``upsample`` are the factors by which the records of the
    events are upsampled.
    """

    start: float
    events: float
    counting: float
    counting_exact: float
    tables: float
    report: float
    screened: bool
    upsample: tuple[int, ...]

    @property
    def total(self) -> float:
        """All of it, with default options."""
        return self.start + self.events + self.counting + self.tables + self.report

    @property
    def total_exact(self) -> float:
        """All of it, with every point counted."""
        return self.total - self.counting + self.counting_exact


@dataclass(frozen=True, slots=True, eq=False)
class _Trial:
    """A group of welds under a mission of nothing but a chunk of one pass, as often as it takes for the pass."""

    model: Model
    one: Pass
    plan: Plan

    def counted(self, chunk: EventLoad) -> GroupResult:
        """The result with every point counted."""
        return assess_group(self.model, [chunk], self._plan_of(chunk), None)

    def screened(self, chunk: EventLoad, scratch: Path) -> GroupResult:
        """The result where bounds settle what they can; ``scratch`` is a folder for what memory cannot hold."""
        screening = screening_of(SHARE, True, [chunk], scratch, threads=1)
        return assess_group(self.model, [chunk], self._plan_of(chunk), screening)

    def _plan_of(self, chunk: EventLoad) -> Plan:
        chunks = self.one.samples * chunk.counted.step / max(chunk.duration, chunk.counted.step)  # in the pass
        per_km = 1.0 / self.one.length if self.one.length is not None else self.one.passes_per_km
        per_1000_km = 1000.0 * per_km * chunks
        alone = replace(self.one, length=None, share=None, per_1000_km=per_1000_km, stints_per_1000_km=None)
        return replace(self.plan, passes=(alone,), loops=())


def job_time(plan: Plan, model: Model, stations: int, factors: Sequence[int], read_s: float, scratch: Path) -> JobTime:
    """Processor time of ``fatigue assess`` with its default options, as estimated; compiling is left out.

    Parameters
    ----------
    plan : the mission of the job
    model : one group of the welds of its body, solved
    stations : of all welds
    factors : by which the records of the events are upsampled
    read_s : processor time that reading and checking the case took [s]
    scratch : a folder for what memory cannot hold
    """
    body = model.body
    longest = int(np.argmax([one.samples for one in plan.passes]))
    event, one = body.case.mission.event[longest], plan.passes[longest]
    method = body.case.multiaxial.method
    samples = min(one.samples, max(SHORTEST_TRIAL, min(LONGEST_TRIAL, int(TRIAL_SAMPLES / len(model.stations)))))
    record = shortened_record(body, event, samples, scratch)
    less = replace(record, q=np.ascontiguousarray(record.q[:, 0 : max(2, samples // 8)]))
    with threadpool_limits(limits=1, user_api="blas"):
        trial = _Trial(model, one, plan)
        factor = factors[longest]
        finer = factor // max(1, one.refined)
        sampled = [f * p.samples for f, p in zip(factors, plan.passes, strict=True)]
        upsampled = sum(sampled)
        single, large = counts_single(stations, sampled, "auto"), is_large(stations, sampled)
        prepare_s, load = _timed(lambda: load_of(body, event, record, finer, single=single))
        _, short = _timed(lambda: load_of(body, event, less, finer, single=single))
        exact, result = _of_length(load, short, trial.counted)
        default = exact
        screens = large and method not in DECIDING
        if screens:
            default, result = _of_length(load, short, lambda chunk: trial.screened(chunk, scratch))

    n = load.counted.q.shape[1]
    of_groups = stations / len(model.stations)
    shear_s = shear_seconds(method, len(body.welds), stations, len(body.coordinates), sampled, screened=screens)
    checks_s = shear_s + throat_seconds(counted_throats(body), upsampled)
    events = len(plan.passes)
    cells = 2 * stations * (COLUMNS["nodes"] + events * COLUMNS["damage"])
    cells += stations * len(body.coordinates) * COLUMNS["structural_stress"]
    passes = factor * sum(p.samples for p in plan.passes) / n  # cycles are as many, however finely they are sampled
    cycles = _kept_cycles(model.stations, result, large=large) * of_groups * passes
    worst = worst_points(model.stations, result)
    binned = len(histogram_points(model.stations, result, worst, everything=False)) * of_groups
    alone, each = PER_STRESS_SAMPLE[False]
    binning_s = 2 * binned * upsampled * (alone + each * len(body.coordinates))
    return JobTime(
        start=START + read_s,
        events=prepare_s * upsampled / n,
        counting=(SETTLED_LATE if screens else 1.0) * of_groups * default.of(events, upsampled) + binning_s + checks_s,
        counting_exact=of_groups * exact.of(events, upsampled) + binning_s + checks_s,
        tables=CELL * cells + CYCLE * cycles,
        report=PAGE + DETAIL * min(MOST_DETAILED, len(body.welds)) + STATION_ON_PAGE * stations,
        screened=screens,
        upsample=tuple(factors),
    )


def _kept_cycles(stations: Stations, result: GroupResult, *, large: bool) -> float:
    """Cycles of the worst points of a group that go into the table."""
    used_up, cycles = result.mission.utilisation, result.of_events("cycles_per_pass")[0]
    worst = [(p.station, p.face) for p in worst_points(stations, result)]
    return sum(float(np.nan_to_num(cycles[at])) for at in worst if used_up[at] >= (SHARE if large else 0.0))


@dataclass(frozen=True, slots=True)
class _Cost:
    """Time of a group [s]: for each event, and for each sample of a record."""

    event: float
    sample: float

    def of(self, events: int, samples: int) -> float:
        return events * self.event + samples * self.sample


def _of_length(load: EventLoad, short: EventLoad, count: Callable[[EventLoad], Result]) -> tuple[_Cost, Result]:
    """Time of a group, from a chunk of a record and a shorter one; also the result of the longer one."""
    count(short)  # compiles, or loads what was compiled before
    whole_s, result = _timed(lambda: count(load))
    part_s, _ = _timed(lambda: count(short))
    n, n_short = load.counted.q.shape[1], short.counted.q.shape[1]
    sample = max(0.0, whole_s - part_s) / max(1, n - n_short)
    return _Cost(max(0.0, part_s - sample * n_short), sample), result


def _timed(do: Callable[[], Result]) -> tuple[float, Result]:
    """Processor time of this thread for one call [s], the best of some, and what it gives."""
    best, result = np.inf, None
    for _ in range(ROUNDS):
        begin = time.thread_time()
        result = do()
        best = min(best, time.thread_time() - begin)
    assert result is not None
    return float(best), result
