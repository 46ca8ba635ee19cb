"""Stress points compared with the lines of the welds they name: whether they lie there, and e1 is across the weld.

At the end of a line the toe runs around it, so that there e1 may have any direction.
"""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import Problem
from fatigue.readers.neutral.line_file import LineFile
from fatigue.readers.neutral.points.stress_points import NOMINAL, StressPoints
from fatigue.shown import few
from fatigue.weld.beside.hot_spot import FACE
from fatigue.weld.line import WeldLine

ALONG = np.cos(np.deg2rad(30.0))  # of e1 and the line: nearer to along the weld than a slip of the pen
NEAR_END = 3.0  # plate thicknesses: a toe around the end of a line is some leg lengths from its last node
FAR = 10.0  # plate thicknesses, and
FAR_MM = 100.0  # [mm]: farther off than any toe is from the line of its weld

Floats = NDArray[np.float64]


def compared_with_welds(points: StressPoints, lines: LineFile) -> tuple[list[Problem], list[Problem]]:
    """What is wrong with points of type a that name a weld, and what is doubtful of points that do."""
    place = {name: i for i, name in enumerate(lines.weld)}
    by_weld: dict[str, list[int]] = {}
    for number, weld in enumerate(points.weld):
        if weld in place and points.kind[number] in (FACE, NOMINAL):
            by_weld.setdefault(weld, []).append(number)
    along: dict[str, list[tuple[int, float]]] = {FACE: [], NOMINAL: []}
    far: list[tuple[int, float]] = []
    for weld, some in by_weld.items():
        line = lines.lines(slice(place[weld], place[weld] + 1))[0]
        for number in some:
            distance, tangent, at_end = _nearest(line, points.xyz[number], NEAR_END * points.thickness[number])
            cosine = abs(float(tangent @ points.e1[number]))
            if cosine > ALONG and not at_end:
                along[points.kind[number]].append((number, float(np.rad2deg(np.arccos(min(cosine, 1.0))))))
            if points.kind[number] == FACE and distance > max(FAR * points.thickness[number], FAR_MM):
                far.append((number, distance))
    return list(_refusals(points, along[FACE])), [*_along(points, along[NOMINAL]), *_far(points, far)]


def _nearest(line: WeldLine, xyz: Floats, near_end: float) -> tuple[float, Floats, bool]:
    """Distance [mm] of a point from a line, the line's direction there, and whether that is at an end of the line."""
    nodes = np.concatenate([line.xyz, line.xyz[:1]]) if line.closed else line.xyz
    start, edge = nodes[:-1], np.diff(nodes, axis=0)
    length = np.linalg.norm(edge, axis=1)
    along = np.clip(((xyz - start) * edge).sum(axis=1) / np.maximum(length, np.finfo(float).tiny) ** 2, 0.0, 1.0)
    foot = start + along[:, np.newaxis] * edge
    away = np.linalg.norm(xyz - foot, axis=1)
    at = int(away.argmin())
    of_ends = np.linalg.norm(nodes[[0, -1]] - foot[at], axis=1)
    tangent = edge[at] / max(float(length[at]), np.finfo(float).tiny)
    return float(away[at]), tangent, not line.closed and bool(of_ends.min() <= near_end)


def _refusals(points: StressPoints, along: Sequence[tuple[int, float]]) -> Iterator[Problem]:
    """Refusal of hot spots whose stress would be that along the weld."""
    if along:
        number, angle = along[0]
        what = f"e1 is along weld {points.weld[number]} ({angle:.0f} deg from its line), and sx the stress along it"
        what += f"; so is e1 of {len(along) - 1} more points" if len(along) > 1 else ""
        remedy = "Give e1 across the weld, and turn sx, sy, txy with it"
        yield Problem("frame", f"{points.file}: point {points.name[number]}: e1", what, remedy, len(along))


def _along(points: StressPoints, along: Sequence[tuple[int, float]]) -> Iterator[Problem]:
    """Warning about nominal stress along a weld, for which there are classes of their own."""
    if along:
        names = [points.name[number] for number, _ in along]
        what = f"the nominal stress sx of point {few(names)} is along weld {points.weld[along[0][0]]}"
        remedy = "Give e1 across the weld, unless the class of its curve is one for stress along the weld"
        yield Problem("stress_along_weld", f"{points.file}: point {names[0]}", what, remedy, len(along))


def _far(points: StressPoints, far: Sequence[tuple[int, float]]) -> Iterator[Problem]:
    """Warning about hot spots that are nowhere near their welds."""
    if far:
        number, distance = max(far, key=lambda one: one[1])
        what = f"the hot spot is {distance:.3g} mm from the line of weld {points.weld[number]}, above "
        what += f"{max(FAR * points.thickness[number], FAR_MM):g} mm (10 thicknesses, at least 100 mm)"
        what += f"; so are {len(far) - 1} more" if len(far) > 1 else ""
        remedy = "Check x_mm, y_mm, z_mm and the name of the weld"
        yield Problem("far_from_weld", f"{points.file}: point {points.name[number]}", what, remedy, len(far))


def assessed_names(assessed: Mapping[str, str], others: Sequence[str]) -> dict[str, str]:
    """Names a point may give its weld, each with the name of the weld in results.

    ``assessed`` are the names in the tables with those that welds are assessed by, which go first; ``others`` are
    welds that are not assessed.
    """
    return {name: name for name in others} | dict(assessed) | {name: name for name in assessed.values()}
