"""A shell body from the tables ``nodes``, ``elements`` and ``properties``."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem, refuse
from fatigue.flexbody.shell_mesh import NONE, ShellMesh
from fatigue.readers.neutral.body.mesh import Mesh
from fatigue.readers.neutral.tables import Table, open_table

Floats = NDArray[np.float64]


def read_shell_mesh(mesh: Mesh, elements: Path, properties: Path, *, strict: bool) -> tuple[ShellMesh, list[Problem]]:
    """Give the elements of a mesh their properties: ``pid, E_MPa, nu, rho_t_mm3`` and thickness.

    ``thickness_mm`` of an element goes before that of its property; ``bending_thickness_mm`` is the thickness where it
    is not given, ``nsm_t_mm2`` 0. Nodes that no element has are left out.

    Raises
    ------
    DataError : a property is missing or impossible, an element has mid-side nodes or no thickness
    """
    table = open_table(properties)
    optional = ("thickness_mm", "bending_thickness_mm", "nsm_t_mm2")
    table.expect(("pid", "E_MPa", "nu", "rho_t_mm3"), optional, strict=strict)
    pid = table.integers("pid")
    table.unique({"pid": pid})
    E = table.numbers("E_MPa", above=0.0).astype(np.float64)
    nu = table.numbers("nu", least=0.0).astype(np.float64)
    rho = table.numbers("rho_t_mm3", least=0.0).astype(np.float64)
    thickness = table.numbers("thickness_mm", default=np.nan, above=0.0).astype(np.float64)
    bending = table.numbers("bending_thickness_mm", default=np.nan, above=0.0).astype(np.float64)
    nsm = table.numbers("nsm_t_mm2", default=0.0, least=0.0).astype(np.float64)
    _refuse_no_solid(table, nu)
    table.refuse()
    order = np.argsort(pid)
    at = np.clip(np.searchsorted(pid[order], mesh.pid), 0, len(pid) - 1)
    refuse(DataError, _without_property(mesh, elements, properties, pid[order][at]))
    row = order[at]
    own = np.where(np.isnan(mesh.thickness), thickness[row], mesh.thickness)
    refuse(DataError, _without_thickness(mesh, elements, properties, own))
    bends = np.where(np.isnan(bending[row]), own, bending[row])
    used, corners = np.unique(mesh.corners[:, :4], return_inverse=True)
    corners = corners.reshape(-1, 4)
    if used[0] == 0:  # no fourth corner
        used, corners = used[1:], np.where(corners == 0, NONE, corners - 1)
    xyz = mesh.xyz[np.searchsorted(mesh.node, used)]
    shells = ShellMesh(used, xyz, mesh.element, corners, own, bends, E[row], nu[row], rho[row], nsm[row])
    return shells, table.warnings


def _refuse_no_solid(table: Table, nu: Floats) -> None:
    beyond = nu >= 0.5
    what = f"{nu[int(beyond.argmax())]:g} is not below 0.5"
    table.report(beyond, "bad_value", "nu", what, "Give Poisson's ratio of the material")


def _without_property(mesh: Mesh, elements: Path, properties: Path, found: NDArray[np.int64]) -> list[Problem]:
    """Refusals of elements that are no flat shells, and of those whose property is not in the table."""
    problems = []
    curved: NDArray[np.bool_] = np.any(mesh.corners[:, 4:] > 0, axis=1)
    if curved.any():
        what = f"it has mid-side nodes{_more(curved)}"
        remedy = "Give elements of three or four nodes; elements with mid-side nodes are not computed here"
        problems.append(Problem("mid_nodes", _element(mesh, elements, curved), what, remedy))
    unknown: NDArray[np.bool_] = np.not_equal(found, mesh.pid)
    if unknown.any():
        what = f"its property {mesh.pid[unknown.argmax()]} is not in {properties.name}{_more(unknown)}"
        problems.append(Problem("unknown_id", _element(mesh, elements, unknown), what, "Add the property there"))
    return problems


def _without_thickness(mesh: Mesh, elements: Path, properties: Path, thickness: Floats) -> list[Problem]:
    none = np.isnan(thickness)
    if not none.any():
        return []
    what = f"it has no thickness_mm, nor has its property {mesh.pid[none.argmax()]}{_more(none)}"
    return [Problem("missing_value", _element(mesh, elements, none), what, f"Give it in {properties.name}")]


def _element(mesh: Mesh, elements: Path, which: NDArray[np.bool_]) -> str:
    return f"{elements.name}: element {mesh.element[int(which.argmax())]}"


def _more(which: NDArray[np.bool_]) -> str:
    count = int(np.count_nonzero(which))
    return f" (and {count - 1} more)" if count > 1 else ""
