"""Welds brought to life: their forces read and their structural stress solved, for all modes at once."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from numpy.typing import NDArray

from fatigue.case import Case, given_case
from fatigue.errors import NumericalError, Problem
from fatigue.pipeline.solve.body import Body, read_body
from fatigue.pipeline.solve.rated.rated_curves import RatedCurve
from fatigue.pipeline.solve.stations import Stations, joined, stations_of
from fatigue.pipeline.solve.weld_groups import WeldGroups, forces_of_block, one_group
from fatigue.readers.neutral.body.modes import Modes
from fatigue.readers.neutral.body.welds import Weld
from fatigue.weld.edge_type import edge_type_warnings, jumpy_lines
from fatigue.weld.line import LineStack, line_of_node, stacked
from fatigue.weld.line_load import line_load
from fatigue.weld.load_extent import LoadExtent, load_extent
from fatigue.weld.structural_stress import StructuralStress, assess_line, line_stress


@dataclass(frozen=True, slots=True, eq=False)
class Model:
    """Some welds of a body, or all of them, ready for events.

    ``lines`` are the line parts of ``welds`` in their order, ``stations`` their nodes, solved, as one table;
    ``warnings`` are those about the forces and lines of these welds, ``extents`` say how large the forces are.
    """

    body: Body
    lines: LineStack
    stations: Stations
    warnings: tuple[Problem, ...]
    extents: tuple[LoadExtent, ...]

    @property
    def case(self) -> Case:
        """The case the body belongs to."""
        return self.body.case

    @property
    def modes(self) -> Modes:
        """The modes of the body."""
        return self.body.modes

    @property
    def welds(self) -> tuple[Weld, ...]:
        """The welds."""
        return self.stations.welds

    @property
    def curve_of_weld(self) -> list[RatedCurve]:
        """The curve of every weld."""
        return [self.body.curve_of(weld) for weld in self.welds]

    def by_curve(self) -> Iterator[tuple[RatedCurve, NDArray[np.intp]]]:
        """Every curve and the stations of its welds, ascending; what is a weld's own is that of one of them."""
        curves = self.curve_of_weld
        curve_of = np.array([rated.curve.name for rated in curves])[self.stations.weld]
        for name, rated in {rated.curve.name: rated for rated in curves}.items():
            yield rated, np.flatnonzero(curve_of == name)

    def damage_limits(self, of_mission: float) -> NDArray[np.float64]:
        """Allowed Miner sum of every station (n,), that of its curve where it has one."""
        limits = np.array([rated.damage_limit(of_mission) for rated in self.curve_of_weld])
        return limits[self.stations.weld]


def read_model(case: Case | Path | str, *, strict: bool = False) -> Model:
    """All welds of a case, or of a case file, solved at once: for small bodies and notebooks.

    Raises
    ------
    CaseError, DataError : with every mistake found in the file at fault
    """
    with TemporaryDirectory() as scratch:
        return solve_group(one_group(read_body(given_case(case), strict=strict), Path(scratch)), 0)


def solve_group(groups: WeldGroups, number: int) -> Model:
    """One group of welds, its forces read and its structural stress solved.

    Raises
    ------
    DataError : forces are missing, given twice, not finite or out of balance
    """
    body = groups.body
    welds = body.welds[groups.groups[number]]
    stacks: list[LineStack] = []
    blocks: list[Stations] = []
    warnings: list[Problem] = []
    extents: list[LoadExtent] = []
    for block in groups.blocks_of[number]:
        lines, forces, of_forces = forces_of_block(groups, block)
        stations, of_lines = _solved(lines, forces, welds, body.case.body.weld_nodes)
        stacks.append(lines)
        blocks.append(stations)
        warnings += of_forces + of_lines
        extents.append(load_extent(lines, forces))
    together = stacks[0] if len(stacks) == 1 else stacked([line for stack in stacks for line in stack])
    return Model(body, together, joined(blocks), tuple(warnings), tuple(extents))


def _solved(
    lines: LineStack, forces: NDArray[np.floating], welds: Sequence[Weld], file: str
) -> tuple[Stations, list[Problem]]:
    """Stations of some lines under their nodal forces (n, m, 6), and the warnings about them."""
    load = line_load(lines, forces)
    with np.errstate(over="ignore", invalid="ignore"):
        solved = line_stress(lines, load)
        if not _is_finite(solved.treated):
            _refuse_overflow(lines, solved.treated, forces)
        jumpy = jumpy_lines(lines, load)
    warnings: list[Problem] = []
    for i in np.union1d(jumpy, line_of_node(lines)[solved.unresolved]).tolist():
        line, nodes = lines[i], slice(lines.begin[i], lines.begin[i + 1])
        where = f"{file}: weld {line.weld}"
        warnings += edge_type_warnings(line, forces[nodes], where) if i in jumpy else []
        warnings += _end_warnings(line.node[solved.unresolved[nodes]], where)
    return stations_of(lines, solved, welds), warnings


def _refuse_overflow(lines: LineStack, solved: StructuralStress, forces: NDArray[np.floating]) -> None:
    """Refuse a line that has grown beyond all bounds, also when it is solved without its neighbours."""
    for line, (a, b) in zip(lines, pairwise(lines.begin), strict=True):
        if not _is_finite(solved, slice(a, b)) and not _is_finite(assess_line(line, forces[a:b]).treated):
            problem = Problem(
                "overflow",
                f"weld {line.weld}",
                "the structural stress per unit modal coordinate exceeds what double precision can hold",
                "Check forces, coordinates and thickness of the weld for a value that is far too large or small",
            )
            raise NumericalError(problem)


def _is_finite(stress: StructuralStress, nodes: slice = slice(None)) -> bool:
    parts = [getattr(stress, part.name)[nodes] for part in fields(StructuralStress)]
    return all(-np.inf < part.min(initial=0.0) and part.max(initial=0.0) < np.inf for part in parts)  # nor NaN


def _end_warnings(unresolved: NDArray[np.int64], where: str) -> list[Problem]:
    """Warning that names the end nodes whose edge is longer than the end treatment."""
    if not unresolved.size:
        return []
    nodes = ", ".join(str(node) for node in unresolved)
    return [
        Problem(
            "end_unresolved",
            where,
            f"the edge at the end node {nodes} is longer than the length of the end treatment",
            "Refine the mesh at the weld end, or read the end value as one of a single edge",
        )
    ]
