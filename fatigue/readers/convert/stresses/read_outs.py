"""The places where stress is read: for each a shell, the frame of its point there, and what is wrong or doubtful."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import Problem
from fatigue.readers.convert.options import Density
from fatigue.readers.convert.stresses.edge import along_edge, foot
from fatigue.readers.convert.stresses.points import StressPoint
from fatigue.readers.convert.stresses.surface import INSIDE, Held, Plates, holding
from fatigue.weld.beside.hot_spot import EDGE, FACE
from fatigue.weld.mesh import NONE

Floats = NDArray[np.float64]
_SAME_THICKNESS = 0.01
_FINE_OF_T, _COARSE_OF_T, _FINE_EDGE_MM, _COARSE_EDGE_MM = 0.4, 1.0, 4.0, 10.0  # IIW recommendations, sizes of elements
_LARGER = 1.1


@dataclass(frozen=True, slots=True, eq=False)
class ReadOut:
    """One place where stress is read.

    Attributes
    ----------
    point : it belongs to
    number : of the read-out, from 1
    distance : from the toe [mm]
    held : the element that holds it, and where
    x, normal : of the frame there
    """

    point: StressPoint
    number: int
    distance: float
    held: Held
    x: Floats
    normal: Floats

    @property
    def surfaces(self) -> tuple[str, ...]:
        """Faces of the plate whose stress is wanted."""
        return ("edge",) if self.point.kind == EDGE else ("top", "bottom")

    @property
    def called(self) -> str:
        """What the read-out is called in messages."""
        return f"read-out {self.number}, {self.distance:g} mm from point {self.point.name}"


def place_read_outs(
    plates: Plates, points: Sequence[StressPoint], density: Density, file: str
) -> tuple[list[ReadOut], list[Problem]]:
    """Read-outs of all points, and the mistakes of those that lie in no shell."""
    found: list[ReadOut] = []
    problems: list[Problem] = []
    for point in points:
        where = f"{file}: row {point.row + 1}, point {point.name}"
        for one in (_on_edge if point.kind == EDGE else _on_face)(plates, point, density, where):
            if isinstance(one, Problem):
                problems.append(one)
            else:
                found.append(one)
    return found, problems


def _on_face(plates: Plates, point: StressPoint, density: Density, where: str) -> Iterator[ReadOut | Problem]:
    """Read-outs on a straight line from the toe."""
    for number, distance in enumerate(point.distances(density), 1):
        place = point.place + distance * point.x
        all_held = holding(plates, place, point.normal, point.thickness)
        inside = [held for held in all_held if held.excess <= INSIDE]
        if not inside:
            yield _outside(where, number, distance, place, point, all_held, plates)
            return
        ahead = sorted(inside, key=lambda h: (round(abs(h.height), 6), -(plates.centre[h.element] - place) @ point.x))
        yield ReadOut(point, number, distance, ahead[0], point.x, point.normal)


def _outside(
    where: str, number: int, distance: float, place: Floats, point: StressPoint, near: list[Held], plates: Plates
) -> Problem:
    """Refusal of a place that lies in no shell, with how far it is from the nearest one."""
    at = ", ".join(f"{c:g}" for c in place)
    what = f"read-out {number} at {distance:g} mm ({at}) lies in no shell that is parallel to the plate"
    if near:
        away = min(_away(plates, held, place) for held in near)
        what += f"; the nearest one, element {plates.mesh.element[near[0].element]}, is {away:.3g} mm away"
    remedy = "Correct x_mm, y_mm, z_mm and normal_x|y|z"
    if distance:
        remedy += ", or turn e1 round: it points from the toe into the plate, away from the weld"
    elif point.kind == FACE:
        remedy += "; the point is the toe"
    return Problem("outside_plate", where, what, remedy)


def _away(plates: Plates, held: Held, place: Floats) -> float:
    """Distance of a place from the outline of an element [mm]."""
    ends = plates.ends[held.element]
    ends = ends[(ends != NONE).all(axis=1)]
    first, last = plates.mesh.xyz[ends[:, 0]], plates.mesh.xyz[ends[:, 1]]
    chord = last - first
    at = np.clip(np.sum((place - first) * chord, axis=1) / np.sum(chord**2, axis=1), 0.0, 1.0)
    return float(np.linalg.norm(first + at[:, None] * chord - place, axis=1).min())


def _on_edge(plates: Plates, point: StressPoint, density: Density, where: str) -> Iterator[ReadOut | Problem]:
    """Read-outs along the free edge of the plate."""
    start = foot(plates, point.place, point.x)
    if start is None or start.distance > 0.6 * point.thickness:
        nearest = "none" if start is None else f"the nearest is {start.distance:.3g} mm away"
        what = f"the point lies on no free edge of a shell that runs along e1: {nearest}"
        remedy = "Give a point on the edge of the plate, and e1 along the edge, away from the weld"
        yield Problem("outside_plate", where, what, remedy)
        return
    for number, distance in enumerate(point.distances(density), 1):
        on = along_edge(plates, start, point.x, distance)
        if on.missing > 0:
            what = f"read-out {number} at {distance:g} mm: the edge ends or turns {on.missing:.3g} mm before it"
            remedy = "Turn e1 round: it points along the edge, away from the weld; or give another kind of point"
            yield Problem("outside_plate", where, what, remedy)
            return
        normal = plates.normal[on.element]
        (held,) = (h for h in holding(plates, on.place, normal, point.thickness) if h.element == on.element)
        yield ReadOut(point, number, distance, held, on.along, normal)


def doubts(plates: Plates, read_outs: Sequence[ReadOut], density: Density, file: str) -> list[Problem]:
    """Warnings, one of a kind: other thicknesses, coarse elements, read-outs beyond a line where plates meet."""
    thickness, coarse, across = [], [], []
    first: dict[str, ReadOut] = {}
    for one in read_outs:
        own = float(plates.mesh.thickness[one.held.element])
        before = first.setdefault(one.point.name, one)
        if one is before and abs(own - one.point.thickness) > _SAME_THICKNESS * one.point.thickness:
            thickness.append(
                f"{one.point.thickness:g} mm at point {one.point.name}, {own:g} mm in element "
                f"{plates.mesh.element[one.held.element]}"
            )
        most = _largest_element(one, density)
        size = plates.size(one.held.element)
        if one is before and most and size > _LARGER * most:
            coarse.append(f"{size:.3g} mm at point {one.point.name}, at most {most:.3g} mm")
        if one.point.kind == FACE and not _is_joined(plates, one):
            across.append(one.called)
    return [
        *_told("point_thickness", file, thickness, "plate and shell differ in thickness", "Correct thickness_mm; "
               "bending stress is that of the shell"),
        *_told("coarse_elements", file, coarse, f"elements are larger than {density} read-outs want (IIW "
               "recommendations: 0.4 t, 4 mm on edges; coarse: t, 10 mm)", "Mesh finer, or state --read-outs coarse"),
        *_told("across_plates", file, across, "plates meet, or the section changes, between the read-outs of a point",
               "Turn e1 round if it points into the weld: it points from the toe into the plate"),
    ]  # fmt: skip


def _told(code: str, where: str, found: list[str], what: str, remedy: str) -> Iterator[Problem]:
    """One warning for all that is alike."""
    if found:
        more = f" and {len(found) - 2} more" if len(found) > 2 else ""
        yield Problem(code, where, f"{what}: {'; '.join(found[:2])}{more}", remedy, len(found))


def _largest_element(one: ReadOut, density: Density) -> float:
    """Size of elements that read-outs of this density are meant for [mm]; 0 where nothing is extrapolated."""
    if one.point.kind == EDGE:
        return _COARSE_EDGE_MM if density == "coarse" else _FINE_EDGE_MM
    of_t = _COARSE_OF_T if density == "coarse" else _FINE_OF_T
    return of_t * one.point.thickness if one.point.kind == FACE else 0.0


def _is_joined(plates: Plates, one: ReadOut) -> bool:
    """Whether the plate goes on smoothly from the toe to a read-out; a toe on a line belongs to both sides of it."""
    point = one.point
    toe = [h.element for h in holding(plates, point.place, point.normal, point.thickness) if h.excess <= INSIDE]
    if not toe or one.held.element in toe:
        return True
    reach = one.distance + 2.0 * max(plates.size(element) for element in toe)
    found, todo = set(toe), list(toe)
    while todo:
        for other in plates.smooth[todo.pop()].tolist():
            is_near = np.linalg.norm(plates.centre[other] - point.place) <= reach + plates.reach[other]
            if other != NONE and other not in found and is_near:
                found.add(other)
                todo.append(other)
    return one.held.element in found
