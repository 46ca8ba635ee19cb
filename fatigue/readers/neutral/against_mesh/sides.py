"""Whether the elements of a weld's assessed side lie where its normal and its outward vector put them."""

from collections.abc import Collection, Mapping

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import Problem
from fatigue.readers.neutral.against_mesh.directions import astray
from fatigue.readers.neutral.against_mesh.findings import Finding, worst_first
from fatigue.readers.neutral.against_mesh.shells import arms, shells_of_forces
from fatigue.readers.neutral.body.mesh import Mesh
from fatigue.readers.neutral.line_file import LineFile
from fatigue.weld.element_forces import ElementForces
from fatigue.weld.line import LineStack, Vectors, line_of_node
from fatigue.weld.line_geometry import unit

LINES_AT_ONCE = 64


def side_warnings(
    lines: LineFile,
    forces: ElementForces,
    sides: Mapping[str, NDArray[np.int64]],
    mesh: Mesh,
    lines_file: str,
    sides_file: str,
    solid: Collection[str] = (),
) -> list[Problem]:
    """Warnings of welds whose assessed elements lie elsewhere, the worst first.

    Parameters
    ----------
    forces : at least those of the elements of all sides; they tell which nodes an element has
    sides : elements of the assessed side of each weld
    solid : welds of solid elements, whose middle lies below the top; their columns tell how the normal should be
    """
    shells = shells_of_forces(forces, mesh)
    found: list[Finding] = []
    for first in range(0, len(lines), LINES_AT_ONCE):
        some = lines.lines(slice(first, first + LINES_AT_ONCE))
        at, shell = shells.pairs(some.node)
        own = [sides[name] for name in some.weld]
        weld = np.repeat(np.arange(len(own)), [elements.size for elements in own])
        assessed = _pair(weld, np.concatenate(own), shells.element)
        is_assessed = np.isin(_pair(line_of_node(some)[at], shells.element[shell], shells.element), assessed)
        at, arm = arms(some, at[is_assessed], shells, shell[is_assessed], mesh)
        if solid:
            arm = _in_plate(some, at, arm, solid)
        found += astray(some, at, arm, f"the assessed side that {sides_file} names", lines_file)
    return worst_first(found)


def _in_plate(lines: LineStack, at: NDArray[np.int64], arm: Vectors, solid: Collection[str]) -> Vectors:
    """Vectors from nodes of lines, (p, 3), those at solid welds without their part along the normal."""
    z = unit(lines.normal[at])
    is_solid = np.isin(line_of_node(lines)[at], [i for i, weld in enumerate(lines.weld) if weld in solid])
    return np.asarray(arm - np.where(is_solid, np.sum(arm * z, axis=1), 0.0)[:, np.newaxis] * z)


def _pair(weld: NDArray[np.int64], element: NDArray[np.int64], elements: NDArray[np.int64]) -> NDArray[np.int64]:
    """Number of each pair of a weld and an element, of ``elements``, ascending."""
    return weld * elements.size + np.searchsorted(elements, element)
