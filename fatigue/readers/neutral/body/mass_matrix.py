"""The mass matrix of a body, what its rows are, and the shapes of the modes in these rows."""

from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from fatigue.errors import DataError, Problem
from fatigue.readers.neutral.body.mesh import Mesh
from fatigue.readers.neutral.body.modes import Modes
from fatigue.readers.neutral.body.participation import refuse_unknown_modes
from fatigue.readers.neutral.body.symmetric_matrix import read_symmetric_matrix
from fatigue.readers.neutral.tables import Table, open_table

DIRECTIONS = ("x", "y", "z", "rx", "ry", "rz")
COMPONENTS = ("1", "2", "3", "4", "5", "6")
XYZ = ("x_mm", "y_mm", "z_mm")
SHAPE = ("ux_mm", "uy_mm", "uz_mm", "rx_rad", "ry_rad", "rz_rad")


@dataclass(frozen=True, slots=True, eq=False)
class MassRows:
    """What the rows of a mass matrix are, in their order.

    Attributes
    ----------
    node : (n,) node id
    direction : (n,) 0, 1, 2: displacement along x, y, z; 3, 4, 5: rotation about them
    xyz : (n, 3) place of the node [mm]
    held : (n,) whether it was held where the modes were computed: the boundary
    """

    node: NDArray[np.int64]
    direction: NDArray[np.int64]
    xyz: NDArray[np.float64]
    held: NDArray[np.bool_]


def read_mass_matrix(path: Path) -> sparse.csc_array:
    """Symmetric mass matrix (n, n) [t, t mm, t mm2] of a ``.mtx`` file of Matrix Market or a ``.npz`` of scipy.sparse.

    Raises
    ------
    DataError : missing, of another format, damaged, not square, not symmetric, without mass, or with masses below 0
    """
    return read_symmetric_matrix(path, "mass matrix", "[t, t mm, t mm2]", "masses")


def read_mass_rows(
    path: Path, rows: int, matrix: str, mesh: Mesh | None, *, strict: bool, need_places: bool = True
) -> tuple[MassRows, list[Problem]]:
    """Read ``row, node, direction`` and, where present, ``x_mm, y_mm, z_mm, held``: one row for each of the matrix.

    ``row`` counts from 1. The direction is x, y, z, rx, ry, rz; instead of it, ``component`` has its number, 1 to 6.
    Places are given here, or by the ``mesh`` of the case; where nobody needs them they may be NaN. Rows that are
    ``held`` are the boundary that was fixed where the modes were computed.

    Raises
    ------
    DataError : rows missing, twice or beyond the matrix; unknown directions or nodes; nodes without a place
    """
    table = open_table(path, texts=("direction",))
    numbered = "component" in table.position and "direction" not in table.position
    of_row = "component" if numbered else "direction"
    table.expect(("row", "node", of_row), (*XYZ, "held"), strict=strict)
    row, node = table.integers("row"), table.integers("node")
    code = _components(table) if numbered else _directions(table)
    held = table.flags("held", default=False)
    beyond = (row < 1) | (row > rows)
    what = f"row {row[int(beyond.argmax())]} is none of the {rows} of {matrix}"
    table.report(beyond, "unknown_id", "row", what, "Count the rows of the matrix from 1")
    table.unique({"row": row})
    table.unique({"node": node, of_row: code}, {of_row: COMPONENTS if numbered else DIRECTIONS})
    xyz = _places(table, node, mesh, need_places)
    table.refuse()
    if table.rows < rows:
        absent = np.setdiff1d(np.arange(1, rows + 1), row)
        also = f" (and {absent.size - 1} more)" if absent.size > 1 else ""
        what = f"row {absent[0]} of {matrix} has no line here{also}"
        remedy = "Say of every row of the matrix which node and direction it is"
        raise DataError(Problem("missing_id", f"{path.name}: column row", what, remedy))
    order = np.argsort(row)
    return MassRows(node[order], code[order], xyz[order], held[order]), table.warnings


def _directions(table: Table) -> NDArray[np.int64]:
    """Direction of every row (r,), 0 to 5, by name."""
    direction = table.texts("direction")
    table.choices("direction", direction, DIRECTIONS)
    return np.array([DIRECTIONS.index(d) if d in DIRECTIONS else 0 for d in direction], dtype=np.int64)


def _components(table: Table) -> NDArray[np.int64]:
    """Direction of every row (r,), 0 to 5, by its number from 1."""
    component = table.integers("component")
    unknown = (component < 1) | (component > len(COMPONENTS))
    what = f"{component[int(unknown.argmax())]} is no component"
    table.report(unknown, "bad_value", "component", what, "Give 1 to 3 for x, y, z, 4 to 6 for rotations about them")
    return np.where(unknown, 0, component - 1)


def _places(table: Table, node: NDArray[np.int64], mesh: Mesh | None, needed: bool) -> NDArray[np.float64]:
    """Place (n, 3) of every row [mm]: as the table has it, else that of the node in the mesh, else NaN."""
    if any(name in table.position for name in XYZ):
        return np.column_stack([table.numbers(name) for name in XYZ]).astype(np.float64)
    if mesh is None:
        if needed:
            what = "nothing says where the nodes are"
            remedy = "Give x_mm, y_mm, z_mm here, or nodes in [body]"
            table.problems.append(Problem("missing_column", f"{table.path.name}: x_mm, y_mm, z_mm", what, remedy))
        return np.full((table.rows, 3), np.nan)
    at = np.clip(np.searchsorted(mesh.node, node), 0, len(mesh.node) - 1)
    unknown = mesh.node[at] != node
    what = f"node {node[int(unknown.argmax())]} is not in the nodes of [body]"
    table.report(unknown, "unknown_id", "node", what, "Add it there, or give x_mm, y_mm, z_mm here")
    return np.asarray(mesh.xyz[at])


def read_mode_shapes(
    path: Path, rows: MassRows, modes: Modes, ignore_modes: Collection[int], *, strict: bool
) -> tuple[NDArray[np.int64], NDArray[np.float64], list[Problem]]:
    """Modes (p,) that have shapes, and these in the rows of the mass matrix (n, p) [mm, rad per unit of the mode].

    Read are ``mode, node, ux_mm, uy_mm, uz_mm`` and, where rows of the matrix are rotations, ``rx_rad, ry_rad,
    rz_rad``. Nodes that the matrix does not have are passed over.

    Raises
    ------
    DataError : a node of the matrix missing in a mode or given twice; an unknown mode; no finite number
    """
    turns = bool((rows.direction > 2).any())
    table = open_table(path)
    table.expect(("mode", "node", *(SHAPE if turns else SHAPE[:3])), SHAPE, strict=strict)
    mode, node = table.integers("mode"), table.integers("node")
    refuse_unknown_modes(table, mode, modes, ignore_modes)
    table.unique({"mode": mode, "node": node})
    table.refuse()
    nodes, at_node = np.unique(rows.node, return_inverse=True)
    found = np.intersect1d(mode, modes.mode)
    used = np.isin(mode, found) & np.isin(node, nodes)
    of_mode, of_node = np.searchsorted(found, mode[used]), np.searchsorted(nodes, node[used])
    there = np.zeros((len(found), len(nodes)), dtype=np.bool_)
    there[of_mode, of_node] = True
    if not there.all():
        table.problems.append(_missing_node(table, found, nodes, there))
    table.refuse()
    shapes = np.zeros((len(rows.node), len(found)))
    for number, name in enumerate(SHAPE):
        of_direction = rows.direction == number
        if not of_direction.any():
            continue
        values = table.numbers(name)
        table.refuse()
        at = np.zeros((len(nodes), len(found)))
        at[of_node, of_mode] = values[used]
        shapes[of_direction] = at[at_node[of_direction]]
    return found, shapes, table.warnings


def _missing_node(
    table: Table, modes: NDArray[np.int64], nodes: NDArray[np.int64], there: NDArray[np.bool_]
) -> Problem:
    """Refusal of shapes that lack nodes of the matrix."""
    mode, node = np.argwhere(~there)[0]
    more = int(np.count_nonzero(~there)) - 1
    also = f" (and {more} more)" if more else ""
    what = f"mode {modes[mode]} has no row of node {nodes[node]}, which the mass matrix has{also}"
    return Problem("missing_id", f"{table.path.name}: column node", what, "Give every mode at every node of the matrix")
