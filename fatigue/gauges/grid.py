"""One grid: where it sits, which way it points, and the stress in the plane under it per unit of each coordinate."""

from dataclasses import dataclass

import numpy as np

from fatigue.errors import DataError, Problem
from fatigue.gauges.gauge_file import Gauge
from fatigue.gauges.instrument import Floats, normal_stress, strain_reading
from fatigue.gauges.material import Material, Properties, material_of
from fatigue.gauges.table_row import AtPoint
from fatigue.gauges.toe_row import AtToe

SHORTEST = np.sin(np.deg2rad(10.0))  # part of a direction in the plane: less says little of one


@dataclass(frozen=True, slots=True, eq=False)
class Piece:
    """A part of a grid on one element.

    Attributes
    ----------
    share : of the length of the grid
    stress : (3, c) s_xx, s_yy, s_xy in axes there [MPa]
    angle_deg : from their x to the grid
    material : of that element
    """

    share: float
    stress: Floats
    angle_deg: float
    material: Material

    def strain(self, transverse_sensitivity: float, turned_deg: float = 0.0) -> Floats:
        """What a grid here shows per unit of each coordinate, (c,) [ue], turned by so much in its plane [deg]."""
        E, nu = self.material.E, self.material.nu
        return strain_reading(self.stress, self.angle_deg + turned_deg, E, nu, transverse_sensitivity)


@dataclass(frozen=True, slots=True, eq=False)
class Grid:
    """A grid on a plate.

    Attributes
    ----------
    pieces : of its length, one for each element that it crosses
    angle_deg : from axis x of the element under its middle, or of the point, to the grid
    material : of the plate under its middle
    transverse_sensitivity : [-]
    xyz : (3,) its middle on the mid-surface of the plate, or the stress point, or the node of the line [mm]
    direction, normal : (3,) unit vectors along the grid and out of the face
    thickness : of the plate [mm]
    surface : the face
    stand_in : nothing can be mounted there
    element : id of the element under its middle, 0: none
    element_index : its place among the shells, -1: none
    distance : of the place that was given from the mid-surface [mm]
    part : of the weld line, 0: none
    doubts : warnings about it
    """

    pieces: tuple[Piece, ...]
    angle_deg: float
    material: Material
    transverse_sensitivity: float
    xyz: Floats
    direction: Floats
    normal: Floats
    thickness: float
    surface: str
    stand_in: bool = False
    element: int = 0
    element_index: int = -1
    distance: float = 0.0
    part: int = 0
    doubts: tuple[Problem, ...] = ()

    def strain(self, turned_deg: float = 0.0) -> Floats:
        """What the grid shows per unit of each coordinate, (c,) [ue], turned by so much in its plane [deg]."""
        readings = (piece.share * piece.strain(self.transverse_sensitivity, turned_deg) for piece in self.pieces)
        return np.asarray(sum(readings))

    def along(self) -> Floats:
        """Normal stress along the grid per unit of each coordinate, (c,) [MPa]."""
        return np.asarray(sum(piece.share * normal_stress(piece.stress, piece.angle_deg) for piece in self.pieces))


def angle_in(axes: Floats, direction: Floats) -> float:
    """Angle of a vector's part in a plane from its axis x towards y [deg]; NaN where it is along the normal.

    >>> round(angle_in(np.eye(3), np.array([1.0, 1.0, 5.0])), 9)
    45.0
    """
    x, y = axes[:2] @ direction
    in_plane = np.hypot(x, y)
    return float(np.rad2deg(np.arctan2(y, x))) if in_plane > SHORTEST * np.linalg.norm(direction) else np.nan


def vector_at(axes: Floats, angle_deg: float) -> Floats:
    """Unit vector (3,) at an angle from x towards y [deg]."""
    angle = np.deg2rad(angle_deg)
    return np.asarray(np.cos(angle) * axes[0] + np.sin(angle) * axes[1])


def given_angle(gauge: Gauge, axes: Floats) -> float:
    """Angle of a gauge in some axes [deg], as it is given or that of its direction.

    Raises
    ------
    DataError : the direction is along the normal
    """
    if gauge.angle_deg is not None:
        return gauge.angle_deg
    angle = angle_in(axes, np.array(gauge.direction))
    if np.isnan(angle):
        what = "its direction is along the normal of the plate (within 10 degrees)"
        raise DataError(Problem("bad_gauge", gauge.where, what, "Give a direction in the plate"))
    return angle


def grid_at_point(gauge: Gauge, found: AtPoint, properties: Properties) -> Grid:
    """Grid of a gauge at a stress point.

    Raises
    ------
    DataError : as ``given_angle`` and ``material_of``
    """
    angle, material = given_angle(gauge, found.axes), material_of(gauge, properties, None)
    return Grid(
        pieces=(Piece(1.0, found.stress, angle, material),),
        angle_deg=angle,
        material=material,
        transverse_sensitivity=gauge.transverse_sensitivity,
        xyz=found.xyz,
        direction=vector_at(found.axes, angle),
        normal=-found.axes[2] if gauge.surface == "bottom" else found.axes[2],
        thickness=found.thickness,
        surface=gauge.surface,
        stand_in=found.stand_in,
    )


def grid_at_toe(gauge: Gauge, toe: AtToe, properties: Properties) -> Grid:
    """Stand-in of a gauge at a toe: strain across the line where there is none along it, s_yy = nu s_xx.

    Raises
    ------
    DataError : as ``material_of``
    """
    material = material_of(gauge, properties, None)
    stress = np.stack([toe.stress, material.nu * toe.stress, np.zeros_like(toe.stress)])
    return Grid(
        pieces=(Piece(1.0, stress, 0.0, material),),
        angle_deg=0.0,
        material=material,
        transverse_sensitivity=gauge.transverse_sensitivity,
        xyz=toe.xyz,
        direction=toe.axes[0],
        normal=toe.axes[2] if gauge.surface == "top" else -toe.axes[2],
        thickness=toe.thickness,
        surface=gauge.surface,
        stand_in=True,
        part=toe.part,
    )
