"""From nodal forces along a weld line to the line load, and its treatment at weld ends.

The work-equivalent nodal forces of a line load f(s) interpolated like the edges are ``F_i = int N_i f ds``, hence
``A f = F`` with ``A_ij = int N_i N_j ds`` (Dong, Int. J. Fatigue 23 (2001) 865; Dong & Hong 2003; ASME VIII-2 Annex
5-A). The system is solved in global axes, once for all components and modes: rotating nodal forces into local axes
first would lose a factor on curved lines.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solveh_banded
from scipy.sparse import csr_array

from fatigue.weld.line import (
    GAUSS_POINT,
    GAUSS_WEIGHT,
    WeldLine,
    arc_length,
    edge_derivative,
    edge_nodes,
    edge_points,
)


def line_load_matrix(line: WeldLine) -> csr_array:
    """Consistent matrix A of ``A f = F``, (n, n) [mm], for linear and parabolic, straight and curved edges."""
    nodes = edge_nodes(line)
    shape = _shape_functions(nodes, GAUSS_POINT)
    ds = np.linalg.norm(edge_derivative(edge_points(line), GAUSS_POINT), axis=-1) * GAUSS_WEIGHT
    blocks = (shape * ds[..., np.newaxis]).swapaxes(1, 2) @ shape
    at = _with_dummy_mid(nodes)
    row, column = np.broadcast_arrays(at[:, :, np.newaxis], at[:, np.newaxis, :])
    n = line.node.size
    return csr_array((blocks.ravel(), (row.ravel(), column.ravel())), shape=(n, n))


def line_load(line: WeldLine, nodal: NDArray[np.floating]) -> NDArray[np.float64]:
    """Solve ``A f = F`` for the line load, (n, ...) [N/mm or N], of nodal forces or moments, (n, ...) [N or N mm].

    A is symmetric, positive definite, banded and, scaled to a unit diagonal, has eigenvalues in [0.5, 1.5] for any
    spacing: a plain banded Cholesky factorisation needs no regularisation.
    """
    n = line.node.size
    place = _folded(n) if line.closed else np.arange(n)
    matrix = line_load_matrix(line).tocoo()
    row, column = place[matrix.row], place[matrix.col]
    above = column - row
    width = above.max()
    upper = above >= 0
    band = np.zeros((width + 1, n))
    band[width - above[upper], column[upper]] = matrix.data[upper]
    right_sides = np.empty((n, nodal[0].size))
    right_sides[place] = nodal.reshape(n, -1)
    solution: NDArray[np.float64] = solveh_banded(band, right_sides, overwrite_ab=True, overwrite_b=True)[place]
    return solution.reshape(nodal.shape)


@dataclass(frozen=True, slots=True, eq=False)
class EndTreatment:
    """A line load with its weld ends treated.

    Attributes
    ----------
    value : (n, ...) line load, in the end zones replaced by its mean over the zone [N/mm or N]
    at_end : (n,) within the zone of a weld end; the end node itself also where nothing is treated
    unresolved : (n,) end node whose edge is longer than the zone
    """

    value: NDArray[np.float64]
    at_end: NDArray[np.bool_]
    unresolved: NDArray[np.bool_]


def treat_ends(line: WeldLine, load: NDArray[np.float64]) -> EndTreatment:
    """Replace the line load, (n, ...), near the ends of an open line by its mean over the end zone.

    The plate solution is singular at a weld end, and at a corner, so the value there grows under mesh refinement while
    its mean over a fixed length ``a`` does not. ``a`` is the line's end length, the plate thickness by default, and
    at most half the line; nodes with s <= a take the mean over [0, a], the node in the middle that lies in both
    zones the mean of both.
    """
    at_end, unresolved = np.zeros((2, line.node.size), dtype=bool)
    if line.closed:
        return EndTreatment(load, at_end, unresolved)
    s = arc_length(line)
    total = s[-1]
    wanted = line.thickness[[0, -1]] if line.end_length is None else np.full(2, line.end_length)
    zone_length = np.minimum(wanted, total / 2)
    to_zone, to_other, to_end = _integral_weights(line, s, np.array([zone_length[0], total - zone_length[1], total]))
    first, _, last = edge_nodes(line).T
    edge = s[last] - s[first]
    sum_of_means, zones = np.zeros_like(load), np.zeros(line.node.size)
    for end, a, weights, is_corner in (
        (0, zone_length[0], to_zone, line.corner_start),
        (-1, zone_length[1], to_end - to_other, line.corner_end),
    ):
        zone = np.abs(s - s[end]) <= a + 1e-9 * total
        if not is_corner:
            at_end |= zone
        if a > 0:
            sum_of_means[zone] += np.tensordot(weights / a, load, axes=1)
            zones += zone
            unresolved[end] = edge[end] > a * (1 + 1e-9)
    value = load.copy()
    treated = zones > 0
    value[treated] = sum_of_means[treated] / zones[treated].reshape(-1, *[1] * (load.ndim - 1))
    return EndTreatment(value, at_end, unresolved)


def _shape_functions(nodes: NDArray[np.int64], xi: NDArray[np.float64]) -> NDArray[np.float64]:
    """Shape functions of each edge at ``xi``, (g,) or (..., e, g), as (..., e, g, 3); zero for a missing mid node."""
    parabolic = np.stack([xi * (xi - 1) / 2, 1 - xi**2, xi * (xi + 1) / 2], axis=-1)
    linear = np.stack([(1 - xi) / 2, np.zeros_like(xi), (1 + xi) / 2], axis=-1)
    return np.where((nodes[:, 1] >= 0)[:, np.newaxis, np.newaxis], parabolic, linear)


def _with_dummy_mid(nodes: NDArray[np.int64]) -> NDArray[np.int64]:
    """Edge nodes with a valid place for the mid node of a linear edge, whose shape function is zero."""
    return np.where(nodes < 0, nodes[:, :1], nodes)


def _folded(n: int) -> NDArray[np.int64]:
    """Place of each ring node when the ring is pressed flat (0, n-1, 1, n-2, ...): a cyclic matrix becomes banded."""
    at = np.arange(n)
    return np.where(2 * at < n, 2 * at, 2 * (n - at) - 1)


def _integral_weights(line: WeldLine, s: NDArray[np.float64], stops: NDArray[np.float64]) -> NDArray[np.float64]:
    """Weights w, (k, n) [mm], for which ``w @ f`` are the integrals of f over the arc length from 0 to each stop."""
    nodes, points = edge_nodes(line), edge_points(line)
    half = (_local_coordinates(points, stops[:, np.newaxis] - s[nodes[:, 0]])[..., np.newaxis] + 1) / 2
    xi = half * (GAUSS_POINT + 1) - 1
    ds = np.linalg.norm(edge_derivative(points, xi), axis=-1) * half * GAUSS_WEIGHT
    integral = np.einsum("keg,kegi->eik", ds, _shape_functions(nodes, xi))
    weights = np.zeros((line.node.size, stops.size))
    np.add.at(weights, _with_dummy_mid(nodes), integral)
    return weights.T


def _local_coordinates(points: NDArray[np.float64], s: NDArray[np.float64]) -> NDArray[np.float64]:
    """Local coordinate xi, (k, e), of the arc length ``s``, (k, e), from each edge's first node, within [-1, 1]."""
    whole = _arc_to(points, np.ones(len(points)))
    wanted = np.clip(s, 0, whole)
    xi = 2 * wanted / whole - 1  # exact on straight edges with a central mid node; Newton's method mends the others
    for _ in range(20):
        speed = np.linalg.norm(edge_derivative(points, xi[..., np.newaxis]), axis=-1)[..., 0]
        change = (wanted - _arc_to(points, xi)) / speed
        xi = np.clip(xi + change, -1, 1)
        if np.abs(change).max() < 1e-14:
            break
    return xi


def _arc_to(points: NDArray[np.float64], xi: NDArray[np.float64]) -> NDArray[np.float64]:
    """Arc length [mm] of each edge from its first node to the local coordinates ``xi``, (..., e)."""
    half = (xi[..., np.newaxis] + 1) / 2
    speed = np.linalg.norm(edge_derivative(points, half * (GAUSS_POINT + 1) - 1), axis=-1)
    arc: NDArray[np.float64] = (speed * half) @ GAUSS_WEIGHT
    return arc
