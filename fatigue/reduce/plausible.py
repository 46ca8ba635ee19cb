"""A body of shells that cannot be meant: materials and sizes of no body, flat or crossed elements, loose parts."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse.csgraph import connected_components

from fatigue.errors import Problem
from fatigue.flexbody.shell_mesh import NONE, ShellMesh
from fatigue.flexbody.structure import Structure
from fatigue.shown import few

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

STIFFEST = 1.5e6  # MPa: diamond has 1.1e6
HARD = 300.0  # MPa: a body whose stiffest part is softer carries no vehicle; metals in GPa stay below
DENSEST = 2.3e-8  # t/mm3: osmium
LIGHTEST = 1e-13  # t/mm3 of the box around a body: a tenth of air
THIN = 1e-2  # of its longest side: what a flat body counts as thick
UNITS_OF_E = {"Pa": 1e6, "GPa": 1e-3}  # how many of them are 1 MPa
UNITS_OF_RHO = {"kg/m3": 1e12, "g/cm3": 1e9, "kg/mm3": 1e3}  # 1 t/mm3
METAL_E, METAL_RHO = (4e4, 2.2e5), (1.7e-9, 9e-9)  # MPa, t/mm3: magnesium to steel
NO_AREA = 1e-8  # of the square of the longest edge


def material_problems(mesh: ShellMesh, pid: Integers, properties: str) -> Iterator[Problem]:
    """Refusals of a stiffness or density that no material of a body has; ``pid`` (e,) is the property of elements."""
    E, rho = mesh.E, mesh.rho
    stiff = E > STIFFEST
    soft = np.full(E.shape, bool(E.max() < HARD))
    for wrong, than in ((stiff, "stiffer than diamond"), (soft, "and nothing stiffer is there, softer than any body")):
        if wrong.any():
            at = int(wrong.argmax())
            what = f"E is {E[at]:g} MPa, {than}{_in_unit(float(E[at]), METAL_E, UNITS_OF_E)}"
            yield Problem("other_unit", f"{properties}: property {pid[at]}", what, "Give E in MPa: of steel 210000")
    dense = rho > DENSEST
    if dense.any():
        at = int(dense.argmax())
        what = f"the density is {rho[at]:g} t/mm3, denser than osmium{_in_unit(rho[at], METAL_RHO, UNITS_OF_RHO)}"
        yield Problem("other_unit", f"{properties}: property {pid[at]}", what, "Give t/mm3: of steel 7.85e-9")
    if not np.any(rho * mesh.thickness + mesh.nsm > 0.0):
        what = "no element has mass"
        yield Problem("no_mass", f"{properties}: column rho_t_mm3", what, "Give densities in t/mm3, of steel 7.85e-9")


def _in_unit(value: float, metals: tuple[float, float], units: dict[str, float]) -> str:
    """Say which unit would make a metal of the value; empty where none does."""
    for unit, factor in units.items():
        if metals[0] <= value / factor <= metals[1]:
            return f": it looks like {unit}"
    return ""


def size_problems(xyz: Floats, mass_t: float, where: str, units: str) -> Iterator[Problem]:
    """Refusal of a body heavier or lighter than any of its size; ``units`` says what to do about it."""
    side = np.ptp(xyz, axis=0)
    if not side.max() > 0.0:
        yield Problem("no_size", where, "all nodes are at one place", "Give the places of the nodes in mm")
        return
    density = mass_t / float(np.prod(np.maximum(side, THIN * side.max())))
    if not LIGHTEST < density < DENSEST:
        size = " x ".join(f"{length:.4g}" for length in side.tolist())
        than = "heavier than osmium" if density >= DENSEST else "lighter than air"
        what = f"{mass_t:.4g} t in a box of {size} mm are {than}"
        yield Problem("other_unit", where, what, units)


def element_problems(mesh: ShellMesh, file: str) -> Iterator[Problem]:
    """Refusals of elements with a corner twice or of no area, and of quads that turn in or cross themselves."""
    element, corners = mesh.element, mesh.corners
    in_order = np.sort(corners, axis=1)
    twice = ((in_order[:, 1:] == in_order[:, :-1]) & (in_order[:, 1:] != NONE)).any(axis=1)
    if twice.any():
        what = f"a node is twice among its corners{_and_more(twice)}"
        remedy = "Leave n4 empty where three corners are left, or take the element out"
        yield Problem("collapsed", f"{file}: element {element[twice][0]}", what, remedy)
    triangle = mesh.is_triangle
    p = mesh.xyz[np.where(corners == NONE, corners[:, :1], corners)]
    of_quad = np.cross(p[:, 2] - p[:, 0], p[:, 3] - p[:, 1])
    normal = np.where(triangle[:, None], np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]), of_quad)
    longest = np.linalg.norm(np.roll(p, -1, axis=1) - p, axis=2).max(axis=1)
    area = np.linalg.norm(normal, axis=1) / 2
    flat = (area <= NO_AREA * longest**2) & ~twice
    if flat.any():
        what = f"its area is {area[flat][0]:.3g} mm2{_and_more(flat)}"
        remedy = "Number its corners around it, or take it out"
        yield Problem("no_area", f"{file}: element {element[flat][0]}", what, remedy)
    turn = np.cross(np.roll(p, -1, axis=1) - p, np.roll(p, 1, axis=1) - p)
    inwards = (np.einsum("ecj,ej->ec", turn, normal) <= 0.0).any(axis=1) & ~(triangle | flat | twice)
    if inwards.any():
        what = f"its corners cross each other or turn inwards{_and_more(inwards)}"
        remedy = "Number the corners around the element, and split one that turns inwards"
        yield Problem("turned_in", f"{file}: element {element[inwards][0]}", what, remedy)


def _and_more(wrong: NDArray[np.bool_]) -> str:
    more = int(wrong.sum()) - 1
    return f" (and {more} more element{'s' * (more > 1)})" if more > 0 else ""


def loose_shells(mesh: ShellMesh, file: str) -> Iterator[Problem]:
    """Refusal of parts that no element joins to the rest of the body."""
    pairs = np.concatenate([np.stack([mesh.corners[:, 0], mesh.corners[:, k]], axis=1) for k in (1, 2, 3)])
    pairs = pairs[pairs[:, 1] != NONE]
    joined = sparse.coo_array((np.ones(len(pairs)), pairs.T), shape=(len(mesh.node),) * 2)
    yield from _apart(joined, mesh.node, file)


def loose_rows(structure: Structure, file: str) -> Iterator[Problem]:
    """Refusal of parts of a body that its stiffness does not join; the rows of one node belong together."""
    node, at = np.unique(structure.node, return_inverse=True)
    K = structure.K.tocoo()
    joined = sparse.coo_array((np.ones(K.nnz), (at[K.coords[0]], at[K.coords[1]])), shape=(len(node),) * 2)
    yield from _apart(joined, node, file)


def _apart(joined: sparse.coo_array, node: Integers, file: str) -> Iterator[Problem]:
    parts, part = connected_components(joined, directed=False)
    if parts > 1:
        size = np.bincount(part)
        loose = node[part == size.argmin()]
        what = f"the body is in {parts} parts that nothing joins, the smallest of {loose.size} "
        what += f"node{'s' * (loose.size > 1)}: {few(loose.tolist())}"
        remedy = "Join them by common nodes, or leave out what is no part of the body"
        yield Problem("unconnected", file, what, remedy)


def other_thickness(
    mesh: ShellMesh, pid: Integers, given: dict[int, float], elements: Path, properties: Path
) -> list[Problem]:
    """Warning about elements that were computed with another thickness than their property has, ``given`` by id."""
    of_property = np.array([given.get(p, np.nan) for p in pid.tolist()])
    other = np.abs(mesh.thickness - of_property) > 1e-3 * mesh.thickness  # as somebody may write it down
    if not other.any():
        return []
    at = int(other.argmax())
    what = f"its thickness_mm {mesh.thickness[at]:g} is taken, and property {pid[at]} has {of_property[at]:g} in "
    what += f"{properties.name}{_and_more(other)}"
    remedy = "Correct one of them; a table that is given with --properties goes before that of the elements"
    where = f"{elements.name}: element {mesh.element[at]}"
    return [Problem("other_thickness_of_property", where, what, remedy, int(other.sum()))]
