"""Places of nodes from K alone: a free body moves rigidly without force, and how it moves tells where its nodes are.

One node with all six rows is moved by unit displacements and rotations; the others follow by ``u_s = -K_ss^-1 K_sm``.
Turned by ``theta`` about that node, a node at r moves by ``theta x r``. Source: Craig and Kurdila, Fundamentals of
Structural Dynamics, ch. 17 (constraint modes of a statically determinate support are rigid-body modes).
"""

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import splu

from fatigue.errors import DataError, Problem

Floats = NDArray[np.float64]

REFINED = 3  # times: held at one node a body is a poor support, and places have to be good to rounding
HELD = 1e-6  # of the stiffness of the moved node: what is left of a free body's after it moved rigidly
TURNED = (  # (rotation about, displacement along, coordinate it shows, its sign): theta x r
    *((0, 1, 2, -1.0), (0, 2, 1, 1.0), (1, 0, 2, 1.0)),
    *((1, 2, 0, -1.0), (2, 0, 1, -1.0), (2, 1, 0, 1.0)),
)


def places_by_stiffness(
    K: sparse.csc_array, node: NDArray[np.int64], direction: NDArray[np.int64], file: str
) -> tuple[Floats, int]:
    """Place (n, 3) of each row's node, in the length unit of K, and the node they are measured from.

    Parameters
    ----------
    K : (n, n) stiffness of a free body
    node, direction : (n,) node of each row; 0, 1, 2 displacement along x, y, z, 3, 4, 5 rotation about them
    file : that the rows are from, for messages

    Raises
    ------
    DataError : no node has six rows, the body is held or loose in itself, a node moves along one axis only
    """
    nodes, of_node = np.unique(node, return_inverse=True)
    whole = np.flatnonzero(np.bincount(of_node) == 6)
    if not whole.size:
        raise _untold(file, "no node has all six components, from which places could be found")
    origin = int(nodes[whole[0]])
    rows_of_node = sparse.csr_array((np.ones(len(node)), (of_node, np.arange(len(node)))))
    if connected_components(rows_of_node @ abs(K) @ rows_of_node.T, directed=False)[0] > 1:
        raise _untold(file, "its parts are not joined, so that places cannot be found from K")
    moved = np.flatnonzero(node == origin)
    moved = moved[np.argsort(direction[moved])]
    follows = np.setdiff1d(np.arange(len(node)), moved)
    U = np.zeros((len(node), 6))
    U[moved] = np.eye(6)
    K_ss = sparse.csc_array(K[follows][:, follows])
    pulled = -K[follows][:, moved].toarray()
    try:
        lu = splu(K_ss, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
        U[follows] = lu.solve(pulled)
        for _ in range(REFINED):
            U[follows] += lu.solve(pulled - K_ss @ U[follows])
    except RuntimeError:
        raise _untold(file, "parts of it are loose, so that places cannot be found from K") from None
    left = K[moved] @ U
    if not np.isfinite(U).all() or np.abs(left).max() > HELD * np.abs(K[moved][:, moved].diagonal()).max():
        raise _untold(file, "the body of K is held or loose in itself, so that places cannot be found from it")
    found, times = np.zeros((len(nodes), 3)), np.zeros((len(nodes), 3))
    for about, along, coordinate, sign in TURNED:
        rows = np.flatnonzero(direction == along)
        found[of_node[rows], coordinate] += sign * U[rows, 3 + about]  # a node has each direction once
        times[of_node[rows], coordinate] += 1.0
    if (times == 0.0).any():
        lost = int(nodes[(times == 0.0).any(axis=1)][0])
        raise _untold(file, f"node {lost} has fewer than two displacements, which is too little to find its place")
    return np.asarray((found / times)[of_node]), origin


def _untold(file: str, why: str) -> DataError:
    what = f"nothing says where the nodes are, and {why}"
    remedy = "Give x_mm, y_mm, z_mm here, or a table nodes in the folder"
    return DataError(Problem("missing_column", f"{file}: x_mm, y_mm, z_mm", what, remedy))
