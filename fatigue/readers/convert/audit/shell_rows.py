"""Which force rows belong to the shells and solids of a mesh, and what a solver's drilling springs leave in them.

A flat shell has no stiffness about its own normal; solvers add a spring there (PARAM,K6ROT). Where the spring ties the
rotation to the ground instead of to the shell's own plane, as MYSTRAN's does, the shells are out of balance by just
these moments. Structural stress uses none of them.
"""

import numpy as np
from numpy.typing import NDArray

from fatigue.readers.foreign.fe.model import FeModel
from fatigue.readers.foreign.fe.results import FeResults
from fatigue.readers.neutral.body.modes import LOWEST_HZ
from fatigue.weld.mesh import NONE, normals

_ROUND_OFF = 1e-9
"""Of the largest force in any mode: rigid modes carry no more."""

_CORNERS = {"HEXA": 8, "PENTA": 6, "PYRAM": 5, "TETRA": 4, "SHEAR": 4}
"""Corners of elements that are no lines; a set of grids may hold a part of them."""


def shell_rows(results: FeResults, model: FeModel) -> NDArray[np.bool_]:
    """Rows of shells of the mesh that have all their nodes in the file, (r,)."""
    mesh = model.mesh
    return _of_elements(results, mesh.element, mesh.node, np.concatenate([mesh.corner, mesh.mid], axis=1))[2]


def kind_in_words(model: FeModel) -> str:
    """What the plates of a model are made of: shell, solid, or element where it has both."""
    return "shell" if model.solids is None else "element" if model.mesh.element.size else "solid"


def plate_rows(results: FeResults, model: FeModel) -> NDArray[np.bool_]:
    """Rows of shells and solids of the mesh that have all their nodes in the file, (r,)."""
    return shell_rows(results, model) | _solid_rows(results, model)[1]


def own_plate_rows(results: FeResults, model: FeModel) -> NDArray[np.bool_]:
    """Rows that belong to a shell or a solid of the mesh and one of its nodes, (r,)."""
    return own_rows(results, model)[1] | _solid_rows(results, model)[0]


def _solid_rows(results: FeResults, model: FeModel) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Rows that belong to a solid of the mesh and one of its nodes, and those among them of whole solids, (r,) each.

    A parabolic solid is whole with its corners and mid-side nodes.
    """
    solids = model.solids
    if solids is None:
        return np.zeros(results.node.size, bool), np.zeros(results.node.size, bool)
    return _of_elements(results, solids.element, solids.node, np.concatenate([solids.corner, solids.mid], axis=1))[1:]


def _of_elements(
    results: FeResults, element: NDArray[np.int64], ids: NDArray[np.int64], around: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.bool_], NDArray[np.bool_]]:
    """Position of each row's element among elements of nodes ``around``, (e, k); whether it is its own, and whole."""
    if not element.size:
        none = np.zeros(results.node.size, bool)
        return np.zeros(results.node.size, np.int64), none, none
    at = np.minimum(np.searchsorted(element, results.element), element.size - 1)
    own = results.of_element & (element[at] == results.element)
    rows = np.flatnonzero(own)
    node = np.where(around[at[rows]] == NONE, 0, ids[around[at[rows]]])
    own[rows] = (node == results.node[rows, None]).any(axis=1)
    count = np.bincount(at[own], minlength=element.size)
    return at, own, np.asarray(own & (count == (around != NONE).sum(axis=1))[at])


def whole_rows(results: FeResults, model: FeModel) -> NDArray[np.bool_]:
    """Rows of elements that have forces at all their nodes, (r,): plates, and others as far as their kind tells.

    Rigid elements, of any number of nodes, do no work and are left out.
    """
    of_element = results.of_element
    _, element, count = np.unique(results.element[of_element], return_inverse=True, return_counts=True)
    kinds, kind = np.unique(results.kind[of_element], return_inverse=True)
    least = np.array([np.inf if k.startswith("RB") else _CORNERS.get(k, 2) for k in kinds.tolist()])
    others = of_element & ~np.isin(results.element, model.mesh.element)
    if model.solids is not None:
        others &= ~np.isin(results.element, model.solids.element)
    others[of_element] &= count[element.ravel()] >= least[kind.ravel()]
    return plate_rows(results, model) | others


def elastic_modes(results: FeResults) -> NDArray[np.bool_]:
    """Modes that have more than the round-off of a rigid one, (m,); all of them if none has."""
    rows = np.flatnonzero(results.of_element)
    size = np.array([np.abs(force[rows]).max(initial=0.0) for force in results.force])
    is_static = results.is_static
    floor = _ROUND_OFF * size[~is_static].max(initial=0.0)
    found = np.asarray(is_static | (~(results.frequency <= LOWEST_HZ) & (size > floor)))
    return found if found.any() else np.ones(size.size, bool)


def own_rows(results: FeResults, model: FeModel) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
    """Position in the mesh of each row's element, and whether the row belongs to a shell and one of its nodes."""
    mesh = model.mesh
    return _of_elements(results, mesh.element, mesh.node, np.concatenate([mesh.corner, mesh.mid], axis=1))[:2]


def without_drilling(force: NDArray[np.floating], results: FeResults, model: FeModel) -> NDArray[np.floating]:
    """Forces (m, r, 6) in basic axes without the moments of shells about their own normals."""
    at, is_own = own_rows(results, model)
    rows = np.flatnonzero(is_own)
    normal = normals(model.mesh)[at[rows]].astype(force.dtype)
    changed = force.copy()
    drilling = np.einsum("mri,ri->mr", force[:, rows, 3:], normal)
    changed[:, rows, 3:] -= drilling[:, :, None] * normal
    return changed
