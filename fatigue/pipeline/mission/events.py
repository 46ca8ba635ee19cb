"""The records of the events, read and prepared: what each event brings to every station, in memory or on disk."""

import logging
import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.case import LARGEST_UPSAMPLE, Event
from fatigue.errors import NumericalError, Problem
from fatigue.life.mission import Plan
from fatigue.life.records.history import ModalHistory, mean_and_covariance
from fatigue.pipeline.mission.event_load import EventLoad, HowCounted, held_copies, prepare_event
from fatigue.pipeline.mission.offsets import MeanLevel, mean_level, with_offset
from fatigue.pipeline.mission.unit_loads import event_files
from fatigue.pipeline.solve.body import Body
from fatigue.pipeline.solve.model import solve_group
from fatigue.pipeline.solve.weld_groups import WeldGroups
from fatigue.readers.neutral.event.event_record import FINER, EventRecord, read_event
from fatigue.side_by_side import in_order
from fatigue.spectrum.moments import (
    MomentMatrices,
    Spectra,
    default_upper_hz,
    has_spectrum,
    moment_matrices,
    point_moments,
    segment_spectra,
    spectra_above,
)
from fatigue.spectrum.outside import peak_rate

log = logging.getLogger(__name__)

SAMPLES_PER_PEAK = 20.0  # what upsample = "auto" reaches for
DOUBLE_PRECISION_SAMPLES = 5e9  # of stress, both faces: above, the kernel in single precision counts (3e-7 of damage)
RECORD = "record"  # file of the samples as they were read
HELD_BYTES = 16e6  # of all records together, as they are in their files; the longest beyond that stay on disk


def event_loads(
    groups: WeldGroups, plan: Plan, scratch: Path | None = None, threads: int | None = None
) -> tuple[EventLoad, ...]:
    """What all stations share of every event; it is kept while welds stream by.

    ``scratch`` is a folder for the longest records where all of them are more than ``HELD_BYTES``; None: all are held
    in memory, whatever their size. ``threads`` prepare an event each, by default one per processor core; the numbers do
    not depend on how many there are.
    """
    body, events = groups.body, groups.body.case.mission.event
    sizes = np.array([len(body.coordinates) * p.samples for p in plan.passes])
    asked = body.case.counting.upsample
    folders = _folders(4 * sizes, scratch)
    wanted = _automatic_factors(groups, folders) if asked == "auto" else [asked] * len(events)
    factors = [p.factor(factor) for p, factor in zip(plan.passes, wanted, strict=True)]
    stations = int(body.lines.begin[-1])
    samples = sum(f * p.samples for f, p in zip(factors, plan.passes, strict=True))
    single = 2 * stations * samples > DOUBLE_PRECISION_SAMPLES
    log.info("cycles are counted in %s precision", "single" if single else "double")
    for event, upsample in zip(events, factors, strict=True):
        if upsample > 1:
            log.info("event '%s' is counted on a record upsampled %d times", event.name, upsample)
    bytes_held = sizes * [f * (8 if f > 1 else 4) for f in factors]  # interpolated in double precision

    given = [p.samples for p in plan.passes]
    held = held_copies(len(body.coordinates), given, [f * n for f, n in zip(factors, given, strict=True)])

    def prepared(job: tuple[Event, int, Path | None, bool]) -> EventLoad:
        event, upsample, folder, holds = job
        return event_load(body, event, upsample, single=single, scratch=folder, holds_single=holds)

    jobs = zip(events, factors, _folders(bytes_held, scratch), held, strict=True)
    return tuple(in_order(prepared, jobs, threads))


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
    how = HowCounted(body.case.residue(event), event.stress_factor, upsample, single, holds_single)
    record = _record(body, event, scratch)
    load = with_offset(body, event, _load_of(body, record, how, scratch), record)
    if load.is_upsampled and scratch is not None:
        _forget(scratch)
    return load


def shortened_record(body: Body, event: Event, samples: int, scratch: Path) -> ModalHistory:
    """The first samples of the record of an event behind its start-up."""
    shortened = _record(body, event, scratch).shortened(samples).history
    _forget(scratch)
    return shortened


def load_of(body: Body, event: Event, history: ModalHistory, upsample: int, *, single: bool) -> EventLoad:
    """What all stations share of a record in memory."""
    how = HowCounted(body.case.residue(event), event.stress_factor, upsample, single)
    record = EventRecord(history, history.duration, is_static=event.history is None)
    return with_offset(body, event, _load_of(body, record, how), record)


def _load_of(body: Body, record: EventRecord, how: HowCounted, scratch: Path | None = None) -> EventLoad:
    """What all stations share of a record; ``scratch``: folder for what is computed of each sample."""
    history = record.history
    spectra = None if record.is_static else event_spectra(body, history)
    try:
        with np.errstate(over="raise", invalid="raise"):
            return prepare_event(history, how, spectra, top_mode_hz(body), scratch, record)
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


def _below_and_above(spectra: Spectra) -> tuple[MomentMatrices, MomentMatrices | None]:
    """Moment matrices of the band of the spectra, and of what lies above it."""
    above = spectra_above(spectra)
    return moment_matrices(spectra), None if above is None else moment_matrices(above)


def _automatic_factors(groups: WeldGroups, folders: Sequence[Path | None]) -> list[int]:
    """Smallest power of 2 per event that gives every point of the body ``SAMPLES_PER_PEAK`` samples per peak.

    ``folders`` are for the records of the events, None: in memory. One record is open at a time.
    """
    body = groups.body
    steps: list[float] = []
    moments: list[tuple[MomentMatrices, MomentMatrices | None] | None] = []
    for event, folder in zip(body.case.mission.event, folders, strict=True):
        record = _record(body, event, folder)
        spectra = None if record.is_static else event_spectra(body, record.history)
        steps.append(record.history.step * record.refined)
        moments.append(None if spectra is None else _below_and_above(spectra))
    peaks_per_s = np.zeros(len(steps))
    for number in range(len(groups)):
        stress = solve_group(groups, number).stations.treated
        faces = np.concatenate([stress.membrane + stress.bending, stress.membrane - stress.bending])
        for i, matrices in enumerate(moments):
            if matrices is not None:
                of_band, of_above = matrices
                band = point_moments(faces, of_band)
                above = np.zeros_like(band) if of_above is None else point_moments(faces, of_above)
                peaks_per_s[i] = np.nanmax(peak_rate(band, above), initial=peaks_per_s[i])
    wanted = SAMPLES_PER_PEAK * peaks_per_s * np.array(steps)
    return [min(LARGEST_UPSAMPLE, 2 ** max(0, math.ceil(math.log2(w)))) if w > 0.0 else 1 for w in wanted]
