"""From a line on the skin of a solid mesh to a cut through the plate beneath: columns of nodes, and the solids.

Under every face of the assessed side the solids are passed from face to opposite face until the next free one: this is
the plate there, and its solids are the assessed ones. The corners and mid-side nodes passed on the way below a node of
the line are its column. Where the way ends inside (a tetrahedron, the flank of a wedge, several solids behind a face),
where columns of one node differ, or where the faces passed are no two faces of a plate, there is no cut.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from fatigue.weld.cuts import WeldCut
from fatigue.weld.line_geometry import length, unit
from fatigue.weld.mesh import NONE
from fatigue.weld.solid.skin import BRANCHES, FORMS, FREE, SIDES, Skin

PARALLEL_DEG = 30.0
"""Two faces of a plate are parallel within this angle."""

SLANT_DEG = 20.0
"""Columns are perpendicular to the surface within this angle."""

THICKEST = 2.0
"""A plate is not thicker than this times the length of the line."""

_BENT = 0.1
"""Nodes of a column lie on one straight line within this fraction of its length."""

_NAMES = {8: "hexahedron", 6: "pentahedron", 4: "tetrahedron"}
_PARALLEL, _SLANT = np.cos(np.radians((PARALLEL_DEG, SLANT_DEG)))


@dataclass(frozen=True, slots=True, eq=False)
class _Stack:
    """Solids under one face of the skin: indices, columns of its corners and mid-side nodes, the face at the bottom."""

    solids: tuple[int, ...]
    columns: dict[int, tuple[int, ...]]
    bottom: tuple[int, ...]


def cut_through(skin: Skin, cut: WeldCut) -> tuple[WeldCut, str]:
    """Cut of a line on the skin through the plate beneath: x, y, z at mid-thickness, thickness, solids, columns.

    Parameters
    ----------
    cut : of the skin, its elements are faces of it

    Returns
    -------
    The cut, and why it cannot be assessed; the line on the skin, without thickness, where there is such a reason.
    """
    stacks: list[_Stack] = []
    for face in cut.elements.tolist():
        found = _stack(skin, face - 1)
        if isinstance(found, str):
            return _without_columns(skin, cut), found
        stacks.append(found)
    columns: dict[int, tuple[int, ...]] = {}
    for stack in stacks:
        for node, column in stack.columns.items():
            if columns.setdefault(node, column) != column:
                what = f"the columns of nodes beneath node {skin.mesh.node[node]} differ from solid to solid"
                return _without_columns(skin, cut), what
    top = np.searchsorted(skin.mesh.node, cut.line.node)
    own = [columns[int(node)] for node in top.tolist()]
    xyz = skin.mesh.xyz
    upper, lower = xyz[top], xyz[[column[-1] for column in own]]
    through = upper - lower
    line = replace(cut.line, xyz=(upper + lower) / 2, thickness=np.linalg.norm(through, axis=1))
    solids = np.unique([solid for stack in stacks for solid in stack.solids])
    whole = replace(
        cut,
        line=line,
        elements=skin.solids.element[solids],
        columns=tuple(tuple(skin.mesh.node[list(column)].tolist()) for column in own),
    )
    return whole, _no_plate(skin, cut, stacks, own, through)


def _without_columns(skin: Skin, cut: WeldCut) -> WeldCut:
    """Cut that keeps its line on the skin, and the solids right beneath."""
    beneath = np.unique(skin.face[cut.elements - 1] // SIDES)
    return replace(cut, elements=skin.solids.element[beneath])


def _stack(skin: Skin, number: int) -> _Stack | str:
    """Solids from a face of the skin to the next free face; or why the way ends before."""
    solids = skin.solids
    face = int(skin.face[number])
    columns: dict[int, list[int]] = {}
    ring: list[int] = []  # corners of the face where the way stands, each below the one it began at
    starts: list[int] = []
    passed: list[int] = []
    while True:
        solid, side = divmod(face, SIDES)
        corner, mid = solids.corner[solid], solids.mid[solid]
        size = int((corner != NONE).sum())
        form, kind = FORMS[size], _NAMES[size]
        behind, behind_corners = form.opposite[side]
        if behind < 0:
            return f"element {solids.element[solid]}, a {kind}, has no face opposite: the columns of nodes end there"
        if solid in passed:
            return f"the columns of nodes come back to element {solids.element[solid]}"
        passed.append(solid)
        here = form.faces[side]
        if not ring:
            starts = ring = [int(corner[k]) for k in here]
            columns = {node: [node] for node in ring}
        local = {int(corner[k]): (k, b) for k, b in zip(here, behind_corners, strict=True)}
        below = []
        for start, node in zip(starts, ring, strict=True):
            k, b = local[node]
            between = mid[form.mids[frozenset((k, b))]]
            columns[start] += [int(n) for n in (between, corner[b]) if n != NONE]
            below.append(int(corner[b]))
        for at, node in enumerate(ring):
            after = ring[(at + 1) % len(ring)]
            (k, b), (k_after, b_after) = local[node], local[after]
            upper, lower = mid[form.mids[frozenset((k, k_after))]], mid[form.mids[frozenset((b, b_after))]]
            if (upper == NONE) != (lower == NONE):
                missing = solids.element[solid]
                return f"element {missing} has mid-side nodes on one of two opposite edges only"
            if upper != NONE:
                key = int(upper) if len(passed) == 1 else _begun(columns, int(upper))
                if key == NONE:
                    return f"element {solids.element[solid]} has mid-side nodes that the one above it lacks"
                columns.setdefault(key, [key]).append(int(lower))
        ring = below
        face = int(skin.beyond[SIDES * solid + behind])
        if face == FREE:
            return _Stack(tuple(passed), {node: tuple(column) for node, column in columns.items()}, tuple(ring))
        if face == BRANCHES:
            return f"several solids share one face of element {solids.element[solid]}"


def _begun(columns: dict[int, list[int]], node: int) -> int:
    """Node on the skin whose column has come down to ``node``; -1 where none has."""
    return next((start for start, column in columns.items() if column[-1] == node), NONE)


def _no_plate(
    skin: Skin,
    cut: WeldCut,
    stacks: Iterable[_Stack],
    columns: list[tuple[int, ...]],
    through: NDArray[np.float64],
) -> str:
    """Say why what lies between the outer nodes is no plate with columns across it; empty if it is one."""
    xyz, ids = skin.mesh.xyz, skin.mesh.node
    thickness = np.linalg.norm(through, axis=1)
    if not (thickness > 0).all():
        return f"the column of node {cut.line.node[int(np.argmin(thickness))]} has no length"
    along = length(cut.line)
    if thickness.mean() > THICKEST * along:
        return f"{thickness.mean():.3g} mm thick beside a line of {along:.3g} mm: no plate"
    slant = np.einsum("ij,ij->i", unit(through), unit(cut.line.normal))
    if slant.min() < _SLANT:
        k = int(np.argmin(slant))
        angle = np.degrees(np.arccos(np.clip(slant[k], -1.0, 1.0)))
        return f"the column of node {cut.line.node[k]} is {angle:.0f} degrees off the normal of the surface: no plate"
    for stack in stacks:
        top, bottom = (_normal(xyz[list(face)]) for face in (list(stack.columns)[: len(stack.bottom)], stack.bottom))
        if top @ bottom < _PARALLEL:
            angle = np.degrees(np.arccos(np.clip(top @ bottom, -1.0, 1.0)))
            where = skin.solids.element[stack.solids[-1]]
            return f"the faces above and beneath element {where} are {angle:.0f} degrees from parallel: no plate"
    for column, way, t in zip(columns, through, thickness, strict=True):
        arms = xyz[list(column)] - xyz[column[-1]]
        off = np.linalg.norm(arms - np.outer(arms @ way, way) / t**2, axis=1)
        if off.max() > _BENT * t:
            k = int(off.argmax())
            return f"node {ids[column[k]]} is {off[k]:.3g} mm off the straight column of node {ids[column[0]]}"
    return ""


def _normal(ring: NDArray[np.float64]) -> NDArray[np.float64]:
    """Unit normal of a face of three or four corners."""
    a, b, c, d = ring[[0, 1, 2, -1]]
    return unit(np.cross(b - a, c - a) if len(ring) == 3 else np.cross(c - a, d - b))
