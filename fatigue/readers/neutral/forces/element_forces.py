"""Modal element nodal forces in the neutral format, and the elements on the assessed side of each weld."""

from collections.abc import Collection, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import Problem
from fatigue.readers.neutral.body.modes import Modes
from fatigue.readers.neutral.body.unit_loads import UnitLoads, key_column
from fatigue.readers.neutral.body.welds import Weld
from fatigue.readers.neutral.forces.convention import COMPONENTS, Convention, on_element, on_element_factor
from fatigue.readers.neutral.forces.load_names import row_numbers
from fatigue.readers.neutral.forces.mistakes import note_unknown_modes
from fatigue.readers.neutral.forces.placement import positions
from fatigue.readers.neutral.tables import open_table
from fatigue.weld.element_forces import ElementForces


def read_element_forces(
    path: Path, modes: Modes | UnitLoads, convention: Convention, ignore_modes: Collection[int], *, strict: bool
) -> tuple[ElementForces, list[Problem]]:
    """Read ``mode, node, element, fx_N ... mz_Nmm``, one row per element corner, as forces on the element.

    Of unit loads the column is ``unit_load`` in place of ``mode``; rows of loads that are not asked for are skipped.

    Raises
    ------
    DataError
        a row given twice, an unknown mode, a value that is no finite number
    """
    table = open_table(path, texts=("unit_load",))
    table.expect((key_column(modes), "node", "element", *COMPONENTS), (), strict=strict)
    mode, ignore_modes = row_numbers(table, modes, ignore_modes)
    node, element = table.integers("node"), table.integers("element")
    column = positions(modes.mode, mode)
    note_unknown_modes(table, mode, column, ignore_modes)
    table.unique({"mode": mode, "node": node, "element": element})
    force = np.column_stack([table.numbers(name) for name in COMPONENTS])
    table.refuse()
    used = column >= 0
    factor = on_element_factor(modes, convention)[column[used], np.newaxis]
    return ElementForces(mode[used], node[used], element[used], on_element(force[used], factor)), table.warnings


def read_weld_elements(
    path: Path, welds: Sequence[Weld], *, strict: bool, needed: Collection[str] | None = None
) -> tuple[dict[str, NDArray[np.int64]], list[Problem]]:
    """Read ``weld, element``: the elements of the assessed side of each weld, ascending.

    ``needed`` are the names of the welds that must have some, by default all.

    Raises
    ------
    DataError
        a needed weld without elements, an unknown weld, an element named twice
    """
    table = open_table(path, texts=("weld",))
    table.expect(("weld", "element"), ("shares_edge",), strict=strict)  # by an edge, or by a corner of the line
    names, code = table.groups("weld")
    element = table.integers("element")
    table.known("weld", names, code, {weld.name for weld in welds}, "the welds")
    table.unique({"weld": code, "element": element}, {"weld": names})
    wanted = [weld.name for weld in welds if needed is None or weld.name in needed]
    table.complete("weld", names, wanted, "elements")
    table.refuse()
    return {name: np.sort(element[code == i]) for i, name in enumerate(names)}, table.warnings
