"""A static solution at loaded points, in the neutral format: what the modes alone are held against."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fatigue.errors import Problem
from fatigue.readers.neutral.body.interface_shapes import DIRECTIONS
from fatigue.readers.neutral.tables import open_table


@dataclass(frozen=True, slots=True)
class StaticFlexibility:
    """Flexibility of a direction at a point under a unit load of its own.

    ``value`` is in mm/N of a displacement under a force, in 1/(N mm) of a rotation under a moment.
    """

    point: str
    direction: str
    value: float


def read_flexibility(path: Path, *, strict: bool) -> tuple[tuple[StaticFlexibility, ...], list[Problem]]:
    """Read ``point, direction, value_mm_per_N``, in the file's order.

    Raises
    ------
    DataError : an unknown direction, a value not above 0, a direction of a point given twice
    """
    table = open_table(path, texts=("point", "direction"))
    table.expect(("point", "direction", "value_mm_per_N"), (), strict=strict)
    points, point = table.groups("point")
    direction = table.texts("direction")
    table.choices("direction", direction, DIRECTIONS)
    value = table.numbers("value_mm_per_N", above=0.0)
    place = np.array([DIRECTIONS.index(one) if one in DIRECTIONS else 0 for one in direction], np.int64)
    table.unique({"point": point, "direction": place}, {"point": points, "direction": DIRECTIONS})
    table.refuse()
    return tuple(
        StaticFlexibility(points[p], one, float(v)) for p, one, v in zip(point, direction, value, strict=True)
    ), table.warnings
