"""Participation factors of the modes in the neutral format: what each carries of a rigid motion of the boundary."""

from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import Problem
from fatigue.readers.neutral.body.modes import Modes
from fatigue.readers.neutral.tables import Table, open_table

COLUMNS = ("l_x", "l_y", "l_z", "l_rx", "l_ry", "l_rz")


@dataclass(frozen=True, slots=True, eq=False)
class Participation:
    """Participation factors of those modes that have a row, in the order of their ids.

    Attributes
    ----------
    mode : (p,) mode id
    factor : (p, 6) along x, y, z [t] and about them through the centre of mass [t mm]; NaN where not given
    """

    mode: NDArray[np.int64]
    factor: NDArray[np.float64]


def read_participation(
    path: Path, modes: Modes, ignore_modes: Collection[int], *, strict: bool
) -> tuple[Participation, list[Problem]]:
    """Read ``mode`` and, where present, ``l_x, l_y, l_z`` [t] and ``l_rx, l_ry, l_rz`` [t mm].

    Raises
    ------
    DataError : none of the factors is there, a mode twice, a mode that is not in the modes, no finite number
    """
    table = open_table(path)
    table.expect(("mode",), COLUMNS, strict=strict)
    if not any(name in table.position for name in COLUMNS):
        what = f"none of {', '.join(COLUMNS)} is there"
        table.problems.append(Problem("missing_column", path.name, what, "Give the factors of one direction or more"))
    mode = table.integers("mode")
    factor = np.column_stack([table.numbers(name, default=np.nan).astype(np.float64) for name in COLUMNS])
    table.unique({"mode": mode})
    refuse_unknown_modes(table, mode, modes, ignore_modes)
    table.refuse()
    order = np.argsort(mode)
    used = order[np.isin(mode[order], modes.mode)]
    return Participation(mode[used], factor[used]), table.warnings


def refuse_unknown_modes(table: Table, mode: NDArray[np.int64], modes: Modes, ignore_modes: Collection[int]) -> None:
    """Note the first mode of a table that is neither used nor ignored."""
    known = np.concatenate([modes.mode, np.array(sorted(ignore_modes), dtype=np.int64)])
    unknown = ~np.isin(mode, known)
    what = f"mode {mode[int(unknown.argmax())]} is not in the modes"
    table.report(unknown, "unknown_id", "mode", what, "Add it to the modes, or list it under ignore_modes")
