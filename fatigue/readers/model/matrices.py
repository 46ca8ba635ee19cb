"""K and M of a body from files, with what their rows are, in N, mm, t."""

from pathlib import Path

import numpy as np
from scipy import sparse

from fatigue.errors import DataError, Problem
from fatigue.flexbody.structure import Structure
from fatigue.readers.neutral.body.mass_matrix import read_mass_rows
from fatigue.readers.neutral.body.mesh import Mesh
from fatigue.readers.neutral.body.symmetric_matrix import ENDINGS, read_symmetric_matrix
from fatigue.readers.units.systems import UnitSystem

MATRIX_ENDINGS = ENDINGS


def read_structure(
    K: Path, M: Path, dof: Path, mesh: Mesh | None, units: UnitSystem, *, strict: bool
) -> tuple[Structure, list[Problem]]:
    """Structure of K and M, and of the table ``dof``: ``row, node, component`` and the place of the node.

    Rows that have neither stiffness nor mass are no degrees of freedom and are left out.

    Raises
    ------
    DataError : a file is missing or damaged, matrices of two sizes, rows without a node
    """
    stiffness = read_symmetric_matrix(K, "stiffness matrix", "[N/mm, N, N mm]", "stiffness")
    mass = read_symmetric_matrix(M, "mass matrix", "[t, t mm, t mm2]", "masses")
    if stiffness.shape != mass.shape:
        what = f"{mass.shape[0]} rows, and {K.name} has {stiffness.shape[0]}"
        raise DataError(Problem("bad_shape", M.name, what, "Export both from the same run"))
    rows, warnings = read_mass_rows(dof, stiffness.shape[0], K.name, mesh, strict=strict)
    return structure_in_mm(Structure(stiffness, mass, rows.node, rows.direction, rows.xyz), units), warnings


def structure_in_mm(structure: Structure, units: UnitSystem) -> Structure:
    """Structure in N, mm, t, from K and M in ``units``; places are in mm already; empty rows are left out.

    ``K_ij`` is force over displacement, with a length for each of i and j that is a rotation; ``M_ij`` mass alike.
    """
    length = sparse.diags_array(np.where(structure.direction > 2, units.length, 1.0))
    K = sparse.csc_array(length @ structure.K @ length) * (units.force / units.length)
    M = sparse.csc_array(length @ structure.M @ length) * units.mass
    filled = np.flatnonzero((abs(K).sum(axis=0) > 0.0) | (abs(M).sum(axis=0) > 0.0))
    if filled.size < K.shape[0]:
        K, M = (sparse.csc_array(matrix[filled][:, filled]) for matrix in (K, M))
    return Structure(K, M, structure.node[filled], structure.direction[filled], structure.xyz[filled])
