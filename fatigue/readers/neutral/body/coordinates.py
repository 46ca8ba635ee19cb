"""What the stress of a body is a sum over: its modes and, behind them, its unit loads."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.readers.neutral.body.modes import Modes


@dataclass(frozen=True, slots=True, eq=False)
class Coordinates:
    """The c = m + u coordinates of a body: m modes by id, then u unit loads by name as the case lists them.

    A unit load is one more coordinate everywhere. Where arrays want a number for it, that is the next one behind the
    largest id of a mode; no table shows it.
    """

    modes: Modes
    unit_loads: tuple[str, ...]

    def __len__(self) -> int:
        """Count the coordinates."""
        return len(self.modes.mode) + len(self.unit_loads)

    @property
    def number(self) -> NDArray[np.int64]:
        """(c,) ids of the modes, and numbers for the unit loads behind them."""
        first = int(self.modes.mode.max()) + 1
        return np.concatenate([self.modes.mode, np.arange(first, first + len(self.unit_loads))])

    def name(self, number: int) -> str:
        """Name of the coordinate of a number, for messages: ``mode 7`` or ``unit load gravity``."""
        at = int(np.flatnonzero(self.number == number)[0])
        return f"mode {number}" if self.is_mode[at] else f"unit load {self.unit_load[at]}"

    @property
    def column(self) -> list[str]:
        """(c,) names of columns in histories: ``q_<mode>`` and ``u_<name>``."""
        return [f"q_{mode}" for mode in self.modes.mode.tolist()] + [f"u_{name}" for name in self.unit_loads]

    @property
    def is_mode(self) -> NDArray[np.bool_]:
        """(c,) whether each is a mode."""
        return np.arange(len(self)) < len(self.modes.mode)

    @property
    def kind(self) -> tuple[str, ...]:
        """(c,) normal, interface, rigid or unit_load."""
        return (*self.modes.kind, *("unit_load" for _ in self.unit_loads))

    @property
    def unit_load(self) -> list[str]:
        """(c,) name of each unit load, empty for a mode: the column ``unit_load`` of result tables."""
        return [""] * len(self.modes.mode) + [*self.unit_loads]
