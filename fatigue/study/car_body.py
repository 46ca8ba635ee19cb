"""The car body of a vehicle: the built-in frame, or a folder that ``fatigue reduce`` wrote."""

from pathlib import Path

from fatigue.study.reduced_body import reduced_body
from fatigue.study.vehicle_file import FRAME
from fatigue.vehicle.definition import Vehicle
from fatigue.vehicle.elastic import ElasticBody
from fatigue.vehicle.frame_body import frame_body


def car_body(vehicle: Vehicle) -> ElasticBody:
    """Car body of a vehicle, in SI units.

    Raises
    ------
    CaseError, DataError : the folder of the body is none, or was changed
    """
    if vehicle.car.body == FRAME:
        return frame_body(vehicle.car)
    return reduced_body(Path(vehicle.car.body), vehicle.car.floor_z_m)
