"""The number of each row of a table of forces: the id of its mode, or that of the unit load it names."""

import difflib
from collections.abc import Collection

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import Problem
from fatigue.readers.neutral.body.modes import Modes
from fatigue.readers.neutral.body.unit_loads import UnitLoads
from fatigue.readers.neutral.tables import Table
from fatigue.shown import few


def row_numbers(
    table: Table, axis: Modes | UnitLoads, ignore_modes: Collection[int]
) -> tuple[NDArray[np.int64], Collection[int]]:
    """Numbers of all rows, (r,), and those of rows that are skipped.

    A unit load without any row is noted as a mistake. One that is not asked for here is a warning: its rows are
    skipped under numbers behind all others.
    """
    if not isinstance(axis, UnitLoads):
        return table.integers("mode"), ignore_modes
    names, code = table.groups("unit_load")
    number_of = dict(zip(axis.names, axis.mode.tolist(), strict=True))
    others = [name for name in names if name and name not in number_of]
    behind = int(axis.mode.max()) + 1
    number_of |= {name: behind + i for i, name in enumerate(others)}
    for name in axis.names if names else ():
        if name not in names and "unit_load" not in table.spoilt:
            near = difflib.get_close_matches(name, others, n=1)
            remedy = f"Write {near[0]!r}, there or here" if near else f"Add its rows; the file has {few(list(names))}"
            what = f"the unit load '{name}' has no forces"
            table.problems.append(Problem("missing_id", table.where("unit_load"), what, remedy))
    if others and not table.problems:
        told = few([f"'{name}'" for name in others])
        what = f"rows of {told} are not used"
        remedy = "Define a [[body.unit_load]] with this file, unless the load is left out on purpose"
        table.warnings.append(Problem("unused_forces", table.where("unit_load"), what, remedy, len(others)))
    numbers = np.array([number_of.get(name, behind) for name in names], dtype=np.int64)
    return numbers[code], range(behind, behind + len(others))
