"""K and M of a shell body, and the forces of its elements at their nodes.

Degrees of freedom are ordered by node, six each: ux, uy, uz, rx, ry, rz in global axes.
"""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from fatigue.errors import DataError, Problem
from fatigue.flexbody.elements.quad import quad_stiffness
from fatigue.flexbody.elements.quad_mass import quad_mass
from fatigue.flexbody.elements.section import Section
from fatigue.flexbody.elements.triangle import triangle_mass, triangle_stiffness
from fatigue.flexbody.shell_check import refuse_bad_elements
from fatigue.flexbody.shell_mesh import ShellMesh
from fatigue.flexbody.structure import Structure

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

CHUNK = 4096  # elements at once: their matrices take some 40 MB


def structure(mesh: ShellMesh) -> Structure:
    """K [N/mm, N, N mm] and consistent M [t, t mm2] of the free body; six rows of each node, in the order of nodes.

    Raises
    ------
    DataError : an element without area, folded, or with a node twice
    """
    refuse_bad_elements(mesh)
    nodes = len(mesh.node)
    of_all = np.arange(len(mesh.element))
    K = _assembled(((dofs, K) for _, dofs, K in _stiffness(mesh, of_all)), 6 * nodes)
    M = _assembled(_mass(mesh), 6 * nodes)
    directions = np.tile(np.arange(6, dtype=np.int64), nodes)
    return Structure(
        sparse.csc_array(K), sparse.csc_array(M), np.repeat(mesh.node, 6), directions, np.repeat(mesh.xyz, 6, axis=0)
    )


def element_forces(mesh: ShellMesh, shapes: Floats, elements: Integers) -> Floats:
    """Forces and moments on elements at their nodes, K_e u_e (e, 4, 6, k), of the ids ``elements`` (e,) as given.

    ``shapes`` (6 n, k) are displacements in the rows of ``structure``. The fourth node of a triangle has none.

    Raises
    ------
    DataError : an element that the mesh does not have
    """
    forces = np.zeros((len(elements), 4, 6, shapes.shape[1]))
    for at, dofs, K in _stiffness(mesh, _index(mesh.element, elements, "element")):
        corners = dofs.shape[1] // 6
        forces[at, :corners] = (K @ shapes[dofs]).reshape(len(dofs), corners, 6, -1)
    return forces


def side_forces(mesh: ShellMesh, shapes: Floats, elements: Integers, nodes: Integers) -> Floats:
    """Forces and moments on the ``elements`` (e,) together at each of the ``nodes`` (n,), of ids (n, 6, k).

    Arguments as of ``element_forces``. No more is kept than the rows of these nodes in the stiffness of these elements.

    Raises
    ------
    DataError : an element or node that the mesh does not have
    """
    parts = _stiffness(mesh, _index(mesh.element, elements, "element"))
    K = _assembled(((dofs, K) for _, dofs, K in parts), 6 * len(mesh.node))
    at = 6 * _index(mesh.node, nodes, "node")[:, None] + np.arange(6)
    return np.asarray(K[at.ravel()] @ shapes).reshape(len(nodes), 6, -1)


def section_of(mesh: ShellMesh, which: Integers) -> Section:
    """Section of some elements, given by index."""
    every = Section(mesh.thickness, mesh.bending_thickness, mesh.E, mesh.nu, mesh.rho, mesh.nsm)
    return every.of(which)


def _index(known: Integers, ids: Integers, called: str) -> Integers:
    """Indices of ids among those of the mesh."""
    at = np.minimum(np.searchsorted(known, ids), len(known) - 1)
    unknown = known[at] != ids
    if unknown.any():
        where = f"{called} {np.asarray(ids)[unknown][0]}"
        raise DataError(Problem("unknown_id", where, "the mesh does not have it", f"Name a {called} of the mesh"))
    return np.asarray(at)


def _kinds(mesh: ShellMesh, which: Integers) -> Iterator[tuple[Integers, Integers]]:
    """Positions in ``which`` of elements of one kind, a chunk at a time, and their corners (c, 4) or (c, 3)."""
    triangle = mesh.is_triangle[which]
    for kind, corners in ((~triangle, 4), (triangle, 3)):
        at = np.flatnonzero(kind)
        for start in range(0, at.size, CHUNK):
            some = at[start : start + CHUNK]
            yield some, mesh.corners[which[some], :corners]


def _stiffness(mesh: ShellMesh, which: Integers) -> Iterator[tuple[Integers, Integers, Floats]]:
    """Positions in ``which``, degrees of freedom (c, d) and stiffness (c, d, d), a chunk at a time."""
    for at, corners in _kinds(mesh, which):
        of_kind = quad_stiffness if corners.shape[1] == 4 else triangle_stiffness
        dofs = (6 * corners[:, :, None] + np.arange(6)).reshape(len(corners), -1)
        yield at, dofs, of_kind(mesh.xyz[corners], section_of(mesh, which[at]))


def _mass(mesh: ShellMesh) -> Iterator[tuple[Integers, Floats]]:
    """Degrees of freedom and mass of elements, one of the six directions at a time: directions have none in common."""
    which = np.arange(len(mesh.element))
    for at, corners in _kinds(mesh, which):
        of_kind = quad_mass if corners.shape[1] == 4 else triangle_mass
        section = section_of(mesh, which[at])
        m = of_kind(mesh.xyz[corners], section)
        for direction in range(6):
            dofs = 6 * corners + direction
            yield dofs, m if direction < 3 else m * section.rotary[:, None, None]


def _assembled(parts: Iterator[tuple[Integers, Floats]], size: int) -> sparse.csr_array:
    """Sum (size, size) of element matrices (c, d, d) at their degrees of freedom (c, d)."""
    data, row, column = [np.zeros(0)], [np.zeros(0, np.int32)], [np.zeros(0, np.int32)]
    for dofs, matrix in parts:
        i, j = np.broadcast_arrays(dofs[:, :, None], dofs[:, None, :])
        data.append(matrix.ravel())
        row.append(i.astype(np.int32).ravel())
        column.append(j.astype(np.int32).ravel())
    at = (np.concatenate(row), np.concatenate(column))
    return sparse.csr_array((np.concatenate(data), at), shape=(size, size))
