"""Stress of each coordinate at the stress points in the neutral format, extrapolated to the toe as it is read.

The table is large, ten thousand points times a hundred modes are millions of rows. So its columns are read one after
the other, and what is kept is one tensor for each point, surface and coordinate.
"""

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import Problem
from fatigue.readers.neutral.body.coordinates import Coordinates
from fatigue.readers.neutral.points.rows import Rows, looked_up
from fatigue.readers.neutral.points.stress_points import StressPoints
from fatigue.readers.neutral.tables import Table, open_table
from fatigue.weld.beside.hot_spot import EDGE, FACE, ReadOuts, matching_set, sets_of

COMPONENTS = ("sx_MPa", "sy_MPa", "txy_MPa")
AT_ONCE = 1 << 18  # rows of which the weighted stress is summed together
SAME_MM = 1e-3  # distances of one read-out may differ by rounding


@dataclass(frozen=True, slots=True, eq=False)
class PointStress:
    """Stress of p points per unit of each of c coordinates, at the toe where there is one.

    Attributes
    ----------
    tensor : (p, 2, 3, c) sx, sy, txy at two surfaces [MPa per unit]: top and bottom, or the edge and nothing
    given : (p, 2) surfaces that are there
    surface : names of the two surfaces of each point
    read_outs : (p,) the set a point is extrapolated with; empty where there is one read-out
    """

    tensor: NDArray[np.float64]
    given: NDArray[np.bool_]
    surface: tuple[tuple[str, str], ...]
    read_outs: tuple[str, ...]


def read_modal_stresses(
    path: Path, points: StressPoints, coordinates: Coordinates, ignore_modes: Collection[int], *, strict: bool
) -> tuple[PointStress, list[Problem]]:
    """Read ``point, read_out, distance_mm, mode, unit_load, surface, sx_MPa, sy_MPa, txy_MPa``.

    The stress of a mode is multiplied by its ``scale``, as forces are. Rows of ignored modes are skipped.

    Raises
    ------
    DataError
        a (point, read-out, coordinate, surface) missing or given twice; an unknown point or mode; a surface that the
        kind of the point does not have; distances of no set of read-outs; a value that is no finite number
    """
    table = open_table(path, texts=("point", "surface", "unit_load"))
    plates = any(kind != EDGE for kind in points.kind)
    required = ("point", "mode", "surface", *(COMPONENTS if plates else COMPONENTS[:1]))
    table.expect(required, ("read_out", "distance_mm", "unit_load", *COMPONENTS), strict=strict)
    rows = looked_up(table, points, coordinates, ignore_modes)
    chosen, weight = _weights(table, rows, points)
    scale = np.ones(len(coordinates))
    scale[: coordinates.modes.mode.size] = coordinates.modes.scale
    tensor = np.zeros((len(points), 2, 3, len(coordinates)))
    on_edge = np.array([kind == EDGE for kind in points.kind])
    for number, name in enumerate(COMPONENTS):
        values = _component(table, name, on_edge[rows.point_of_pair] & (number > 0), rows)
        table.refuse()
        for some in (slice(first, first + AT_ONCE) for first in range(0, table.rows, AT_ONCE)):
            pair, face, coordinate = rows.pair[some], rows.face[some], rows.coordinate[some]
            factor = rows.used[some] * weight[pair] * scale[coordinate]
            np.add.at(tensor[:, :, number], (rows.point_of_pair[pair], face, coordinate), factor * values[some])
    stress = PointStress(
        tensor=tensor,
        given=rows.given,
        surface=rows.surface,
        read_outs=tuple("" if one is None else str(one) for one in chosen),
    )
    return stress, table.warnings


def _component(table: Table, name: str, unused: NDArray[np.bool_], rows: Rows) -> NDArray[np.floating]:
    """One component of the stress of every row; of pairs where it is ``unused`` it may be empty, and is 0."""
    values = table.numbers(name, default=np.nan)
    if unused.any():
        values = np.where(unused[rows.pair], values.dtype.type(0.0), values)
    table.report(np.isnan(values), "missing_value", name, "the value is missing or NaN", "Give a number")
    return values


def _weights(table: Table, rows: Rows, points: StressPoints) -> tuple[Sequence[ReadOuts | None], NDArray[np.float64]]:
    """The set of read-outs of each point, None: one read-out as it is; and the weight of each pair of both."""
    weight = np.ones(rows.point_of_pair.size)
    chosen: list[ReadOuts | None] = [None] * len(points)
    hot_spots = np.array([kind in (FACE, EDGE) for kind in points.kind])
    distance = _distances(table, rows, hot_spots)
    first = np.searchsorted(rows.point_of_pair, np.arange(len(points) + 1))
    wrong = np.zeros(len(points), dtype=np.bool_)
    for number in range(len(points)):
        pairs = slice(first[number], first[number + 1])
        if not hot_spots[number]:
            wrong[number] = pairs.stop - pairs.start > 1
            continue
        order = np.argsort(distance[pairs], kind="stable")
        found = matching_set(points.kind[number], distance[pairs][order], float(points.thickness[number]))
        chosen[number], wrong[number] = found, found is None
        if found is not None:
            weight[pairs][order] = found.weights
    if wrong.any() and not table.problems:
        _refuse_read_outs(table, rows, points, distance, wrong)
    table.refuse()
    return chosen, weight


def _distances(table: Table, rows: Rows, hot_spots: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Distance of each (point, read-out) from the toe [mm]; of points without a toe it means nothing."""
    given = table.numbers("distance_mm", default=np.nan, least=0.0)
    needed = hot_spots[rows.point_of_pair[rows.pair]]
    remedy = "Give the distance of the read-out from the toe [mm]"
    table.report(np.isnan(given) & needed, "missing_value", "distance_mm", "the value is missing or NaN", remedy)
    distance = np.zeros(rows.point_of_pair.size)
    distance[rows.pair[::-1]] = given[::-1]  # that of the first row
    differs = needed & (np.abs(given - distance[rows.pair]) > SAME_MM)
    row = int(differs.argmax())
    what = f"{given[row]:g} mm of point {_pair_name(rows, row)} was {distance[rows.pair[row]]:g} mm before"
    table.report(differs, "read_outs", "distance_mm", what, "Give one distance to each read-out of a point")
    return distance


def _pair_name(rows: Rows, row: int) -> str:
    """Point and read-out of a row, for messages."""
    pair = rows.pair[row]
    return f"{rows.names[rows.point_of_pair[pair]]}, read-out {rows.read_out_of_pair[pair]}"


def _refuse_read_outs(
    table: Table, rows: Rows, points: StressPoints, distance: NDArray[np.float64], wrong: NDArray[np.bool_]
) -> None:
    """Note the first point of each kind whose read-outs fit no rule, with the number of others."""
    for kind in dict.fromkeys(points.kind[i] for i in np.flatnonzero(wrong)):
        first, *others = (int(i) for i in np.flatnonzero(wrong) if points.kind[i] == kind)
        more = f" (and {len(others)} more points)" if others else ""
        distances = np.sort(distance[rows.point_of_pair == first])
        if kind in (FACE, EDGE):
            given = ", ".join(f"{d:g}" for d in distances.tolist())
            within = f"1 % of its {points.thickness[first]:g} mm" if kind == FACE else "0.1 mm"
            what = f"read-outs at {given} mm are no set of kind {kind}, within {within}{more}"
            remedy = f"Read the stress at the distances of one set: {', '.join(map(str, sets_of(kind)))}"
        else:
            what = f"{distances.size} read-outs are given, and a point of kind {kind} has one{more}"
            remedy = "Keep the read-out at the point"
        where = f"{table.path.name}: point {points.name[first]}"
        table.problems.append(Problem("read_outs", where, what, remedy))
