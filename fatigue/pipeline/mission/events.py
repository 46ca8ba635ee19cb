"""The records of the events, read and prepared: what each event brings to every station, in memory or on disk."""

import logging
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.case import Event
from fatigue.errors import NumericalError, Problem
from fatigue.life.mission import Plan
from fatigue.life.records.history import ModalHistory, mean_and_covariance
from fatigue.pipeline.mission.event_load import EventLoad, HowCounted, as_counted, held_copies, of_samples
from fatigue.pipeline.mission.offsets import MeanLevel, mean_level, with_offset
from fatigue.pipeline.mission.precision import Precision, counts_single
from fatigue.pipeline.mission.unit_loads import event_files
from fatigue.pipeline.mission.upsampling import automatic_factors
from fatigue.pipeline.solve.body import Body
from fatigue.pipeline.solve.weld_groups import WeldGroups
from fatigue.readers.neutral.event.event_record import FINER, EventRecord, read_event
from fatigue.side_by_side import in_order
from fatigue.spectrum.moments import Spectra, default_upper_hz, has_spectrum, segment_spectra

log = logging.getLogger(__name__)

RECORD = "record"  # file of the samples as they were read
HELD_BYTES = 16e6  # of all records together, as they are in their files; the longest beyond that stay on disk


def event_loads(
    groups: WeldGroups,
    plan: Plan,
    scratch: Path | None = None,
    threads: int | None = None,
    factors: Sequence[int] | None = None,
    precision: Precision = "auto",
) -> tuple[EventLoad, ...]:
    """What all stations share of every event; it is kept while welds stream by.

    ``scratch`` is a folder for the longest records where all of them are more than ``HELD_BYTES``; None: all are held
    in memory, whatever their size. ``threads`` prepare an event each, by default one per processor core; the numbers do
    not depend on how many there are. ``factors`` by which the records are upsampled, where they are known; None: as the
    case asks for. ``precision`` in which cycles are counted.
    """
    body, events = groups.body, groups.body.case.mission.event
    sizes = np.array([len(body.coordinates) * p.samples for p in plan.passes])
    folders = _folders(4 * sizes, scratch)

    def given(job: tuple[Event, Path | None]) -> tuple[EventLoad, EventRecord]:
        record = _record(body, *job)
        return _of_samples(body, job[0], record, how_counted(body, job[0])), record

    loads = list(in_order(given, zip(events, folders, strict=True), threads))
    if factors is None:
        factors = _factors(groups, plan, [load for load, _ in loads], threads)
    samples = [f * p.samples for f, p in zip(factors, plan.passes, strict=True)]
    single = counts_single(int(body.lines.begin[-1]), samples, precision)
    is_fast = single and body.case.counting.reversals == "samples"
    log.info("cycles are counted in %s precision", "single" if is_fast else "double")
    for event, upsample in zip(events, factors, strict=True):
        if upsample > 1:
            log.info("event '%s' is counted on a record upsampled %d times", event.name, upsample)
    bytes_held = sizes * [f * (8 if f > 1 else 4) for f in factors]  # interpolated in double precision
    held = held_copies(len(body.coordinates), [p.samples for p in plan.passes], samples)
    finer = _folders(bytes_held, scratch)

    def prepared(number: int) -> EventLoad:
        how = how_counted(body, events[number], factors[number], single=single, held=held[number])
        before = folders[number]
        return _as_counted(body, *loads[number], how, finer[number] or before, before)

    return tuple(in_order(prepared, range(len(events)), threads))


def _factors(groups: WeldGroups, plan: Plan, loads: Sequence[EventLoad], threads: int | None) -> list[int]:
    """By how much the record of each event is upsampled in all, of which ``loads`` has the samples."""
    asked = groups.body.case.counting.upsample
    if asked != "auto":
        return [p.factor(asked) for p in plan.passes]
    found = automatic_factors(groups, loads, threads)  # of records that may have been refined for a load
    return [p.factor(factor * max(1, p.refined)) for p, factor in zip(plan.passes, found, strict=True)]


def event_load(
    body: Body,
    event: Event,
    upsample: int,
    *,
    single: bool = False,
    scratch: Path | None = None,
    holds_single: bool = True,
) -> EventLoad:
    """What all stations share of one event, whose record is read; ``scratch``: folder to keep the record in."""
    how = how_counted(body, event, upsample, single=single, held=holds_single)
    record = _record(body, event, scratch)
    return _as_counted(body, _of_samples(body, event, record, how), record, how, scratch, scratch)


def shortened_record(body: Body, event: Event, samples: int, scratch: Path) -> ModalHistory:
    """The first samples of the record of an event behind its start-up."""
    shortened = _record(body, event, scratch).shortened(samples).history
    _forget(scratch)
    return shortened


def load_of(body: Body, event: Event, history: ModalHistory, upsample: int, *, single: bool) -> EventLoad:
    """What all stations share of a record in memory."""
    how = how_counted(body, event, upsample, single=single)
    record = EventRecord(history, history.duration, is_static=event.history is None)
    return _as_counted(body, _of_samples(body, event, record, how), record, how)


def how_counted(body: Body, event: Event, upsample: int = 1, *, single: bool = False, held: bool = True) -> HowCounted:
    """How the case has the record of an event counted; values of a static load case are no samples of a signal."""
    vertex = body.case.counting.reversals == "vertex" and event.history is not None
    return HowCounted(body.case.residue(event), event.stress_factor, upsample, single, held, vertex)


def _of_samples(body: Body, event: Event, record: EventRecord, how: HowCounted) -> EventLoad:
    """Statistics of a record, and its constants, beside its samples."""
    with _no_overflow(body, record.history):
        spectra = None if record.is_static else event_spectra(body, record.history)
        load = of_samples(record, how, spectra, top_mode_hz(body))
    return with_offset(body, event, load, record)


def _as_counted(
    body: Body,
    load: EventLoad,
    record: EventRecord,
    how: HowCounted,
    scratch: Path | None = None,
    before: Path | None = None,
) -> EventLoad:
    """A record as it is counted.

    ``scratch``: folder for what is computed of each sample; ``before``: folder of the samples as they were read, which
    are removed where others are counted.
    """
    with _no_overflow(body, record.history):
        counted = as_counted(load, record, how, scratch)
    if counted.counted is not record.history and before is not None:
        _forget(before)
    return counted


@contextmanager
def _no_overflow(body: Body, history: ModalHistory) -> Iterator[None]:
    """Refuse a record whose squares exceed double precision."""
    try:
        with np.errstate(over="raise", invalid="raise"):
            yield
    except FloatingPointError:
        raise NumericalError(_too_large(body, history)) from None


def _too_large(body: Body, history: ModalHistory) -> Problem:
    """Refusal of a record whose squares exceed double precision, with the largest value in it."""
    file = next(event.history for event in body.case.mission.event if event.name == history.event)
    where = file or f"{body.case.path.name}: mission.event '{history.event}'"
    largest, mode, at = 0.0, 0, 0
    for i in range(len(history.mode)):
        size = np.abs(history.q[i : i + 1, :])[0]
        if size.max() >= largest:
            largest, mode, at = float(size.max()), i, int(size.argmax())
    what = f"modal coordinates of event '{history.event}' are so large that their squares exceed double precision: "
    what += f"{body.coordinates.column[mode]} is {largest:g} at {history.start + at * history.step:g} s"
    return Problem("overflow", where, what, "Look for a value that is far too large")


def event_spectra(body: Body, history: ModalHistory) -> Spectra | None:
    """Segment spectra of a record; None where it is shorter than one segment."""
    segment_s = body.case.spectrum.segment_s
    if not has_spectrum(history, segment_s):
        return None
    return segment_spectra(history, segment_s, upper_hz(body, history))


def top_mode_hz(body: Body) -> float | None:
    """Highest frequency of a normal mode [Hz]; None where no mode vibrates."""
    vibration_hz = body.modes.vibration_hz
    return float(vibration_hz.max()) if vibration_hz.size else None


def upper_hz(body: Body, history: ModalHistory) -> float:
    """Upper frequency of the spectra of a record [Hz]: as given, else by ``default_upper_hz``."""
    if body.case.spectrum.upper_hz is not None:
        return body.case.spectrum.upper_hz
    return default_upper_hz(history.step, top_mode_hz(body))


def _record(body: Body, event: Event, scratch: Path | None) -> EventRecord:
    """The record of an event without its start-up."""
    return read_event(event_files(body, event), scratch and scratch / RECORD)


def _forget(scratch: Path) -> None:
    """Remove the samples as they were read."""
    for name in (RECORD, RECORD + FINER):
        (scratch / name).unlink(missing_ok=True)


def _folders(sizes: NDArray[np.integer], scratch: Path | None) -> list[Path | None]:
    """Folder of each record that does not fit in memory after all shorter ones; None for a record that does."""
    order = np.argsort(sizes, kind="stable")
    held = np.empty(len(sizes), dtype=np.bool_)
    held[order] = np.cumsum(sizes[order]) <= HELD_BYTES
    return [None if scratch is None or fits else scratch / f"event-{i:04d}" for i, fits in enumerate(held)]


def mean_levels(body: Body, scratch: Path) -> list[MeanLevel]:
    """Means of every event, whose records are read for it, one after the other; ``scratch``: folder for a long one."""
    levels = []
    for event in body.case.mission.event:
        mean, _ = mean_and_covariance(_record(body, event, scratch).history.q)
        levels.append(mean_level(body, event, mean))
        _forget(scratch)
    return levels
