"""What is read off a vehicle: rows over its coordinates that give displacements at named points."""

import numpy as np
from numpy.typing import NDArray

from fatigue.vehicle.equations.coordinates import BOGIES, CONVERTER, TRANSFORMER
from fatigue.vehicle.equations.suspension import Places

Floats = NDArray[np.float64]

OBSERVED = {  # name of the output: point of the car body
    "floor_mid": "floor_mid",
    "floor_bog": "floor_front",
    "floor_rear": "floor_rear",
    "roof_mid": "roof_mid",
    "roof_base": "roof_base",
}
DIRECTIONS = {"y": 1, "z": 2}


def output_rows(of: Places) -> dict[str, Floats]:
    """Rows (n,) of displacements [m] along y and z, by name and direction: ``floor_mid_y``, ``conv_z`` ...

    ``floor_mid``, ``floor_bog``, ``floor_rear``, ``roof_mid``, ``roof_base`` of the car body where it has these points;
    ``conv`` and ``trafo``, the centres of gravity of converter and transformer; ``bog`` and ``bog_rear``, the bogie
    frames above the leading axle of the front and the last of the rear bogie, at the height of the frame.
    """
    points = {name: of.car(point) for name, point in OBSERVED.items() if point in of.body.points}
    for name in (CONVERTER, TRANSFORMER):
        points[name] = of.at.carried(name, of.equipment_cg(name), of.equipment_cg(name))
    for bogie, (name, axle) in enumerate((("bog", 0), ("bog_rear", 3))):
        above = np.array([of.wheelset_cg(axle)[0], 0.0, of.vehicle.bogie.z_m])
        points[name] = of.at.carried(BOGIES[bogie], of.bogie_cg(bogie), above)
    return {
        f"{name}_{letter}": motion[direction]
        for name, motion in points.items()
        for letter, direction in DIRECTIONS.items()
        if np.isfinite(motion[direction]).all()
    }


def recovered_rows(of: Places) -> dict[str, Floats]:
    """Rows (n,) of what the car body recovers from its modes, by name, in the unit of the body."""
    rows = {}
    for name, row in zip(of.body.recovered, [] if of.body.recover is None else of.body.recover, strict=True):
        rows[name] = np.zeros(of.at.size)
        rows[name][of.at.flex] = row
    return rows
