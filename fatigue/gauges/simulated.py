"""What the gauges read in one event of the simulation: rows times modal coordinates and unit loads."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.case import Event
from fatigue.gauges.rows import GaugeRows
from fatigue.life.records.history import Residue, stress_history
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.mission.unit_loads import event_constants, event_files
from fatigue.pipeline.solve.body import Body
from fatigue.readers.neutral.event.event_record import read_event

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Reading:
    """What g gauges read in one event, at t instants.

    Attributes
    ----------
    event : its name
    start, step : file time of the first kept sample, and between samples [s]
    strain : (g, t) what the grids show [ue]
    stress : (g, t) normal stress along them [MPa]
    residue : how its cycles are closed
    """

    event: str
    start: float
    step: float
    strain: Floats
    stress: Floats
    residue: Residue

    @property
    def time(self) -> Floats:
        """File time of each sample, (t,) [s]."""
        return np.asarray(self.start + self.step * np.arange(self.strain.shape[1], dtype=np.float64))


def simulated(body: Body, rows: GaugeRows, event: Event, scratch: Path | None = None) -> Reading:
    """Reading of all gauges in an event at the kept samples of its file.

    A partial or allowance factor of the event is left out: it is on no strain that anybody measures. What is constant
    in the event, given loads and a mean of q that the case removes, is in.

    Raises
    ------
    DataError : the record cannot be read
    """
    record = read_event(event_files(body, event), scratch)
    q, every = record.history.q, slice(None, None, record.refined)
    both = np.concatenate([rows.strain, rows.stress])
    constant = both @ event_constants(body, event)
    if body.case.mean_of_q(event) == "remove":
        of_modes = np.where(body.coordinates.is_mode, both, 0.0)
        constant = constant - stress_history(of_modes, q)[:, every].mean(axis=1)
    values = stress_history(both, q)[:, every] + constant[:, np.newaxis]
    strain, stress = np.split(values, 2)
    step = record.history.step * record.refined
    return Reading(event.name, record.history.start, step, strain, stress, body.case.residue(event))


def counted(rows: GaugeRows, load: EventLoad) -> Reading:
    """Reading of all gauges in an event at the instants that are counted: upsampled as an assessment does."""
    both = np.concatenate([rows.strain, rows.stress])
    values = stress_history(both, load.counted.q) + (both @ load.offset)[:, np.newaxis]
    strain, stress = np.split(values, 2)
    record = load.counted
    return Reading(record.event, record.start, record.step, strain, stress, load.residue)
