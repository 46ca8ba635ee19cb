"""Forces for the weld lines: which lines have them, and their way to global axes, neutral units and the mid-surface."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from fatigue.readers.convert.modal_basis import coordinate_units
from fatigue.readers.convert.weld_lines import FoundWelds
from fatigue.readers.foreign.fe.model import FeModel, to_basic
from fatigue.readers.foreign.fe.results import SHELL_KINDS, SOLID_KINDS, FeResults
from fatigue.readers.units.systems import Normalisation, UnitSystem
from fatigue.weld.cuts import WeldCut
from fatigue.weld.mesh import normals

_CONNECTORS = frozenset(
    {
        *(
            "BAR",
            "BEAM",
            "BEAM3",
            "BEND",
            "ROD",
            "CONROD",
            "TUBE",
            "BUSH",
            "BUSH1D",
            "FAST",
            "WELD",
            "SEAM",
            "GAP",
            "VISC",
        ),
        *(f"{kind}{k}" for kind in ("ELAS", "DAMP", "MASS") for k in range(1, 5)),
        *("CONM1", "CONM2", "RBE2", "RBE3", "RBAR", "RROD"),
    }
)
"""Elements that may touch a weld line without being part of a plate."""


def with_forces_only(found: FoundWelds, results: FeResults) -> FoundWelds:
    """Weld lines, excluded where their side lacks forces or an element of unknown kind touches them."""
    present: dict[int, set[int]] = {}
    for element, node in zip(results.element[results.of_element], results.node[results.of_element], strict=True):
        present.setdefault(int(element), set()).add(int(node))
    strange_at = {of_solids: _strange_at(results, of_solids) for of_solids in (False, True)}
    gaps = {row.weld: _force_gap(cut, present, strange_at[bool(cut.columns)]) for row, cut in found.assessed()}
    rows = (
        replace(row, status="excluded", reason=gaps[row.weld]) if row.status == "assess" and gaps[row.weld] else row
        for row in found.rows
    )
    return replace(found, rows=tuple(rows))


def _strange_at(results: FeResults, of_solids: bool) -> dict[int, str]:
    """Nodes of elements that do not belong to a cut of shells, or of solids, with the kind of the element."""
    known = (SOLID_KINDS if of_solids else SHELL_KINDS) | _CONNECTORS
    strange = results.of_element & ~np.isin(results.kind, sorted(known))
    return dict(zip(results.node[strange].tolist(), results.kind[strange].tolist(), strict=True))


def _force_gap(cut: WeldCut, present: dict[int, set[int]], strange_at: dict[int, str]) -> str:
    """Every reason why a cut cannot be assessed with the forces at hand; empty if it can."""
    silent = [int(e) for e in cut.elements if int(e) not in present]
    found = []
    if silent:
        many = f"{len(silent)} of {cut.elements.size} elements"
        found.append(f"{many} have no grid point forces, element {silent[0]} the first")
    covered = set().union(*(present.get(int(e), ()) for e in cut.elements))
    nodes = [n for column in cut.columns for n in column] or cut.line.node.tolist()
    bare = [n for n in nodes if n not in covered]
    if bare and not silent:
        found.append(f"node {bare[0]} has no grid point forces")
    touching: dict[str, int] = {}
    for node in nodes:
        if node in strange_at:
            touching.setdefault(strange_at[node], node)
    found += [f"an element of kind {kind} touches the line at node {node}" for kind, node in touching.items()]
    return "; ".join(found)


def rows_at_welds(found: FoundWelds, results: FeResults) -> NDArray[np.int64]:
    """Force rows of the elements beside the welds to assess."""
    elements = np.unique(np.concatenate([cut.elements for _, cut in found.assessed()]))
    return np.flatnonzero(np.isin(results.element, elements) & results.of_element)


def neutral_forces(
    results: FeResults, model: FeModel, units: UnitSystem, normalisation: Normalisation
) -> NDArray[np.floating]:
    """Forces of all rows in basic axes, (m, r, 6) [N, N mm per unit modal coordinate of the mm, t, s system]."""
    coordinate = coordinate_units(results, units, normalisation)
    factor = units.force / coordinate[:, None, None] * np.array([1.0] * 3 + [units.length] * 3)
    force = to_basic(results.force, results.node, model)
    return force if np.all(factor == 1) else (force * factor).astype(force.dtype)


def to_mid_surface(
    force: NDArray[np.floating], results: FeResults, model: FeModel, rows: NDArray[np.int64]
) -> NDArray[np.floating]:
    """Forces with moments about the mid-surface: the grid lies at -offset along the element normal."""
    mesh = model.mesh
    rows = rows[np.isin(results.element[rows], mesh.element)]  # forces of solids stand where they act
    at = np.searchsorted(mesh.element, results.element[rows])
    offset = mesh.offset[at]
    shifted = rows[offset != 0]
    if not shifted.size:
        return force
    arm = -(offset[:, None] * normals(mesh)[at])[offset != 0]
    moved = force.copy()
    moved[:, shifted, 3:] += np.cross(arm, force[:, shifted, :3])
    return moved
