"""Modal nodal forces in the neutral format, as on_element forces per unit modal coordinate of the simulation.

The sign convention of the file and the scale of each mode are applied here, once.
"""

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import Problem
from fatigue.readers.neutral.body import Modes, Weld
from fatigue.readers.neutral.tables import Table, open_table
from fatigue.weld.element_forces import ElementForces
from fatigue.weld.line import LineStack, WeldLine, line_of_node

Convention: TypeAlias = Literal["on_element", "on_node"]
COMPONENTS = ("fx_N", "fy_N", "fz_N", "mx_Nmm", "my_Nmm", "mz_Nmm")
BLOCK = 1 << 20  # rows whose stations are looked up at a time, so that a large file needs little memory beside it


def open_nodal_forces(path: Path) -> Table:
    """Open a table of modal nodal forces."""
    return open_table(path, texts=("weld",))


def read_nodal_forces(
    table: Table,
    lines: LineStack,
    modes: Modes,
    convention: Convention,
    ignore_modes: Collection[int],
    *,
    strict: bool,
) -> tuple[NDArray[Any], list[Problem]]:
    """Read ``weld, node, mode, fx_N ... mz_Nmm``: the forces on the elements of all lines, (n, m, 6) [N, N mm].

    ``table`` is a whole file, or the rows of the lines' welds in it. Nodes are in the order of the lines, modes in that
    of ``modes``; float32 where the file has float32. Rows of ignored modes and of nodes that are not on the weld's line
    are skipped.

    Raises
    ------
    DataError
        a (weld, node, mode) missing or given twice, an unknown weld or mode, a value that is no finite number
    """
    places = _places(table, lines, modes, ignore_modes, strict=strict)
    dtype = np.float32 if table.single_precision(COMPONENTS) else np.float64
    by_mode = np.empty((lines.node.size, modes.mode.size, 6), dtype)
    if isinstance(places, _Grid):
        for axis, name in enumerate(COMPONENTS):
            by_mode[..., axis] = places.by_station(table.numbers(name))
    else:
        force = by_mode.reshape(-1, 6)
        used = slice(None) if len(force) == table.rows else places >= 0
        for axis, name in enumerate(COMPONENTS):
            force[places[used], axis] = table.numbers(name)[used]
    table.refuse()
    factor = _factor(modes, convention)[:, np.newaxis]
    if not np.isin(factor, (-1.0, 1.0)).all():
        by_mode = by_mode.astype(np.float64)  # a product in single precision would cost the last digits
    by_mode *= factor.astype(by_mode.dtype)
    return by_mode, table.warnings


def check_nodal_forces(
    table: Table, lines: LineStack, modes: Modes, ignore_modes: Collection[int], *, strict: bool
) -> None:
    """Refuse what ``read_nodal_forces`` refuses, in the same words, and keep nothing."""
    _places(table, lines, modes, ignore_modes, strict=strict)
    for name in COMPONENTS:
        table.numbers(name)
    table.refuse()


def read_element_forces(
    path: Path, modes: Modes, convention: Convention, ignore_modes: Collection[int], *, strict: bool
) -> tuple[ElementForces, list[Problem]]:
    """Read ``mode, node, element, fx_N ... mz_Nmm``, one row per element corner, as forces on the element.

    Raises
    ------
    DataError
        a row given twice, an unknown mode, a value that is no finite number
    """
    table = open_table(path)
    table.expect(("mode", "node", "element", *COMPONENTS), (), strict=strict)
    mode, node, element = (table.integers(name) for name in ("mode", "node", "element"))
    column = _mode_columns(table, mode, modes, ignore_modes)
    table.unique({"mode": mode, "node": node, "element": element})
    force = np.column_stack([table.numbers(name) for name in COMPONENTS])
    table.refuse()
    used = column >= 0
    factor = _factor(modes, convention)[column[used], np.newaxis]
    exact = np.isin(factor, (-1.0, 1.0)).all()
    force = force[used] * (factor.astype(force.dtype) if exact else factor)
    return ElementForces(mode[used], node[used], element[used], force), table.warnings


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
    table.expect(("weld", "element"), (), strict=strict)
    names, code = table.groups("weld")
    element = table.integers("element")
    table.known("weld", names, code, {weld.name for weld in welds}, "the welds")
    table.unique({"weld": code, "element": element}, {"weld": names})
    wanted = [weld.name for weld in welds if needed is None or weld.name in needed]
    table.complete("weld", names, wanted, "elements")
    table.refuse()
    return {name: np.sort(element[code == i]) for i, name in enumerate(names)}, table.warnings


def _factor(modes: Modes, convention: Convention) -> NDArray[np.float64]:
    """Factor of each mode that turns the file's forces into on_element forces of the simulation's mode."""
    return modes.scale if convention == "on_element" else -modes.scale


@dataclass(frozen=True, slots=True, eq=False)
class _Keys:
    """What each row is about: ``names`` of welds, and (r,) each, which of them, node id and mode id."""

    names: tuple[str, ...]
    weld: NDArray[np.int32]
    node: NDArray[np.int64]
    mode: NDArray[np.int64]


def _keys(table: Table) -> _Keys:
    """Read the key columns; what is wrong with them is noted in the table."""
    return _Keys(*table.groups("weld"), table.integers("node"), table.integers("mode"))


@dataclass(frozen=True, slots=True, eq=False)
class _Grid:
    """Rows in the order most programs write: node by node all modes, or mode by mode all nodes.

    ``shape`` is that of the rows, nodes first if ``by_node``; ``station`` and ``mode`` are positions on its two axes
    where the stations of all lines and the modes used stand.
    """

    shape: tuple[int, int]
    by_node: bool
    station: NDArray[np.intp]
    mode: NDArray[np.intp]

    def by_station(self, values: NDArray[Any]) -> NDArray[Any]:
        """Values of all rows, as (n, m)."""
        grid = values.reshape(self.shape) if self.by_node else values.reshape(self.shape).T
        in_order = np.array_equal(self.station, np.arange(len(grid))) and np.array_equal(
            self.mode, np.arange(len(grid.T))
        )
        return grid if in_order else grid[np.ix_(self.station, self.mode)]


def _grid(keys: _Keys, lines: LineStack, modes: Modes, ignore_modes: Collection[int]) -> _Grid | None:
    """Recognise a complete regular table, which needs no search for every row; None if anything is unusual."""
    names, weld, node, mode = keys.names, keys.weld, keys.node, keys.mode
    if not set(lines.weld).issuperset(names):
        return None
    width = min(_run(node), _run(weld))
    by_node = width > 1
    width = width if by_node else _run(mode)
    if width == 0 or node.size % width:
        return None
    shape = (node.size // width, width)
    of_node, of_mode = (slice(None, None, width), slice(width)) if by_node else (slice(width), slice(None, None, width))
    for values, at in ((weld, of_node), (node, of_node), (mode, of_mode)):
        axis = (slice(None), np.newaxis) if at.step else (np.newaxis, slice(None))
        if np.any(values.reshape(shape) != values[at][axis]):
            return None
    station = stations_of(names, weld[of_node], node[of_node], lines)
    column = _positions(modes.mode, mode[of_mode])
    ignored = column < 0
    if not np.isin(mode[of_mode][ignored], list(ignore_modes)).all():
        return None
    for found, n in ((station, lines.node.size), (column[~ignored], modes.mode.size)):
        if not np.array_equal(np.sort(found), np.arange(n)):
            return None
    return _Grid(shape, by_node, np.argsort(station), np.argsort(column)[np.count_nonzero(ignored) :])


def _places(
    table: Table, lines: LineStack, modes: Modes, ignore_modes: Collection[int], *, strict: bool
) -> _Grid | NDArray[np.int64]:
    """Find out where the forces of each row belong: on a grid, or each at a slot of its own, as ``_slots`` says."""
    table.expect(("weld", "node", "mode", *COMPONENTS), (), strict=strict)
    keys = _keys(table)
    grid = None if table.problems else _grid(keys, lines, modes, ignore_modes)
    return _slots(table, keys, lines, modes, ignore_modes) if grid is None else grid


def _run(values: NDArray[Any]) -> int:
    """Count the equal values at the beginning."""
    other = values != values[:1]
    return int(other.argmax()) if other.any() else values.size


def _slots(
    table: Table, keys: _Keys, lines: LineStack, modes: Modes, ignore_modes: Collection[int]
) -> NDArray[np.int64]:
    """Position of each row among the (station, mode) of all lines (r,), -1 where it is not used.

    Every slot is filled by exactly one row, or the table is refused.
    """
    names, code, node, mode = keys.names, keys.weld, keys.node, keys.mode
    table.known("weld", names, code, set(lines.weld), "the welds")
    column = _mode_columns(table, mode, modes, ignore_modes)
    table.refuse()
    station = stations_of(names, code, node, lines)
    if (stray := station < 0).any():
        row = int(stray.argmax())
        what = f"node {node[row]} is not on the line of weld {names[code[row]]}; {np.count_nonzero(stray)} rows of "
        what += "such nodes are not used"
        remedy = "Remove them, or add the nodes to the weld's line"
        table.warnings.append(Problem("extra_node", table.where("node", row), what, remedy))
    slot = np.where(stray | (column < 0), -1, station.astype(np.int64) * modes.mode.size + column)
    filled = np.zeros((lines.node.size, modes.mode.size), dtype=np.bool_)
    filled.reshape(-1)[slot[slot >= 0]] = True
    if np.count_nonzero(filled) < np.count_nonzero(slot >= 0):
        table.unique({"weld": code, "node": node, "mode": mode}, {"weld": names})
    if not filled.all():
        for line, present in zip(lines, np.split(filled, lines.begin[1:-1]), strict=True):
            table.problems.extend(_gaps(table.path, line, modes, present))
    table.refuse()
    return slot


def _mode_columns(
    table: Table, mode: NDArray[np.int64], modes: Modes, ignore_modes: Collection[int]
) -> NDArray[np.int32]:
    """Position of each row's mode among the used ones (r,), -1 where it is ignored; an unknown mode is a mistake."""
    column = _positions(modes.mode, mode)
    unknown = column < 0
    unknown[unknown] = ~np.isin(mode[unknown], list(ignore_modes))
    if unknown.any():
        ids = ", ".join(map(str, np.unique(mode[unknown])))
        what = f"modes {ids} are not in the table of modes"
        table.report(unknown, "unknown_id", "mode", what, "Add them there or to ignore_modes")
    return column


def stations_of(
    names: Sequence[str], code: NDArray[np.int32], node: NDArray[np.int64], lines: LineStack
) -> NDArray[np.int32]:
    """Position of each row's (weld, node) along all lines one after another (r,), -1 where the line lacks the node."""
    nodes = np.unique(lines.node)
    keys = line_of_node(lines) * nodes.size + np.searchsorted(nodes, lines.node)
    along = np.argsort(keys)
    index = {weld: i for i, weld in enumerate(lines.weld)}
    line_of = np.array([index[name] for name in names])
    station = np.empty(node.size, dtype=np.int32)
    for start in range(0, node.size, BLOCK):
        rows = slice(start, start + BLOCK)
        rank = _positions(nodes, node[rows])
        at = _positions(keys[along], np.where(rank < 0, -1, line_of[code[rows]] * nodes.size + rank))
        station[rows] = np.where(at < 0, -1, along[at])
    return station


def _positions(ids: NDArray[np.int64], values: NDArray[np.int64]) -> NDArray[np.int32]:
    """Position of each value in ascending ids, -1 where it is not among them."""
    at = np.searchsorted(ids, values).astype(np.int32)
    at[at == ids.size] = 0
    at[ids[at] != values] = -1
    return at


def _gaps(path: Path, line: WeldLine, modes: Modes, present: NDArray[np.bool_]) -> list[Problem]:
    """Name the first node and mode of a line without forces; ``present`` is (n, m)."""
    if present.all():
        return []
    i, j = np.argwhere(~present)[0]
    missing = np.count_nonzero(~present)
    return [
        Problem(
            "missing_row",
            f"{path.name}: weld {line.weld}, node {line.node[i]}, mode {modes.mode[j]}",
            f"no forces are given ({missing} of the weld's {present.size} pairs of node and mode are missing)",
            "Write the forces of every node and mode, zeros too, or list the mode under ignore_modes",
        )
    ]
