"""Elements of a mesh that have no stiffness to compute: collapsed, without area, folded."""

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem, refuse
from fatigue.flexbody.elements.bilinear import jacobians
from fatigue.flexbody.elements.triangle import triangle_areas
from fatigue.flexbody.shell_mesh import ShellMesh

Floats = NDArray[np.float64]

NO_AREA = 1e-9  # of the square of the longest distance of corners: less is rounding of their places
MOST = 5  # elements named


def refuse_bad_elements(mesh: ShellMesh) -> None:
    """Refuse elements with a node twice, without area, or with a corner that points inwards.

    Raises
    ------
    DataError : one line for each kind, with the first elements
    """
    problems = []
    ordered = np.sort(mesh.corners, axis=1)
    twice = (ordered[:, 1:] == ordered[:, :-1]).any(axis=1)
    if twice.any():
        remedy = "Give a triangle with n4 left empty, or another node"
        problems.append(_problem(mesh, "collapsed", twice, "a node is there twice", remedy))
    triangle, quad = mesh.is_triangle & ~twice, ~mesh.is_triangle & ~twice
    flat, folded = np.zeros_like(twice), np.zeros_like(twice)
    corners = mesh.xyz[mesh.corners[triangle, :3]]
    flat[triangle] = triangle_areas(corners) <= NO_AREA * _squared_size(corners)
    corners = mesh.xyz[mesh.corners[quad]]
    normal = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    flat[quad] = np.linalg.norm(normal, axis=1) <= 2.0 * NO_AREA * _squared_size(corners)
    if flat.any():
        problems.append(_problem(mesh, "no_area", flat, "its corners lie on a line", "Move a node, or take it out"))
    whole = np.flatnonzero(quad & ~flat)
    j = jacobians(mesh.xyz[mesh.corners[whole]])
    folded[whole] = j.min(axis=1, initial=np.inf) <= NO_AREA * j.max(axis=1, initial=0.0)
    if folded.any():
        what = "its corners do not run around it, or one of them points inwards"
        problems.append(_problem(mesh, "folded", folded, what, "Give n1 ... n4 in a sense of rotation"))
    refuse(DataError, problems)


def _squared_size(corners: Floats) -> Floats:
    """Square of the largest extent of each element (e,)."""
    return np.asarray(np.ptp(corners, axis=1).max(axis=1) ** 2)


def _problem(mesh: ShellMesh, code: str, which: NDArray[np.bool_], what: str, remedy: str) -> Problem:
    ids = mesh.element[which]
    named = ", ".join(str(element) for element in ids[:MOST])
    also = f" and {ids.size - MOST} more" if ids.size > MOST else ""
    return Problem(code, f"element {named}{also}", what, remedy, ids.size)
