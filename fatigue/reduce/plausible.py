"""A body that cannot be meant: materials and sizes of no body, which tell of other units; two thicknesses."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import Problem
from fatigue.flexbody.factor import row_name
from fatigue.flexbody.shell_mesh import ShellMesh
from fatigue.flexbody.structure import Structure

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

STIFFEST = 1.5e6  # MPa: diamond has 1.1e6
HARD = 300.0  # MPa: a body whose stiffest part is softer carries no vehicle; metals in GPa stay below
DENSEST = 2.3e-8  # t/mm3: osmium
LIGHTEST = 1e-13  # t/mm3 of the box around a body: a tenth of air
INDEFINITE = 1e-9  # of the largest mass: files are written with some digits
THIN = 0.1  # of its longest side: what a flat body or a straight beam counts as thick
UNITS_OF_E = {"Pa": 1e6, "GPa": 1e-3}  # how many of them are 1 MPa
UNITS_OF_RHO = {"kg/m3": 1e12, "g/cm3": 1e9, "kg/mm3": 1e3}  # 1 t/mm3
METAL_E, METAL_RHO = (4e4, 2.2e5), (1.7e-9, 9e-9)  # MPa, t/mm3: magnesium to steel


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


def mass_problems(structure: Structure, file: str) -> Iterator[Problem]:
    """Refusal of a mass matrix that gives some motion a negative energy: ``M_ij^2 > M_ii M_jj`` of two of its rows."""
    M = structure.M.tocoo()
    i, j = M.coords
    diagonal = structure.M.diagonal()
    own = np.sqrt(diagonal[i] * diagonal[j])
    over = np.abs(M.data) - own
    if over.size and np.any(over > INDEFINITE * diagonal.max()):
        at = int(over.argmax())
        a, b = sorted((int(i[at]), int(j[at])))
        where = f"{file}: {row_name(structure, a)} with {row_name(structure, b)}"
        what = f"{M.data[at]:.4g} between them is above {own[at]:.4g}, the root of their own: some motion has a "
        what += "negative mass"
        yield Problem("not_positive", where, what, "Export M again, and its rows in the order of dof")


def _and_more(wrong: NDArray[np.bool_]) -> str:
    more = int(wrong.sum()) - 1
    return f" (and {more} more element{'s' * (more > 1)})" if more > 0 else ""


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
