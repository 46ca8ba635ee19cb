"""The lines of the welds in the neutral format, and what is wrong or doubtful about them."""

from collections.abc import Collection, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem, refuse
from fatigue.readers.neutral.body.welds import Weld
from fatigue.readers.neutral.tables import Table, open_table
from fatigue.weld.line import LineStack, WeldLine
from fatigue.weld.line_check import check_line, line_warnings, unfit_lines, warned_lines

CHECKED_TOGETHER = 256  # weld lines


def read_lines(
    path: Path, welds: Sequence[Weld], needed: Collection[str], *, strict: bool
) -> tuple[LineStack, list[Problem]]:
    """Read the line of every weld, in the order of ``welds`` and sorted by ``order``; those ``needed`` must be there.

    Columns: ``weld, order, node, x_mm, y_mm, z_mm, thickness_mm, normal_x|y|z, outward_x|y|z`` and, where present,
    ``edge_mid``.

    Raises
    ------
    DataError
        a needed weld without nodes, nodes of an unknown weld, a repeated order or node
    """
    table = open_table(path, texts=("weld",))
    vectors = {name: [f"{name}_{axis}" for axis in "xyz"] for name in ("normal", "outward")}
    coordinates = ["x_mm", "y_mm", "z_mm"]
    table.expect(
        ("weld", "order", "node", *coordinates, "thickness_mm", *vectors["normal"], *vectors["outward"]),
        ("edge_mid",),
        strict=strict,
    )
    names, code = table.groups("weld")
    order = table.integers("order")
    node = table.integers("node")
    xyz = _vectors(table, coordinates)
    thickness = table.numbers("thickness_mm", above=0.0).astype(np.float64)
    normal, outward = _vectors(table, vectors["normal"]), _vectors(table, vectors["outward"])
    edge_mid = table.flags("edge_mid", default=False)
    table.unique({"weld": code, "order": order}, {"weld": names})
    table.unique({"weld": code, "node": node}, {"weld": names})
    table.known("weld", names, code, {weld.name for weld in welds}, "the welds")
    table.complete("weld", names, [weld.name for weld in welds if weld.name in needed], "nodes")
    table.refuse()
    place = {weld.name: i for i, weld in enumerate(welds)}
    of_weld = np.array([place[name] for name in names])[code]
    along = np.lexsort((order, of_weld))
    at = slice(None) if np.array_equal(along, np.arange(along.size)) else along  # no copies of a sorted file
    bare = np.zeros(len(welds), dtype=np.bool_)
    lines = LineStack(
        weld=tuple(weld.name for weld in welds),
        part=np.ones(len(welds), dtype=np.int64),
        closed=np.array([weld.closed for weld in welds]),
        end_length=np.array([np.nan if weld.end_length is None else weld.end_length for weld in welds]),
        corner_start=bare,
        corner_end=bare,
        begin=np.append(0, np.cumsum(np.bincount(of_weld, minlength=len(welds)))),
        order=order[at],
        node=node[at],
        xyz=xyz[at],
        thickness=thickness[at],
        normal=normal[at],
        outward=outward[at],
        edge_mid=edge_mid[at],
    )
    return lines, table.warnings


def _vectors(table: Table, names: Sequence[str]) -> NDArray[np.float64]:
    """Read three columns of numbers as vectors, (r, 3)."""
    vectors = np.empty((table.rows, 3))
    for axis, name in enumerate(names):
        vectors[:, axis] = table.numbers(name)
    return vectors


def checked_lines(lines: LineStack, file: str) -> list[Problem]:
    """Warnings about lines that can be assessed; the lines of all welds that cannot are refused together."""
    problems: list[Problem] = []
    warnings: list[Problem] = []
    for first in range(0, len(lines), CHECKED_TOGETHER):
        some = lines.lines(slice(first, first + CHECKED_TOGETHER))
        for i in unfit_lines(some):
            try:
                check_line(some[i], _place(file, some[i]))
            except DataError as error:
                problems += error.problems
        if not problems:
            for i in warned_lines(some):
                warnings += line_warnings(some[i], _place(file, some[i]))
    refuse(DataError, problems)
    return warnings


def _place(file: str, line: WeldLine) -> str:
    return f"{file}: weld {line.weld}"
