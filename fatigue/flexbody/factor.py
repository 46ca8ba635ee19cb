"""A stiffness matrix factorised, and a free body answering loads: held at six rows, freed again.

The factors are those of SuperLU without pivoting, rows and columns ordered alike by minimum degree on K + K': for a
symmetric, positive definite matrix they are L D L'.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.linalg import cholesky, qr, solve_triangular
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import SuperLU, splu

from fatigue.errors import DataError, Problem
from fatigue.flexbody.mass import centre_of_mass, rigid_mass, rigid_motions
from fatigue.flexbody.structure import Structure

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]

NAMES = ("x", "y", "z", "rx", "ry", "rz")
UNEQUAL = 1e-6  # of the roots of the diagonal, between K and K': files are written with six digits or more
GROUNDED = 1e-5  # of the terms that cancel in K R: ten times what six digits leave
MOVES_FREELY = 1e-14  # stiffness of a motion over that of its rows one by one: rounding, some 100 units of it
NOT_POSITIVE = "Export K without geometric stiffness and in double precision, with 16 digits"
ON_A_LINE = 1e-6  # sixth pivot of the rigid motions of the rows that may be held, over the first


@dataclass(frozen=True, slots=True, eq=False)
class Factor:
    """The factors of K on the rows that are not ``held`` (n,)."""

    lu: SuperLU | None
    held: Mask

    def solve(self, loads: Floats) -> Floats:
        """Displacements (n, k) under loads (n, k); 0 on the rows that are held."""
        u = np.zeros(loads.shape)
        if self.lu is not None:
            u[~self.held] = self.lu.solve(np.asfortranarray(loads[~self.held]))
        return u


def factored(structure: Structure, held: Mask) -> Factor:
    """Factors of the stiffness of a structure with the rows ``held`` (n,) at zero.

    Raises
    ------
    DataError : a row without stiffness, a part that moves freely, K not symmetric or not positive
    """
    refuse_unsymmetric("K", structure.K, structure)
    free = np.flatnonzero(~held)
    if not free.size:
        return Factor(None, held)
    K = structure.K if free.size == held.size else sparse.csc_array(structure.K[free][:, free])
    diagonal = K.diagonal()
    if diagonal.min() <= 0.0:
        raise DataError(_without_stiffness(structure, int(free[diagonal.argmin()]), float(diagonal.min())))
    try:
        lu = _splu(K)
    except RuntimeError:  # exactly singular
        raise DataError(_mechanism(structure, free[_softest(K, diagonal)])) from None
    motion = _inverse_iteration(lu, diagonal)
    energy = float(motion @ (K @ motion)) / float(diagonal @ motion**2)
    row = int(free[np.argmax(diagonal * motion**2)])
    if energy < -MOVES_FREELY:
        what = "the stiffness of a motion that is largest here is negative"
        raise DataError(Problem("not_positive", f"K: {row_name(structure, row)}", what, NOT_POSITIVE))
    if not energy > MOVES_FREELY:
        raise DataError(_mechanism(structure, row))
    return Factor(lu, held)


@dataclass(frozen=True, slots=True, eq=False)
class FreeBody:
    """A free body that answers loads: its structure, and factors of K held at a statically determinate support.

    ``rigid`` (n, 6) are rigid motions with unit mass, ``R' M R = 1``.
    """

    structure: Structure
    factor: Factor
    rigid: Floats

    def elastic(self, loads: Floats) -> Floats:
        """Elastic displacements (n, k) under loads (n, k) of the body that flies free (inertia relief).

        ``u = P K^+ P' f`` with ``P = 1 - R R' M``: inertia balances the loads, and u is orthogonal to rigid motions.
        The support carries nothing, so that the answer does not depend on it (Craig and Chang 1977).
        """
        M_R = self.structure.M @ self.rigid
        u = self.factor.solve(loads - M_R @ (self.rigid.T @ loads))
        return np.asarray(u - self.rigid @ (M_R.T @ u))


def free_body(structure: Structure) -> FreeBody:
    """Factorise a free body, once for its modes and its answers to loads.

    Raises
    ------
    DataError : K or M not symmetric, K that resists rigid motions, M without mass, parts that nothing joins or a hinge
    """
    refuse_unsymmetric("M", structure.M, structure)
    rigid = unit_rigid_motions(structure)
    refuse_unsymmetric("K", structure.K, structure)
    _refuse_grounded(structure, rigid)
    _refuse_parts(structure)
    held = np.zeros(len(structure.node), dtype=np.bool_)
    held[support(structure)] = True
    return FreeBody(structure, factored(structure, held), rigid)


def support(structure: Structure) -> NDArray[np.int64]:
    """Six rows that hold a free body without stressing it, far from each other and none of the softest.

    They are the pivots of the rigid motions, whose rotations are scaled to the size of the body. Displacements are
    taken; rotations only where nodes lie on a line, or have no displacements that could do it.

    Raises
    ------
    DataError : no six rows hold the body
    """
    at_middle = rigid_motions(structure.xyz, structure.direction, structure.xyz.mean(axis=0))
    size = max(float(np.abs(structure.xyz - structure.xyz.mean(axis=0)).max()), 1e-300)
    turns = structure.direction > 2
    at_middle[:, 3:] /= size
    at_middle[turns] *= size
    stiffness = structure.K.diagonal()
    displacements = np.flatnonzero(~turns & (stiffness > 0.0))
    if displacements.size:
        firm = displacements[stiffness[displacements] >= np.median(stiffness[displacements])]
        for rows in (firm, displacements):
            if (found := _pivots(at_middle, rows)).size:
                return found
    if not (found := _pivots(at_middle, np.flatnonzero(stiffness > 0.0))).size:
        what = "no six rows of the matrices hold the body: it has no stiffness against all of its rigid motions"
        raise DataError(Problem("mechanism", "K", what, "Give the matrices of a whole body in space"))
    return found


def refuse_unsymmetric(name: str, matrix: sparse.csc_array, structure: Structure) -> None:
    """Refuse a matrix that differs from its transpose.

    Raises
    ------
    DataError : and where it differs most
    """
    bad = ~np.isfinite(matrix.data)
    if bad.any():
        column = int(np.searchsorted(matrix.indptr, int(bad.argmax()), side="right")) - 1
        what = f"{matrix.data[bad][0]} is not finite"
        raise DataError(Problem("bad_value", f"{name}: {row_name(structure, column)}", what, "Give finite numbers"))
    scale = np.sqrt(np.abs(matrix.diagonal()))
    difference = abs(matrix - matrix.T).tocoo()
    i, j = difference.coords
    of_scale = difference.data - UNEQUAL * np.maximum(scale[i] * scale[j], 1e-300)
    if of_scale.size and of_scale.max() > 0.0:
        worst = int(of_scale.argmax())
        row, column = sorted((int(i[worst]), int(j[worst])))
        where = f"{name}: {row_name(structure, row)} with {row_name(structure, column)}"
        what = f"the matrix is not symmetric: {matrix[row, column]:.9g}, and {matrix[column, row]:.9g} in its transpose"
        raise DataError(Problem("not_symmetric", where, what, "Export both triangles of the same run"))


def row_name(structure: Structure, row: int) -> str:
    """Name of a row in messages: its node and direction."""
    return f"node {structure.node[row]}, {NAMES[structure.direction[row]]}"


def _splu(K: sparse.csc_array) -> SuperLU:
    return splu(K, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})


def _inverse_iteration(lu: SuperLU, diagonal: Floats) -> Floats:
    """Softest motion, against the diagonal: three steps of inverse iteration."""
    motion = np.random.default_rng(0).standard_normal(diagonal.size) / np.sqrt(diagonal)
    for _ in range(3):
        motion = lu.solve(diagonal * motion)
        motion = motion / np.sqrt(diagonal @ motion**2)
    return motion


def _softest(K: sparse.csc_array, diagonal: Floats) -> int:
    """Row that moves most where K is exactly singular, by a matrix that is just not."""
    motion = _inverse_iteration(_splu(sparse.csc_array(K + sparse.diags_array(1e-9 * diagonal))), diagonal)
    return int(np.argmax(diagonal * motion**2))


def _pivots(rigid: Floats, rows: NDArray[np.int64]) -> NDArray[np.int64]:
    """Six of some rows, by QR with pivots; none where these rows do not tell the six motions apart."""
    if rows.size < 6:
        return np.zeros(0, dtype=np.int64)
    R, order = qr(rigid[rows].T, mode="r", pivoting=True)
    pivot = np.abs(np.diag(R))
    return rows[order[:6]] if pivot[5] > ON_A_LINE * pivot[0] else np.zeros(0, dtype=np.int64)


def unit_rigid_motions(structure: Structure) -> Floats:
    """Rigid motions R (n, 6) with R' M R = 1.

    Raises
    ------
    DataError : M has no mass against one of them
    """
    M = structure.M
    about_origin = rigid_mass(M, rigid_motions(structure.xyz, structure.direction))
    centre = centre_of_mass(about_origin)
    R = rigid_motions(structure.xyz, structure.direction, centre)
    mass = rigid_mass(M, R)
    diagonal = np.diag(mass)
    if diagonal.min() <= 0.0:
        axis = NAMES[int(diagonal.argmin())]
        what = f"the mass of the body against a rigid motion {axis} is {diagonal.min():g}"
        raise DataError(Problem("no_mass", "M", what, "Give M of the whole body, with its densities"))
    try:
        upper = cholesky(mass / np.sqrt(np.outer(diagonal, diagonal)))
    except np.linalg.LinAlgError:
        what = "the mass matrix of rigid motions is not positive definite"
        raise DataError(Problem("no_mass", "M", what, "Give M of the whole body, with its densities")) from None
    return np.asarray(solve_triangular(upper, (R / np.sqrt(diagonal)).T, trans="T").T)


def _refuse_grounded(structure: Structure, rigid: Floats) -> None:
    """Refuse a K that resists rigid motions: the body is held, or rows and matrix do not belong together."""
    force, terms = np.abs(structure.K @ rigid), abs(structure.K) @ np.abs(rigid)
    most = terms.max(axis=1, keepdims=True)  # a motion may leave a row alone, but for the last digits of a place
    share = np.divide(force, most, out=np.zeros_like(force), where=most > 0.0)
    row, motion = np.unravel_index(int(share.argmax()), share.shape)
    if share[row, motion] > GROUNDED:
        where = f"K: {row_name(structure, int(row))}"
        what = f"the body resists a rigid motion here ({share[row, motion]:.2g} of the terms of its row are left)"
        remedy = "Give K of the free body, without supports, its units, and what its rows are in their order"
        raise DataError(Problem("grounded", where, what, remedy))


def _refuse_parts(structure: Structure) -> None:
    """Refuse a body whose nodes K does not join to one."""
    nodes, number = np.unique(structure.node, return_inverse=True)
    row, column = structure.K.nonzero()
    links = sparse.coo_array((np.ones(row.size, dtype=np.bool_), (number[row], number[column])), (nodes.size,) * 2)
    parts, of_node = connected_components(links, directed=False)
    if parts == 1:
        return
    size = np.bincount(of_node)
    least = int(size.argmin())
    what = f"the body is in {parts} parts that nothing joins, and the one of this node has {size[least]} of its nodes"
    remedy = "Connect it to the body, or leave it out of the model"
    raise DataError(Problem("mechanism", f"K: node {nodes[of_node == least][0]}", what, remedy))


def _without_stiffness(structure: Structure, row: int, diagonal: float) -> Problem:
    what = f"its stiffness is {diagonal:g}, so nothing holds it"
    remedy = "Connect the node, or leave its row out of K and M"
    return Problem("mechanism", f"K: {row_name(structure, row)}", what, remedy)


def _mechanism(structure: Structure, row: int) -> Problem:
    what = "a part of the body moves freely here: it hangs on nothing, or on a hinge"
    remedy = "Connect it to the body, or leave it out of the model"
    return Problem("mechanism", f"K: {row_name(structure, int(row))}", what, remedy)
