"""NASTRAN coordinate systems: CORD1R/C/S by three grids, CORD2R/C/S by three points."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem

Vector = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class FrameCard:
    """One coordinate system as the file gives it.

    Attributes
    ----------
    kind : "R" rectangular, "C" cylindrical, "S" spherical
    reference : id of the system the points are given in (CORD2)
    points : origin, a point on the z axis and one in the x-z plane (CORD2); empty for CORD1
    grids : the same three points as grids (CORD1); empty for CORD2
    """

    kind: str
    reference: int = 0
    points: tuple[tuple[float, float, float], ...] = ()
    grids: tuple[int, ...] = ()


@dataclass(frozen=True, slots=True, eq=False)
class Frame:
    """A coordinate system in basic components: its origin and its axes, one in each row."""

    kind: str
    origin: Vector
    axes: Vector


class Frames:
    """Coordinate systems by id, each found when it is first asked for.

    Parameters
    ----------
    source : file, for messages
    cards : the systems of the file
    grid : basic coordinates of a grid, which may itself ask for a system
    """

    def __init__(self, source: str, cards: dict[int, FrameCard], grid: Callable[[int], Vector]) -> None:
        self._source, self._cards, self._grid = source, cards, grid
        self._found: dict[int, Frame] = {0: Frame("R", np.zeros(3), np.eye(3))}
        self._open: set[int] = set()

    def frame(self, cid: int) -> Frame:
        """Coordinate system ``cid``.

        Raises
        ------
        DataError : it does not exist, refers to itself, or its three points lie on a line
        """
        if cid in self._found:
            return self._found[cid]
        where = f"{self._source}, coordinate system {cid}"
        if cid not in self._cards:
            raise DataError(Problem("no_frame", where, "it does not exist", "Include the file that defines it"))
        if cid in self._open:
            raise DataError(Problem("frame_loop", where, "it refers to itself", "Correct its reference"))
        self._open.add(cid)
        card = self._cards[cid]
        try:
            if card.grids:
                origin, on_z, in_xz = (self._grid(grid) for grid in card.grids)
            else:
                origin, on_z, in_xz = (self.position(card.reference, point) for point in card.points)
        finally:
            self._open.discard(cid)
        z = on_z - origin
        y = np.cross(z, in_xz - origin)
        if not (np.linalg.norm(z) > 0 and np.linalg.norm(y) > 1e-9 * np.linalg.norm(z) ** 2):
            raise DataError(Problem("frame_flat", where, "its three points lie on a line", "Correct its points"))
        z, y = z / np.linalg.norm(z), y / np.linalg.norm(y)
        frame = Frame(card.kind, origin, np.array([np.cross(y, z), y, z]))
        self._found[cid] = frame
        return frame

    def position(self, cid: int, coordinates: tuple[float, float, float]) -> Vector:
        """Basic coordinates of a point of system ``cid``; angles in degrees."""
        a, b, c = coordinates
        if cid == 0:
            return np.array([a, b, c])
        frame = self.frame(cid)
        if frame.kind == "C":
            theta = np.radians(b)
            local = np.array([a * np.cos(theta), a * np.sin(theta), c])
        elif frame.kind == "S":
            theta, phi = np.radians(b), np.radians(c)
            local = a * np.array([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)])
        else:
            local = np.array([a, b, c])
        return np.asarray(frame.origin + local @ frame.axes)

    def axes_at(self, cid: int, xyz: Vector) -> Vector:
        """Directions of system ``cid`` at a point in basic coordinates, one in each row."""
        frame = self.frame(cid)
        if frame.kind == "R":
            return frame.axes
        x, y, z = frame.axes @ (xyz - frame.origin)
        theta = np.arctan2(y, x)  # 0 on the axis, where the system's own x direction holds
        radial = np.array([np.cos(theta), np.sin(theta), 0.0])
        around = np.array([-np.sin(theta), np.cos(theta), 0.0])
        if frame.kind == "C":
            local = np.array([radial, around, [0.0, 0.0, 1.0]])
        else:
            polar = np.arctan2(np.hypot(x, y), z)
            up = np.array([0.0, 0.0, 1.0])
            local = np.array(
                [np.sin(polar) * radial + np.cos(polar) * up, np.cos(polar) * radial - np.sin(polar) * up, around]
            )
        return np.asarray(local @ frame.axes)
