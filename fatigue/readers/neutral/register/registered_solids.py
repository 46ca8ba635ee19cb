"""The welds of solid elements in a body: at which nodes their forces are given, and what these come to on the line."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem, refuse
from fatigue.readers.neutral.line_file import LineFile
from fatigue.readers.neutral.register.registered import Registered
from fatigue.weld.element_forces import ElementForces
from fatigue.weld.line import LineStack, stacked
from fatigue.weld.solid.columns import Columns, SolidWeld, collapsed, columns_of, unfolded
from fatigue.weld.solid.folded import held_moments, seen_from_the_top


@dataclass(frozen=True, slots=True, eq=False)
class Solids:
    """The columns of solid welds by the name they are assessed under; false of a body of shells."""

    welds: Mapping[str, SolidWeld]

    def __bool__(self) -> bool:
        """Whether there is a solid weld."""
        return bool(self.welds)

    def begin(self, lines: LineFile) -> NDArray[np.int64]:
        """Position of each line's first node among all that forces are given at, (k + 1,), and their number."""
        if not self:
            return lines.begin
        sizes = np.diff(lines.begin)
        for i, name in enumerate(lines.weld):
            if name in self.welds:
                sizes[i] = self.welds[name].columns.node.size
        return np.append(0, np.cumsum(sizes))

    def loaded(self, lines: LineStack) -> LineStack:
        """Lines with the nodes that forces are given at: those of solid welds through the thickness."""
        return unfolded(lines, columns_of(lines, self.welds)) if self else lines

    def on_lines(
        self, lines: LineStack, forces: NDArray[np.floating], file: str
    ) -> tuple[NDArray[np.floating], list[Problem]]:
        """Forces (n, c, 6) on the lines of those at the nodes they are given at, (N, c, 6), and doubts about them."""
        if not self:
            return forces, []
        columns = columns_of(lines, self.welds)
        return collapsed(columns, lines.xyz, forces), self._doubts(lines, columns, forces, file)

    def others(self, lines: LineStack) -> LineStack:
        """Lines of welds of shells, which the mesh of shells can be compared with."""
        if not self:
            return lines
        shells = [line for line in lines if line.weld not in self.welds]
        return stacked(shells) if shells else lines.lines(slice(0))

    def seen_from_the_top(self, forces: ElementForces) -> ElementForces:
        """Element forces whose rows in a column are at the node of its station, to tell which elements touch."""
        return seen_from_the_top(forces, list(self.welds.values())) if self else forces

    def _doubts(self, lines: LineStack, columns: Columns, forces: NDArray[np.floating], file: str) -> list[Problem]:
        begin = columns.begin[lines.begin]
        found: list[Problem] = []
        for i, weld in enumerate(lines.weld):
            if weld in self.welds:
                thickness = float(lines.thickness[lines.begin[i] : lines.begin[i + 1]].min())
                found += held_moments(forces[begin[i] : begin[i + 1]], thickness, f"{file}: weld {weld}")
        return found


NO_SOLIDS = Solids({})


def registered_solids(of_tables: Mapping[str, SolidWeld], register: Registered) -> Solids:
    """Columns of the welds to assess, of those that the tables give; lines of one name have the columns of all.

    Raises
    ------
    DataError : lines of one name are of solids and of shells, or have two columns at the node where they meet
    """
    found: dict[str, SolidWeld] = {}
    problems: list[Problem] = []
    for weld, sources in zip(register.welds, register.sources, strict=True):
        own = [of_tables[name] for name in sources if name in of_tables]
        if not own:
            continue
        where = f"{register.file}: weld {weld.name}"
        if len(own) < len(sources):
            shell = next(name for name in sources if name not in of_tables)
            what = f"line {shell} has no columns, and others of the weld have"
            problems.append(Problem("not_joined", where, what, "Give lines of solids and of shells two names"))
            continue
        together, differ = _together(own)
        if differ is not None:
            what = f"the lines have two columns at node {differ}, where they meet"
            problems.append(Problem("not_joined", where, what, "List the same nodes in both columns"))
        found[weld.name] = together
    refuse(DataError, problems)
    return Solids(found)


def _together(welds: list[SolidWeld]) -> tuple[SolidWeld, int | None]:
    """Columns of several lines, each station once, and a station with two columns that differ, None without one."""
    if len(welds) == 1:
        return welds[0], None
    differ: int | None = None
    columns: dict[int, tuple[NDArray[np.int64], NDArray[np.float64]]] = {}
    for weld in welds:
        for at, station in enumerate(weld.station.tolist()):
            rows = slice(weld.columns.begin[at], weld.columns.begin[at + 1])
            here = weld.columns.node[rows], weld.columns.xyz[rows]
            if station in columns and set(columns[station][0].tolist()) != set(here[0].tolist()):
                differ = station
            columns[station] = here
    ordered = [columns[station] for station in sorted(columns)]
    begin = np.append(0, np.cumsum([node.size for node, _ in ordered]))
    merged = Columns(begin, np.concatenate([node for node, _ in ordered]), np.concatenate([xyz for _, xyz in ordered]))
    return SolidWeld(np.array(sorted(columns)), merged), differ
