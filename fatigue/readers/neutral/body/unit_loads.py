"""The unit loads whose forces one file holds, as the rows of the file name them."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.readers.neutral.body.modes import Modes


@dataclass(frozen=True, slots=True, eq=False)
class UnitLoads:
    """Some unit loads by name, in ascending order of their numbers among the coordinates of the body.

    They stand where forces of ``Modes`` may stand: ``mode`` are their numbers, ``scale`` is 1.
    """

    names: tuple[str, ...]
    mode: NDArray[np.int64]

    @property
    def scale(self) -> NDArray[np.float64]:
        """(u,) factor on the forces: the unit of a load is that of its values."""
        return np.ones(len(self.names))


def key_column(axis: Modes | UnitLoads) -> str:
    """Column that says what a row of forces belongs to."""
    return "unit_load" if isinstance(axis, UnitLoads) else "mode"


def key_name(axis: Modes | UnitLoads, number: int) -> str:
    """Name of the mode or unit load of a number, for messages.

    >>> key_name(UnitLoads(("gravity",), np.array([8])), 8)
    'unit_load gravity'
    """
    if not isinstance(axis, UnitLoads):
        return f"mode {number}"
    at = np.flatnonzero(axis.mode == number)
    return f"unit_load {axis.names[at[0]]}" if at.size else f"unit_load {number}"
