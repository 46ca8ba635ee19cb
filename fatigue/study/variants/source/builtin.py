"""A ride of the vehicle as a source: modal coordinates as the case has them, channels, and numbers of the ride."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import NDArray

from fatigue.case import Case
from fatigue.files.mishaps import refused_writing
from fatigue.study.variants.hashes import files_below
from fatigue.study.variants.source.made import Asked, Made, SourceNumber
from fatigue.study.vehicle_file import FRAME
from fatigue.vehicle.definition import Vehicle
from fatigue.vehicle.elastic import ElasticBody
from fatigue.vehicle.frame_body import frame_body
from fatigue.vehicle.run import Ride, ride
from fatigue.vehicle.run_numbers import run_numbers

Floats = NDArray[np.float64]

HISTORY = "history.parquet"
ROLES = {"bog": "bogie", "conv": "equipment", "trafo": "equipment", "floor": "floor"}


def ridden(vehicle: Vehicle, asked: Asked, case: Case | None, folder: Path) -> Made:
    """Let the vehicle ride and write the history of its events into a folder.

    Raises
    ------
    CaseError, DataError, NumericalError : as ``ride``; a case with the modes of another body
    """
    vehicle = replace(vehicle, run=replace(vehicle.run, seed=asked.seed))
    of = ride(vehicle, body_of(vehicle))
    numbers = tuple(SourceNumber(name, float(n.value), n.unit, n.reason) for name, n in run_numbers(of).items())
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
    """Columns of the modal coordinates (n,) in the units of the case, mm, t and s; none of the frame: it has no case.

    A mode of unit modal mass has sqrt(1000) times the coordinate where its mass is 1 t and lengths are in mm.
    """
    if is_frame(vehicle):
        return {}
    raise NotImplementedError


def body_of(vehicle: Vehicle) -> ElasticBody:
    """Car body of a vehicle."""
    return frame_body(vehicle.car)


def body_inputs(vehicle: Vehicle) -> list[Path]:
    """Files that the car body of a vehicle is read from; none of the frame."""
    return [] if is_frame(vehicle) else files_below(Path(vehicle.car.body))


def is_frame(vehicle: Vehicle) -> bool:
    """Whether the car body is the built-in frame, which has no welds."""
    return vehicle.car.body == FRAME
