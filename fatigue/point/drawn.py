"""Figures of a result on demand: those of the report, of any weld and any point."""

from typing import Literal, get_args

import numpy as np
import pandas as pd
import plotly.graph_objects as go

from fatigue.errors import DataError, Problem
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.point.cycles import counted_point, cycle_frame
from fatigue.point.found import FACES, Station
from fatigue.point.reopened import Reopened, counted_load, event_numbers, forget
from fatigue.report import figures, stress
from fatigue.report.of_record import mode_names, target_of, weights_of
from fatigue.report.sections.point.worst_cycles import most_damaging
from fatigue.report.variants import assumptions_of, how_often, laws_of
from fatigue.results import assessed

PointFigure = Literal["history", "rainflow", "exceedance", "sn"]
FigureName = Literal["lives", "weld", "history", "rainflow", "exceedance", "sn"]

FIGURES: tuple[str, ...] = get_args(FigureName)
DS_UNIT = "MPa mm<sup>−0.222</sup>"


def draw_lives(welds: pd.DataFrame, target_km: float) -> go.Figure:
    """Lives of the welds against the target."""
    return figures.weld_lives(assessed(welds), target_km)


def draw_weld(points: pd.DataFrame, target_km: float) -> go.Figure:
    """Life, load factor and largest ranges along a weld, ``points`` being its rows in the table of nodes."""
    return figures.along_weld(points, target_km)


def draw_point(name: PointFigure, inputs: Reopened, station: Station, face: int, event: str | None) -> go.Figure:
    """A figure of a face of a station, under one event or all.

    Raises
    ------
    DataError : no such event, or a point that no event loads
    """
    if name == "history":
        event_numbers(inputs, event)  # a sequence has no history
    cycles = cycle_frame(inputs, station, face, event)
    if not cycles["range_MPa"].max() > 0.0:
        what = "nothing changes its stress, so it has no cycles to be drawn"
        raise DataError(Problem("no_cycles", f"{station}, {FACES[face]} face", what, "Take another point or event"))
    passes_per_km = weights_of(inputs.record)
    if name == "history":
        return _history(inputs, station, face, cycles)
    if name == "exceedance":
        return figures.exceedance(cycles, {name: passes_per_km[name] for name in cycles["event"].unique()})
    per_km = how_often(cycles, passes_per_km)
    if name == "rainflow":
        return figures.rainflow_matrices(cycles, per_km)
    used = assumptions_of(inputs.record, counted_point(inputs, station, face).rated.curve.name)
    per_target = per_km * target_of(inputs.record)
    unit = DS_UNIT if used.curve.applies == "dS" else "MPa"
    return figures.sn_with_spectrum(cycles, per_target, laws_of(used), used.survival, unit)


def _history(inputs: Reopened, station: Station, face: int, cycles: pd.DataFrame) -> go.Figure:
    """Stress of a face over the event with the most damage among some cycles, its most damaging one close by."""
    of_events = cycles[cycles["event"].isin(inputs.events)]
    damage = how_often(of_events, weights_of(inputs.record)) * (of_events["damage"] / of_events["count"])
    event = str(damage.groupby(of_events["event"], sort=False).sum().idxmax())
    point = counted_point(inputs, station, face)
    modal_stress = point.membrane + (1.0 if face == 0 else -1.0) * point.bending
    (number,) = event_numbers(inputs, event)
    load = counted_load(inputs, number)
    record = _record(load)
    shares = stress.variance_shares(record, modal_stress)
    leading = np.argsort(-np.abs(shares), kind="stable")[: stress.DOMINANT_MODES].tolist()
    envelope = stress.envelope(record, modal_stress)
    ((start, end),) = most_damaging(of_events, event, 1)
    close_by = stress.excerpts(record, modal_stress, start, end, leading)
    forget(load)
    names, _ = mode_names(inputs.record)
    return figures.stress_history(envelope, close_by, names, figures.event_colours(inputs.events)[event])


def _record(load: EventLoad) -> stress.EventRecord:
    """An event as it was counted, in the form that figures of histories are made from."""
    factor = load.stress_factor
    return stress.EventRecord(load.counted, factor, load.mean, factor**2 * load.covariance, load.offset)
