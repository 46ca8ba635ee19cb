"""Solid meshes of joints: blocks of hexahedra and wedges joined where their nodes coincide, and their decks."""

from collections.abc import Callable, Sequence
from itertools import pairwise, product

import numpy as np

from fatigue.readers.foreign.fe.model import Solid, solid_mesh
from fatigue.weld.solid.mesh import SolidMesh

_HEXA = ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))
_HEXA_EDGES = (
    *((0, 1), (1, 2), (2, 3), (3, 0)),
    *((0, 4), (1, 5), (2, 6), (3, 7)),
    *((4, 5), (5, 6), (6, 7), (7, 4)),
)
_PENTA_EDGES = (*((0, 1), (1, 2), (2, 0)), *((0, 3), (1, 4), (2, 5)), *((3, 4), (4, 5), (5, 3)))


class Solids:
    """Solids that grow: corners by their places, merged."""

    def __init__(self) -> None:
        self.place: dict[tuple[float, ...], int] = {}
        self.elements: list[tuple[int, list[int]]] = []

    def node(self, xyz: Sequence[float]) -> int:
        """Give the id of the node at a place."""
        return self.place.setdefault(tuple(np.round(np.asarray(xyz, float), 6) + 0.0), len(self.place) + 1)

    def block(self, x, y, z, pid: int = 1) -> "Solids":
        """Add hexahedra between planes."""
        for (x0, x1), (y0, y1), (z0, z1) in product(pairwise(x), pairwise(y), pairwise(z)):
            ends = ((x0, x1), (y0, y1), (z0, z1))
            self.elements.append((pid, [self.node([ends[k][c[k]] for k in range(3)]) for c in _HEXA]))
        return self

    def wedges(self, x, corners, pid: int = 1) -> "Solids":
        """Add pentahedra along x of the triangle (y, z) of three ``corners``."""
        for x0, x1 in pairwise(x):
            self.elements.append((pid, [self.node((x, *c)) for x in (x0, x1) for c in corners]))
        return self

    def mesh(
        self,
        parabolic: bool = False,
        move: Callable[[np.ndarray], np.ndarray] = lambda xyz: xyz,
        renumber: Callable[[int], int] = lambda n: n,
    ) -> SolidMesh:
        """Give the solid mesh, moved and renumbered."""
        grids, solids = self.parts(parabolic, move, renumber)
        found = solid_mesh("mesh", grids, solids, [])
        assert found is not None
        return found

    def parts(self, parabolic=False, move=lambda xyz: xyz, renumber=lambda n: n):
        """Give grids by id and solids."""
        xyz = {n: np.array(place) for place, n in self.place.items()}
        middle: dict[frozenset, int] = {}
        solids = []
        for number, (pid, corners) in enumerate(self.elements, 1):
            mids = []
            for a, b in (_HEXA_EDGES if len(corners) == 8 else _PENTA_EDGES) if parabolic else ():
                key = frozenset((corners[a], corners[b]))
                if key not in middle:
                    middle[key] = len(xyz) + 1
                    xyz[middle[key]] = (xyz[corners[a]] + xyz[corners[b]]) / 2
                mids.append(middle[key])
            solids.append(Solid(number, pid, tuple(renumber(n) for n in corners), tuple(renumber(n) for n in mids)))
        return {renumber(n): move(place) for n, place in xyz.items()}, solids


def tee(z=(0.0, 3.0, 10.0), wedge: float = 0.0, x=(0.0, 10.0, 25.0, 40.0)) -> Solids:
    """A base plate of 10 mm in uneven layers, 40 x 60 mm, with an upright of 6 mm along x, welds of ``wedge`` mm."""
    y = [0.0, 10.0, 20.0, 27.0 - wedge, 27.0, 30.0, 33.0, 33.0 + wedge, 40.0, 50.0, 60.0]
    y = sorted(set(y))
    top = z[-1]
    model = Solids().block(x, y, z, 1)
    model.block(x, [27.0, 30.0, 33.0], [top, *([top + wedge] if wedge else []), top + 12.0, top + 24.0], 2)
    if wedge:
        model.wedges(x, ((27.0 - wedge, top), (27.0, top), (27.0, top + wedge)), 3)
        model.wedges(x, ((33.0, top), (33.0 + wedge, top), (33.0, top + wedge)), 3)
    return model


def deck(solids: Solids, parabolic=False, extra: str = "", **parts) -> str:
    """Bulk data of the solids, mid-side grids in continuations."""
    grids, found = solids.parts(parabolic, **parts)
    lines = ["BEGIN BULK"]
    lines += [f"GRID,{n},,{x[0]:.9g},{x[1]:.9g},{x[2]:.9g}" for n, x in grids.items()]
    for solid in found:
        name = "CHEXA" if len(solid.corners) == 8 else "CPENTA"
        fields = [name, solid.element, solid.pid, *solid.corners, *(n or "" for n in solid.mids)]
        rows = [fields[:9], *(["", *fields[k : k + 8]] for k in range(9, len(fields), 8))]
        lines += [",".join(map(str, row)) for row in rows]
    lines += [f"PSOLID,{pid},1" for pid in sorted({solid.pid for solid in found})]
    return "\n".join([*lines, extra, "ENDDATA", ""])
