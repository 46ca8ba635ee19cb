"""Mode shapes at the points where forces enter the body, in the neutral format."""

from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import Problem
from fatigue.readers.neutral.body.modes import Modes
from fatigue.readers.neutral.tables import open_table
from fatigue.shown import few

DIRECTIONS = ("x", "y", "z", "rx", "ry", "rz")


@dataclass(frozen=True, slots=True, eq=False)
class InterfaceShapes:
    """Shapes of the m modes of a body at loaded points.

    Attributes
    ----------
    point, direction : (d,) the directions the file has, point after point
    value : (d, m) displacement [mm] along x, y, z or rotation [rad] about them per unit modal coordinate; NaN where the
        file has none
    """

    point: tuple[str, ...]
    direction: tuple[str, ...]
    value: NDArray[np.float64]

    def row(self, point: str, direction: str) -> NDArray[np.float64] | None:
        """Shapes (m,) of one direction; None where the file does not have it."""
        for i, key in enumerate(zip(self.point, self.direction, strict=True)):
            if key == (point, direction):
                return np.asarray(self.value[i])
        return None

    @property
    def points(self) -> tuple[str, ...]:
        """Names of the points."""
        return tuple(dict.fromkeys(self.point))


def read_interface_shapes(
    path: Path, modes: Modes, ignore_modes: Collection[int], *, strict: bool
) -> tuple[InterfaceShapes, list[Problem]]:
    """Read ``point, direction, mode, value``; rows of ignored modes are skipped.

    The shapes go with the modal masses of the table of modes: a mode that the simulation normalises otherwise keeps
    the shape and the mass of the FE run.

    Raises
    ------
    DataError : an unknown direction or mode, a value given twice or missing
    """
    table = open_table(path, texts=("point", "direction"))
    table.expect(("point", "direction", "mode", "value"), (), strict=strict)
    points, point = table.groups("point")
    direction = table.texts("direction")
    table.choices("direction", direction, DIRECTIONS)
    mode, value = table.integers("mode"), table.numbers("value").astype(np.float64)
    place = np.array([DIRECTIONS.index(one) if one in DIRECTIONS else 0 for one in direction], np.int64)
    table.unique({"point": point, "direction": place, "mode": mode}, {"point": points, "direction": DIRECTIONS})
    known = set(modes.mode.tolist())
    unknown = sorted(set(mode.tolist()) - known - set(ignore_modes))
    if unknown:
        row = int(np.isin(mode, unknown).argmax())
        what = f"modes {few(unknown)} are not in the table of modes"
        remedy = "Add them there, or list them under ignore_modes"
        table.problems.append(Problem("unknown_id", table.where("mode", row), what, remedy))
    table.refuse()
    keys = sorted(set(zip(point.tolist(), place.tolist(), strict=True)))
    values = np.full((len(keys), len(modes.mode)), np.nan)
    used = np.flatnonzero(np.isin(mode, modes.mode))
    row_of = {key: i for i, key in enumerate(keys)}
    rows = [row_of[key] for key in zip(point[used].tolist(), place[used].tolist(), strict=True)]
    values[rows, np.searchsorted(modes.mode, mode[used])] = value[used]
    shapes = InterfaceShapes(tuple(points[p] for p, _ in keys), tuple(DIRECTIONS[k] for _, k in keys), values)
    return shapes, table.warnings
