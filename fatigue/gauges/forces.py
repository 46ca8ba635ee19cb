"""Element forces under gauges: of the modes and of the unit loads, arranged node by node of each element.

They are those of the assessed sides, or a table of their own: ``[body] gauge_forces``. The sides of welds are seldom
where gauges can be.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem, refuse
from fatigue.files.naming import missing_file
from fatigue.gauges.element_row import Floats, element_frames
from fatigue.gauges.place import Shells
from fatigue.pipeline.mission.unit_loads import load_sources
from fatigue.pipeline.solve.body import Body
from fatigue.readers.neutral.body.coordinates import Coordinates
from fatigue.readers.neutral.body.mesh import Mesh
from fatigue.readers.neutral.body.unit_loads import UnitLoads
from fatigue.readers.neutral.forces.element_forces import read_element_forces
from fatigue.shown import few
from fatigue.weld.element_forces import BALANCE_FLOOR, ElementForces, together

WARNED = 1e-4  # of the largest term out of balance; single precision leaves 3e-5
MOVING = ("column", "file", "values")  # ways in which an event has a load that is no constant


@dataclass(frozen=True, slots=True, eq=False)
class ElementLoads:
    """Element forces of all coordinates, and where the nodes of an element are.

    Attributes
    ----------
    file : of the forces of the modes, for messages
    forces : with the numbers of the coordinates as their modes
    coordinates : of the body
    given : (c,) coordinates whose forces have to be there: all modes, and unit loads that have a file
    balanced : (c,) those whose forces are in balance: elastic modes, unit loads that no element carries itself
    mesh : has the nodes
    """

    file: str
    forces: ElementForces
    coordinates: Coordinates
    given: NDArray[np.bool_]
    balanced: NDArray[np.bool_]
    mesh: Mesh

    @property
    def number(self) -> NDArray[np.int64]:
        """Numbers of the coordinates (c,)."""
        return self.coordinates.number

    def nodes(self, shells: Shells, index: int) -> Floats:
        """Nodes (n, 3) of an element [mm] in its order."""
        return self.mesh.xyz[np.searchsorted(self.mesh.node, _ids(shells, index))]

    def of(self, shells: Shells, index: int, where: str) -> Floats:
        """Forces (n, c, 6) on an element at its nodes, in its order; ``where`` for messages.

        Raises
        ------
        DataError : rows are missing, given twice, or of nodes that the element does not have
        """
        element = int(shells.element[index])
        rows = self.forces.of(shells.element[index : index + 1])
        if not rows.node.size:
            what, remedy = f"element {element} has no forces in {self.file}", "Request them, or move the gauge"
            raise DataError(Problem("missing_element", where, what, remedy))
        ids = _ids(shells, index)
        order = np.argsort(ids)
        place = order[np.searchsorted(ids[order], rows.node).clip(max=ids.size - 1)]
        column = np.searchsorted(self.number, rows.mode)
        count = np.zeros((ids.size, self.number.size), dtype=np.int64)
        np.add.at(count, (place, column), 1)
        stray, wrong = ids[place] != rows.node, (count != 1) & self.given
        if stray.any() or wrong.any():
            what = f"has forces at node {rows.node[stray.argmax()]}, which is none of its nodes"
            if not stray.any():
                n, c = np.argwhere(wrong)[0]
                times = "no row" if count[n, c] == 0 else f"{count[n, c]} rows"
                what = f"has {times} at node {ids[n]} for {self.coordinates.name(int(self.number[c]))}"
            remedy = "Write the forces of every corner and mode once, zeros too"
            raise DataError(Problem("bad_rows", where, f"element {element} of {self.file} {what}", remedy))
        force = np.zeros((ids.size, self.number.size, 6))
        force[place, column] = rows.force
        return force

    def largest(self) -> Floats:
        """Largest force [N] and, at a corner, moment [N mm] of each coordinate on any element, (c, 2)."""
        column = np.searchsorted(self.number, self.forces.mode)
        found = np.zeros((self.number.size, 2))
        for i, part in enumerate((self.forces.force[:, :3], self.forces.force[:, 3:])):
            np.maximum.at(found[:, i], column, np.linalg.norm(part, axis=1))
        return found


def read_element_loads(body: Body, *, strict: bool) -> tuple[ElementLoads, list[Problem]]:
    """Element forces of modes and unit loads under gauges, and the warnings about their files.

    Raises
    ------
    DataError : there are none, or not of a unit load that changes over time; what ``read_element_forces`` refuses
    """
    case, files = body.case, body.case.body
    name = files.gauge_forces or files.element_forces
    if name is None or body.mesh is None or not body.mesh.element.size:
        lacking = "nodes and elements" if name is not None else "gauge_forces"
        what = f"gauges of kind element need element forces and the mesh, and the case names no {lacking}"
        remedy = "Give gauge_forces (as element_forces: mode, node, element, fx_N ...), nodes and elements under [body]"
        raise DataError(Problem("no_element_forces", f"{case.path.name}: body", what, remedy))
    path = case.resolve(name)
    refuse(DataError, _missing(path, f"{case.path.name}: body.gauge_forces"))
    modes, warnings = read_element_forces(path, body.modes, files.force_convention, files.ignore_modes, strict=strict)
    parts = [modes]
    for of_load in _load_files(body):
        refuse(DataError, _missing(of_load[0], f"{case.path.name}: body.unit_load"))
        of_file, about = read_element_forces(of_load[0], of_load[1], files.force_convention, (), strict=strict)
        parts.append(of_file)
        warnings += about
    warnings += _left_out(body)
    kinds, loads = np.array(body.modes.kind), case.body.unit_load
    elastic = kinds != "rigid" if (kinds != "rigid").any() else np.ones(kinds.size, dtype=np.bool_)
    given = np.array([bool(load.gauge_forces or load.element_forces) for load in loads], dtype=np.bool_)
    balanced = given & ~np.array([load.elements_carry_load for load in loads], dtype=np.bool_)
    found = ElementLoads(
        file=path.name,
        forces=together(parts),
        coordinates=body.coordinates,
        given=np.concatenate([np.ones(kinds.size, dtype=np.bool_), given]),
        balanced=np.concatenate([elastic, balanced]),
        mesh=body.mesh,
    )
    return found, warnings


def imbalance(nodes: Floats, corners: int, force: Floats, largest: Floats) -> Floats:
    """How far an element is from balance in each coordinate (c,), of its largest term or 1e-3 of ``largest`` (c, 2).

    Of forces, and of moments about the axes in its plane: without those about the normal, which do no work, forces in
    the plane need not balance. ``largest`` are the largest force and moment of each coordinate on any element.
    """
    frame = element_frames(nodes, corners)
    f, m = force[..., :3], force[..., 3:]
    arm = np.broadcast_to((nodes - frame.centre)[:, None, :], f.shape)
    moment = (np.cross(arm, f) + m) @ frame.axes[:2].T
    size_f = np.linalg.norm(f, axis=-1).max(axis=0)
    size_m = np.maximum(np.linalg.norm(np.cross(arm, f), axis=-1), np.linalg.norm(m, axis=-1)).max(axis=0)
    reference = np.maximum(np.stack([size_f, size_m], axis=-1), BALANCE_FLOOR * largest)
    resultant = np.stack([np.linalg.norm(part.sum(axis=0), axis=-1) for part in (f, moment)], axis=-1)
    residual = np.divide(resultant, reference, out=np.zeros_like(resultant), where=reference > 0.0)
    return np.asarray(residual.max(axis=-1))


def _ids(shells: Shells, index: int) -> NDArray[np.int64]:
    """Ids of the nodes of an element; a quadrilateral with a corner twice is a triangle."""
    ids = shells.nodes[index][shells.nodes[index] > 0]
    twice = ids.size == 4 and ids[3] == ids[2]
    return np.asarray(ids[:3] if twice else ids)


def corner_count(shells: Shells, index: int) -> int:
    """Corners of an element, 3 or 4: its first nodes."""
    ids = shells.nodes[index]
    return 3 if ids[3] in (0, ids[2]) else 4


def _missing(path: Path, where: str) -> Iterator[Problem]:
    if not path.is_file():
        yield missing_file(path, where)


def _load_files(body: Body) -> list[tuple[Path, UnitLoads]]:
    """Files of element forces of unit loads, and the loads that each holds."""
    coordinates, of_case = body.coordinates, body.case.body.unit_load
    numbers = dict(zip(coordinates.unit_loads, coordinates.number[len(body.modes.mode) :].tolist(), strict=True))
    files: dict[str, list[str]] = {}
    for load in of_case:
        if (file := load.gauge_forces or load.element_forces) is not None:
            files.setdefault(file, []).append(load.name)
    return [
        (body.case.resolve(file), UnitLoads(tuple(names), np.array([numbers[name] for name in names])))
        for file, names in files.items()
    ]


def _left_out(body: Body) -> list[Problem]:
    """Warning of unit loads without element forces, whose strain is missing; refused where they are no constants.

    Raises
    ------
    DataError : such a load changes over the time of an event
    """
    case = body.case
    without = [load.name for load in case.body.unit_load if not (load.gauge_forces or load.element_forces)]
    if not without:
        return []
    where = f"{case.path.name}: body.unit_load"
    remedy = "Give gauge_forces of the unit load: its element forces under the gauges"
    moving = {
        source.name
        for event in case.mission.event
        for source in load_sources(body, event)
        if source.name in without and source.way in MOVING
    }
    if moving:
        what = f"{few(sorted(moving))} changes over an event, and has no element forces under gauges"
        raise DataError(Problem("load_not_in_gauges", where, what, remedy))
    what = f"{few(without)} has no element forces: gauges on elements do not read it. It is constant in every event, "
    what += "so that only means are wrong"
    return [Problem("load_not_in_gauges", where, what, remedy, len(without))]
