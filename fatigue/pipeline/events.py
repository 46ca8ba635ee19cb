"""The events of a mission: their records read, cut and checked, and what each brings to every station."""

import logging
import math

import numpy as np

from fatigue.case import Event, check_distance, event_length_km
from fatigue.errors import CaseError, DataError, FatigueError, NumericalError, Problem, refuse
from fatigue.life.history import ModalHistory, kept
from fatigue.life.mission import Pass, Plan
from fatigue.pipeline.body import Body
from fatigue.pipeline.event_load import EventLoad, prepare_event
from fatigue.pipeline.model import WeldGroups, solve_group
from fatigue.readers.history import read_history
from fatigue.spectrum.moments import (
    Spectra,
    has_spectrum,
    moment_matrices,
    point_moments,
    samples_per_segment,
    segment_spectra,
    segment_starts,
)

log = logging.getLogger(__name__)

FEW_SEGMENTS = 8  # below, the spectrum is an estimate from too little
SAMPLES_PER_PEAK = 20.0  # what upsample = "auto" reaches for
LARGEST_UPSAMPLE = 64
DOUBLE_PRECISION_SAMPLES = 5e9  # of stress, both faces: above, the kernel in single precision counts (1e-7 of damage)


def mission_plan(body: Body) -> tuple[Plan, tuple[Problem, ...]]:
    """Read and check every record of the mission; return its passes per km and the doubts about the records."""
    warnings: list[Problem] = []
    problems: list[Problem] = []
    passes: list[Pass] = []
    for event in body.case.mission.event:
        try:
            history, doubts = _record(body, event)
        except FatigueError as error:
            problems += error.problems
            continue
        warnings += doubts + _record_warnings(body, event, history)
        passes.append(
            Pass(
                event=event.name,
                samples=history.q.shape[1],
                length=event_length_km(event, history.duration),
                share=event.share,
                per_1000_km=event.per_1000_km,
            )
        )
    refuse(DataError, problems)
    mission = body.case.mission
    return Plan(tuple(passes), mission.target_km, mission.km_per_year, mission.damage_limit), tuple(warnings)


def event_loads(groups: WeldGroups, plan: Plan) -> tuple[EventLoad, ...]:
    """Read the records of all events and compute what all stations share; they stay in memory while welds stream by."""
    body, events = groups.body, groups.body.case.mission.event
    factor = body.case.counting.upsample
    factors = _automatic_factors(groups) if factor == "auto" else [factor] * len(events)
    stations = sum(len(line.node) for line in body.lines)
    samples = sum(f * p.samples for f, p in zip(factors, plan.passes, strict=True))
    single = 2 * stations * samples > DOUBLE_PRECISION_SAMPLES
    log.info("cycles are counted in %s precision", "single" if single else "double")
    return tuple(
        event_load(body, event, upsample, single=single) for event, upsample in zip(events, factors, strict=True)
    )


def event_load(body: Body, event: Event, upsample: int, *, single: bool = False) -> EventLoad:
    """Read the record of one event and compute what all stations share."""
    history, _ = _record(body, event)
    if upsample > 1:
        log.info("event '%s' is counted on a record upsampled %d times", event.name, upsample)
    try:
        with np.errstate(over="raise"):
            spectra = event_spectra(body, history)
            residue = body.case.residue(event)
            return prepare_event(
                history, residue, event.stress_factor, upsample, spectra, top_mode_hz(body), single=single
            )
    except FloatingPointError:
        problem = Problem(
            "overflow",
            event.history,
            f"modal coordinates of event '{event.name}' are so large that their squares exceed double precision",
            "Look for a value that is far too large",
        )
        raise NumericalError(problem) from None


def event_spectra(body: Body, history: ModalHistory) -> Spectra | None:
    """Segment spectra of a record; None where it is shorter than one segment."""
    segment_s = body.case.spectrum.segment_s
    if not has_spectrum(history, segment_s):
        return None
    return segment_spectra(history, segment_s, upper_hz(body, history))


def top_mode_hz(body: Body) -> float | None:
    """Highest frequency of a normal mode [Hz]; None where there is none above 0."""
    frequencies = zip(body.modes.frequency, body.modes.kind, strict=True)
    return max((float(f) for f, kind in frequencies if kind == "normal" and f > 0.0), default=None)


def upper_hz(body: Body, history: ModalHistory) -> float:
    """Upper frequency of the spectra [Hz]: as given, else the lower of 0.4 f_s and 1.5 x the highest normal mode."""
    if body.case.spectrum.upper_hz is not None:
        return body.case.spectrum.upper_hz
    top = top_mode_hz(body)
    return 0.4 / history.step if top is None else min(0.4 / history.step, 1.5 * top)


def _record(body: Body, event: Event) -> tuple[ModalHistory, list[Problem]]:
    """Read the record of an event, cut its start-up, and check its length."""
    case = body.case
    path = case.resolve(event.history)
    whole, warnings = read_history(path, event.name, body.modes.mode, case.body.ignore_modes, strict=body.strict)
    history = kept(whole, event.start_s)
    if history.q.shape[1] < 2:
        raise CaseError(
            Problem(
                "short_record",
                f"{case.path.name}: mission.event '{event.name}': start_s",
                f"start_s = {event.start_s:g} leaves {history.q.shape[1]} samples of {path.name}, which lasts "
                f"{whole.duration:g} s",
                "Cut less, or record longer",
            )
        )
    check_distance(event, history.duration, f"{case.path.name}: mission.event '{event.name}'")
    return history, warnings


def _record_warnings(body: Body, event: Event, history: ModalHistory) -> list[Problem]:
    where = f"event '{event.name}'"
    segment_s = body.case.spectrum.segment_s
    if not has_spectrum(history, segment_s):
        return [
            Problem(
                "no_spectrum",
                where,
                f"the record of {history.duration:g} s has no spectral segment of {segment_s:g} s (at least four "
                "samples), so there is no frequency-domain estimate",
                "Record longer or shorten segment_s if you need one",
            )
        ]
    segments = len(segment_starts(history.q.shape[1], samples_per_segment(history.step, segment_s)))
    if segments < FEW_SEGMENTS:
        return [
            Problem(
                "few_segments",
                where,
                f"the spectrum is an average of {segments} segments of {segment_s:g} s",
                f"Record longer, or shorten segment_s to get {FEW_SEGMENTS} segments or more",
            )
        ]
    return []


def _automatic_factors(groups: WeldGroups) -> list[int]:
    """Smallest power of 2 per event that gives every point of the body ``SAMPLES_PER_PEAK`` samples per peak."""
    body = groups.body
    records = [_record(body, event)[0] for event in body.case.mission.event]
    spectra = [event_spectra(body, history) for history in records]
    moments = [None if s is None else moment_matrices(s) for s in spectra]
    peaks_per_s = np.zeros(len(records))
    for number in range(len(groups)):
        stress = solve_group(groups, number).stations.treated
        faces = np.concatenate([stress.membrane + stress.bending, stress.membrane - stress.bending])
        for i, matrices in enumerate(moments):
            if matrices is not None:
                _, _, m2, m4 = point_moments(faces, matrices)
                fastest = np.max(np.divide(m4, m2, out=np.zeros_like(m4), where=m2 > 0.0))
                peaks_per_s[i] = max(peaks_per_s[i], np.sqrt(fastest))
    wanted = SAMPLES_PER_PEAK * peaks_per_s * np.array([history.step for history in records])
    return [min(LARGEST_UPSAMPLE, 2 ** max(0, math.ceil(math.log2(w)))) if w > 0.0 else 1 for w in wanted]
