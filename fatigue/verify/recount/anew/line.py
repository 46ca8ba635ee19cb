"""Structural stress along a weld line once more: dense matrices, edge by edge, all in plain loops.

Dong, Int. J. Fatigue 23 (2001) 865; ASME VIII-2 5.5.5.2: the line load f with ``F_i = int N_i f ds``, solved in global
axes, then ``sigma_m = f_y'/t``, ``sigma_b = -6 m_x'/t^2`` in the local axes of each node.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

Floats = NDArray[np.float64]

POINTS, WEIGHTS = np.polynomial.legendre.leggauss(20)
CORNER_DEG = 30.0 + 1e-6  # a 12-gon, which turns by 30 degrees, is a smooth ring


@dataclass(frozen=True, slots=True, eq=False)
class Line:
    """A weld line, or a part of one between kinks; the fields mean what the columns of ``weld_nodes`` mean.

    ``end_length`` is None where the plate thickness decides; ``corner_ends`` tells whether start and end are kinks.
    """

    weld: str
    part: int
    order: NDArray[np.int64]
    node: NDArray[np.int64]
    xyz: Floats
    thickness: Floats
    normal: Floats
    outward: Floats
    edge_mid: NDArray[np.bool_]
    closed: bool
    end_length: float | None
    corner_ends: tuple[bool, bool] = (False, False)


@dataclass(frozen=True, slots=True, eq=False)
class RecountLineStress:
    """Stress of a line per unit modal coordinate.

    ``raw`` and ``treated`` are (n, m, 5) [MPa]: membrane, bending, in-plane shear, twist shear, transverse shear.
    """

    line: Line
    arc_length: Floats
    raw: Floats
    treated: Floats
    at_end: NDArray[np.bool_]
    at_corner: NDArray[np.bool_]
    summed_corner: NDArray[np.bool_]


def line_stress(line: Line, forces: Floats) -> RecountLineStress:
    """Stress of a line for all modes; ``forces`` is (n, m, 6) [N, N mm] on the assessed elements, global axes."""
    n = len(line.node)
    load: Floats = np.asarray(np.linalg.solve(mass_matrix(line), forces.reshape(n, -1))).reshape(forces.shape)
    treated, at_end = treat_ends(line, load)
    summed_corner = kinks(line) > CORNER_DEG
    at_corner = summed_corner.copy()
    at_corner[[0, -1]] |= line.corner_ends
    solved, with_ends = _stress(line, load), _stress(line, treated)
    return RecountLineStress(line, arc_length(line), solved, with_ends, at_end, at_corner, summed_corner)


def edges(line: Line) -> list[list[int]]:
    """Positions of the nodes of each edge, two of a linear and three of a parabolic one."""
    n = len(line.node)
    corner = [i for i in range(n) if not line.edge_mid[i]]
    found = [list(range(a, b + 1)) for a, b in pairwise(corner)]
    if line.closed:
        found.append([i % n for i in range(corner[-1], corner[0] + n + 1)])
    return found


def mass_matrix(line: Line) -> Floats:
    """Consistent matrix ``A_ij = int N_i N_j ds``, (n, n) [mm]."""
    matrix = np.zeros((len(line.node), len(line.node)))
    for edge in edges(line):
        N, ds = integrand(line.xyz[edge], -1.0, 1.0)
        matrix[np.ix_(edge, edge)] += N.T @ (N * ds[:, None])
    return matrix


def integrand(xyz: Floats, low: float, high: float) -> tuple[Floats, Floats]:
    """Shape functions (g, k) and line elements ds (g,) at the Gauss points of an edge between two local coordinates."""
    xi = 0.5 * (low + high) + 0.5 * (high - low) * POINTS
    if len(xyz) == 2:
        N, dN = np.stack([1 - xi, 1 + xi], 1) / 2, np.array([[-0.5, 0.5]])
    else:
        N = np.stack([xi * (xi - 1) / 2, 1 - xi**2, xi * (xi + 1) / 2], 1)
        dN = np.stack([xi - 0.5, -2 * xi, xi + 0.5], 1)
    return N, np.linalg.norm(dN @ xyz, axis=1) * 0.5 * (high - low) * WEIGHTS


def edge_length(xyz: Floats, high: float = 1.0, low: float = -1.0) -> float:
    """Length of an edge between two local coordinates [mm]."""
    return float(integrand(xyz, low, high)[1].sum())


def arc_length(line: Line) -> Floats:
    """Distance of each node from the first along the line, (n,) [mm]."""
    steps = np.zeros(len(line.node))
    for edge in edges(line):
        xyz = line.xyz[edge]
        if len(edge) == 2:
            steps[edge[0]] = edge_length(xyz)
        else:
            steps[edge[0]], steps[edge[1]] = edge_length(xyz, 0.0), edge_length(xyz, 1.0, 0.0)
    return np.concatenate([[0.0], np.cumsum(steps)[:-1]])


def edge_directions(line: Line) -> list[list[Floats]]:
    """Unit tangents at each node of the one or two edges that meet there."""
    meeting: list[list[Floats]] = [[] for _ in line.node]
    for edge in edges(line):
        xyz = line.xyz[edge]
        for at, xi in zip(edge, np.linspace(-1.0, 1.0, len(edge)), strict=True):
            dN = [-0.5, 0.5] if len(edge) == 2 else [xi - 0.5, -2 * xi, xi + 0.5]
            meeting[at].append(_unit(dN @ xyz))
    return meeting


def kinks(line: Line) -> Floats:
    """Angle by which the line turns at each node, (n,) [deg]."""
    turn = [
        0.0 if len(t) == 1 else np.degrees(np.arctan2(np.linalg.norm(np.cross(t[0], t[1])), t[0] @ t[1]))
        for t in edge_directions(line)
    ]
    return np.array(turn)


def treat_ends(line: Line, load: Floats) -> tuple[Floats, NDArray[np.bool_]]:
    """Line load with its mean over the end zones there, and the nodes in the zone of a weld end."""
    at_end = np.zeros(len(line.node), dtype=bool)
    if line.closed:
        return load, at_end
    s = arc_length(line)
    zones: list[list[Floats]] = [[] for _ in line.node]
    for end, is_corner in zip((0, -1), line.corner_ends, strict=True):
        a = min(line.thickness[end] if line.end_length is None else line.end_length, s[-1] / 2)
        inside = np.flatnonzero(np.abs(s - s[end]) <= a + 1e-9 * s[-1])
        at_end[inside] |= not is_corner
        if a > 0:
            mean = _mean_over(line, load, a, from_start=end == 0)
            for i in inside:
                zones[i].append(mean)
    treated = np.array([np.mean(zone, axis=0) if zone else own for zone, own in zip(zones, load, strict=True)])
    return treated, at_end


def _mean_over(line: Line, load: Floats, a: float, *, from_start: bool) -> Floats:
    """Mean of the line load over the length ``a`` from one end, by quadrature over the edges."""
    total, left = np.zeros_like(load[0]), a
    for edge in edges(line) if from_start else [edge[::-1] for edge in reversed(edges(line))]:
        xyz = line.xyz[edge]
        length = edge_length(xyz)
        high = 1.0
        if left < length:
            high = brentq(lambda xi, xyz=xyz, left=left: edge_length(xyz, xi) - left, -1.0, 1.0, xtol=1e-15)
        N, ds = integrand(xyz, -1.0, high)
        total += np.tensordot(ds @ N, load[edge], axes=1)
        left -= length
        if left <= 0:
            break
    return np.asarray(total / a)


def _stress(line: Line, load: Floats) -> Floats:
    """Five stress components at each node, (n, m, 5), of the load (n, m, 6) in global axes."""
    z = [_unit(v) for v in line.normal]
    across = [_unit(np.cross(a, sum(t))) for a, t in zip(z, edge_directions(line), strict=True)]
    side = np.sign(sum(_unit(o) @ a for o, a in zip(line.outward, across, strict=True)))
    stress = np.empty((*load.shape[:2], 5))
    for i, t in enumerate(line.thickness):
        y = side * across[i]
        x = np.cross(y, z[i])
        f, m = load[i, :, :3], load[i, :, 3:]
        stress[i] = np.stack([f @ y / t, -6 * (m @ x) / t**2, f @ x / t, 6 * (m @ y) / t**2, f @ z[i] / t], axis=1)
    return stress


def _unit(vector: Floats) -> Floats:
    return np.asarray(vector / np.linalg.norm(vector))
