"""The case brought to life: everything read, checked and solved once, before any event is counted."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.case import Case, check_files
from fatigue.errors import DataError, Problem
from fatigue.rated_curves import RatedCurve, curves_of_case, rated_curves
from fatigue.readers.body import Mesh, Modes, Weld, read_mesh, read_modes, read_weld_nodes, read_welds
from fatigue.readers.forces import read_element_forces, read_nodal_forces, read_weld_elements
from fatigue.stations import Stations, stations_of
from fatigue.weld.edge_type import edge_type_warnings
from fatigue.weld.element_forces import ElementForces, balance, side_forces
from fatigue.weld.line import WeldLine, split_at_kinks
from fatigue.weld.structural_stress import LineStress, assess_line

IMBALANCE = {"error": 1e-3, "warning": 1e-5}  # of the element's largest force; single precision leaves 1e-6


@dataclass(frozen=True, slots=True, eq=False)
class Model:
    """One body under one case, ready for its events.

    ``lines`` are the solved line parts, ``stations`` the same as one table; ``curves`` holds every curve a weld asks
    for; ``mesh`` is there for pictures only.
    """

    case: Case
    modes: Modes
    welds: tuple[Weld, ...]
    lines: tuple[LineStress, ...]
    stations: Stations
    curves: Mapping[str, RatedCurve]
    mesh: Mesh | None
    strict: bool
    warnings: tuple[Problem, ...]

    @property
    def curve_of_weld(self) -> list[str]:
        """Key of the curve of every weld: its own, else that of the case."""
        return [weld.curve or self.case.curve.name for weld in self.welds]


def read_model(case: Case, *, strict: bool) -> Model:
    """Read the body of a case and solve the structural stress of all its welds for all modes at once.

    Raises
    ------
    CaseError, DataError : with every mistake found in the file at fault
    """
    check_files(case)
    body = case.body
    known_curves = curves_of_case(case)
    modes, warnings = read_modes(case.resolve(body.modes), body.ignore_modes, strict=strict)
    welds, doubts = read_welds(case.resolve(body.welds), known_curves, strict=strict)
    warnings += doubts
    curves = rated_curves(case, known_curves, welds)
    lines, doubts = read_weld_nodes(case.resolve(body.weld_nodes), welds, strict=strict)
    warnings += doubts
    mesh: Mesh | None = None
    if body.nodes:
        elements = case.resolve(body.elements) if body.elements else None
        mesh, doubts = read_mesh(case.resolve(body.nodes), elements, strict=strict)
        warnings += doubts

    if body.nodal_forces:
        path = case.resolve(body.nodal_forces)
        forces, doubts = read_nodal_forces(path, lines, modes, body.force_convention, body.ignore_modes, strict=strict)
    else:
        lines, forces, doubts = _forces_of_sides(case, welds, lines, modes, mesh, strict)
    warnings += doubts

    solved = tuple(assess_line(line, force) for line, force in zip(lines, forces, strict=True))
    for line, force, result in zip(lines, forces, solved, strict=True):
        where = f"{body.weld_nodes}: weld {line.weld}"
        warnings += edge_type_warnings(line, force, where) + _end_warnings(result, where)
    return Model(
        case=case,
        modes=modes,
        welds=welds,
        lines=solved,
        stations=stations_of(solved, [weld.name for weld in welds]),
        curves=curves,
        mesh=mesh,
        strict=strict,
        warnings=tuple(warnings),
    )


def _forces_of_sides(
    case: Case, welds: Sequence[Weld], lines: Sequence[WeldLine], modes: Modes, mesh: Mesh | None, strict: bool
) -> tuple[tuple[WeldLine, ...], tuple[NDArray[np.float64], ...], list[Problem]]:
    """Split lines at their kinks and sum the element forces of the assessed side per part."""
    body = case.body
    assert body.element_forces is not None
    assert body.weld_elements is not None
    path = case.resolve(body.element_forces)
    forces, warnings = read_element_forces(path, modes, body.force_convention, body.ignore_modes, strict=strict)
    sides, doubts = read_weld_elements(case.resolve(body.weld_elements), welds, strict=strict)
    warnings += doubts + _checked_balance(path, forces, mesh)
    parts: list[WeldLine] = []
    summed: list[NDArray[np.float64]] = []
    for line in lines:
        split = split_at_kinks(line)
        parts += split
        summed += side_forces(split, sides[line.weld], forces, modes.mode, f"{path.name}: weld {line.weld}")
    return tuple(parts), tuple(summed), warnings


def _checked_balance(path: Path, forces: ElementForces, mesh: Mesh | None) -> list[Problem]:
    """Refuse element forces out of equilibrium; mention those further off than single precision explains."""
    xyz = None if mesh is None else dict(zip(mesh.node.tolist(), mesh.xyz, strict=True))
    found = balance(forces, xyz)
    residual = (
        found.force_residual
        if found.moment_residual is None
        else np.maximum(found.force_residual, found.moment_residual)
    )
    worst = int(residual.argmax())
    if residual[worst] <= IMBALANCE["warning"]:
        return []
    problem = Problem(
        "imbalance",
        f"{path.name}: element {found.element[worst]}, mode {found.mode[worst]}",
        f"forces and moments are out of balance by {residual[worst]:.2g} of the largest",
        "Export static element forces only (no inertia), of all corners, in global axes",
    )
    if residual[worst] > IMBALANCE["error"]:
        raise DataError(problem)
    return [problem]


def _end_warnings(solved: LineStress, where: str) -> list[Problem]:
    if not solved.unresolved.any():
        return []
    nodes = ", ".join(str(node) for node in solved.line.node[solved.unresolved])
    return [
        Problem(
            "end_unresolved",
            where,
            f"the edge at the end node {nodes} is longer than the length of the end treatment",
            "Refine the mesh at the weld end, or read the end value as one of a single edge",
        )
    ]
