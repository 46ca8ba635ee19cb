"""ANSYS elements as shells and solids, by element routine: degenerate ones are those that their repeated nodes make."""

from collections.abc import Sequence

from fatigue.readers.foreign.fe.model import Shell, Solid

SHELLS = {181: 4, 63: 4, 43: 4, 143: 4, 28: 4, 41: 4, 281: 8, 93: 8, 91: 8, 99: 8}
"""Nodes of shells by element routine."""

SOLIDS = {185: 8, 45: 8, 73: 8, 64: 8, 46: 8, 190: 8, 186: 20, 95: 20, 191: 20, 187: 10, 92: 10, 285: 4, 72: 4}
"""Nodes of solids by element routine."""

SECTIONED = frozenset({181, 281})
"""Shells whose thickness is that of a section; the older ones have real constants."""

# Where ANSYS lists the mid-side nodes, in the order of ``SolidMesh``: bottom, between, top.
_HEXA_MIDS = (8, 9, 10, 11, 16, 17, 18, 19, 12, 13, 14, 15)
# A prism is a brick whose third and fourth corners, and seventh and eighth, are one.
_PENTA_CORNERS = (0, 1, 2, 4, 5, 6)
_PENTA_MIDS = (8, 9, 11, 16, 17, 18, 12, 13, 15)
# A tetrahedron is a prism whose top is one node.
_TETRA_CORNERS = (0, 1, 2, 4)
_TETRA_MIDS = (8, 9, 11, 16, 17, 18)


def element_of(routine: int, element: int, pid: int, nodes: Sequence[int]) -> Shell | Solid | None:
    """Shell or solid of the nodes as ANSYS lists them, 0 for a mid-side node left out.

    None for an element that is neither, or that its repeated nodes make neither: a pyramid, a shell drawn to a line.
    """
    if routine in SHELLS:
        return _shell(element, pid, nodes, SHELLS[routine])
    if routine not in SOLIDS:
        return None
    listed = SOLIDS[routine]
    if listed in (4, 10):
        return Solid(element, pid, tuple(nodes[:4]), tuple(nodes[4:listed]))
    return _brick(element, pid, nodes, listed)


def kind_of(made: Shell | Solid) -> str:
    """Name of an element in force rows."""
    corners = len(made.corners)
    if isinstance(made, Shell):
        return {(4, False): "QUAD4", (3, False): "TRIA3", (4, True): "QUAD8", (3, True): "TRIA6"}[
            (corners, bool(made.mids))
        ]
    return {8: "HEXA", 6: "PENTA", 4: "TETRA"}[corners]


def _shell(element: int, pid: int, nodes: Sequence[int], listed: int) -> Shell | None:
    """Quadrilateral, or a triangle whose third and fourth corners are one."""
    corners, mids = tuple(nodes[:4]), tuple(nodes[4:8]) if listed == 8 else ()
    if len(corners) < 4 or corners[2] == corners[3]:
        corners = corners[:3]
        mids = (*mids[:2], mids[3]) if len(mids) == 4 else mids[:3]
    if len(set(corners)) < len(corners) or 0 in corners:
        return None
    return Shell(element, pid, corners, tuple(n if n not in corners else 0 for n in mids) if any(mids) else ())


def _brick(element: int, pid: int, nodes: Sequence[int], listed: int) -> Solid | None:
    """Hexahedron, or the prism or tetrahedron that its repeated corners make."""
    places: tuple[int, ...] = tuple(range(8))
    mid_places: tuple[int, ...] = _HEXA_MIDS
    if nodes[2] == nodes[3]:
        is_tetra = len(set(nodes[4:8])) == 1
        places, mid_places = (_TETRA_CORNERS, _TETRA_MIDS) if is_tetra else (_PENTA_CORNERS, _PENTA_MIDS)
        if not is_tetra and nodes[6] != nodes[7]:
            return None
    corners = tuple(nodes[k] for k in places)
    if len(set(corners)) < len(corners) or 0 in corners:
        return None
    mids = tuple(nodes[k] if k < len(nodes) else 0 for k in mid_places) if listed == 20 else ()
    return Solid(element, pid, corners, tuple(n if n not in corners else 0 for n in mids) if any(mids) else ())
