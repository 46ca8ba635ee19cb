"""What is wrong with the rows of a table of forces: unknown ids, nodes off the line, repeated and missing rows."""

from collections.abc import Collection
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import Problem
from fatigue.readers.neutral.body.modes import Modes
from fatigue.readers.neutral.body.unit_loads import UnitLoads, key_column, key_name
from fatigue.readers.neutral.forces.placement import RowKeys, Slots
from fatigue.readers.neutral.tables import Table
from fatigue.weld.line import LineStack, WeldLine


def refuse_misplaced(
    table: Table, keys: RowKeys, slots: Slots, lines: LineStack, modes: Modes | UnitLoads, ignore_modes: Collection[int]
) -> None:
    """Refuse a table unless every (station, mode) has exactly one row; rows of nodes off the lines are a warning.

    Raises
    ------
    DataError : an unknown weld or mode, a (weld, node, mode) missing or given twice
    """
    table.known("weld", keys.names, keys.weld, set(lines.weld), "the welds")
    note_unknown_modes(table, keys.mode, slots.mode, ignore_modes)
    table.refuse()
    if (stray := slots.station < 0).any():
        row = int(stray.argmax())
        what = f"node {keys.node[row]} is not on the line of weld {keys.names[keys.weld[row]]}; "
        what += f"{np.count_nonzero(stray)} rows of such nodes are not used"
        remedy = "Remove them, or add the nodes to the weld's line"
        table.warnings.append(Problem("extra_node", table.where("node", row), what, remedy))
    used = slots.slot >= 0
    filled = np.zeros(slots.shape, dtype=np.bool_)
    filled.reshape(-1)[slots.slot[used]] = True
    if np.count_nonzero(filled) < np.count_nonzero(used):
        _refuse_repeats(table, keys, modes)
    if not filled.all():
        for line, present in zip(lines, np.split(filled, lines.begin[1:-1]), strict=True):
            table.problems.extend(_gaps(table.path, line, modes, present))
    table.refuse()


def _refuse_repeats(table: Table, keys: RowKeys, modes: Modes | UnitLoads) -> None:
    """Note rows that repeat a (weld, node, mode)."""
    names, number = table.groups("unit_load") if isinstance(modes, UnitLoads) else ((), keys.mode)
    column = key_column(modes)
    labels = {"weld": keys.names} | ({column: names} if names else {})
    table.unique({"weld": keys.weld, "node": keys.node, column: number}, labels)


def note_unknown_modes(
    table: Table, mode: NDArray[np.int64], column: NDArray[np.int32], ignore_modes: Collection[int]
) -> None:
    """Note modes of rows that are neither used, ``column`` -1, nor ignored."""
    unknown = column < 0
    unknown[unknown] = ~np.isin(mode[unknown], list(ignore_modes))
    if unknown.any():
        ids = ", ".join(map(str, np.unique(mode[unknown])))
        what = f"modes {ids} are not in the table of modes"
        table.report(unknown, "unknown_id", "mode", what, "Add them there or to ignore_modes")


def _gaps(path: Path, line: WeldLine, modes: Modes | UnitLoads, present: NDArray[np.bool_]) -> list[Problem]:
    """Name the first node and mode of a line without forces; ``present`` is (n, m)."""
    if present.all():
        return []
    i, j = np.argwhere(~present)[0]
    missing = np.count_nonzero(~present)
    what, others = "mode", ", or list the mode under ignore_modes"
    if isinstance(modes, UnitLoads):
        what, others = "unit load", ""
    return [
        Problem(
            "missing_row",
            f"{path.name}: weld {line.weld}, node {line.node[i]}, {key_name(modes, int(modes.mode[j]))}",
            f"no forces are given ({missing} of the weld's {present.size} pairs of node and {what} are missing)",
            f"Write the forces of every node and {what}, zeros too" + others,
        )
    ]
