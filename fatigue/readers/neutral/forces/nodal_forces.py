"""Modal nodal forces in the neutral format, as on_element forces per unit modal coordinate of the simulation."""

from collections.abc import Collection
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import Problem
from fatigue.readers.neutral.body.modes import Modes
from fatigue.readers.neutral.body.unit_loads import UnitLoads, key_column
from fatigue.readers.neutral.forces.convention import COMPONENTS, Convention, on_element, on_element_factor
from fatigue.readers.neutral.forces.load_names import row_numbers
from fatigue.readers.neutral.forces.mistakes import refuse_misplaced
from fatigue.readers.neutral.forces.placement import Grid, RowKeys, Slots, grid, slots
from fatigue.readers.neutral.tables import Table, open_table
from fatigue.weld.line import LineStack


def open_nodal_forces(path: Path) -> Table:
    """Open a table of nodal forces of modes or unit loads."""
    return open_table(path, texts=("weld", "unit_load"))


def read_nodal_forces(
    table: Table,
    lines: LineStack,
    modes: Modes | UnitLoads,
    convention: Convention,
    ignore_modes: Collection[int],
    *,
    strict: bool,
) -> tuple[NDArray[Any], list[Problem]]:
    """Read ``weld, node, mode, fx_N ... mz_Nmm``: the forces on the elements of all lines, (n, m, 6) [N, N mm].

    Of unit loads the column is ``unit_load`` in place of ``mode``; rows of loads that are not asked for are skipped.
    ``table`` is a whole file, or the rows of the lines' welds in it. Nodes are in the order of the lines, modes in that
    of ``modes``; float32 where the file has float32. Rows of ignored modes and of nodes that are not on the weld's line
    are skipped.

    Raises
    ------
    DataError
        a (weld, node, mode) missing or given twice, an unknown weld or mode, a value that is no finite number
    """
    placed = _placed(table, lines, modes, ignore_modes, strict=strict)
    dtype = np.float32 if table.single_precision(COMPONENTS) else np.float64
    force = np.empty((lines.node.size, modes.mode.size, 6), dtype)
    for axis, name in enumerate(COMPONENTS):
        force[..., axis] = placed.by_station(table.numbers(name))
    table.refuse()
    return on_element(force, on_element_factor(modes, convention)[:, np.newaxis]), table.warnings


def check_nodal_forces(
    table: Table, lines: LineStack, modes: Modes | UnitLoads, ignore_modes: Collection[int], *, strict: bool
) -> None:
    """Refuse what ``read_nodal_forces`` refuses, in the same words, and keep nothing."""
    _placed(table, lines, modes, ignore_modes, strict=strict)
    for name in COMPONENTS:
        table.numbers(name)
    table.refuse()


def _placed(
    table: Table, lines: LineStack, modes: Modes | UnitLoads, ignore_modes: Collection[int], *, strict: bool
) -> Grid | Slots:
    """Place of every row; a table is refused unless every (station, mode) has exactly one."""
    table.expect(("weld", "node", key_column(modes), *COMPONENTS), (), strict=strict)
    mode, ignore_modes = row_numbers(table, modes, ignore_modes)
    keys = RowKeys(*table.groups("weld"), table.integers("node"), mode)
    regular = None if table.problems else grid(keys, lines, modes, ignore_modes)
    if regular is not None:
        return regular
    looked_up = slots(keys, lines, modes)
    refuse_misplaced(table, keys, looked_up, lines, modes, ignore_modes)
    return looked_up
