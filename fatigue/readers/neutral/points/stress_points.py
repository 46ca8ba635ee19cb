"""Points beside welds and in parent metal in the neutral format: place, frame, plate and curves of each."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import Problem
from fatigue.readers.neutral.tables import Table, open_table
from fatigue.weld.beside.hot_spot import EDGE, FACE

NOMINAL, PARENT, HAZ = "nominal", "parent", "haz"
CHECK_OF = {FACE: "hot_spot", EDGE: "hot_spot", NOMINAL: "nominal", PARENT: "parent", HAZ: "parent"}
"""What a point of each kind is checked for, and what its curve has to be for."""

KINDS = tuple(CHECK_OF)
AT_TOE = (FACE, EDGE, NOMINAL)
PLANES = ("normal", "planes_60")
XYZ, E1, NORMAL = ("x_mm", "y_mm", "z_mm"), ("e1_x", "e1_y", "e1_z"), ("normal_x", "normal_y", "normal_z")
REQUIRED = ("point", "kind", *XYZ, "thickness_mm", *E1, *NORMAL, "curve")
OPTIONAL = ("weld", "curve_shear", "planes")
ALONG_NORMAL = np.sin(np.deg2rad(10.0))  # e1 this near to the normal says little of a direction in the plate


@dataclass(frozen=True, slots=True, eq=False)
class StressPoints:
    """The p stress points of a body in the order of their file; texts are tuples (p,), arrays (p,) unless said.

    Attributes
    ----------
    file : their file
    name : name of each
    kind : one of ``KINDS``
    weld : the weld it belongs to, under the name it is assessed by; empty: none
    xyz : (p, 3) place [mm]
    thickness : of the plate [mm]
    e1, normal : (p, 3) unit vectors: direction x of the stress in the plate, and the normal on the top side
    curve, curve_shear : S-N curves; ``curve_shear`` is empty where shear is not counted
    planes : ``normal`` or ``planes_60``: which planes are counted at a toe; elsewhere ``planes_60``, without a meaning
    """

    file: str
    name: tuple[str, ...]
    kind: tuple[str, ...]
    weld: tuple[str, ...]
    xyz: NDArray[np.float64]
    thickness: NDArray[np.float64]
    e1: NDArray[np.float64]
    normal: NDArray[np.float64]
    curve: tuple[str, ...]
    curve_shear: tuple[str, ...]
    planes: tuple[str, ...]

    def __len__(self) -> int:
        """Count the points."""
        return len(self.name)


def read_stress_points(
    path: Path, welds: Mapping[str, str], curves: Collection[str], *, strict: bool
) -> tuple[StressPoints, list[Problem]]:
    """Read the table of stress points.

    ``welds`` are the names a weld may have here, each with the name it is assessed by; ``curves`` those of all curves.

    Raises
    ------
    DataError
        a frame that is none, an unknown kind, weld or curve, a point twice, a shear curve on an edge, a missing value
    """
    table = open_table(path, texts=("point", "kind", "weld", "curve", "curve_shear", "planes"))
    table.expect(REQUIRED, OPTIONAL, strict=strict)
    names, code = table.groups("point")
    table.unique({"point": code}, {"point": names})
    kind = table.texts("kind")
    table.choices("kind", kind, KINDS)
    weld, of_weld = table.groups("weld", default="")
    table.known("weld", weld, of_weld, {"", *welds}, "the welds")
    curve, of_curve = table.groups("curve")
    shear, of_shear = table.groups("curve_shear", default="")
    table.known("curve", curve, of_curve, curves, "the curves")
    table.known("curve_shear", shear, of_shear, {"", *curves}, "the curves")
    planes = table.texts("planes", default="planes_60")
    table.choices("planes", planes, PLANES)
    curve_shear = tuple(shear[i] for i in of_shear)
    on_edge = np.array([one == EDGE and bool(other) for one, other in zip(kind, curve_shear, strict=True)])
    what = f"shear is counted nowhere on the edge of a plate, kind {EDGE}"
    table.report(on_edge, "shear_on_edge", "curve_shear", what, "Leave it empty")
    xyz = _vectors(table, XYZ)
    thickness = table.numbers("thickness_mm", above=0.0).astype(np.float64)
    e1, normal = _frames(table)
    table.refuse()
    points = StressPoints(
        file=path.name,
        name=tuple(names[i] for i in code),
        kind=tuple(kind),
        weld=tuple(welds[weld[i]] if weld[i] else "" for i in of_weld),
        xyz=xyz,
        thickness=thickness,
        e1=e1,
        normal=normal,
        curve=tuple(curve[i] for i in of_curve),
        curve_shear=curve_shear,
        planes=tuple(planes),
    )
    return points, table.warnings


def _frames(table: Table) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """In-plane part of e1 and normal as unit vectors, each (p, 3); what makes no frame is noted."""
    e1, normal = _vectors(table, E1), _vectors(table, NORMAL)
    for names, vectors in ((E1, e1), (NORMAL, normal)):
        column, what = names[0].removesuffix("_x"), "the vector is zero"
        table.report(np.asarray(~vectors.any(axis=1)), "zero_vector", names[0], what, f"Give the direction {column}")
    e1, normal = _unit(e1), _unit(normal)
    across = np.linalg.norm(np.cross(normal, e1), axis=1)
    zero = ~e1.any(axis=1) | ~normal.any(axis=1)
    what = "e1 is along the normal (within 10 deg), so that it tells no direction in the plate"
    remedy = "Give e1 in the plate: across the weld, or in parent metal any direction"
    table.report(~zero & (across < ALONG_NORMAL), "frame", "e1_x", what, remedy)
    in_plane = e1 - (e1 * normal).sum(axis=1, keepdims=True) * normal
    return _unit(in_plane), normal


def _vectors(table: Table, names: tuple[str, ...]) -> NDArray[np.float64]:
    return np.column_stack([table.numbers(name) for name in names]).astype(np.float64)


def _unit(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    """Vectors of length 1, a zero as it is; lengths near the limits of double precision do no harm."""
    largest = np.abs(np.nan_to_num(vectors, posinf=0.0, neginf=0.0)).max(axis=1, keepdims=True)
    scaled = np.divide(vectors, largest, out=np.zeros_like(vectors), where=largest > 0.0)
    length = np.linalg.norm(scaled, axis=1, keepdims=True)
    return np.asarray(np.divide(scaled, length, out=np.zeros_like(scaled), where=length > 0.0))
