"""K and M of a body from files, with what their rows are, in N, mm, t."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from fatigue.errors import DataError, Problem
from fatigue.files.naming import missing_file
from fatigue.flexbody.places import places_by_stiffness
from fatigue.flexbody.structure import Structure
from fatigue.readers.foreign.nastran.matrices.deck import read_dmig
from fatigue.readers.foreign.nastran.matrices.op4 import read_op4
from fatigue.readers.neutral.body.mass_matrix import MassRows, read_mass_rows
from fatigue.readers.neutral.body.mesh import Mesh
from fatigue.readers.neutral.body.symmetric_matrix import ENDINGS, read_symmetric_matrix, refuse_no_symmetric_matrix
from fatigue.readers.units.systems import UnitSystem

MATRIX_ENDINGS = (*ENDINGS, ".op4")
DECK_ENDINGS = (".pch", ".dmig", ".bdf", ".dat", ".nas")

STIFFNESS = ("stiffness matrix", "[N/mm, N, N mm]", "stiffness")
MASS = ("mass matrix", "[t, t mm, t mm2]", "masses")


def read_structure(
    K: Path, M: Path, dof: Path, mesh: Mesh | None, units: UnitSystem, *, strict: bool
) -> tuple[Structure, list[Problem]]:
    """Structure of K and M in ``units``, and of the table ``dof``: ``row, node, component`` and the place of the node.

    Rows that have neither stiffness nor mass are no degrees of freedom and are left out.

    Raises
    ------
    DataError : a file is missing or damaged, matrices of two sizes, rows without a node
    """
    stiffness, mass = _read(K, "K", STIFFNESS), _read(M, "M", MASS)
    if stiffness.shape != mass.shape:
        what = f"{mass.shape[0]} rows, and {K.name} has {stiffness.shape[0]}"
        raise DataError(Problem("bad_shape", M.name, what, "Export both from the same run"))
    rows, warnings = read_mass_rows(dof, stiffness.shape[0], K.name, mesh, strict=strict, need_places=False)
    xyz = rows.xyz
    if np.isnan(xyz).all():
        xyz, found = _places(stiffness, rows, dof, units)
        warnings = [*warnings, found]
    return structure_in_mm(Structure(stiffness, mass, rows.node, rows.direction, xyz), units), warnings


def _places(K: sparse.csc_array, rows: MassRows, dof: Path, units: UnitSystem) -> tuple[NDArray[np.float64], Problem]:
    """Places (n, 3) [mm] as K tells them, and the warning that says so.

    Raises
    ------
    DataError : K does not tell them
    """
    stiff = np.flatnonzero(abs(K).sum(axis=0) > 0.0)
    of_stiff = sparse.csc_array(K[stiff][:, stiff])
    places, origin = places_by_stiffness(of_stiff, rows.node[stiff], rows.direction[stiff], dof.name)
    xyz = np.zeros((len(rows.node), 3))
    xyz[stiff] = places * units.length
    what = f"nothing says where the nodes are: their places were found from K, measured from node {origin}"
    remedy = "Give x_mm, y_mm, z_mm here, or a table nodes in the folder, where the origin matters, as to a vehicle"
    return xyz, Problem("places_from_stiffness", f"{dof.name}: x_mm, y_mm, z_mm", what, remedy)


def read_structure_of_deck(
    path: Path, mesh: Mesh | None, units: UnitSystem
) -> tuple[Structure, tuple[str, str], tuple[Path, ...]]:
    """Structure of the DMIG of a NASTRAN file, the names of its matrices, and the files it includes.

    Places are those of its grids, in ``units``, or those of the ``mesh`` [mm].

    Raises
    ------
    DataError : no matrices of stiffness and mass, grids without a place; as ``read_structure``
    """
    deck = read_dmig(path)
    refuse_no_symmetric_matrix(path, deck.K, *STIFFNESS)
    refuse_no_symmetric_matrix(path, deck.M, *MASS)
    known = {int(node): place for node, place in zip(mesh.node, mesh.xyz, strict=True)} if mesh is not None else {}
    known |= {node: place * units.length for node, place in deck.xyz.items()}
    nodes = np.unique(deck.node)
    missing = [int(node) for node in nodes if int(node) not in known]
    if missing:
        also = f" (and {len(missing) - 1} more)" if len(missing) > 1 else ""
        what = f"nothing says where grid {missing[0]} is{also}"
        raise DataError(Problem("no_grid", str(path), what, "Add its GRID to the file, or a table nodes to its folder"))
    xyz = np.array([known[int(node)] for node in nodes])[np.searchsorted(nodes, deck.node)]
    given = Structure(deck.K, deck.M, deck.node, deck.direction, xyz)
    return structure_in_mm(given, units), deck.names, deck.included


def structure_in_mm(structure: Structure, units: UnitSystem) -> Structure:
    """Structure in N, mm, t, from K and M in ``units``; places are in mm already; empty rows are left out.

    ``K_ij`` is force over displacement, with a length for each of i and j that is a rotation; ``M_ij`` mass alike.
    """
    length = sparse.diags_array(np.where(structure.direction > 2, units.length, 1.0))
    K = sparse.csc_array(length @ structure.K @ length) * (units.force / units.length)
    M = sparse.csc_array(length @ structure.M @ length) * units.mass
    filled: NDArray[np.int64] = np.flatnonzero((abs(K).sum(axis=0) > 0.0) | (abs(M).sum(axis=0) > 0.0))
    if filled.size < K.shape[0]:
        K, M = (sparse.csc_array(matrix[filled][:, filled]) for matrix in (K, M))
    return Structure(K, M, structure.node[filled], structure.direction[filled], structure.xyz[filled])


def _read(path: Path, letter: str, meant: tuple[str, str, str]) -> sparse.csc_array:
    """Symmetric matrix of a file; of an OUTPUT4 file with several, the one whose name begins with the ``letter``."""
    if path.suffix.lower() != ".op4":
        return read_symmetric_matrix(path, *meant)
    if not path.is_file():
        raise DataError(missing_file(path))
    matrices = read_op4(path)
    named = [name for name in matrices if name.startswith(letter)] if len(matrices) > 1 else list(matrices)
    if len(named) != 1:
        what = f"it has {', '.join(matrices)}, and {len(named)} of these names begin with {letter}"
        raise DataError(Problem("two_matrices", path.name, what, "Write one matrix to each file"))
    matrix = matrices[named[0]]
    refuse_no_symmetric_matrix(path, matrix, *meant)
    return matrix
