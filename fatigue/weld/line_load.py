"""From nodal forces along a weld line to the line load, and its treatment at weld ends.

The work-equivalent nodal forces of a line load f(s) interpolated like the edges are ``F_i = int N_i f ds``, hence
``A f = F`` with ``A_ij = int N_i N_j ds`` (Eq. 1; Dong, Int. J. Fatigue 23 (2001) 865; Dong & Hong 2003; ASME VIII-2
Annex 5-A). The system is solved in global axes, once for all components and modes: rotating nodal forces into local
axes first would lose a factor on curved lines.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array, vstack

from fatigue.weld.banded import solve_banded
from fatigue.weld.line import Lines, end_lengths, is_closed, line_of_node
from fatigue.weld.line_geometry import GAUSS_POINT, GAUSS_WEIGHT, arc_length, edge_derivative, edge_nodes, edge_points


def line_load_matrix(line: Lines) -> csr_array:
    """Consistent matrix A of ``A f = F``, (n, n) [mm], for linear and parabolic, straight and curved edges.

    It is assembled from the edge matrices of Eq. 2; see ``line_load`` for an example.
    """
    nodes = edge_nodes(line)
    shape = _shape_functions(nodes, GAUSS_POINT)
    ds = np.linalg.norm(edge_derivative(edge_points(line), GAUSS_POINT), axis=-1) * GAUSS_WEIGHT
    blocks = (shape * ds[..., np.newaxis]).swapaxes(1, 2) @ shape
    at = _with_dummy_mid(nodes)
    row, column = np.broadcast_arrays(at[:, :, np.newaxis], at[:, np.newaxis, :])
    n = line.node.size
    matrix = csr_array((blocks.ravel(), (row.ravel(), column.ravel())), shape=(n, n))
    matrix.sum_duplicates()  # nodes that edges share; scipy 1.13.0 leaves them apart
    return matrix


def line_load(line: Lines, nodal: NDArray[np.floating]) -> NDArray[np.float64]:
    """Line load f, (n, ...) [N/mm or N], of nodal forces or moments F, (n, ...) [N or N mm], by ``A f = F`` (Eq. 1).

    A is symmetric, positive definite, banded and, scaled to a unit diagonal, has eigenvalues in [0.5, 1.5] for any
    spacing: a plain banded factorisation needs no regularisation. What is returned is contiguous.

    Examples
    --------
    Two linear edges of 10 mm, the edge matrix of Eq. 2, and the nodal forces of a load that grows to 100 N/mm:

    >>> from fatigue.weld.line import WeldLine
    >>> number = np.arange(3)
    >>> line = WeldLine(
    ...     weld="toe", part=1, order=number, node=number, xyz=10.0 * np.outer(number, [1, 0, 0]),
    ...     thickness=np.full(3, 8.0), normal=np.tile([0, 0, 1], (3, 1)), outward=np.tile([0, 1, 0], (3, 1)),
    ...     edge_mid=np.zeros(3, dtype=bool), closed=False, end_length=None,
    ... )
    >>> A = line_load_matrix(line)
    >>> (A.toarray() * 6 / 10).round(9)
    array([[2., 1., 0.],
           [1., 4., 1.],
           [0., 1., 2.]])
    >>> F = A @ [0.0, 50.0, 100.0]
    >>> F.round(3)
    array([ 83.333, 500.   , 416.667])
    >>> abs(line_load(line, F) - [0.0, 50.0, 100.0]).max() < 1e-12
    np.True_
    """
    order, right_sides = _band_order(line), np.ascontiguousarray(nodal).reshape(line.node.size, -1)
    load = np.empty(right_sides.shape)
    solve_banded(_band(line_load_matrix(line), order), order, line.begin, right_sides, load)
    return load.reshape(nodal.shape)


@dataclass(frozen=True, slots=True, eq=False)
class EndTreatment:
    """What the treatment of its weld ends makes of a line load.

    Attributes
    ----------
    load : (n, ...) line load as it was solved [N/mm or N]
    treated : (n,) in an end zone, where a mean replaces it
    mean : (z, ...) its mean over the zone at the z treated nodes [N/mm or N]
    at_end : (n,) within the zone of a weld end; the end node itself also where nothing is treated
    unresolved : (n,) end node whose edge is longer than the zone
    """

    load: NDArray[np.float64]
    treated: NDArray[np.bool_]
    mean: NDArray[np.float64]
    at_end: NDArray[np.bool_]
    unresolved: NDArray[np.bool_]

    @property
    def value(self) -> NDArray[np.float64]:
        """Line load with its weld ends treated, (n, ...) [N/mm or N]."""
        value = self.load.copy(order="K")
        value[self.treated] = self.mean
        return value


def treat_ends(line: Lines, load: NDArray[np.float64]) -> EndTreatment:
    """End treatment of a line load, (n, ...): its mean over the end zone replaces it near open ends (Eq. 4).

    The plate solution is singular at a weld end, and at a corner, so the value there grows under mesh refinement while
    its mean over a fixed length ``a`` does not. ``a`` is the line's end length, the plate thickness by default, and
    at most half the line; nodes with s <= a take the mean over [0, a], the node in the middle that lies in both
    zones the mean of both.
    """
    owner, s = line_of_node(line), arc_length(line)
    total = s[line.begin[1:] - 1]
    given = end_lengths(line)
    nodes, points = edge_nodes(line), edge_points(line)
    zones, at_end, unresolved = np.zeros((3, 2, line.node.size), dtype=bool)
    of_means = []
    for side, end, is_corner in (
        (0, line.begin[:-1], np.atleast_1d(line.corner_start)),
        (1, line.begin[1:] - 1, np.atleast_1d(line.corner_end)),
    ):
        a = np.minimum(np.where(np.isnan(given), line.thickness[end], given), total / 2)
        a[is_closed(line)] = -np.inf
        distance = np.abs(s - s[end][owner])
        zone = distance <= (a + 1e-9 * total)[owner]
        at_end[side] = zone & ~is_corner[owner]
        zones[side] = zone & (a > 0)[owner]
        away = slice(None, None, -1 if side else 1)  # edges from the end of the line inwards
        near, far = nodes[:, away][:, 0], nodes[:, away][:, 2]
        of_edge = a[owner[near]]
        last_edge = (near == end[owner[near]]) & (of_edge > 0) & (distance[far] > of_edge * (1 + 1e-9))
        unresolved[side, near[last_edge]] = True
        inside = distance[near] < of_edge
        weights = _integral_weights(nodes[inside, away], points[inside, away], (of_edge - distance[near])[inside])
        of_means.append(_by_line(line, nodes[inside, away], weights / of_edge[inside, np.newaxis]))
    treated: NDArray[np.bool_] = np.logical_or(*zones)
    taken, node = np.nonzero(zones[:, treated])
    share = 1.0 / zones[:, treated].sum(axis=0)[node]
    number = taken * len(given) + owner[treated][node]  # of the mean: those at first ends, then those at last ends
    to_nodes = csr_array((share, (node, number)), (np.count_nonzero(treated), 2 * len(given)))
    mean = to_nodes @ (vstack(of_means) @ load.reshape(line.node.size, -1))
    return EndTreatment(
        load=load,
        treated=treated,
        mean=np.asarray(mean).reshape(-1, *load.shape[1:]),
        at_end=np.logical_or(*at_end),
        unresolved=np.logical_or(*unresolved),
    )


def _band_order(line: Lines) -> NDArray[np.int64]:
    """Nodes in the order in which A is banded: rings are pressed flat (0, n-1, 1, n-2, ...), open lines stay."""
    order = np.arange(line.node.size)
    for i in np.flatnonzero(is_closed(line)):
        ring = order[line.begin[i] : line.begin[i + 1]].copy()
        order[line.begin[i] : line.begin[i + 1] : 2] = ring[: (ring.size + 1) // 2]
        order[line.begin[i] + 1 : line.begin[i + 1] : 2] = ring[: (ring.size - 1) // 2 : -1]
    return order


def _band(matrix: csr_array, order: NDArray[np.int64]) -> NDArray[np.float64]:
    """Diagonals of A in that order as ``solve_banded`` takes them, (n, w + 1)."""
    place, entries = np.argsort(order), matrix.tocoo()
    row = place[entries.row]
    below = row - place[entries.col]
    lower = below >= 0
    band = np.zeros((order.size, below.max() + 1))
    band[row[lower], below[lower]] = entries.data[lower]
    return band


def _shape_functions(nodes: NDArray[np.int64], xi: NDArray[np.float64]) -> NDArray[np.float64]:
    """Shape functions of each edge at ``xi``, (g,) or (..., e, g), as (..., e, g, 3); zero for a missing mid node."""
    parabolic = np.stack([xi * (xi - 1) / 2, 1 - xi**2, xi * (xi + 1) / 2], axis=-1)
    linear = np.stack([(1 - xi) / 2, np.zeros_like(xi), (1 + xi) / 2], axis=-1)
    return np.where((nodes[:, 1] >= 0)[:, np.newaxis, np.newaxis], parabolic, linear)


def _with_dummy_mid(nodes: NDArray[np.int64]) -> NDArray[np.int64]:
    """Edge nodes with a valid place for the mid node of a linear edge, whose shape function is zero."""
    return np.where(nodes < 0, nodes[:, :1], nodes)


def _integral_weights(
    nodes: NDArray[np.int64], points: NDArray[np.float64], s: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Weights of the nodes of each edge, (e, 3) [mm], in the integral from its first node over the arc length ``s``."""
    half = (_local_coordinates(points, s)[:, np.newaxis] + 1) / 2
    xi = half * (GAUSS_POINT + 1) - 1
    ds = np.linalg.norm(edge_derivative(points, xi), axis=-1) * half * GAUSS_WEIGHT
    weights: NDArray[np.float64] = np.einsum("eg,egi->ei", ds, _shape_functions(nodes, xi))
    return weights


def _by_line(line: Lines, nodes: NDArray[np.int64], weights: NDArray[np.float64]) -> csr_array:
    """Weights of the nodes of some edges, ascending, (e, 3) each, in a sum over each line: (k, n)."""
    at = _with_dummy_mid(nodes)
    lines = line.begin.size - 1
    end = 3 * np.cumsum(np.bincount(line_of_node(line)[at[:, 0]], minlength=lines))
    return csr_array((weights.ravel(), at.ravel(), np.append(0, end)), (lines, line.node.size))


def _local_coordinates(points: NDArray[np.float64], s: NDArray[np.float64]) -> NDArray[np.float64]:
    """Local coordinate xi of the arc length ``s`` from each edge's first node, (e,), within [-1, 1]."""
    whole = _arc_to(points, np.ones(len(points)))
    wanted = np.clip(s, 0, whole)
    xi = 2 * wanted / whole - 1  # exact on straight edges with a central mid node; Newton's method mends the others
    for _ in range(20):
        speed = np.linalg.norm(edge_derivative(points, xi[..., np.newaxis]), axis=-1)[..., 0]
        change = (wanted - _arc_to(points, xi)) / speed
        xi = np.clip(xi + change, -1, 1)
        if np.abs(change).max(initial=0) < 1e-14:
            break
    return xi


def _arc_to(points: NDArray[np.float64], xi: NDArray[np.float64]) -> NDArray[np.float64]:
    """Arc length [mm] of each edge from its first node to the local coordinates ``xi``, (..., e)."""
    half = (xi[..., np.newaxis] + 1) / 2
    speed = np.linalg.norm(edge_derivative(points, half * (GAUSS_POINT + 1) - 1), axis=-1)
    arc: NDArray[np.float64] = (speed * half) @ GAUSS_WEIGHT
    return arc
