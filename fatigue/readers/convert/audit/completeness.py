"""Whether the shells of the mesh have forces at all their nodes and in all modes, and no other shells have."""

import numpy as np

from fatigue.readers.convert.audit.row import AuditRow
from fatigue.readers.convert.audit.shell_rows import own_rows, shell_rows
from fatigue.readers.foreign.fe.model import FeModel
from fatigue.readers.foreign.fe.results import SHELL_KINDS, FeResults
from fatigue.readers.neutral.body.modes import LOWEST_HZ


def completeness_row(results: FeResults, model: FeModel) -> AuditRow:
    """Row on the shells of the mesh that have force rows."""
    mesh = model.mesh
    listed = np.unique(results.element[results.of_element])
    is_shell = results.of_element & (
        np.isin(results.kind, sorted(SHELL_KINDS)) | np.isin(results.element, mesh.element)
    )
    stray = np.unique(results.element[is_shell & ~own_rows(results, model)[1]])
    if stray.size:
        return AuditRow(
            "completeness",
            "red",
            float(stray.size),
            f"{stray.size} shells have forces and are not in the mesh with these nodes, element {stray[0]} the first",
            "Give the mesh of the run that wrote the forces",
        )
    full = np.unique(results.element[shell_rows(results, model)]).size
    some = np.intersect1d(listed, mesh.element).size
    finding = f"{full} of {mesh.element.size} shells have forces at all their nodes"
    if some > full:
        finding += f", {some - full} at some nodes only"
    remedies = []
    if full < mesh.element.size:
        remedies.append("Welds at the other shells are left out; widen the GPFORCE set if they matter")
    has_forces = np.array([force[results.of_element].any() for force in results.force])
    silent = results.mode[(results.frequency > LOWEST_HZ) & ~has_forces]
    if silent.size:
        finding += f"; in {silent.size} modes with a frequency all forces are zero, mode {silent[0]} the first"
        remedies.append("Repeat the run if these modes bend the welds")
    return AuditRow(
        "completeness", "amber" if remedies else "green", full / mesh.element.size, finding, "; ".join(remedies)
    )
