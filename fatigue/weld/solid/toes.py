"""Which edges of the skin of a solid mesh may be weld toes: those where two free faces meet re-entrantly.

The material takes more than 180 degrees there: base plate and weld face, base plate and attached plate. A rounded
transition whose faces turn by no more than 30 degrees from one to the next is no toe; nor is an edge in a coarser
round, of a bore or a notch, where the surface turns as much at the next edge on either side.
"""

import numpy as np
from numpy.typing import NDArray

from fatigue.weld.detection import SMOOTH_DEG, Key, Topology
from fatigue.weld.line_geometry import KINK_TOLERANCE
from fatigue.weld.mesh import NONE

TOE = "solid_toe"
"""Kind of the lines that are found."""

_ALIKE_DEG = 5.0


def toes(topo: Topology) -> dict[int, Key]:
    """Kind and properties of every re-entrant edge of a skin, turned by more than 30 degrees."""
    turn = _turns(topo)
    edges = np.flatnonzero(turn > SMOOTH_DEG + KINK_TOLERANCE)
    edges = edges[~_in_a_round(topo, edges, turn)]
    a, b = topo.sides[topo.first[edges]], topo.sides[topo.first[edges] + 1]
    pid = topo.mesh.pid
    return {
        int(edge): (TOE, tuple(sorted((int(pid[p // 4]), int(pid[q // 4])))))
        for edge, p, q in zip(edges, a, b, strict=True)
    }


def _turns(topo: Topology) -> NDArray[np.float64]:
    """Angle beyond 180 degrees that the material takes at every edge, (k,) [deg]; 0 where it takes less."""
    pair = np.flatnonzero(np.diff(topo.first) == 2)
    a, b = topo.sides[topo.first[pair]], topo.sides[topo.first[pair] + 1]
    rises = np.einsum("ij,ij->i", topo.inward[a], topo.normal[b // 4])
    across = np.einsum("ij,ij->i", topo.inward[a], topo.inward[b])
    turn = np.zeros(len(topo.ends))
    turn[pair] = np.where(rises > 0, 180.0 - np.degrees(np.arccos(np.clip(across, -1.0, 1.0))), 0.0)
    return turn


def _in_a_round(topo: Topology, edges: NDArray[np.int64], turn: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Whether the surface turns by the same angle at the next edge on either side, (e,)."""
    alike = np.ones(edges.size, bool)
    for k in (0, 1):
        side = topo.sides[topo.first[edges] + k]
        triangle = topo.mesh.corner[side // 4, 3] == NONE
        following = topo.edge[side // 4 * 4 + (side % 4 + 2) % 4]
        alike &= ~triangle & (np.abs(turn[following] - turn[edges]) < _ALIKE_DEG)
    return alike
