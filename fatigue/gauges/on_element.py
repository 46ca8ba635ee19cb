"""Gauges on elements: the place is found, the forces of the elements under the grid make the stress."""

from dataclasses import dataclass

import numpy as np

from fatigue.errors import DataError, Problem
from fatigue.gauges.element_row import BOTTOM, TOP, element_stress
from fatigue.gauges.forces import WARNED, ElementLoads, corner_count, imbalance, read_element_loads
from fatigue.gauges.gauge_file import Gauge
from fatigue.gauges.grid import Grid, Piece, angle_in, given_angle, vector_at
from fatigue.gauges.instrument import Floats
from fatigue.gauges.material import Material, Properties, material_of, thickness_of
from fatigue.gauges.place import MOST_DISTANCE, Shells, Spot, crossed, located, shells_of
from fatigue.pipeline.solve.body import Body
from fatigue.weld.element_forces import BALANCE_RED

FACES = ("top", "bottom")


@dataclass(frozen=True, slots=True, eq=False)
class Plates:
    """The shells of a body, their materials, and the forces on those that have any; ``largest``: see ``imbalance``."""

    shells: Shells
    loads: ElementLoads
    properties: Properties
    largest: Floats


def read_plates(body: Body, properties: Properties) -> tuple[Plates, list[Problem]]:
    """The shells of a body and the element forces under gauges, and the warnings about the files of these.

    Raises
    ------
    DataError : as ``read_element_loads``
    """
    loads, warnings = read_element_loads(body, strict=body.strict)
    assert body.mesh is not None
    shells = shells_of(body.mesh)
    return Plates(shells, loads, properties, loads.largest()), warnings


def grid_on_element(gauge: Gauge, plates: Plates) -> Grid:
    """Grid of a gauge on an element.

    Raises
    ------
    DataError : it cannot be placed, or the plate, its material or its forces are not known there
    """
    shells = plates.shells
    spot = _spot(gauge, shells)
    element, axes = int(shells.element[spot.index]), shells.axes[spot.index]
    thickness = plate_thickness(gauge, plates, spot.index)
    if spot.distance > MOST_DISTANCE * thickness:
        what = f"the nearest element {element} is {spot.distance:.4g} mm away, more than twice its {thickness:g} mm"
        raise DataError(Problem("far_from_plate", gauge.where, what, "Correct the place [mm], or give the element"))
    centre = shells.centre[spot.index]
    if gauge.xyz is not None:
        given = np.array(gauge.xyz)
        centre = given - ((given - centre) @ axes[2]) * axes[2]
    angle = given_angle(gauge, axes)
    direction = vector_at(axes, angle)
    normal = axes[2] if spot.face == TOP else -axes[2]
    under = [(spot.index, 1.0)]
    if gauge.grid_length > 0.0:
        under = crossed(shells, spot, centre, direction, gauge.grid_length, gauge.where)
    pieces = [piece_on(gauge, plates, index, normal, direction, share) for index, share in under]
    return Grid(
        pieces=tuple(pieces),
        angle_deg=angle,
        material=material_under(gauge, plates, spot.index),
        transverse_sensitivity=gauge.transverse_sensitivity,
        xyz=centre,
        direction=direction,
        normal=normal,
        thickness=thickness,
        surface=FACES[spot.face],
        element=element,
        element_index=spot.index,
        distance=spot.distance,
        doubts=tuple(problem for index, _ in under for problem in _doubts(gauge, plates, index)),
    )


def piece_on(gauge: Gauge, plates: Plates, index: int, normal: Floats, direction: Floats, share: float) -> Piece:
    """Part of a grid on an element: stress on the face that looks along ``normal``, angle of ``direction`` there.

    Raises
    ------
    DataError : the element has no forces, or not all of them; its thickness or its material is not known
    """
    shells, loads = plates.shells, plates.loads
    axes = shells.axes[index]
    thickness = plate_thickness(gauge, plates, index)
    force = loads.of(shells, index, gauge.where)
    face = TOP if float(axes[2] @ normal) > 0.0 else BOTTOM
    stress = element_stress(loads.nodes(shells, index), thickness, force, corner_count(shells, index))[face]
    return Piece(share, stress, angle_in(axes, direction), material_under(gauge, plates, index))


def material_under(gauge: Gauge, plates: Plates, index: int) -> Material:
    """Material of an element under a gauge.

    Raises
    ------
    DataError : as ``material_of``
    """
    return material_of(gauge, plates.properties, int(plates.shells.pid[index]))


def plate_thickness(gauge: Gauge, plates: Plates, index: int) -> float:
    """Thickness of an element under a gauge [mm].

    Raises
    ------
    DataError : as ``thickness_of``
    """
    shells = plates.shells
    element, pid, own = int(shells.element[index]), int(shells.pid[index]), float(shells.thickness[index])
    doubt = plates.loads.mesh.unconfirmed.get(element, "")
    return thickness_of(gauge, plates.properties, element, pid, own, doubt)


def _doubts(gauge: Gauge, plates: Plates, index: int) -> list[Problem]:
    """Warning of an element whose forces are out of balance; worse is refused."""
    loads, element = plates.loads, int(plates.shells.element[index])
    force, corners = loads.of(plates.shells, index, gauge.where), corner_count(plates.shells, index)
    residuals = imbalance(loads.nodes(plates.shells, index), corners, force, plates.largest)
    residual = float(residuals[loads.balanced].max(initial=0.0))
    if residual <= WARNED:
        return []
    what = f"the forces of element {element} in {loads.file} are out of balance by {residual:.2g} of the largest"
    remedy = "Export static element forces only (no inertia), of all corners, in global axes"
    problem = Problem("imbalance", gauge.where, what, remedy)
    if residual > BALANCE_RED:
        raise DataError(problem)
    return [problem]


def _spot(gauge: Gauge, shells: Shells) -> Spot:
    """Element and face of a gauge, by its id or by its place."""
    if gauge.element is None:
        return located(shells, np.array(gauge.xyz), np.array(gauge.normal), gauge.where)
    index = shells.index(gauge.element)
    if index is None:
        what = f"there is no element {gauge.element} in the mesh of the case"
        remedy = "Correct element, or give x_mm, y_mm, z_mm and a normal"
        raise DataError(Problem("unknown_id", gauge.where, what, remedy))
    if np.isnan(shells.axes[index]).any():
        raise DataError(Problem("no_area", gauge.where, f"element {gauge.element} has no area", "Correct the mesh"))
    return Spot(index, FACES.index(gauge.surface), 0.0)
