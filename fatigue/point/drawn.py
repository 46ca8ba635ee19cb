"""Figures of a result on demand: those of the report, of any weld and any point."""

from typing import Literal, get_args

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.mission.events import upper_hz
from fatigue.point.cycles import counted_point, cycle_frame
from fatigue.point.found import FACES, Station
from fatigue.point.reopened import Reopened, counted_load, event_numbers, forget, sampled_load
from fatigue.report import figures, stress
from fatigue.report.figures.drawn import Figure
from fatigue.report.of_record import weights_of
from fatigue.report.sections.point.detail import Detail, DetailedPoint, add_records
from fatigue.report.sections.point.figures import SPECTRA_DRAWN, draw_history, draw_sn, draw_spectrum
from fatigue.report.sections.point.worst_cycles import leading_event, most_damaging
from fatigue.report.variants import assumptions_of, how_often
from fatigue.results import assessed

PointFigure = Literal["history", "spectrum", "rainflow", "exceedance", "sn"]
FigureName = Literal["lives", "weld", "history", "spectrum", "rainflow", "exceedance", "sn"]

FIGURES: tuple[str, ...] = get_args(FigureName)


def draw_lives(welds: pd.DataFrame, target_km: float) -> Figure:
    """Lives of the welds against the target."""
    return figures.weld_lives(assessed(welds), target_km)


def draw_weld(points: pd.DataFrame, target_km: float) -> Figure:
    """Life, load factor and largest ranges along a weld, ``points`` being its rows in the table of nodes."""
    return figures.along_weld(points, target_km)


def draw_point(name: PointFigure, inputs: Reopened, station: Station, face: int, event: str | None) -> Figure:
    """A figure of a face of a station, under one event or all.

    Raises
    ------
    DataError : no such event, or a point that no event loads
    """
    event_numbers(inputs, event)  # a sequence is a difference, which no figure shows by itself
    cycles = cycle_frame(inputs, station, face, event)
    if not cycles["range_MPa"].max() > 0.0:
        what = "nothing changes its stress, so it has no cycles to be drawn"
        raise DataError(Problem("no_cycles", f"{station}, {FACES[face]} face", what, "Take another point or event"))
    record, passes_per_km = inputs.record, weights_of(inputs.record)
    if name == "history":
        return _history(inputs, station, face, cycles)
    if name == "spectrum":
        return _spectrum(inputs, station, face, cycles)
    if name == "exceedance":
        return figures.exceedance(cycles, {name: passes_per_km[name] for name in cycles["event"].unique()})
    if name == "rainflow":
        return figures.rainflow_matrices(cycles, how_often(cycles, passes_per_km))
    return draw_sn(record, cycles, assumptions_of(record, counted_point(inputs, station, face).rated.curve.name))


def _history(inputs: Reopened, station: Station, face: int, cycles: pd.DataFrame) -> Figure:
    """Stress of a face over the event with the most damage among some cycles, its most damaging one close by."""
    event, detail = _leading_event(inputs, cycles), Detail()
    close_by = most_damaging(cycles, event, 1)
    load = counted_load(inputs, inputs.events.index(event))
    add_records(detail, _record(load), DetailedPoint(_modal_stress(inputs, station, face), {}, None, event, close_by))
    forget(load)
    assert detail.envelope is not None
    return draw_history(inputs.record, detail.envelope, detail.excerpts)


def _spectrum(inputs: Reopened, station: Station, face: int, cycles: pd.DataFrame) -> Figure:
    """Stress spectra of a face in the events of some cycles, with the modes that lead in the one with the most damage.

    Raises
    ------
    DataError : no record is as long as a segment
    """
    leading, modal_stress = _leading_event(inputs, cycles), _modal_stress(inputs, station, face)
    others = [event for event in inputs.events if event != leading and event in set(cycles["event"])]
    spectra: list[stress.StressSpectrum] = []
    shares = np.zeros(len(modal_stress))
    case = inputs.body.case
    for event in (leading, *others[: SPECTRA_DRAWN - 1]):
        number = inputs.events.index(event)
        load = sampled_load(inputs, number)
        record, highest_hz = _record(load), upper_hz(inputs.body, load.counted)
        found = stress.spectrum(record, modal_stress, case.spectrum.segment_s, highest_hz)
        if found is not None and case.mission.event[number].history is not None:
            spectra.append(found)
        if event == leading:
            shares = stress.variance_shares(record, modal_stress)
        forget(load)
    if not spectra:
        what, remedy = "no record is as long as a segment of a spectrum", "Shorten segment_s, or record longer"
        raise DataError(Problem("no_cycles", f"{station}, {FACES[face]} face", what, remedy))
    return draw_spectrum(inputs.record, spectra, shares, leading)


def _leading_event(inputs: Reopened, cycles: pd.DataFrame) -> str:
    """The event, no sequence, that has the most of the damage of some cycles."""
    damage = cycles.groupby("event", sort=False)["damage"].sum().rename("damage_per_pass").reset_index()
    leading = leading_event(damage, inputs.record)
    assert leading is not None
    return leading


def _modal_stress(inputs: Reopened, station: Station, face: int) -> NDArray[np.float64]:
    """Structural stress of a face per unit of each coordinate (c,) [MPa]."""
    point = counted_point(inputs, station, face)
    return np.asarray(point.membrane + (1.0 if face == 0 else -1.0) * point.bending)


def _record(load: EventLoad) -> stress.EventRecord:
    """An event in the form that figures of its record are made from."""
    factor = load.stress_factor
    return stress.EventRecord(load.counted, factor, load.mean, factor**2 * load.covariance, load.offset)
