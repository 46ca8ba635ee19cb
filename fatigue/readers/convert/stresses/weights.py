"""The stress at a read-out as a weighted sum of stresses of elements, turned into the frame of the point.

Where elements have stresses at their corners, those of one plate are averaged at each corner, after they are turned,
and interpolated in the element that holds the read-out. Where there are centres only, the stress at the centre of that
element goes on with the slope that fits the centres round it best, which is exact for a linear field.
"""

from collections.abc import Collection, Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import Problem
from fatigue.readers.convert.stresses.axes import corner_axes, corner_tangents, element_axes, into_frame
from fatigue.readers.convert.stresses.read_outs import ReadOut
from fatigue.readers.convert.stresses.surface import Plates, weights_of_corners
from fatigue.readers.foreign.fe.shell_stress import CENTRE
from fatigue.weld.mesh import NONE

Floats = NDArray[np.float64]
RIGHT_ANGLE_DEG = 10.0  # how far from it a corner of a parabolic quadrangle may be


class Terms(NamedTuple):
    """Terms of weighted sums, (n,) each: stress of ``read_out`` = sum of weight times turned stress at element, node.

    ``turn`` is (n, 3, 3); ``top`` is +1 where the top of the point is the face to which the element's normal points.
    """

    read_out: NDArray[np.int64]
    element: NDArray[np.int64]
    node: NDArray[np.int64]
    turn: Floats
    top: NDArray[np.int64]


class Available(NamedTuple):
    """Ids of the elements that have stresses, and of those that have them at their corners."""

    anywhere: frozenset[int]
    corners: frozenset[int]


def elements_needed(plates: Plates, read_outs: Sequence[ReadOut]) -> NDArray[np.int64]:
    """Ids of the elements whose stresses read-outs may need."""
    held = {one.held.element for one in read_outs}
    return np.unique(plates.mesh.element[[e for own in held for e in (own, *plates.neighbours(own))]].astype(np.int64))


def terms_of(plates: Plates, read_outs: Sequence[ReadOut], given: Available) -> Terms:
    """Terms of all read-outs, by what there is of stresses; the elements that hold read-outs have some."""
    axes = element_axes(plates.mesh)
    rows: list[tuple[int, int, int, Floats, int]] = []
    for number, one in enumerate(read_outs):
        own = one.held.element
        at_corners = int(plates.mesh.element[own]) in given.corners
        shares = _of_corners(plates, one, given.corners) if at_corners else _of_centres(plates, one, given.anywhere)
        for element, node, weight in shares:
            frame = axes[element]
            if node != CENTRE and (plates.mesh.mid[element] != NONE).any() and plates.corners(element).size == 4:
                corner = int(np.flatnonzero(plates.mesh.node[plates.mesh.corner[element]] == node)[0])
                frame = corner_axes(plates.mesh, element, corner)
            turn = weight * into_frame(frame, one.x, one.normal)
            top = 1 if plates.normal[element] @ one.normal >= 0 else -1
            rows.append((number, int(plates.mesh.element[element]), node, turn, top))
    of_read_out, element_id, node_id, turns, tops = zip(*rows, strict=True)
    return Terms(np.array(of_read_out), np.array(element_id), np.array(node_id), np.array(turns), np.array(tops))


def _of_corners(plates: Plates, one: ReadOut, with_corners: Collection[int]) -> Iterator[tuple[int, int, float]]:
    """Element, node and weight of every corner value that a read-out rests on."""
    own = one.held.element
    corners = plates.corners(own).tolist()
    for index, share in zip(corners, weights_of_corners(one.held, len(corners)).tolist(), strict=True):
        if share == 0.0:
            continue
        round_it = [e for e in plates.fan(own, index) if int(plates.mesh.element[e]) in with_corners]
        for element in round_it:
            yield element, int(plates.mesh.node[index]), share / len(round_it)


def _of_centres(plates: Plates, one: ReadOut, with_centres: Collection[int]) -> Iterator[tuple[int, int, float]]:
    """Element and weight of every centre that a read-out rests on."""
    own = one.held.element
    around = [e for e in plates.neighbours(own) if int(plates.mesh.element[e]) in with_centres]
    x, y = one.x, np.cross(one.normal, one.x)
    plane = np.stack([x, y], axis=1)
    centre = plates.centre[own]
    place = one.point.place + one.distance * one.point.x if one.surfaces != ("edge",) else _on_element(plates, one)
    steps = (plates.centre[around] - centre).reshape(-1, 3) @ plane
    slope = (place - centre) @ plane @ np.linalg.pinv(steps, rcond=1e-3) if around else np.empty(0)
    yield own, CENTRE, 1.0 - float(slope.sum())
    for element, share in zip(around, slope.tolist(), strict=True):
        yield element, CENTRE, share


def _on_element(plates: Plates, one: ReadOut) -> Floats:
    """Place of a read-out in its element, by its natural coordinates."""
    corners = plates.corners(one.held.element)
    return np.asarray(weights_of_corners(one.held, corners.size) @ plates.mesh.xyz[corners])


def skewed(plates: Plates, terms: Terms, file: str) -> Iterator[Problem]:
    """Mistake where corners of parabolic quadrangles are far from right angles: their axes there are not known."""
    worst, count = (0.0, 0), 0
    at = np.searchsorted(plates.mesh.element, terms.element)
    for element in np.unique(at).tolist():
        if plates.corners(element).size < 4 or not (plates.mesh.mid[element] != NONE).any():
            continue
        for corner in range(4):
            xi, eta = corner_tangents(plates.mesh, element, corner)
            off = abs(90.0 - float(np.degrees(np.arccos(np.clip(xi @ eta, -1.0, 1.0)))))
            count += off > RIGHT_ANGLE_DEG
            worst = max(worst, (off, int(plates.mesh.element[element])))
    if count:
        what = (
            f"{count} corners of parabolic quadrangles are more than {RIGHT_ANGLE_DEG:g} degrees from a right angle, "
        )
        what += f"worst {worst[0]:.0f} degrees in element {worst[1]}; in which axes a solver states stresses there is "
        what += "not known"
        yield Problem("skewed_element", file, what, "Mesh the plates at the stress points with right angles, or CQUAD4")
