"""Welds brought to life: their forces read and their structural stress solved, for all modes at once."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from numpy.typing import NDArray

from fatigue.case import Case
from fatigue.errors import DataError, NumericalError, Problem
from fatigue.pipeline.body import Body, read_body
from fatigue.pipeline.rated_curves import RatedCurve
from fatigue.pipeline.stations import Stations, stations_of
from fatigue.readers.body import Mesh, Modes, Weld
from fatigue.readers.force_pieces import ForcePieces
from fatigue.readers.forces import read_element_forces, read_nodal_forces, read_weld_elements
from fatigue.weld.edge_type import edge_type_warnings
from fatigue.weld.element_forces import ElementForces, balance, side_forces
from fatigue.weld.line import WeldLine, split_at_kinks
from fatigue.weld.structural_stress import LineStress, assess_line

GROUP = 2048  # stations whose forces are in memory at once; welds are never divided
IMBALANCE = {"error": 1e-3, "warning": 1e-4}  # of the element's largest term; single precision leaves 3e-5


@dataclass(frozen=True, slots=True, eq=False)
class Model:
    """Some welds of a body, or all of them, ready for events.

    ``lines`` are the solved line parts of ``welds``, ``stations`` the same as one table, its ``weld`` an index into
    ``welds``; ``warnings`` are the doubts about these welds' forces and lines.
    """

    body: Body
    welds: tuple[Weld, ...]
    lines: tuple[LineStress, ...]
    stations: Stations
    warnings: tuple[Problem, ...]

    @property
    def case(self) -> Case:
        """The case the body belongs to."""
        return self.body.case

    @property
    def modes(self) -> Modes:
        """The modes of the body."""
        return self.body.modes

    @property
    def curves(self) -> Mapping[str, RatedCurve]:
        """The curves of the body."""
        return self.body.curves

    @property
    def curve_of_weld(self) -> list[str]:
        """Key of the curve of every weld."""
        return [self.body.curve_of(weld) for weld in self.welds]


@dataclass(frozen=True, slots=True, eq=False)
class WeldGroups:
    """The welds of a body in groups that are solved one at a time, so that memory does not grow with the body.

    ``pieces`` are the nodal forces of each group, None where the case has element forces.
    """

    body: Body
    groups: tuple[slice, ...]
    pieces: ForcePieces | None

    def __len__(self) -> int:
        """Count the groups."""
        return len(self.groups)


def read_model(case: Case, *, strict: bool) -> Model:
    """Read a body and solve all its welds at once, for small bodies and notebooks.

    Raises
    ------
    CaseError, DataError : with every mistake found in the file at fault
    """
    with TemporaryDirectory() as scratch:
        return solve_group(_open_groups(read_body(case, strict=strict), (slice(None),), Path(scratch)), 0)


def weld_groups(body: Body, scratch: Path) -> WeldGroups:
    """Cut the welds into groups of about ``GROUP`` stations and open their forces.

    ``scratch`` is a folder for a sorted copy of the forces, should they need one.
    """
    sizes = np.cumsum([len(line.node) for line in body.lines])
    group = (sizes - 1) // GROUP
    first = [0, *(np.flatnonzero(np.diff(group)) + 1).tolist(), len(sizes)]
    return _open_groups(body, tuple(slice(a, b) for a, b in pairwise(first)), scratch)


def check_forces(groups: WeldGroups) -> None:
    """Read the forces of all welds once, so that a mistake in them is refused before anything is counted."""
    for number in range(len(groups)):
        _forces(groups, number)


def solve_group(groups: WeldGroups, number: int) -> Model:
    """Read the forces of one group of welds and solve their structural stress.

    Raises
    ------
    DataError : forces are missing, given twice, not finite or out of balance
    """
    body = groups.body
    welds = body.welds[groups.groups[number]]
    lines, forces, warnings = _forces(groups, number)
    solved = tuple(_solved(line, force) for line, force in zip(lines, forces, strict=True))
    for line, force, result in zip(lines, forces, solved, strict=True):
        where = f"{body.case.body.weld_nodes}: weld {line.weld}"
        warnings += edge_type_warnings(line, force, where) + _end_warnings(result, where)
    return Model(
        body=body,
        welds=welds,
        lines=solved,
        stations=stations_of(solved, [weld.name for weld in welds]),
        warnings=tuple(warnings),
    )


def _solved(line: WeldLine, force: NDArray[np.floating]) -> LineStress:
    try:
        with np.errstate(over="raise", divide="raise"):
            return assess_line(line, force)
    except FloatingPointError:
        problem = Problem(
            "overflow",
            f"weld {line.weld}",
            "the structural stress per unit modal coordinate exceeds what double precision can hold",
            "Check forces, coordinates and thickness of the weld for a value that is far too large or small",
        )
        raise NumericalError(problem) from None


def _open_groups(body: Body, groups: tuple[slice, ...], scratch: Path) -> WeldGroups:
    path = body.case.body.nodal_forces
    if path is None:
        return WeldGroups(body, groups, None)
    names = [[line.weld for line in body.lines[group]] for group in groups]
    return WeldGroups(body, groups, ForcePieces(body.case.resolve(path), names, scratch))


def _forces(
    groups: WeldGroups, number: int
) -> tuple[tuple[WeldLine, ...], tuple[NDArray[np.floating], ...], list[Problem]]:
    """Read the forces of a group of welds: their line parts, (n, m, 6) forces of each, and the doubts about them."""
    body, files = groups.body, groups.body.case.body
    welds, lines = body.welds[groups.groups[number]], body.lines[groups.groups[number]]
    if groups.pieces is None:
        return _forces_of_sides(body, welds, lines)
    forces, warnings = read_nodal_forces(
        groups.pieces.table(number), lines, body.modes, files.force_convention, files.ignore_modes, strict=body.strict
    )
    return lines, forces, warnings


def _forces_of_sides(
    body: Body, welds: Sequence[Weld], lines: Sequence[WeldLine]
) -> tuple[tuple[WeldLine, ...], tuple[NDArray[np.floating], ...], list[Problem]]:
    """Split lines at their kinks and sum the element forces of the assessed side per part."""
    case, files = body.case, body.case.body
    assert files.element_forces is not None
    assert files.weld_elements is not None
    path = case.resolve(files.element_forces)
    forces, warnings = read_element_forces(
        path, body.modes, files.force_convention, files.ignore_modes, strict=body.strict
    )
    sides, doubts = read_weld_elements(case.resolve(files.weld_elements), body.welds, strict=body.strict)
    warnings += doubts + _checked_balance(path, forces, body.mesh)
    parts: list[WeldLine] = []
    summed: list[NDArray[np.float64]] = []
    for weld, line in zip(welds, lines, strict=True):
        split = split_at_kinks(line)
        parts += split
        summed += side_forces(split, sides[weld.name], forces, body.modes.mode, f"{path.name}: weld {weld.name}")
    return tuple(parts), tuple(summed), warnings


def _checked_balance(path: Path, forces: ElementForces, mesh: Mesh | None) -> list[Problem]:
    """Refuse element forces out of equilibrium; mention those further off than single precision explains."""
    xyz = None if mesh is None else dict(zip(mesh.node.tolist(), mesh.xyz, strict=True))
    found = balance(forces, xyz)
    moment = found.force_residual if found.moment_residual is None else found.moment_residual
    residual = np.maximum(found.force_residual, moment)
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
