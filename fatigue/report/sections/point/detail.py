"""What the records say of a point: its stress over time, its spectra, and the stresses along its weld."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from numpy.typing import NDArray

from fatigue.life.records.history import stress_history
from fatigue.life.records.spool import Spool
from fatigue.readers.neutral.body.modes import vibration_hz
from fatigue.report import stress
from fatigue.report.inputs import FoundInputs
from fatigue.report.of_record import Record
from fatigue.report.stress import Envelope, EventRecord, Excerpt, StressSpectrum
from fatigue.spectrum.moments import default_upper_hz

COMPONENTS = {
    "membrane": "membrane_MPa",
    "bending": "bending_MPa",
    "in-plane shear": "in_plane_shear_MPa",
}


@dataclass(slots=True, eq=False)
class Detail:
    """Everything recovered for one point; empty where nothing damages it or the inputs are gone.

    ``deviation`` is the standard deviation of each stress component along its weld [MPa], ``variance_share`` the share
    of each mode in the variance of the point's stress, ``excerpts`` are those of each cycle, all in the governing
    event. ``path`` (2, t) is the normal stress and the shear of the point there, from their means [MPa], where the
    model of shear decides.
    """

    spectra: list[StressSpectrum] = field(default_factory=list)
    envelope: Envelope | None = None
    excerpts: list[list[Excerpt]] = field(default_factory=list)
    deviation: dict[str, NDArray[np.float64]] = field(default_factory=dict)
    variance_share: NDArray[np.float64] | None = None
    path: NDArray[np.float64] | None = None


@dataclass(frozen=True, slots=True, eq=False)
class DetailedPoint:
    """A point while its details are gathered.

    ``modal_stress`` (m,) is its stress per unit modal coordinate, ``stations`` (n, m) are the components at all
    stations of its weld; ``shear`` (m,) is the shear there where the path of both is drawn; ``cycles`` are the instants
    of the cycles in the governing event that are shown close by [s], the most damaging first.
    """

    modal_stress: NDArray[np.float64]
    stations: Mapping[str, NDArray[np.float64]]
    shear: NDArray[np.float64] | None
    governing_event: str | None
    cycles: Sequence[tuple[float, float]]


def point_details(
    points: Mapping[str, DetailedPoint], inputs: FoundInputs, record: Record
) -> tuple[dict[str, Detail], dict[str, float]]:
    """Details of some points by name, and the time step of each record [s]; one event is in memory at a time.

    ``record`` is the provenance of their result.

    Raises
    ------
    DataError : a history is not there any more or is not the one that was assessed
    """
    details = {name: Detail() for name in points}
    steps = {}
    with TemporaryDirectory(prefix="fatigue-") as scratch:
        for event in inputs.case.mission.event:
            history = inputs.history(event, Path(scratch) / "record")
            constants = inputs.constants(event)
            removed = np.full(len(constants), inputs.case.mean_of_q(event) == "remove")
            removed[len(inputs.modes) :] = False  # what the case gives over time stays
            of_event = stress.event_record(history, event.stress_factor, constants, removed)
            steps[event.name] = of_event.history.step
            upper = upper_hz(record, inputs, of_event.history.step)
            for name, point in points.items():
                spectrum = None
                if event.history is not None:
                    spectrum = stress.spectrum(of_event, point.modal_stress, inputs.case.spectrum.segment_s, upper)
                if spectrum is not None:
                    details[name].spectra.append(spectrum)
                if point.governing_event == event.name:
                    add_records(details[name], of_event, point)
    return details, steps


def upper_hz(record: Record, inputs: FoundInputs, step: float) -> float:
    """Upper frequency of the spectra [Hz], by the rule of the assessment."""
    if inputs.case.spectrum.upper_hz is not None:
        return inputs.case.spectrum.upper_hz
    modes = record["modes"]
    vibrating = vibration_hz(np.array(modes["frequency_hz"], dtype=np.float64), modes["kind"])
    return default_upper_hz(step, float(vibrating.max()) if vibrating.size else None)


def add_records(detail: Detail, record: EventRecord, point: DetailedPoint) -> None:
    """Add what is shown of the governing event: stresses along the line, the share of the modes, the history."""
    detail.deviation = {name: stress.deviations(record, modal_stress) for name, modal_stress in point.stations.items()}
    detail.variance_share = stress.variance_shares(record, point.modal_stress)
    detail.envelope = stress.envelope(record, point.modal_stress)
    dominant = np.argsort(-np.abs(detail.variance_share), kind="stable")[: stress.DOMINANT_MODES].tolist()
    if point.shear is not None and not isinstance(record.history.q, Spool):
        both = stress_history(record.stress_factor * np.stack([point.modal_stress, point.shear]), record.history.q)
        detail.path = both - both.mean(axis=1, keepdims=True)
    detail.excerpts = [stress.excerpts(record, point.modal_stress, *instants, dominant) for instants in point.cycles]
