"""What makes a weld line unfit for assessment (refusals), and what is doubtful about it (warnings).

The judgements take a line or a stack of lines. Thousands of lines are judged together first, and the few that stand
out then one by one, in words.
"""

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem, refuse
from fatigue.weld.line import Lines, WeldLine, is_closed, line_of_node, neighbours
from fatigue.weld.line_geometry import edge_nodes, edge_points, edge_tangents, tangents, unit
from fatigue.weld.warnings.open_or_closed import FAR, NEAR, end_gaps, seems_closed, seems_open
from fatigue.weld.warnings.turned_normals import turned_from_neighbours, turns

# Against the nodes around: stress across the weld reads 1 - cos 20 deg = 6 % low. Welds of tube on tube of 0.95 its
# diameter, the sharpest saddles in use, reach 18 on a mesh of 12 nodes.
TURNED_ALONE = 20.0  # [deg]
TURNED_STEP = 30.0  # [deg] from a node to the next: shells that meet at a smaller angle are one plate

FARTHEST = 1e100  # [mm] a coordinate; squares of larger ones come near the largest double
VECTOR = 1e-6, 1e9  # lengths of normals and outward vectors: cross products of mesh edges are within


class _Finding(NamedTuple):
    """The nodes something is wrong at, (n,), and what it is, in words for a single line."""

    at: NDArray[np.bool_]
    code: str
    what: str
    remedy: str


def check_line(line: WeldLine, where: str) -> None:
    """Refuse a line that cannot be assessed; ``where`` names the file and the weld.

    Meant for whole lines, before they are split at kinks.

    Raises
    ------
    DataError
        With all that is wrong: too few nodes, misplaced mid-side nodes, values that are no numbers, a node named
        twice, edges without length, a thickness that is not positive, no usable plate normal or outward vector.
    """
    n, least = line.node.size, int(_least_nodes(line)[0])
    if n < least:
        what = f"{n} node{'s' * (n != 1)}, a {'closed ' * line.closed}line needs {least} or more"
        refuse(DataError, [Problem("few_nodes", where, what, "Add the missing nodes")])
    for findings in _REFUSALS:
        refuse(DataError, _problems(line, where, findings(line)))


def unfit_lines(line: Lines) -> NDArray[np.intp]:
    """Positions in a stack of the lines that ``check_line`` refuses."""
    unfit = np.diff(line.begin) < _least_nodes(line)
    with np.errstate(all="ignore"):
        for findings in _REFUSALS:
            unfit |= _touched(line, findings(line))
    return np.flatnonzero(unfit)


def line_warnings(line: WeldLine, where: str) -> list[Problem]:
    """Warnings about a line that passes ``check_line``: short edges, steps of thickness, crooked geometry."""
    return _problems(line, where, _warnings(line))


def warned_lines(line: Lines) -> NDArray[np.intp]:
    """Positions in a stack of the lines that ``line_warnings`` warns about; all lines are fit for assessment."""
    return np.flatnonzero(_touched(line, _warnings(line)))


def _warnings(line: Lines) -> list[_Finding]:
    """Findings that do not forbid an assessment."""
    nodes, points, t = edge_nodes(line), edge_points(line), line.thickness
    owner = line_of_node(line)
    chord = np.linalg.norm(points[:, 2] - points[:, 0], axis=1)
    of_edge = owner[nodes[:, 0]]
    short = chord < np.maximum(0.2 * _medians(chord, of_edge)[of_edge], 0.1 * t[nodes[:, 0]])
    fraction, _ = _mid_position(points)
    tilt = np.degrees(np.arcsin(np.abs(np.sum(unit(line.normal) * tangents(line), axis=1))))
    first = t[line.begin[:-1]][owner]
    return [
        _Finding(
            _marked(line, nodes[short, 0]),
            "short_edge",
            f"the next edge is shorter than 0.2 of the median edge, {np.median(chord):g} mm, or 0.1 of the thickness "
            f"(shortest {chord.min():g} mm)",
            "Mesh the line evenly: short edges amplify the noise of the nodal forces",
        ),
        _Finding(
            np.abs(t - first) > 0.01 * first,
            "thickness_step",
            f"thickness_mm varies along the line from {t.min():g} to {t.max():g}",
            "End one weld and begin another where the plate changes",
        ),
        _Finding(
            _marked(line, nodes[np.abs(fraction - 0.5) > 0.05, 1]),
            "mid_off_centre",
            "the mid-side node lies off the centre of its edge",
            "Check edge_mid and the coordinates",
        ),
        _Finding(
            tilt > 10,
            "normal_tilted",
            f"the plate normal is up to {tilt.max():.0f} degrees off the right angle to the line",
            "Check normal_x, normal_y and normal_z",
        ),
        *(
            _Finding(
                (size < VECTOR[0]) | (size > VECTOR[1]),
                "vector_length",
                f"{name}_x, {name}_y, {name}_z make a vector of {size.min():.3g} to {size.max():.3g}, of which only "
                f"the direction is used: below {VECTOR[0]:g} it may be round-off, above {VECTOR[1]:g} a damaged value",
                "Check its components, and write it with the length 1",
            )
            for name, size in (("normal", _size(line.normal)), ("outward", _size(line.outward)))
        ),
        *_turned_normals(line),
        *_doubtful_ends(line),
    ]


def _turned_normals(line: Lines) -> list[_Finding]:
    """Findings about normals that are square to the line and turned about it."""
    alone, step = turned_from_neighbours(line)
    turned, steps = alone > TURNED_ALONE, step > TURNED_STEP
    steps &= ~_of_lines(line, np.logical_or.reduceat(turned, line.begin[:-1]))
    most = alone.max() if turned.any() else step.max()
    limit = TURNED_ALONE if turned.any() else TURNED_STEP
    return [
        _Finding(
            turned | steps,
            "normal_turned",
            f"the plate normal is turned about the line by up to {most:.0f} degrees against the nodes beside it (more "
            f"than {limit:g})",
            "Check normal_x, normal_y and normal_z: with them stress across the weld is read in another direction",
        )
    ]


def _doubtful_ends(line: Lines) -> list[_Finding]:
    """Findings about open lines that come back to where they begin, and closed ones that do not."""
    gap, edge = end_gaps(line)
    last = _marked(line, line.begin[1:] - 1)
    return [
        _Finding(
            last & _of_lines(line, seems_closed(line)),
            "not_closed",
            f"the ends of the line lie {gap[0]:.3g} mm apart, less than {NEAR:g} edges of {edge[0]:.3g} mm: it seems "
            "to run round, and is assessed with two weld ends",
            "Write true under closed in the table of welds, or leave it so if the weld really ends there",
        ),
        _Finding(
            last & _of_lines(line, seems_open(line)),
            "far_closing_edge",
            f"the line is closed by an edge of {gap[0]:.3g} mm, more than {FAR:g} times the longest other edge, "
            f"{edge[0]:.3g} mm",
            "Write false under closed in the table of welds if the weld has ends, or add the missing nodes",
        ),
    ]


def _least_nodes(line: Lines) -> NDArray[np.int64]:
    """Number of nodes that each line needs, (k,)."""
    return np.where(is_closed(line), 3, 2)


def _wrong_rows(line: Lines) -> list[_Finding]:
    """Findings in single rows of the table."""
    first, last, closed = line.begin[:-1], line.begin[1:] - 1, is_closed(line)
    thin = ~(np.isfinite(line.thickness) & (line.thickness > 0))
    is_end = np.zeros_like(line.edge_mid)
    is_end[first] = is_end[last] = ~closed
    same_ends = line.node[first] == line.node[last]
    repeated = "Name every node once"
    if np.any(closed & same_ends):
        repeated = "Do not repeat the first node of a closed line"
    elif np.any(same_ends & (last > first)):
        repeated = "Name every node once; a line that runs round has true under closed instead"
    return [
        _Finding(
            _repeated(line_of_node(line), line.node),
            "repeated_node",
            "the node occurs more than once on the line",
            repeated,
        ),
        _Finding(
            line.edge_mid & is_end,
            "mid_at_end",
            "a mid-side node begins or ends an open line",
            "Let the line end at an element corner or correct edge_mid" + _or_closed(line),
        ),
        _Finding(
            line.edge_mid & line.edge_mid[neighbours(line)[1]],
            "mid_after_mid",
            "two mid-side nodes follow each other",
            "Add the element corner between them or correct edge_mid",
        ),
        _Finding(
            thin,
            "thickness",
            f"thickness_mm is {line.thickness[np.argmax(thin)]:g}",
            "Give the thickness of the assessed plate, a positive number",
        ),
        *(
            _Finding(
                np.any(~np.isfinite(values), axis=1),
                "not_a_number",
                f"{columns} hold a value that is no finite number",
                "Correct the value",
            )
            for columns, values in (
                ("x_mm, y_mm, z_mm", line.xyz),
                ("normal_x, normal_y, normal_z", line.normal),
                ("outward_x, outward_y, outward_z", line.outward),
            )
        ),
        _Finding(
            np.any(np.abs(line.xyz) > FARTHEST, axis=1),
            "too_large",
            f"a coordinate is {np.abs(line.xyz).max():g} mm",
            "Correct the value: no square of it can be computed",
        ),
        _Finding(
            np.all(line.normal == 0, axis=1),
            "zero_normal",
            "the normal is zero",
            "Give the top normal of the plate",
        ),
        _Finding(
            np.all(line.outward == 0, axis=1),
            "zero_outward",
            "the outward vector is zero",
            "Give a vector from the assessed plate across the line",
        ),
    ]


def _or_closed(line: Lines) -> str:
    """Words for an open line that ends half an edge before its first node."""
    to_first = np.linalg.norm(line.xyz[0] - line.xyz[-1])
    runs_round = line.node.size > 3 and to_first <= NEAR * np.linalg.norm(line.xyz[-1] - line.xyz[-2])
    return "; a line that runs round has true under closed" if runs_round else ""


def _coincident_nodes(line: Lines) -> list[_Finding]:
    """Findings about the distances between nodes."""
    first, last = line.begin[:-1], line.begin[1:] - 1
    gap = np.linalg.norm(line.xyz[neighbours(line)[1]] - line.xyz, axis=1)
    size = np.linalg.norm(np.maximum.reduceat(line.xyz, first) - np.minimum.reduceat(line.xyz, first), axis=1)
    coincident = gap <= 1e-9 * size[line_of_node(line)]
    coincident[last] &= is_closed(line)
    return [
        _Finding(
            coincident,
            "zero_edge",
            "the next node of the line has the same coordinates",
            "Merge coincident nodes or correct the coordinates",
        )
    ]


def _wrong_mid_nodes(line: Lines) -> list[_Finding]:
    """Findings about where the mid-side nodes lie."""
    nodes = edge_nodes(line)
    fraction, sagitta = _mid_position(edge_points(line))
    astray = (np.abs(fraction - 0.5) >= 0.25) | (sagitta >= 0.5)
    return [
        _Finding(
            _marked(line, nodes[astray, 1]),
            "mid_off_edge",
            "the mid-side node lies outside the middle half of its edge, or far beside it",
            "Check edge_mid, the order of the nodes and their coordinates",
        )
    ]


def _turns_back(line: Lines) -> list[_Finding]:
    """Findings about nodes without a tangent."""
    before, after = edge_tangents(line)
    back = np.linalg.norm(before + after, axis=1) < 0.02
    return [
        _Finding(back, "turns_back", "the line turns back on itself", "Check the order, or make two welds of the line")
    ]


def _wrong_normals(line: Lines) -> list[_Finding]:
    """Findings about the plate normals."""
    return [
        _Finding(
            np.linalg.norm(np.cross(unit(line.normal), tangents(line)), axis=1) < 0.1,
            "normal_along_line",
            "the normal points along the line",
            "Give the normal of the assessed plate",
        ),
        _Finding(
            np.abs(turns(line)) > 90,
            "normal_flips",
            "the normal turns to the other side before the next node",
            "Let all normals of a line point to the same side of the plate, its top",
        ),
    ]


def _wrong_sides(line: Lines) -> list[_Finding]:
    """Findings about the side of the line on which the assessed plate lies."""
    across = unit(np.cross(unit(line.normal), tangents(line)))
    reach = np.sum(unit(line.outward) * across, axis=1)
    blind = np.abs(reach) < 0.01
    sides = np.add.reduceat(reach, line.begin[:-1])[line_of_node(line)]
    return [
        _Finding(
            blind,
            "outward_along_line",
            "the outward vector has no part in the plane of the plate and normal to the line",
            "Give a vector from the assessed plate across the line",
        ),
        _Finding(
            ~blind & (reach * sides <= 0),
            "outward_changes_side",
            "the outward vector points to the other side of the line than at most of its nodes",
            "Let all outward vectors of a line point out of the assessed plate",
        ),
    ]


_REFUSALS = (_wrong_rows, _coincident_nodes, _wrong_mid_nodes, _turns_back, _wrong_normals, _wrong_sides)
"""In this order: each takes for granted what those before it refuse."""


def _size(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    """Largest component of each vector, (n,): its length to a factor of 1.7, however long it is."""
    size: NDArray[np.float64] = np.abs(vectors).max(axis=1)
    return size


def _repeated(owner: NDArray[np.int64], node: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Whether each node occurs more than once on its line, (n,)."""
    order = np.lexsort((node, owner))
    same = (np.diff(owner[order]) == 0) & (np.diff(node[order]) == 0)
    repeated = np.zeros(node.size, dtype=bool)
    repeated[order[1:][same]] = repeated[order[:-1][same]] = True
    return repeated


def _medians(values: NDArray[np.float64], group: NDArray[np.int64]) -> NDArray[np.float64]:
    """Median of the values of each group, (k,); no group is empty."""
    ascending = values[np.lexsort((values, group))]
    count = np.bincount(group)
    first = np.cumsum(count) - count
    medians: NDArray[np.float64] = (ascending[first + (count - 1) // 2] + ascending[first + count // 2]) / 2
    return medians


def _mid_position(points: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Place of each edge's middle point, (e,) each: along the chord and beside it, as shares of the chord."""
    chord, to_mid = points[:, 2] - points[:, 0], points[:, 1] - points[:, 0]
    square = np.sum(chord**2, axis=1)
    fraction = np.sum(to_mid * chord, axis=1) / square
    beside = np.linalg.norm(to_mid - fraction[:, np.newaxis] * chord, axis=1)
    return fraction, beside / np.sqrt(square)


def _touched(line: Lines, findings: Iterable[_Finding]) -> NDArray[np.bool_]:
    """Whether any finding concerns each line of a stack, (k,)."""
    nodes = np.any([found.at for found in findings], axis=0)
    touched: NDArray[np.bool_] = np.logical_or.reduceat(nodes, line.begin[:-1])
    return touched


def _of_lines(line: Lines, some: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Whether each node, (n,), is of the lines that are marked, (k,)."""
    nodes: NDArray[np.bool_] = some[line_of_node(line)]
    return nodes


def _marked(line: Lines, at: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Whether each node is at one of the given positions, (n,)."""
    mask = np.zeros(line.node.size, dtype=bool)
    mask[at] = True
    return mask


def _problems(line: WeldLine, where: str, findings: Iterable[_Finding]) -> list[Problem]:
    """Problems of the findings: each names the first node it occurs at, and how many others."""
    problems = []
    for at, code, what, remedy in findings:
        if at.any():
            first, others = np.argmax(at), np.count_nonzero(at) - 1
            place = f"{where}, node {line.node[first]} (order {line.order[first]})"
            problems.append(Problem(code, f"{place} and {others} more" if others else place, what, remedy))
    return problems
