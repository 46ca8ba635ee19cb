"""What is shown of a weld in detail: its stresses along the line, and its worst point's records and spectra."""

import logging
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.case import Event
from fatigue.report import signals
from fatigue.report.inputs import Inputs
from fatigue.report.result import Result
from fatigue.report.signals import Envelope, Excerpt, Record, Spectrum

log = logging.getLogger(__name__)

COMPONENTS = {
    "membrane": "membrane_MPa",
    "bending": "bending_MPa",
    "in-plane shear": "in_plane_shear_MPa",
}


@dataclass(slots=True, eq=False)
class Detail:
    """Everything recovered for one weld; empty where the weld does no damage or the inputs are gone.

    ``deviation`` are the standard deviations of the stress components along the line [MPa], ``variance_share`` those of
    the modes in the worst point's stress, both in the governing event.
    """

    spectra: list[Spectrum] = field(default_factory=list)
    envelope: Envelope | None = None
    excerpt: Excerpt | None = None
    deviation: dict[str, NDArray[np.float64]] = field(default_factory=dict)
    variance_share: NDArray[np.float64] | None = None


@dataclass(frozen=True, slots=True, eq=False)
class _Shapes:
    """Stress of one weld per unit modal coordinate: at the worst point (m,), and components at all stations (n, m)."""

    worst: NDArray[np.float64]
    stations: Mapping[str, NDArray[np.float64]]


def weld_details(result: Result, inputs: Inputs) -> tuple[dict[str, Detail], dict[str, float]]:
    """Recover the details of the welds shown in detail, one event in memory at a time.

    Returns the details of each weld and the time step of each record [s].

    Raises
    ------
    DataError : a history is not there any more or is not the one that was assessed
    """
    details = {weld: Detail() for weld in result.detailed}
    shapes = {weld: _shapes(result, weld) for weld in result.detailed}
    governing = result.welds.set_index("weld")["governing_event"].to_dict()
    steps = {}
    for event in inputs.case.mission.event:
        record = signals.prepared(inputs.history(event), event.stress_factor)
        steps[event.name] = record.history.step
        for weld, detail in details.items():
            _add_event(detail, record, shapes[weld], result, inputs, event, weld, governing=governing[weld] == event.name)
    return details, steps


def _add_event(
    detail: Detail,
    record: Record,
    shapes: _Shapes,
    result: Result,
    inputs: Inputs,
    event: Event,
    weld: str,
    *,
    governing: bool,
) -> None:
    spectrum = signals.spectrum(
        record, shapes.worst, inputs.case.spectrum.segment_s, upper_hz(result, inputs, record.history.step)
    )
    if spectrum is not None:
        detail.spectra.append(spectrum)
    if not governing:
        return
    detail.deviation = {name: signals.deviations(record, shape) for name, shape in shapes.stations.items()}
    detail.variance_share = signals.variance_shares(record, shapes.worst)
    detail.envelope = signals.envelope(record, shapes.worst)
    of_event = result.cycles[(result.cycles["weld"] == weld) & (result.cycles["event"] == event.name)]
    largest = of_event.loc[(of_event["damage"] / of_event["count"]).idxmax()]
    dominant = np.argsort(-np.abs(np.nan_to_num(detail.variance_share)), kind="stable")[: signals.DOMINANT_MODES]
    detail.excerpt = signals.excerpt(record, shapes.worst, largest["start_s"], largest["end_s"], dominant.tolist())


def upper_hz(result: Result, inputs: Inputs, step: float) -> float:
    """Upper frequency of the spectra [Hz], by the rule of the assessment."""
    if inputs.case.spectrum.upper_hz is not None:
        return inputs.case.spectrum.upper_hz
    modes = result.record["modes"]
    normal = [f for f, kind in zip(modes["frequency_hz"], modes["kind"], strict=True) if kind == "normal"]
    return float(min(0.4 / step, 1.5 * max(normal, default=np.inf)))


def _shapes(result: Result, weld: str) -> _Shapes:
    """Lay the rows of the stress table of one weld out as (station, mode), stations in the order of the nodes."""
    modes = result.record["modes"]["used"]
    rows = result.stress_shapes(weld)
    stations = result.nodes[(result.nodes["weld"] == weld) & (result.nodes["surface"] == "top")]
    index = pd.MultiIndex.from_frame(stations[["part", "order"]])

    def component(column: str) -> NDArray[np.float64]:
        table = rows.pivot(index=["part", "order"], columns="mode", values=column)
        return table.loc[index, modes].to_numpy(dtype=np.float64)

    found = {name: component(column) for name, column in COMPONENTS.items()}
    worst = result.worst(weld)
    at = index.get_loc((worst["part"], worst["order"]))
    bending = found["bending"][at] if worst["surface"] == "top" else -found["bending"][at]
    return _Shapes(worst=found["membrane"][at] + bending, stations=found)
