"""The car body of a vehicle from a folder of ``fatigue reduce``: mm, t, s become SI.

One displacement, energy and force in both unit systems decide the factors. Modal mass is 1 t in the folder and 1 kg in
SI, and with ``u_mm = 1000 u_m`` the energy ``q'^2/2`` in N mm is ``1000 p'^2/2`` of p in SI:

    q = sqrt(1000) p        displacement: psi = phi/sqrt(1000)        rotation: psi = phi sqrt(1000)
    force per unit p = force per unit q * sqrt(1000)
"""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem, refuse
from fatigue.files.hashes import sha256
from fatigue.readers.neutral.body.interface_shapes import DIRECTIONS, read_interface_shapes
from fatigue.readers.neutral.body.modes import Modes, read_modes
from fatigue.readers.neutral.tables import open_table
from fatigue.reduce.folder import FILLED, RECORD
from fatigue.reduce.tables import MODES, OBSERVED_SHAPES, POINTS, SHAPES
from fatigue.vehicle.elastic import ElasticBody, Point, default_damping
from fatigue.vehicle.equations.suspension import require_points

Floats = NDArray[np.float64]

COORDINATE = np.sqrt(1000.0)  # of the folder per unit SI coordinate


def reduced_body(folder: Path, floor_z_m: float) -> ElasticBody:
    """Car body of a folder that ``fatigue reduce`` wrote; its origin lies ``floor_z_m`` above rail top.

    Raises
    ------
    DataError : no such folder, tables changed since, or points that ``require_points`` refuses
    """
    record = _record(folder)
    modes, _ = read_modes(folder / MODES, (), strict=False)
    place = _places(folder / POINTS)
    shapes = _shapes(folder, modes)
    floor = np.array([0.0, 0.0, floor_z_m])
    points = {name: Point(place[name] + floor, shape) for name, shape in shapes.items()}
    given = modes.damping_ratio
    body = ElasticBody(
        mass=1e3 * float(record["mass_t"]),
        cg=1e-3 * np.array(record["cg_mm"], dtype=np.float64) + floor,
        inertia=1e-3 * np.array(record["inertia_t_mm2"], dtype=np.float64),
        frequency_hz=modes.frequency,
        damping_ratio=np.where(np.isnan(given), default_damping(modes.frequency), given),
        points=points,
    )
    require_points(body, str(folder))
    return body


def coordinates_of_folder(q_si: Floats) -> Floats:
    """Modal coordinates as the case of the folder wants them, of those of the vehicle [m sqrt(kg)]."""
    return np.asarray(COORDINATE * q_si)


def _record(folder: Path) -> Mapping[str, Any]:
    """Record of the reduction, of tables that are as they were written."""
    outputs = FILLED.outputs(folder)
    if outputs is None:
        what = f"there is no {RECORD} of fatigue reduce, so this is no reduced body"
        remedy = 'Give a folder that `fatigue reduce` wrote, or body = "frame"'
        raise DataError(Problem("no_reduced_body", str(folder), what, remedy))
    read = [name for name in (MODES, POINTS, SHAPES, OBSERVED_SHAPES) if name in outputs]
    what, remedy = "was changed since fatigue reduce wrote it", "Reduce the body again"
    gone = [name for name in read if not (folder / name).is_file()]
    changed = [name for name in read if name not in gone and sha256(folder / name) != outputs[name]]
    refuse(DataError, [Problem("missing_file", str(folder / name), "is not there any more", remedy) for name in gone])
    refuse(DataError, [Problem("changed", str(folder / name), what, remedy) for name in changed])
    record: Mapping[str, Any] = json.loads((folder / RECORD).read_text(encoding="utf-8"))
    return record


def _places(path: Path) -> dict[str, Floats]:
    """Place (3,) [m] of every point in the body's own frame."""
    table = open_table(path, texts=("point", "side", "components"))
    xyz = np.column_stack([table.numbers(f"{axis}_mm") for axis in "xyz"])
    return dict(zip(table.texts("point"), 1e-3 * xyz, strict=True))


def _shapes(folder: Path, modes: Modes) -> dict[str, Floats]:
    """Shapes (6, m) of every point in SI; NaN in directions that the folder does not have."""
    unit = np.array([1.0 / COORDINATE] * 3 + [COORDINATE] * 3)
    found: dict[str, Floats] = {}
    for path in (folder / SHAPES, folder / OBSERVED_SHAPES):
        if not path.is_file():
            continue
        shapes, _ = read_interface_shapes(path, modes, (), strict=False)
        for point, direction, value in zip(shapes.point, shapes.direction, shapes.value, strict=True):
            at = DIRECTIONS.index(direction)
            found.setdefault(point, np.full((6, len(modes.mode)), np.nan))[at] = unit[at] * value
    return found
