"""A ride of the vehicle as a source: modal coordinates as the case has them, channels, and numbers of the ride."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from threading import Lock
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import NDArray

from fatigue.case import Case
from fatigue.errors import Problem
from fatigue.files.hashes import sha256
from fatigue.files.mishaps import refused_writing
from fatigue.readers.neutral.body.modes import read_modes
from fatigue.reduce.folder import RECORD
from fatigue.reduce.tables import FORCES, MODES, OBSERVED_SHAPES, POINTS, SHAPES
from fatigue.study.car_body import car_body
from fatigue.study.reduced_body import coordinates_of_folder
from fatigue.study.variants.source.made import Asked, Made, SourceNumber
from fatigue.study.vehicle_file import FRAME
from fatigue.vehicle.definition import Car, Vehicle
from fatigue.vehicle.elastic import ElasticBody
from fatigue.vehicle.in_time.thinned import thinned
from fatigue.vehicle.run import Ride, ride
from fatigue.vehicle.run_numbers import run_numbers

Floats = NDArray[np.float64]

HISTORY = "history.parquet"
READ = (RECORD, MODES, POINTS, SHAPES, OBSERVED_SHAPES)  # of the folder of a body
ROLES = {"bog": "bogie", "conv": "equipment", "trafo": "equipment", "floor": "floor"}


class Bodies:
    """Car bodies of a study, each made once; threads may share it."""

    def __init__(self) -> None:
        self._known: dict[Car, ElasticBody] = {}
        self._lock = Lock()

    def of(self, vehicle: Vehicle) -> ElasticBody:
        """The car body of a vehicle.

        Raises
        ------
        DataError : as ``car_body``
        """
        with self._lock:
            if vehicle.car not in self._known:
                self._known[vehicle.car] = car_body(vehicle)
            return self._known[vehicle.car]


def ridden(
    vehicle: Vehicle, body: ElasticBody, rate_hz: float | None, asked: Asked, case: Case | None, folder: Path
) -> Made:
    """Let the vehicle ride and write the history of its events into a folder, with fewer samples if a rate is given.

    The numbers of the ride are those of all its samples.

    Raises
    ------
    CaseError, DataError, NumericalError : as ``ride`` and ``thinned``
    """
    vehicle = replace(vehicle, run=replace(vehicle.run, seed=asked.seed))
    of = ride(vehicle, body)
    numbers = tuple(SourceNumber(name, float(n.value), n.unit, n.reason) for name, n in run_numbers(of).items())
    of = of if rate_hz is None else thinned(of, rate_hz)
    path = folder / HISTORY
    columns = {"time_s": of.time_s} | coordinates_of(of, vehicle) | dict(of.channels)
    with refused_writing(path):
        pq.write_table(
            pa.table(columns),
            path,
            compression="zstd",
            use_dictionary=False,
            column_encoding=dict.fromkeys(columns, "BYTE_STREAM_SPLIT"),
        )
    if case is None:
        return Made({}, numbers=numbers)
    files = {event: dict.fromkeys(names[:1], path) for event, names in asked.files.items()}
    return Made(files, dict(added(vehicle, tuple(of.channels), case, tuple(asked.files))), numbers)


def added(
    vehicle: Vehicle, channels: tuple[str, ...], case: Case, names: tuple[str, ...]
) -> Iterator[tuple[str, Mapping[str, Any]]]:
    """What a ride sets for its events: speed and channels; the length follows from speed and duration."""
    tables = [channel_table(name) for name in channels]
    for event in case.mission.event:
        if event.name in names:
            way = {} if event.share is None else {"speed_km_h": vehicle.run.speed_km_h, "length_km": None}
            yield event.name, {**way, "channel": tables}


def channel_table(name: str) -> dict[str, str]:
    """Channel of a case for an output of the ride, which is a column of its history.

    >>> channel_table("floor_mid_z")["role"], channel_table("bog_y")["place"]
    ('floor', 'bog')
    """
    place, _, direction = name.rpartition("_")
    role = ROLES.get(place.split("_", maxsplit=1)[0], "other")
    return {"name": name, "column": name, "unit": "m/s2", "role": role, "direction": direction, "place": place}


def coordinates_of(of: Ride, vehicle: Vehicle) -> dict[str, Floats]:
    """Columns of the modal coordinates (n,) in the units of the case, mm, t, s; none of the frame: it has no case."""
    if vehicle.car.body == FRAME:
        return {}
    modes, _ = read_modes(Path(vehicle.car.body) / MODES, (), strict=False)
    return {f"q_{mode}": coordinates_of_folder(q) for mode, q in zip(modes.mode, of.q, strict=True)}


def body_inputs(vehicle: Vehicle) -> list[Path]:
    """Files that the car body of a vehicle is read from; none of the frame."""
    folder = Path(vehicle.car.body)
    return [] if vehicle.car.body == FRAME else [folder / name for name in READ if (folder / name).is_file()]


def body_problems(vehicle: Vehicle, case: Case, where: str) -> Iterator[Problem]:
    """Refusals of a case whose modes are not those of the car body: their numbers may agree, and nothing else would."""
    if vehicle.car.body == FRAME:
        what = "the car body is the built-in frame, which has no welds, and there is a case"
        remedy = "Give [car] body a folder of `fatigue reduce`, or leave out base.case"
        yield Problem("contradiction", where, what, remedy)
        return
    folder = Path(vehicle.car.body)
    for key, name in (("modes", MODES), ("nodal_forces", FORCES)):
        given = getattr(case.body, key)
        path = None if given is None else case.resolve(given)
        if path is not None and path.is_file() and (folder / name).is_file() and sha256(path) != sha256(folder / name):
            what = f"body.{key} of {case.path.name} is {path}, and the vehicle rides on the body in {folder}"
            remedy = f"Name {folder / name}; where the body varies, vary 'case' with it in one [[vary]] with set"
            yield Problem("other_body", where, what, remedy)
