"""Element forces of solids folded onto the line: the corners of an element in one column become one corner.

Seen from the top, columns are points and bricks are plates. With the forces of each element at the nodes of a column
put together at its station, the sum along the line, the share of an element at a kink and the fan of a plate round a
joint are those of shells.
"""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem, refuse
from fatigue.weld.element_forces import ElementForces, corner_table, gaps
from fatigue.weld.line import WeldLine
from fatigue.weld.solid.columns import SolidWeld, columns_at

HELD = 1e-6  # of force times thickness: a moment below it at a node of a solid is round-off


def folded_side(
    line: WeldLine,
    weld: SolidWeld,
    side: ElementForces,
    elements: NDArray[np.int64],
    modes: NDArray[np.int64],
    where: str,
    name: Callable[[int], str],
) -> ElementForces:
    """Forces of the assessed side of a solid weld with one row per mode, element and station in place of its column.

    Parameters
    ----------
    side : forces of its ``elements``; rows at other nodes stay, they tell which elements are neighbours
    name : tells a mode in messages

    Raises
    ------
    DataError
        If an element has no forces, a node of a column no element, or a row is missing or given twice.
    """
    columns = columns_at(line, weld)
    refuse(DataError, gaps(np.setdiff1d(elements, side.element), np.setdiff1d(columns.node, side.node), where))
    in_columns = np.isin(side.node, columns.node)
    element, node, force = corner_table(side.rows(in_columns), modes, where, name)
    by_node = np.argsort(columns.node)
    at = by_node[np.searchsorted(columns.node[by_node], node)]
    station = columns.station[at]
    force[..., 3:] += np.cross((columns.xyz[at] - line.xyz[station])[:, np.newaxis], force[..., :3])
    corner = np.lexsort((station, element))
    first = np.flatnonzero(np.diff(element[corner], prepend=-1) | np.diff(station[corner], prepend=-1))
    summed = np.add.reduceat(force[corner], first, axis=0)
    others = side.rows(~in_columns)
    return ElementForces(
        mode=np.append(np.tile(modes, first.size), others.mode),
        node=np.append(np.repeat(line.node[station[corner][first]], modes.size), others.node),
        element=np.append(np.repeat(element[corner][first], modes.size), others.element),
        force=np.concatenate([summed.reshape(-1, 6), others.force]),
    )


def seen_from_the_top(forces: ElementForces, welds: Sequence[SolidWeld]) -> ElementForces:
    """Rows of element forces under the node of the station wherever they are in one of its columns; forces stay."""
    column = np.concatenate([weld.columns.node for weld in welds])
    station = np.concatenate([weld.station[weld.columns.station] for weld in welds])
    known, first = np.unique(column, return_index=True)
    at = np.searchsorted(known, forces.node).clip(max=known.size - 1)
    node = np.where(known[at] == forces.node, station[first][at], forces.node)
    return ElementForces(forces.mode, node, forces.element, forces.force)


def held_moments(force: NDArray[np.floating], thickness: float, where: str) -> list[Problem]:
    """Warn of moments at nodes of a solid, (N, m, 6): it has none, so that shells must be among the elements."""
    largest = float(np.abs(force[..., :3]).max(initial=0.0)) * thickness
    moment = float(np.abs(force[..., 3:]).max(initial=0.0))
    if not moment > HELD * largest:
        return []
    what = f"there are moments, up to {moment:.3g} N mm, at nodes of a solid weld, and solid elements have none"
    remedy = "Keep the elements of one plate side only; they are added to the moments about mid-thickness"
    return [Problem("moments_of_solids", where, what, remedy)]
