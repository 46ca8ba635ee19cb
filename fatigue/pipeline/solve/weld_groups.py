"""The welds of a body in groups and blocks, and the forces of each block: memory does not grow with the body."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import Problem
from fatigue.pipeline.solve.body import Body
from fatigue.pipeline.solve.element_balance import checked_balance
from fatigue.pipeline.solve.load_forces import (
    LoadForces,
    check_unit_loads,
    element_forces_of_loads,
    loads_by_file,
    with_unit_loads,
)
from fatigue.readers.neutral.against_mesh.sides import side_warnings
from fatigue.readers.neutral.body.modes import Modes
from fatigue.readers.neutral.forces.by_group import ForcesByGroup
from fatigue.readers.neutral.forces.element_forces import read_element_forces, read_weld_elements
from fatigue.readers.neutral.forces.nodal_forces import check_nodal_forces, read_nodal_forces
from fatigue.readers.neutral.forces.regular_check import NotRegular
from fatigue.readers.neutral.register.registered_lines import registered_sides
from fatigue.readers.neutral.spare_memory import give_back
from fatigue.side_by_side import in_order
from fatigue.weld.element_forces import ElementForces, side_forces, together
from fatigue.weld.line import LineStack, WeldLine, stacked
from fatigue.weld.line_geometry import split_at_kinks
from fatigue.weld.solid.folded import folded_side, held_moments

GROUPS = 16  # that a body is cut into, so that threads have something to share,
SMALLEST_GROUP, LARGEST_GROUP = 32, 3584  # of so many stations: memory is bounded, matrices stay efficient
OF_FILE = (
    "unknown_column",
    "unit_unused",
    "not_utf8",
    "unused_forces",
)  # warnings about a whole file, told with its first block
BLOCK = 1024  # stations of a group whose forces are read and solved at once: some 40 MB at 100 modes


@dataclass(frozen=True, slots=True, eq=False)
class SideForces:
    """Element forces of the assessed sides of all welds, in memory as a whole: some 60 bytes for each row of the file.

    ``elements`` are the elements of the side of each weld; ``warnings`` are about both files.
    """

    file: str
    forces: ElementForces
    elements: Mapping[str, NDArray[np.int64]]
    warnings: tuple[Problem, ...]


@dataclass(frozen=True, slots=True, eq=False)
class WeldGroups:
    """The welds of a body in groups that are assessed one at a time, so that memory does not grow with the body.

    ``groups`` and ``blocks`` are slices of welds; ``blocks_of`` are the numbers of the blocks of each group, which are
    read and solved one at a time. ``forces`` are the nodal forces block by block, or the element forces, which do grow
    with the body and hold those of the unit loads. ``loads`` are the nodal forces of unit loads, file by file.
    """

    body: Body
    groups: tuple[slice, ...]
    blocks: tuple[slice, ...]
    blocks_of: tuple[range, ...]
    forces: ForcesByGroup | SideForces
    loads: tuple[LoadForces, ...] = ()

    def __len__(self) -> int:
        """Count the groups."""
        return len(self.groups)


def weld_groups(body: Body, scratch: Path) -> WeldGroups:
    """The welds in groups, by their stations alone, and their forces opened; no weld is ever divided.

    ``scratch`` is a folder for a sorted copy of the forces, should they need one.

    Raises
    ------
    DataError : a file of forces cannot be read, or element forces are out of balance
    """
    last = body.nodes_of_forces[1:] - 1
    group, place = np.divmod(last, min(LARGEST_GROUP, max(SMALLEST_GROUP, (int(last[-1]) + 1) // GROUPS)))
    return _open_groups(body, group, place // BLOCK, scratch)


def one_group(body: Body, scratch: Path) -> WeldGroups:
    """All welds as one group of one block, for small bodies; otherwise like ``weld_groups``."""
    together = np.zeros(len(body.welds))
    return _open_groups(body, together, together, scratch)


def check_forces(groups: WeldGroups, threads: int | None) -> None:
    """Read the forces of all welds once, so that a mistake in them is refused before anything is counted.

    ``threads``: by default one per processor core.

    Raises
    ------
    DataError : the mistakes of the first block of a group that has any
    """
    if not _are_regular(groups, threads):
        in_order(partial(_check_block, groups), range(len(groups.blocks)), threads)
    if groups.loads:
        in_order(partial(_check_loads, groups), range(len(groups.blocks)), threads)
    give_back()


def forces_of_block(groups: WeldGroups, number: int) -> tuple[LineStack, NDArray[np.floating], list[Problem]]:
    """Line parts of a block of a group, their forces (n, c, 6), and the warnings about the forces.

    Raises
    ------
    DataError : forces are missing, given twice or not finite
    """
    body, files = groups.body, groups.body.case.body
    lines = body.lines.lines(groups.blocks[number])
    if isinstance(groups.forces, SideForces):
        parts, summed, warnings = _sums_of_sides(groups.forces, lines, body)
        return parts, summed, [*(groups.forces.warnings if number == 0 else ()), *warnings]
    table = groups.forces.table(number)
    loaded = body.solids.loaded(lines)
    forces, warnings = read_nodal_forces(
        table, loaded, body.modes, files.force_convention, files.ignore_modes, strict=body.strict
    )
    if groups.loads:
        forces, of_loads = with_unit_loads(groups.loads, number, loaded, forces, files.force_convention, body)
        warnings += of_loads
    forces, of_solids = body.solids.on_lines(lines, forces, table.path.name)
    warnings += of_solids
    of_file = OF_FILE if number else ()
    return lines, forces, [warning for warning in warnings if warning.code not in of_file]


def _are_regular(groups: WeldGroups, threads: int | None) -> bool:
    """Whether one pass over nodal forces in their own order shows that there is nothing wrong with them."""
    if isinstance(groups.forces, SideForces):
        return False
    body = groups.body
    if body.solids:
        return False
    check = groups.forces.regular_check(body.lines, body.modes, body.case.body.ignore_modes, strict=body.strict)
    if check is None:
        return False
    try:
        return check.covers(in_order(check.runs, range(len(check.rows)), threads))
    except NotRegular:
        return False


def _check_block(groups: WeldGroups, number: int) -> None:
    """Check the forces of a block of a group; of element forces only the sums are left to be checked."""
    body, lines = groups.body, groups.body.lines.lines(groups.blocks[number])
    if isinstance(groups.forces, SideForces):
        _sums_of_sides(groups.forces, lines, body)
    else:
        ignored, loaded = body.case.body.ignore_modes, body.solids.loaded(lines)
        check_nodal_forces(groups.forces.table(number), loaded, body.modes, ignored, strict=body.strict)


def _check_loads(groups: WeldGroups, number: int) -> None:
    """Check the nodal forces of unit loads of a block of a group."""
    lines = groups.body.solids.loaded(groups.body.lines.lines(groups.blocks[number]))
    check_unit_loads(groups.loads, number, lines, strict=groups.body.strict)


def _open_groups(body: Body, group: NDArray[np.number], block: NDArray[np.number], scratch: Path) -> WeldGroups:
    """Groups of a body whose welds have these numbers of group and of block in the group, ascending."""
    of_blocks = _slices((np.diff(group) != 0) | (np.diff(block) != 0))
    of_groups = _slices(np.diff(group) != 0)
    first = np.searchsorted([some.start for some in of_blocks], [*(some.start for some in of_groups), len(body.welds)])
    blocks_of = tuple(range(a, b) for a, b in pairwise(first.tolist()))
    path = body.case.body.nodal_forces
    if path is None:
        return WeldGroups(body, of_groups, of_blocks, blocks_of, _side_forces(body))
    names = [body.lines.weld[some] for some in of_blocks]
    in_file = {weld.name: source for weld, (source,) in zip(body.welds, body.register.sources, strict=True)}
    skipped = {weld.name for weld in body.in_tables} - set(in_file.values())
    forces = ForcesByGroup(body.case.resolve(path), names, scratch, in_file, skipped)
    loads = tuple(
        LoadForces(axis, ForcesByGroup(body.case.resolve(file), names, scratch / f"loads-{i:03d}", in_file, skipped))
        for i, (file, axis) in enumerate(loads_by_file(body))
    )
    return WeldGroups(body, of_groups, of_blocks, blocks_of, forces, loads)


def _slices(changes: NDArray[np.bool_]) -> tuple[slice, ...]:
    """Slices of a sequence between its changes from one element to the next."""
    return tuple(slice(a, b) for a, b in pairwise([0, *(np.flatnonzero(changes) + 1).tolist(), changes.size + 1]))


def _side_forces(body: Body) -> SideForces:
    """Element forces of the assessed sides, read once for all groups; the balance of all elements is checked."""
    case, files = body.case, body.case.body
    assert files.element_forces is not None
    assert files.weld_elements is not None
    path = case.resolve(files.element_forces)
    forces, warnings = read_element_forces(
        path, body.modes, files.force_convention, files.ignore_modes, strict=body.strict
    )
    weld_elements, needed = case.resolve(files.weld_elements), body.register.names
    of_tables, of_elements = read_weld_elements(weld_elements, body.in_tables, strict=body.strict, needed=needed)
    sides = registered_sides(of_tables, body.solids.seen_from_the_top(forces), body.register, body.joints)
    warnings += of_elements + checked_balance(path, _of_elastic_modes(forces, body.modes), body.mesh, body.coordinates)
    of_sides = forces.of(np.concatenate(list(sides.values())))
    if body.mesh is not None:
        lines_file = case.resolve(files.weld_nodes).name
        warnings += side_warnings(
            body.lines, of_sides, sides, body.mesh, lines_file, weld_elements.name, set(body.solids.welds)
        )
    of_loads, about_loads = element_forces_of_loads(body, np.concatenate(list(sides.values())))
    if of_loads:
        of_sides, warnings = together([of_sides, *of_loads]), warnings + about_loads
    return SideForces(path.name, of_sides, sides, tuple(warnings))


def _sums_of_sides(
    sides: SideForces, lines: LineStack, body: Body
) -> tuple[LineStack, NDArray[np.floating], list[Problem]]:
    """Parts of lines between their kinks, the forces of the assessed side summed per part, (n, c, 6), and doubts."""
    parts: list[WeldLine] = []
    summed: list[NDArray[np.float64]] = []
    warnings: list[Problem] = []
    coordinates = body.coordinates
    for line in lines:
        split = split_at_kinks(line)
        parts += split
        where = f"{sides.file}: weld {line.weld}"
        elements, forces = sides.elements[line.weld], sides.forces
        if (weld := body.solids.welds.get(line.weld)) is not None:
            side = forces.of(elements)
            forces = folded_side(line, weld, side, elements, coordinates.number, where, coordinates.name)
            at_columns = side.force[np.isin(side.node, weld.columns.node)]
            warnings += held_moments(at_columns, float(line.thickness.min()), where)
        summed += side_forces(split, elements, forces, coordinates.number, where, coordinates.name)
    return stacked(parts), np.concatenate(summed), warnings


def _of_elastic_modes(forces: ElementForces, modes: Modes) -> ElementForces:
    """Forces without rigid modes, which are round-off, unless there are no other modes."""
    is_rigid = np.array([kind == "rigid" for kind in modes.kind])
    if not is_rigid.any() or is_rigid.all():
        return forces
    return forces.rows(~np.isin(forces.mode, modes.mode[is_rigid]))
