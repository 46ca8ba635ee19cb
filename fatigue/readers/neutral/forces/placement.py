"""The station and the mode of every row of a table of nodal forces.

Most programs write a grid: node by node all modes, or mode by mode all nodes. Then each axis is looked up once. In a
table of any other order every row is looked up. Only arrays are known here; ``mistakes`` tells what is wrong with them.
"""

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.readers.neutral.body.modes import Modes
from fatigue.readers.neutral.body.unit_loads import UnitLoads
from fatigue.weld.line import LineStack, line_of_node

BLOCK = 1 << 20  # rows whose stations are looked up at a time, so that a large file needs little memory beside it


@dataclass(frozen=True, slots=True, eq=False)
class RowKeys:
    """The keys of r rows: ``names`` of welds, and (r,) each, which of them, node id and mode id."""

    names: tuple[str, ...]
    weld: NDArray[np.int32]
    node: NDArray[np.int64]
    mode: NDArray[np.int64]


@dataclass(frozen=True, slots=True, eq=False)
class Grid:
    """Rows that run node by node through all modes, or mode by mode through all nodes.

    ``shape`` is (nodes, modes) if ``by_node``, else (modes, nodes). ``station``, (n,), and ``mode``, (m,), are the
    positions on these axes where the stations of all lines and the modes used stand.
    """

    shape: tuple[int, int]
    by_node: bool
    station: NDArray[np.intp]
    mode: NDArray[np.intp]

    def by_station(self, values: NDArray[Any]) -> NDArray[Any]:
        """Values of all rows, (r,), in the order of stations and modes, (n, m)."""
        grid = values.reshape(self.shape) if self.by_node else values.reshape(self.shape).T
        in_order = np.array_equal(self.station, np.arange(len(grid))) and np.array_equal(
            self.mode, np.arange(len(grid.T))
        )
        return grid if in_order else grid[np.ix_(self.station, self.mode)]


@dataclass(frozen=True, slots=True, eq=False)
class Slots:
    """Rows in any order: the ``station`` of each among all lines and its ``mode`` among those used, (r,), -1 for none.

    ``slot``, (r,), is the position among the (station, mode) of all lines, -1 where either is none.
    ``shape`` is (n, m).
    """

    shape: tuple[int, int]
    station: NDArray[np.int32]
    mode: NDArray[np.int32]
    slot: NDArray[np.int64]

    def by_station(self, values: NDArray[Any]) -> NDArray[Any]:
        """Values of all rows, (r,), in the order of stations and modes, (n, m); every slot has exactly one row."""
        placed = np.empty(self.shape[0] * self.shape[1], values.dtype)
        used = slice(None) if placed.size == self.slot.size else self.slot >= 0
        placed[self.slot[used]] = values[used]
        return placed.reshape(self.shape)


def grid(keys: RowKeys, lines: LineStack, modes: Modes | UnitLoads, ignore_modes: Collection[int]) -> Grid | None:
    """Grid of a complete regular table; None if anything is unusual."""
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
    column = positions(modes.mode, mode[of_mode])
    ignored = column < 0
    if not np.isin(mode[of_mode][ignored], list(ignore_modes)).all():
        return None
    for found, n in ((station, lines.node.size), (column[~ignored], modes.mode.size)):
        if not np.array_equal(np.sort(found), np.arange(n)):
            return None
    return Grid(shape, by_node, np.argsort(station), np.argsort(column)[np.count_nonzero(ignored) :])


def slots(keys: RowKeys, lines: LineStack, modes: Modes | UnitLoads) -> Slots:
    """Station and mode of every row, looked up one by one."""
    station, mode = stations_of(keys.names, keys.weld, keys.node, lines), positions(modes.mode, keys.mode)
    slot = np.where((station < 0) | (mode < 0), -1, station.astype(np.int64) * modes.mode.size + mode)
    return Slots((lines.node.size, modes.mode.size), station, mode, slot)


def stations_of(
    names: Sequence[str], code: NDArray[np.int32], node: NDArray[np.int64], lines: LineStack
) -> NDArray[np.int32]:
    """Position of each row's (weld, node) along all lines one after another (r,), -1 where no line has it."""
    nodes = np.unique(lines.node)
    keys = line_of_node(lines) * nodes.size + np.searchsorted(nodes, lines.node)
    along = np.argsort(keys)
    index = {weld: i for i, weld in enumerate(lines.weld)}
    line_of = np.array([index.get(name, -1) for name in names])
    station = np.empty(node.size, dtype=np.int32)
    for start in range(0, node.size, BLOCK):
        rows = slice(start, start + BLOCK)
        rank = positions(nodes, node[rows])
        at = positions(keys[along], np.where(rank < 0, -1, line_of[code[rows]] * nodes.size + rank))
        station[rows] = np.where(at < 0, -1, along[at])
    return station


def positions(ids: NDArray[np.int64], values: NDArray[np.int64]) -> NDArray[np.int32]:
    """Position of each value in ascending ids, -1 where it is not among them."""
    at = np.searchsorted(ids, values).astype(np.int32)
    at[at == ids.size] = 0
    at[ids[at] != values] = -1
    return at


def _run(values: NDArray[Any]) -> int:
    """Count the equal values at the beginning."""
    other = values != values[:1]
    return int(other.argmax()) if other.any() else values.size
