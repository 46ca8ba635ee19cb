"""Masters of a condensation that are the mean motion of several nodes: a change of coordinates puts them into rows."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.linalg import qr

from fatigue.errors import DataError, Problem
from fatigue.flexbody.mass import rigid_motions
from fatigue.flexbody.structure import Structure

Floats = NDArray[np.float64]

DEPENDENT = 1e-9  # last pivot over the first: motions of points that are no others
LOOSE = 1e-6  # the same of rigid motions


@dataclass(frozen=True, slots=True, eq=False)
class Masters:
    """A structure in coordinates v, ``u = B v``, in which the ``rows`` (n,) are the motions of the masters."""

    structure: Structure
    rows: NDArray[np.bool_]
    B: sparse.csc_array


def masters(structure: Structure, C: Floats, which: str) -> Masters:
    """Coordinates in which the motions ``C u`` (d,) are rows, ``which`` saying whose they are.

    Of the rows that take part as many are replaced as there are motions: ``u_p = C_p^-1 (v_p - C_o u_o)``; a motion of
    one node is a row already. Stiffness and mass become ``B' K B`` and ``B' M B``.

    Raises
    ------
    DataError : some motions follow from others, or all of them together do not hold the body
    """
    _refuse_loose(structure, C, which)
    part = np.flatnonzero(C.any(axis=0))
    _, R, order = qr(C[:, part], mode="economic", pivoting=True)
    pivot = np.abs(np.diag(R))
    if len(pivot) < len(C) or pivot[-1] <= DEPENDENT * pivot[0]:
        what = f"the motions of the {which} points are {len(C)}, and only {int((pivot > DEPENDENT * pivot[0]).sum())} "
        what += "of them are independent"
        remedy = "Take out points whose nodes are those of others"
        raise DataError(Problem("dependent_points", "interface", what, remedy))
    p, o = part[order[: len(C)]], part[order[len(C) :]]
    rows = np.zeros(len(structure.node), dtype=np.bool_)
    rows[p] = True
    if not o.size and np.count_nonzero(C) == len(C):
        return Masters(structure, rows, sparse.csc_array(sparse.eye_array(len(rows))))
    inverse = np.linalg.inv(C[:, p])
    kept = np.flatnonzero(~rows)
    i, j = np.broadcast_arrays(p[:, None], np.concatenate([p, o])[None, :])
    values = np.concatenate([np.ones(kept.size), np.hstack([inverse, -inverse @ C[:, o]]).ravel()])
    at = (np.concatenate([kept, i.ravel()]), np.concatenate([kept, j.ravel()]))
    B = sparse.csc_array(sparse.coo_array((values, at), shape=(len(rows), len(rows))))
    B.eliminate_zeros()
    K, M = (sparse.csc_array(B.T @ matrix @ B) for matrix in (structure.K, structure.M))
    return Masters(replace(structure, K=K, M=M), rows, B)


def _refuse_loose(structure: Structure, C: Floats, which: str) -> None:
    """Refuse masters that leave the body free to move: a condensation holds it at them."""
    centre = structure.xyz.mean(axis=0)
    R = rigid_motions(structure.xyz, structure.direction, centre)
    size = max(float(np.abs(structure.xyz - centre).max()), 1e-300)
    moved = C @ R / np.array([1.0, 1.0, 1.0, size, size, size])
    moved /= np.maximum(np.linalg.norm(moved, axis=1, keepdims=True), 1e-300)  # rotations and displacements alike
    value = np.linalg.svd(moved, compute_uv=False)
    rank = int((value > LOOSE * value[0]).sum())
    if rank < 6:
        what = f"the {which} points hold only {rank} of the 6 rigid motions of the body"
        remedy = "Add points or components, or take --basis residual, which needs none"
        raise DataError(Problem("body_not_held", "interface", what, remedy))
