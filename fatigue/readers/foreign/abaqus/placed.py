"""Where an instance of a part stands: moved, then turned about an axis."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem


@dataclass(frozen=True, slots=True, eq=False)
class Placed:
    """A motion ``R (x + d - a) + a``: translation d, rotation matrix R about a point a of the axis."""

    move: NDArray[np.float64] = field(default_factory=lambda: np.zeros(3))
    turn: NDArray[np.float64] = field(default_factory=lambda: np.eye(3))
    about: NDArray[np.float64] = field(default_factory=lambda: np.zeros(3))

    @property
    def is_still(self) -> bool:
        """Whether every position stays where it is."""
        return not self.move.any() and bool((self.turn == np.eye(3)).all())

    def of(self, place: NDArray[np.float64]) -> NDArray[np.float64]:
        """Global position of a position in the part, (3,)."""
        return np.asarray(self.turn @ (place + self.move - self.about) + self.about)


def placed(rows: Sequence[Sequence[float]], where: str) -> Placed:
    """Motion of an instance from its data lines: three numbers, then two points of an axis and an angle [degrees].

    Raises
    ------
    DataError : other numbers of values, an axis without direction
    """
    if not rows:
        return Placed()
    move = np.array([*rows[0][:3], 0.0, 0.0, 0.0][:3])
    if len(rows) == 1:
        return Placed(move)
    if len(rows) > 2 or len(rows[1]) != 7:
        raise DataError(
            Problem("inp_damaged", where, "an instance has other data than a move and a turn", "Write it again")
        )
    a, b, angle = np.array(rows[1][:3]), np.array(rows[1][3:6]), np.radians(rows[1][6])
    axis = b - a
    size = float(np.linalg.norm(axis))
    if size == 0.0:
        raise DataError(Problem("inp_damaged", where, "the axis of an instance has no direction", "Write it again"))
    x, y, z = axis / size
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    turn = np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross  # Rodrigues
    return Placed(move, turn, a)
