"""The forces of unit loads, file by file, put behind those of the modes."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import Problem
from fatigue.pipeline.solve.body import Body
from fatigue.pipeline.solve.element_balance import checked_balance
from fatigue.readers.neutral.body.unit_loads import UnitLoads
from fatigue.readers.neutral.forces.by_group import ForcesByGroup
from fatigue.readers.neutral.forces.convention import Convention
from fatigue.readers.neutral.forces.element_forces import read_element_forces
from fatigue.readers.neutral.forces.nodal_forces import check_nodal_forces, read_nodal_forces
from fatigue.weld.element_forces import ElementForces
from fatigue.weld.line import LineStack


@dataclass(frozen=True, slots=True, eq=False)
class LoadForces:
    """The nodal forces of the unit loads of one file, group of welds by group of welds."""

    loads: UnitLoads
    forces: ForcesByGroup


def loads_by_file(body: Body) -> list[tuple[str, UnitLoads]]:
    """The files of forces of unit loads, in the order in which the case names them, and the loads of each."""
    coordinates, loads = body.coordinates, body.case.body.unit_load
    numbers = dict(zip(coordinates.unit_loads, coordinates.number[len(body.modes.mode) :].tolist(), strict=True))
    files: dict[str, list[str]] = {}
    for load in loads:
        files.setdefault(load.forces, []).append(load.name)
    return [(file, UnitLoads(tuple(names), np.array([numbers[n] for n in names]))) for file, names in files.items()]


def with_unit_loads(
    files: Sequence[LoadForces],
    number: int,
    lines: LineStack,
    modal: NDArray[np.floating],
    convention: Convention,
    body: Body,
) -> tuple[NDArray[Any], list[Problem]]:
    """Forces of modes (n, m, 6) of a block of welds, and behind them those of the unit loads, (n, c, 6).

    Raises
    ------
    DataError : forces are missing, given twice or not finite
    """
    warnings: list[Problem] = []
    found: list[tuple[UnitLoads, NDArray[Any]]] = []
    for file in files:
        table = file.forces.table(number)
        forces, of_file = read_nodal_forces(table, lines, file.loads, convention, (), strict=body.strict)
        found.append((file.loads, forces))
        warnings += of_file
    kind = np.result_type(modal, *(forces for _, forces in found))
    numbers = body.coordinates.number
    together = np.empty((len(modal), numbers.size, 6), kind)
    together[:, : modal.shape[1]] = modal
    for loads, forces in found:
        together[:, np.searchsorted(numbers, loads.mode)] = forces
    return together, warnings


def check_unit_loads(files: Sequence[LoadForces], number: int, lines: LineStack, *, strict: bool) -> None:
    """Refuse what ``with_unit_loads`` refuses of a block of welds, and keep nothing."""
    for file in files:
        check_nodal_forces(file.forces.table(number), lines, file.loads, (), strict=strict)


def element_forces_of_loads(body: Body, elements: NDArray[np.int64]) -> tuple[list[ElementForces], list[Problem]]:
    """Element forces of the unit loads of each file at some elements, and the warnings about the files.

    The balance of all elements of a file is checked, but not under loads that act on the elements themselves.

    Raises
    ------
    DataError : a row given twice, a value that is not finite, or elements out of balance
    """
    carried = {load.name for load in body.case.body.unit_load if load.elements_carry_load}
    found: list[ElementForces] = []
    warnings: list[Problem] = []
    if body.case.body.element_forces is None:
        return found, warnings
    convention = body.case.body.force_convention
    for file, loads in loads_by_file(body):
        path = body.case.resolve(file)
        forces, of_file = read_element_forces(path, loads, convention, (), strict=body.strict)
        checked = [n for n, name in zip(loads.mode.tolist(), loads.names, strict=True) if name not in carried]
        balanced = forces.rows(np.isin(forces.mode, checked))
        remedy = "; or set elements_carry_load = true if the load acts on the elements themselves"
        warnings += of_file + checked_balance(path, balanced, body.mesh, body.coordinates, remedy)
        found.append(forces.of(elements))
    return found, warnings
