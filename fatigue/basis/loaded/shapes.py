"""What a case says of its modes at loaded points: shapes, ready for flexibility, and a static solution."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import Problem
from fatigue.pipeline.solve.body import Body
from fatigue.readers.neutral.body.interface_shapes import InterfaceShapes, read_interface_shapes
from fatigue.readers.neutral.body.modes import LOWEST_HZ, Modes
from fatigue.readers.neutral.body.static_flexibility import StaticFlexibility, read_flexibility
from fatigue.shown import few

Floats = NDArray[np.float64]
Key = tuple[str, str]  # point and direction

NO_SHAPES = (
    "the case gives no shapes of the modes at loaded points ([body] interface_shapes: point, direction, mode, value)"
)
NO_STATIC = "the case gives no static solution at loaded points ([body] flexibility: point, direction, value_mm_per_N)"


@dataclass(frozen=True, slots=True, eq=False)
class Loaded:
    """Loaded points of a case.

    ``shapes`` are None and ``static`` empty where the case does not give them; ``static_file`` is the name of the file
    of the latter; ``warnings`` are about both files.
    """

    modes: Modes
    shapes: InterfaceShapes | None
    static: tuple[StaticFlexibility, ...] = ()
    static_file: str = ""
    warnings: tuple[Problem, ...] = ()

    @property
    def keys(self) -> list[Key]:
        """Points and directions that either file has, those with shapes first."""
        shaped = [] if self.shapes is None else list(zip(self.shapes.point, self.shapes.direction, strict=True))
        return list(dict.fromkeys([*shaped, *((one.point, one.direction) for one in self.static)]))

    def static_of(self, key: Key) -> float:
        """The static solution of a direction; NaN where there is none."""
        return next((one.value for one in self.static if (one.point, one.direction) == key), np.nan)

    def shape(self, key: Key) -> Floats | None:
        """Shapes of the elastic modes (e,) in a direction; None where the file does not have it."""
        row = None if self.shapes is None else self.shapes.row(*key)
        return None if row is None else row[self.elastic]

    @property
    def elastic(self) -> NDArray[np.bool_]:
        """(m,) modes that deform the body."""
        return elastic(self.modes)

    @property
    def of_interface(self) -> NDArray[np.bool_]:
        """(e,) which of the elastic modes are interface modes."""
        return np.asarray(np.array(self.modes.kind)[self.elastic] == "interface")

    def missing(self, shape: Floats) -> str:
        """Elastic modes without a shape, in words; empty where all have one."""
        absent = self.modes.mode[self.elastic][np.isnan(shape)]
        return f"no shape of the modes {few(absent.tolist())}" if absent.size else ""


def loaded_points(body: Body) -> Loaded:
    """Shapes and static solution that a case gives.

    Raises
    ------
    DataError : with every mistake found in the file at fault
    """
    case, files = body.case, body.case.body
    shapes: InterfaceShapes | None = None
    static: tuple[StaticFlexibility, ...] = ()
    warnings: list[Problem] = []
    if files.interface_shapes is not None:
        path = case.resolve(files.interface_shapes)
        shapes, found = read_interface_shapes(path, body.modes, files.ignore_modes, strict=body.strict)
        warnings += found
    if files.flexibility is not None:
        static, found = read_flexibility(case.resolve(files.flexibility), strict=body.strict)
        warnings += found
    return Loaded(body.modes, shapes, static, files.flexibility or "", tuple(warnings))


def elastic(modes: Modes) -> NDArray[np.bool_]:
    """Modes (m,) that deform the body: rigid ones, and those at no frequency, do not."""
    return np.asarray((np.array(modes.kind) != "rigid") & (modes.frequency > LOWEST_HZ))


def unit_of(direction: str) -> str:
    """Unit of a flexibility in this direction."""
    return "1/(N mm)" if direction.startswith("r") else "mm/N"


def told(keys: Sequence[Key]) -> str:
    """Points and directions in words."""
    return few([f"{point} {direction}" for point, direction in keys])
