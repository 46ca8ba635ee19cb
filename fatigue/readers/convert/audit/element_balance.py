"""The balance of the forces on every shell: stiffness forces are in equilibrium, in the frames they are written in."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from fatigue.readers.convert.audit.row import AuditRow
from fatigue.readers.convert.audit.shell_rows import elastic_modes, kind_in_words, plate_rows, without_drilling
from fatigue.readers.foreign.fe.model import FeModel
from fatigue.readers.foreign.fe.results import REQUEST, FeResults
from fatigue.weld.element_forces import BALANCE_RED, ElementForces, balance

BALANCE_GREEN = 1e-3


def _element_forces(
    results: FeResults, force: NDArray[np.floating], rows: NDArray[np.bool_] | slice = slice(None)
) -> ElementForces:
    """Table of the forces (m, r, 6) of chosen rows in all modes."""
    node, element = results.node[rows], results.element[rows]
    modes = results.mode.size
    return ElementForces(
        np.repeat(results.mode, node.size), np.tile(node, modes), np.tile(element, modes), force[:, rows].reshape(-1, 6)
    )


def _worst_balance(results: FeResults, model: FeModel, force: NDArray[np.floating]) -> tuple[float, int, int, int]:
    """Largest residual of any shell or solid and mode, its element and mode, and the number of elements checked."""
    rows = plate_rows(results, model)
    if not rows.any():
        return np.nan, 0, 0, 0
    elastic = elastic_modes(results)
    results, force = replace(results, mode=results.mode[elastic]), force[elastic]
    xyz = dict(zip(model.mesh.node.tolist(), model.mesh.xyz, strict=True))
    found = balance(_element_forces(results, force, rows), xyz)
    k = found.worst
    moment = 0.0 if found.moment_residual is None else float(found.moment_residual[k])
    worst = max(float(found.force_residual[k]), moment)
    return worst, int(found.element[k]), int(found.mode[k]), np.unique(results.element[rows]).size


def balance_row(results: FeResults, model: FeModel, force: NDArray[np.floating]) -> tuple[AuditRow, bool]:
    """Row on the worst shell; and whether only the moments about the shells' normals are out of balance."""
    worst, element, mode, count = _worst_balance(results, model, force)
    kind = kind_in_words(model)
    if not count:
        return AuditRow(
            "element balance", "red", None, f"no {kind} of the mesh has forces at all its nodes", REQUEST
        ), False
    where = f"element {element} in {results.called(mode)}"
    finding = f"worst of {count} {kind}s: {where}, {worst:.2g} of its largest force or moment"
    if worst <= BALANCE_GREEN:
        return AuditRow("element balance", "green", worst, finding), False
    rest = _worst_balance(results, model, without_drilling(force, results, model))[0]
    if rest <= BALANCE_GREEN:
        finding += f"; {rest:.2g} without their moments about their own normals, which are left out"
        remedy = (
            "The solver ties these rotations to the ground (PARAM,K6ROT in MYSTRAN): welds do not need them; set it to "
            "0 if the frequencies matter"
        )
        return AuditRow("element balance", "amber", worst, finding, remedy), True
    remedy = (
        "Give the mesh of this run with its coordinate systems (CD); request stiffness forces without inertia and "
        "damping; a damaged number looks the same"
    )
    return AuditRow("element balance", "amber" if worst <= BALANCE_RED else "red", worst, finding, remedy), False


def frames_row(results: FeResults, model: FeModel, force: NDArray[np.floating]) -> AuditRow:
    """Row on the rotation out of the displacement frames: the forces balance after it, and not before."""
    count = int(np.isin(model.frame_node, results.node).sum())
    if not count:
        return AuditRow("displacement frames", "green", 0.0, "all forces are in the basic frame")
    turned = _worst_balance(results, model, force)[0]
    plain = _worst_balance(results, model, results.force)[0]
    if plain < BALANCE_GREEN < turned:
        return AuditRow(
            "displacement frames",
            "red",
            float(count),
            f"{count} grids have displacement frames (CD), but only the unrotated forces balance: they are basic",
            "Write GPFORCE in the displacement frames, or remove CD from the mesh given here",
        )
    finding = f"forces of {count} grids rotated to basic: worst balance {plain:.2g} before, {turned:.2g} after"
    return AuditRow("displacement frames", "green", float(count), finding)
