"""Whether shells and solids of the mesh have forces at all their nodes and in all modes, and no others have."""

import numpy as np

from fatigue.readers.convert.audit.row import AuditRow
from fatigue.readers.convert.audit.shell_rows import kind_in_words, own_plate_rows, plate_rows
from fatigue.readers.foreign.fe.model import FeModel
from fatigue.readers.foreign.fe.results import SHELL_KINDS, SOLID_KINDS, FeResults
from fatigue.readers.neutral.body.modes import LOWEST_HZ

UNREAD = frozenset({"PYRAM"})
"""Solids that meshes are read without."""


def completeness_row(results: FeResults, model: FeModel) -> AuditRow:
    """Row on the shells and solids of the mesh that have force rows."""
    element, kinds, word = model.mesh.element, SHELL_KINDS, kind_in_words(model)
    if model.solids is not None:
        element, kinds = np.union1d(element, model.solids.element), SHELL_KINDS | (SOLID_KINDS - UNREAD)
    listed = np.unique(results.element[results.of_element])
    is_plate = results.of_element & (np.isin(results.kind, sorted(kinds)) | np.isin(results.element, element))
    stray = np.unique(results.element[is_plate & ~own_plate_rows(results, model)])
    if stray.size:
        return AuditRow(
            "completeness",
            "red",
            float(stray.size),
            f"{stray.size} {word}s have forces and are not in the mesh with these nodes, element {stray[0]} the first",
            "Give the mesh of the run that wrote the forces",
        )
    full = np.unique(results.element[plate_rows(results, model)]).size
    some = np.intersect1d(listed, element).size
    finding = f"{full} of {element.size} {word}s have forces at all their nodes"
    if some > full:
        finding += f", {some - full} at some nodes only"
    remedies = []
    if full < element.size:
        remedies.append(f"Welds at the other {word}s are left out; widen the GPFORCE set if they matter")
    has_forces = np.array([force[results.of_element].any() for force in results.force])
    silent = results.mode[(results.frequency > LOWEST_HZ) & ~has_forces]
    if silent.size:
        finding += f"; in {silent.size} modes with a frequency all forces are zero, mode {silent[0]} the first"
        remedies.append("Repeat the run if these modes bend the welds")
    return AuditRow("completeness", "amber" if remedies else "green", full / element.size, finding, "; ".join(remedies))
