"""The mass matrix of a body, what its rows are, and the shapes of the modes in these rows."""

from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path
from zipfile import BadZipFile

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.io import mmread

from fatigue.errors import DataError, Problem
from fatigue.files.naming import missing_file
from fatigue.readers.neutral.body.mesh import Mesh
from fatigue.readers.neutral.body.modes import Modes
from fatigue.readers.neutral.body.participation import refuse_unknown_modes
from fatigue.readers.neutral.tables import Table, open_table

DIRECTIONS = ("x", "y", "z", "rx", "ry", "rz")
XYZ = ("x_mm", "y_mm", "z_mm")
SHAPE = ("ux_mm", "uy_mm", "uz_mm", "rx_rad", "ry_rad", "rz_rad")
UNEQUAL = 1e-6  # of the largest value, between M and its transpose: files are written with six digits or more


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
    if not path.is_file():
        raise DataError(missing_file(path))
    readers = {".mtx": mmread, ".npz": sparse.load_npz}
    reader = readers.get(path.suffix.lower())
    if reader is None:
        what = f"unknown kind of file {path.suffix!r}"
        remedy = "Give a .mtx file of Matrix Market or a .npz file that scipy.sparse.save_npz wrote"
        raise DataError(Problem("unknown_format", str(path), what, remedy))
    try:
        with path.open("rb") as file:
            read = reader(file)
        matrix = sparse.csc_array(read, dtype=np.float64) if np.isrealobj(getattr(read, "data", read)) else None
    except (ValueError, OSError, LookupError, TypeError, OverflowError, EOFError, BadZipFile) as error:
        detail = str(error).splitlines()[0] if str(error) else type(error).__name__
        what = f"cannot be read as a matrix ({detail})"
        raise DataError(Problem("damaged_file", str(path), what, "Write the file again")) from None
    if matrix is None:
        raise DataError(Problem("bad_value", path.name, "its values are complex", "Give a real mass matrix"))
    _refuse_no_mass_matrix(path, matrix)
    return matrix


def _refuse_no_mass_matrix(path: Path, M: sparse.csc_array) -> None:
    """Refuse a matrix that cannot be one of masses."""
    rows, columns = M.shape
    if rows != columns or not rows:
        what = f"the matrix has {rows} rows and {columns} columns"
        raise DataError(Problem("bad_shape", path.name, what, "Give a square matrix, as many rows as columns"))
    bad = ~np.isfinite(M.data)
    if bad.any():
        entry = int(bad.argmax())
        where = f"{path.name}: row {M.indices[entry] + 1}, column {np.searchsorted(M.indptr, entry, side='right')}"
        raise DataError(Problem("bad_value", where, f"{M.data[entry]} is not finite", "Give a finite number"))
    largest = float(np.abs(M.data).max(initial=0.0))
    if largest == 0.0:
        raise DataError(Problem("bad_value", path.name, "the matrix is 0", "Give the mass matrix [t, t mm, t mm2]"))
    difference = abs(M - M.T).tocoo()
    if difference.nnz and difference.data.max() > UNEQUAL * largest:
        at = int(difference.data.argmax())
        row, column = sorted((int(difference.coords[0][at]), int(difference.coords[1][at])))
        one_sided = sparse.triu(M, 1).nnz == 0 or sparse.tril(M, -1).nnz == 0
        what = f"the matrix is not symmetric: {M[row, column]:g}, and {M[column, row]:g} in row {column + 1}"
        what += "; only one of its triangles is there" if one_sided else ""
        remedy = "Write both triangles, or a .mtx file whose head says symmetric" if one_sided else "Export it again"
        raise DataError(Problem("not_symmetric", f"{path.name}: row {row + 1}, column {column + 1}", what, remedy))
    diagonal = M.diagonal()
    if diagonal.min() < 0.0:
        row = int(diagonal.argmin())
        what = f"{diagonal[row]:g} on the diagonal is below 0"
        raise DataError(Problem("bad_value", f"{path.name}: row {row + 1}", what, "Give a mass matrix, masses above 0"))


def read_mass_rows(
    path: Path, rows: int, matrix: str, mesh: Mesh | None, *, strict: bool
) -> tuple[MassRows, list[Problem]]:
    """Read ``row, node, direction`` and, where present, ``x_mm, y_mm, z_mm, held``: one row for each of the matrix.

    ``row`` counts from 1. Places are given here, or by the ``mesh`` of the case. Rows that are ``held`` are the
    boundary that was fixed where the modes were computed.

    Raises
    ------
    DataError : rows missing, twice or beyond the matrix; unknown directions or nodes; nodes without a place
    """
    table = open_table(path, texts=("direction",))
    table.expect(("row", "node", "direction"), (*XYZ, "held"), strict=strict)
    row, node = table.integers("row"), table.integers("node")
    direction = table.texts("direction")
    table.choices("direction", direction, DIRECTIONS)
    held = table.flags("held", default=False)
    beyond = (row < 1) | (row > rows)
    what = f"row {row[int(beyond.argmax())]} is none of the {rows} of {matrix}"
    table.report(beyond, "unknown_id", "row", what, "Count the rows of the matrix from 1")
    table.unique({"row": row})
    code = np.array([DIRECTIONS.index(d) if d in DIRECTIONS else 0 for d in direction], dtype=np.int64)
    table.unique({"node": node, "direction": code}, {"direction": DIRECTIONS})
    xyz = _places(table, node, mesh)
    table.refuse()
    if table.rows < rows:
        absent = np.setdiff1d(np.arange(1, rows + 1), row)
        also = f" (and {absent.size - 1} more)" if absent.size > 1 else ""
        what = f"row {absent[0]} of {matrix} has no line here{also}"
        remedy = "Say of every row of the matrix which node and direction it is"
        raise DataError(Problem("missing_id", f"{path.name}: column row", what, remedy))
    order = np.argsort(row)
    return MassRows(node[order], code[order], xyz[order], held[order]), table.warnings


def _places(table: Table, node: NDArray[np.int64], mesh: Mesh | None) -> NDArray[np.float64]:
    """Place (n, 3) of every row [mm]: as the table has it, else that of the node in the mesh."""
    if any(name in table.position for name in XYZ):
        return np.column_stack([table.numbers(name) for name in XYZ]).astype(np.float64)
    if mesh is None:
        what = "nothing says where the nodes are"
        remedy = "Give x_mm, y_mm, z_mm here, or nodes in [body]"
        table.problems.append(Problem("missing_column", f"{table.path.name}: x_mm, y_mm, z_mm", what, remedy))
        return np.zeros((table.rows, 3))
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
