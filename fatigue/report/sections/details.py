"""What is shown of a weld in detail: its stresses along the line, and its worst point's records and spectra."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.life.records.history import stress_history
from fatigue.life.records.spool import Spool
from fatigue.readers.neutral.body.modes import vibration_hz
from fatigue.report import stress
from fatigue.report.inputs import FoundInputs
from fatigue.report.result import ShownResult
from fatigue.report.stress import Envelope, EventRecord, Excerpt, StressSpectrum
from fatigue.spectrum.moments import default_upper_hz

COMPONENTS = {
    "membrane": "membrane_MPa",
    "bending": "bending_MPa",
    "in-plane shear": "in_plane_shear_MPa",
}

_OF_LARGEST = ("event", "start_s", "end_s", "count", "damage")


@dataclass(slots=True, eq=False)
class Detail:
    """Everything recovered for one weld; empty where the weld does no damage or the inputs are gone.

    ``deviation`` is the standard deviation of each stress component along the line [MPa], ``variance_share`` the
    share of each mode in the variance of the worst point's stress, both in the governing event. ``path`` (2, t) is
    the normal stress and the shear of the worst point there, from their means [MPa], where the model of shear decides.
    """

    spectra: list[StressSpectrum] = field(default_factory=list)
    envelope: Envelope | None = None
    excerpts: list[Excerpt] = field(default_factory=list)
    deviation: dict[str, NDArray[np.float64]] = field(default_factory=dict)
    variance_share: NDArray[np.float64] | None = None
    path: NDArray[np.float64] | None = None


@dataclass(frozen=True, slots=True, eq=False)
class _DetailedWeld:
    """A weld while its details are gathered.

    ``worst`` (m,) is the stress of its worst point per unit modal coordinate, ``stations`` (n, m) are the components at
    all its stations; ``shear`` (m,) is the shear there where the path of both is drawn; ``largest`` are the instants of
    the most damaging cycle of its worst point in that event [s], None where its cycles are not kept.
    """

    worst: NDArray[np.float64]
    stations: Mapping[str, NDArray[np.float64]]
    shear: NDArray[np.float64] | None
    governing_event: str | None
    largest: tuple[float, float] | None


def weld_details(result: ShownResult, inputs: FoundInputs) -> tuple[dict[str, Detail], dict[str, float]]:
    """Details of each weld shown in detail, and the time step of each record [s]; one event is in memory at a time.

    Raises
    ------
    DataError : a history is not there any more or is not the one that was assessed
    """
    welds = _welds(result)
    details = {weld: Detail() for weld in welds}
    steps = {}
    with TemporaryDirectory(prefix="fatigue-") as scratch:
        for event in inputs.case.mission.event:
            history = inputs.history(event, Path(scratch) / "record")
            constants = inputs.constants(event)
            removed = np.full(len(constants), inputs.case.mean_of_q(event) == "remove")
            removed[len(inputs.modes) :] = False  # what the case gives over time stays
            record = stress.event_record(history, event.stress_factor, constants, removed)
            steps[event.name] = record.history.step
            upper = upper_hz(result, inputs, record.history.step)
            for name, weld in welds.items():
                spectrum = None
                if event.history is not None:
                    spectrum = stress.spectrum(record, weld.worst, inputs.case.spectrum.segment_s, upper)
                if spectrum is not None:
                    details[name].spectra.append(spectrum)
                if weld.governing_event == event.name:
                    _add_records(details[name], record, weld)
    return details, steps


def upper_hz(result: ShownResult, inputs: FoundInputs, step: float) -> float:
    """Upper frequency of the spectra [Hz], by the rule of the assessment."""
    if inputs.case.spectrum.upper_hz is not None:
        return inputs.case.spectrum.upper_hz
    modes = result.record["modes"]
    vibrating = vibration_hz(np.array(modes["frequency_hz"], dtype=np.float64), modes["kind"])
    return default_upper_hz(step, float(vibrating.max()) if vibrating.size else None)


def _add_records(detail: Detail, record: EventRecord, weld: _DetailedWeld) -> None:
    """Add what is shown of the governing event: stresses along the line, the share of the modes, the history."""
    detail.deviation = {name: stress.deviations(record, modal_stress) for name, modal_stress in weld.stations.items()}
    detail.variance_share = stress.variance_shares(record, weld.worst)
    detail.envelope = stress.envelope(record, weld.worst)
    dominant = np.argsort(-np.abs(detail.variance_share), kind="stable")[: stress.DOMINANT_MODES]
    if weld.shear is not None and not isinstance(record.history.q, Spool):
        both = stress_history(record.stress_factor * np.stack([weld.worst, weld.shear]), record.history.q)
        detail.path = both - both.mean(axis=1, keepdims=True)
    if weld.largest is not None:
        detail.excerpts = stress.excerpts(record, weld.worst, *weld.largest, dominant.tolist())


def _welds(result: ShownResult) -> dict[str, _DetailedWeld]:
    governing = _leading_events(result)
    twist = result.modal_stress(["twist_shear_MPa"]) if _shows_a_path(result) else {}
    welds = {}
    for name, (stations, modal_stress) in result.modal_stress(list(COMPONENTS.values())).items():
        components = dict(zip(COMPONENTS, modal_stress, strict=True))
        point = result.worst(name)
        at = int(((stations["part"] == point["part"]) & (stations["order"] == point["order"])).argmax())
        sign = 1.0 if point["surface"] == "top" else -1.0
        by_model = name in twist and point["multiaxial_verdict"] == "model_dependent"
        welds[name] = _DetailedWeld(
            worst=components["membrane"][at] + sign * components["bending"][at],
            stations=components,
            shear=components["in-plane shear"][at] + sign * twist[name][1][0][at] if by_model else None,
            governing_event=governing[name],
            largest=_largest(result.cycles(name, _OF_LARGEST), governing[name]),
        )
    return {name: welds[name] for name in result.detailed}


def _shows_a_path(result: ShownResult) -> bool:
    """Whether the worst point of any detailed weld passes by one model of shear and fails by another."""
    return any(result.worst(weld).get("multiaxial_verdict") == "model_dependent" for weld in result.detailed)


def _leading_events(result: ShownResult) -> dict[str, str | None]:
    """Governing event of each weld; the event with the most damage where a sequence governs, which has no record."""
    known = {event["event"] for event in result.events}
    found: dict[str, str | None] = {}
    for weld, name in result.assessed.set_index("weld")["governing_event"].items():
        found[str(weld)] = None if pd.isna(name) else str(name)
        if not pd.isna(name) and name not in known:
            of_weld = result.damage[(result.damage["weld"] == weld) & result.damage["event"].isin(known)]
            weighted = of_weld["damage_per_pass"] * of_weld["event"].map(result.passes_per_km)
            found[str(weld)] = None if weighted.empty else str(of_weld.loc[weighted.idxmax(), "event"])
    return found


def _largest(cycles: pd.DataFrame, event: str | None) -> tuple[float, float] | None:
    """Instants of the most damaging cycle of an event [s]; None where its cycles are not kept."""
    cycles = cycles[cycles["event"] == event]
    if cycles.empty:
        return None
    largest = cycles.loc[(cycles["damage"] / cycles["count"]).idxmax()]
    return float(largest["start_s"]), float(largest["end_s"])
