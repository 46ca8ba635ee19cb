"""Which edges of the skin of a solid mesh may be weld toes: those where two free faces meet re-entrantly.

The material takes more than 180 degrees there: base plate and weld face, base plate and attached plate. A rounded
transition whose faces turn by less than 30 degrees from one to the next is no toe.
"""

import numpy as np

from fatigue.weld.detection import SMOOTH_DEG, Key, Topology

TOE = "solid_toe"
"""Kind of the lines that are found."""


def toes(topo: Topology) -> dict[int, Key]:
    """Kind and properties of every re-entrant edge of a skin, turned by more than 30 degrees."""
    pair = np.flatnonzero(np.diff(topo.first) == 2)
    a, b = topo.sides[topo.first[pair]], topo.sides[topo.first[pair] + 1]
    rises = np.einsum("ij,ij->i", topo.inward[a], topo.normal[b // 4])
    across = np.einsum("ij,ij->i", topo.inward[a], topo.inward[b])
    where = (rises > 0) & (across > -np.cos(np.radians(SMOOTH_DEG)))
    pid = topo.mesh.pid
    return {
        int(edge): (TOE, tuple(sorted((int(pid[p // 4]), int(pid[q // 4])))))
        for edge, p, q in zip(pair[where], a[where], b[where], strict=True)
    }
