"""Columns of nodes through the thickness of a solid plate: at each station they collapse to one force and one moment.

A shell gives a force and a moment at a node of the line; a brick gives forces alone, at every node through the
thickness. Summed, with their levers about mid-thickness, ``F = sum_k F_k`` and ``M = sum_k M_k + (x_k - x_mid) x F_k``
are the consistent nodal forces of ``f(s) = int sigma dz`` and ``m(s) = int z sigma dz`` on the line: exactly so for any
sigma(s, z) and any number of uneven layers, with linear edges for 8-node bricks and parabolic ones for 20-node bricks.
So ``A f = F`` and ``A m = M`` serve as for shells (Dong, Int. J. Fatigue 23 (2001) 865).
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from fatigue.weld.line import NODE_COLUMNS, LineStack, Vectors, WeldLine


@dataclass(frozen=True, slots=True, eq=False)
class Columns:
    """The nodes through the thickness at n stations, N in all.

    Attributes
    ----------
    begin : (n + 1,) position of each station's first node, and N
    node : (N,) node ids; a station of a shell is a column of its own node
    xyz : (N, 3) coordinates [mm]
    """

    begin: NDArray[np.int64]
    node: NDArray[np.int64]
    xyz: Vectors

    @property
    def station(self) -> NDArray[np.int64]:
        """Which station each node belongs to, (N,)."""
        return np.repeat(np.arange(self.begin.size - 1), np.diff(self.begin))

    def of(self, station: int) -> NDArray[np.int64]:
        """Node ids of one station."""
        return self.node[self.begin[station] : self.begin[station + 1]]


@dataclass(frozen=True, slots=True, eq=False)
class SolidWeld:
    """The columns of one weld: ``station``, (n,), are the nodes of its line, ascending, and ``columns`` theirs."""

    station: NDArray[np.int64]
    columns: Columns


def columns_at(line: WeldLine, weld: SolidWeld | None) -> Columns:
    """Columns at the stations of a line or a part of it; without columns, the line of a shell, its own nodes."""
    if weld is None:
        return Columns(np.arange(line.node.size + 1), line.node, line.xyz)
    at = np.searchsorted(weld.station, line.node)
    first, size = weld.columns.begin[at], np.diff(weld.columns.begin)[at]
    begin = np.append(0, np.cumsum(size))
    rows = np.arange(begin[-1]) + np.repeat(first - begin[:-1], size)
    return Columns(begin, weld.columns.node[rows], weld.columns.xyz[rows])


def columns_of(lines: LineStack, welds: Mapping[str, SolidWeld]) -> Columns:
    """Columns at the stations of all lines of a stack, shells among them."""
    found = [columns_at(line, welds.get(line.weld)) for line in lines]
    sizes = np.concatenate([np.diff(one.begin) for one in found])
    return Columns(
        begin=np.append(0, np.cumsum(sizes)),
        node=np.concatenate([one.node for one in found]),
        xyz=np.concatenate([one.xyz for one in found]),
    )


def unfolded(lines: LineStack, columns: Columns) -> LineStack:
    """Lines with every node of the columns in place of its station: what a table of forces at those nodes is about."""
    nodes = {name: getattr(lines, name)[columns.station] for name in NODE_COLUMNS}
    return replace(lines, **(nodes | {"node": columns.node, "xyz": columns.xyz, "begin": columns.begin[lines.begin]}))


def collapsed(columns: Columns, mid: Vectors, forces: NDArray[np.floating]) -> NDArray[np.float64]:
    """Force and moment about ``mid``, (n, 3), of each column, (n, m, 6), from those at its nodes, (N, m, 6) [N, N mm].

    The sum is in double precision, since the forces of a column in bending all but cancel.

    Examples
    --------
    A column of three nodes, 10 mm thick, under a traction across the line that varies linearly from 1 MPa at the bottom
    to 3 MPa at the top, 6 mm wide: 120 N of force, and -100 N mm of moment, which is ``-sigma_b t^2 / 6`` per mm.

    >>> columns = Columns(np.array([0, 3]), np.array([1, 2, 3]), np.array([[0, 0, -5.0], [0, 0, 0], [0, 0, 5.0]]))
    >>> forces = np.zeros((3, 1, 6))
    >>> forces[:, 0, 1] = 6 * 5 / 6 * np.array([2 * 1 + 2, 1 + 4 * 2 + 3, 2 + 2 * 3])
    >>> collapsed(columns, np.zeros((1, 3)), forces)[0, 0].round(9).tolist()
    [0.0, 120.0, 0.0, -100.0, 0.0, 0.0]
    """
    forces = forces.astype(np.float64, copy=True)
    lever = (columns.xyz - mid[columns.station])[:, np.newaxis]
    forces[..., 3:] += np.cross(lever, forces[..., :3])
    return np.asarray(np.add.reduceat(forces, columns.begin[:-1], axis=0))
