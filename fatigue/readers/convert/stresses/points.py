"""Stress points of the user, and the places where stress is read for each of them."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem, refuse
from fatigue.readers.convert.options import Density
from fatigue.readers.neutral.points.stress_points import E1, KINDS, NORMAL, OPTIONAL, XYZ
from fatigue.readers.neutral.tables import Table, open_table
from fatigue.weld.beside.hot_spot import FACE, sets_of

Vector = NDArray[np.float64]

OF_CHECKS = ("curve", *OPTIONAL)
"""Columns of the table that only the checks of stress points read."""
_MOST_PROBLEMS = 10


@dataclass(frozen=True, slots=True, eq=False)
class StressPoint:
    """One stress point: its place [mm], the direction e1 from the toe into the plate, the top normal of the plate.

    ``x`` is the part of e1 in the plane of the plate; both directions have the length 1.
    """

    name: str
    kind: str
    place: Vector
    thickness: float
    x: Vector
    normal: Vector
    row: int

    def distances(self, density: Density) -> tuple[float, ...]:
        """Distances of the read-outs along x [mm]; one of 0 where nothing is extrapolated."""
        sets = {one.name.split()[1]: one for one in sets_of(self.kind)}
        if not sets:
            return (0.0,)
        chosen = sets.get(density, sets["fine"])  # on edges no set is quadratic
        return tuple(d * (self.thickness if self.kind == FACE else 1.0) for d in chosen.distances)


def read_stress_points(path: Path) -> tuple[tuple[StressPoint, ...], list[Problem]]:
    """Read the table of stress points; and warnings.

    Columns: ``point, kind, x_mm, y_mm, z_mm, thickness_mm, e1_x|y|z, normal_x|y|z``, perhaps those of ``OF_CHECKS``.

    Raises
    ------
    DataError : anything missing or impossible, a point given twice, e1 along the normal
    """
    table = open_table(path, texts=("point", "kind", *OF_CHECKS))
    table.expect(("point", "kind", *XYZ, "thickness_mm", *E1, *NORMAL), OF_CHECKS, strict=False)
    names, code = table.groups("point")
    table.unique({"point": code}, {"point": names})
    kind = table.texts("kind")
    table.choices("kind", kind, KINDS)
    xyz, e1, normal = (_vectors(table, columns) for columns in (XYZ, E1, NORMAL))
    thickness = table.numbers("thickness_mm", above=0.0)
    table.refuse()
    refuse(DataError, list(_flat(table, e1, normal))[:_MOST_PROBLEMS])
    z = normal / np.linalg.norm(normal, axis=1)[:, None]
    x = e1 - np.sum(e1 * z, axis=1)[:, None] * z
    x /= np.linalg.norm(x, axis=1)[:, None]
    points = tuple(
        StressPoint(names[code[i]], kind[i], xyz[i], float(thickness[i]), x[i], z[i], i) for i in range(table.rows)
    )
    return points, table.warnings


def _vectors(table: Table, columns: tuple[str, ...]) -> NDArray[np.float64]:
    """Three columns as vectors, (r, 3)."""
    return np.stack([table.numbers(name).astype(np.float64) for name in columns], axis=1)


def _flat(table: Table, e1: NDArray[np.float64], normal: NDArray[np.float64]) -> Iterator[Problem]:
    """Mistakes of directions that span no frame."""
    across = np.linalg.norm(np.cross(normal, e1), axis=1)
    length = np.linalg.norm(normal, axis=1) * np.linalg.norm(e1, axis=1)
    for i in np.flatnonzero(~(across > 1e-3 * length)).tolist():
        where = f"{table.path.name}: {table.row_name(i)}"
        yield Problem("no_frame", where, "e1 is zero or along the normal", "Give e1 in the plane of the plate")
