"""The events of a mission: their records read, cut and checked, and what each brings to every station."""

import logging
from dataclasses import replace

import numpy as np

from fatigue.case import Event, check_distance, event_length_km
from fatigue.errors import CaseError, DataError, FatigueError, Problem, refuse
from fatigue.event_block import EventLoad, prepare_event
from fatigue.life.history import ModalHistory, kept
from fatigue.life.mission import Pass, Plan
from fatigue.model import Model
from fatigue.readers.history import read_history
from fatigue.spectrum.moments import MomentMatrices, has_spectrum, moment_matrices, point_moments, segment_spectra
from fatigue.stations import Stations

log = logging.getLogger(__name__)

FEW_SEGMENTS = 8  # below, the spectrum is an estimate from too little
SAMPLES_PER_PEAK = 20.0  # what upsample = "auto" reaches for
LARGEST_UPSAMPLE = 64


def mission_plan(model: Model) -> tuple[Plan, tuple[Problem, ...]]:
    """Read and check every record of the mission; return its passes per km and the doubts about the records."""
    warnings: list[Problem] = []
    problems: list[Problem] = []
    passes: list[Pass] = []
    for event in model.case.mission.event:
        try:
            history, doubts = _record(model, event)
        except FatigueError as error:
            problems += error.problems
            continue
        warnings += doubts + _record_warnings(model, event, history)
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
    mission = model.case.mission
    return Plan(tuple(passes), mission.target_km, mission.km_per_year, mission.damage_limit), tuple(warnings)


def event_load(model: Model, event: Event) -> EventLoad:
    """Read the record of an event and compute what all stations share."""
    history, _ = _record(model, event)
    residue = model.case.residue(event)
    moments: MomentMatrices | None = None
    if has_spectrum(history, model.case.spectrum.segment_s):
        moments = moment_matrices(segment_spectra(history, model.case.spectrum.segment_s, upper_hz(model, history)))
    factor = model.case.counting.upsample
    upsample = _automatic_factor(model.stations, history, moments) if factor == "auto" else factor
    if upsample > 1:
        log.info("event '%s' is counted on a record upsampled %d times", event.name, upsample)
    return prepare_event(history, residue, event.stress_factor, upsample, moments)


def upper_hz(model: Model, history: ModalHistory) -> float:
    """Upper frequency of the spectra [Hz]: as given, else the lower of 0.4 f_s and 1.5 x the highest normal mode."""
    if model.case.spectrum.upper_hz is not None:
        return model.case.spectrum.upper_hz
    normal = [f for f, kind in zip(model.modes.frequency, model.modes.kind, strict=True) if kind == "normal"]
    return float(min(0.4 / history.step, 1.5 * max(normal, default=np.inf)))


def _record(model: Model, event: Event) -> tuple[ModalHistory, list[Problem]]:
    """Read the record of an event, cut its start-up, and check its length."""
    case = model.case
    path = case.resolve(event.history)
    whole, warnings = read_history(path, event.name, model.modes.mode, case.body.ignore_modes, strict=model.strict)
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


def _record_warnings(model: Model, event: Event, history: ModalHistory) -> list[Problem]:
    where = f"event '{event.name}'"
    segment_s = model.case.spectrum.segment_s
    if not has_spectrum(history, segment_s):
        return [
            Problem(
                "no_spectrum",
                where,
                f"the record of {history.duration:g} s is shorter than one spectral segment of {segment_s:g} s, so "
                "there is no frequency-domain estimate",
                "Record longer or shorten segment_s if you need one",
            )
        ]
    moments = segment_spectra(replace(history, q=history.q[:1]), segment_s, upper_hz(model, history))
    if len(moments.amplitude) < FEW_SEGMENTS:
        return [
            Problem(
                "few_segments",
                where,
                f"the spectrum is an average of {len(moments.amplitude)} segments of {segment_s:g} s",
                f"Record longer, or shorten segment_s to get {FEW_SEGMENTS} segments or more",
            )
        ]
    return []


def _automatic_factor(stations: Stations, history: ModalHistory, moments: MomentMatrices | None) -> int:
    """Smallest power of 2 that gives every point ``SAMPLES_PER_PEAK`` samples per peak."""
    if moments is None:
        return 1
    stress = stations.treated
    _, _, m2, m4 = point_moments(
        np.concatenate([stress.membrane + stress.bending, stress.membrane - stress.bending]), moments
    )
    peaks_per_s = np.sqrt(np.max(np.divide(m4, m2, out=np.zeros_like(m4), where=m2 > 0.0)))
    factor = 1
    while factor / history.step < SAMPLES_PER_PEAK * peaks_per_s and factor < LARGEST_UPSAMPLE:
        factor *= 2
    return factor
