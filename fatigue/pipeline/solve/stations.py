"""Weld lines as one long table of stations."""

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from fatigue.life.curves import ThicknessRule
from fatigue.life.rule import size_factor
from fatigue.pipeline.solve.modal_stress import RawEnds, Shapes
from fatigue.pipeline.solve.rated_curves import RatedCurve
from fatigue.weld.line import LineStack, line_of_node
from fatigue.weld.line_geometry import arc_length
from fatigue.weld.structural_stress import LineStress, StructuralStress


@dataclass(frozen=True, slots=True, eq=False)
class Stations:
    """Every node of every line part in the order of the weld register; arrays are (n,) unless said.

    Attributes
    ----------
    weld : index into the register
    part, order, node : identity of the station
    arc_length [mm], xyz (n, 3) [mm], thickness [mm] : where it is
    at_end, at_corner : flags of the line solution
    treated : stress shapes, components (n, m) [MPa per unit modal coordinate]
    raw_rows, raw : (e,) stations whose stress the end treatment has changed, and the shapes without it, (e, m)
    """

    weld: NDArray[np.int64]
    part: NDArray[np.int64]
    order: NDArray[np.int64]
    node: NDArray[np.int64]
    arc_length: NDArray[np.float64]
    xyz: NDArray[np.float64]
    thickness: NDArray[np.float64]
    at_end: NDArray[np.bool_]
    at_corner: NDArray[np.bool_]
    treated: StructuralStress
    raw_rows: NDArray[np.intp]
    raw: StructuralStress

    def __len__(self) -> int:
        """Count the stations."""
        return len(self.node)


def stations_of(lines: LineStack, solved: LineStress, weld_names: Sequence[str]) -> Stations:
    """Lay out the nodes of solved line parts, which follow each other as in the register of the welds."""
    place = {name: i for i, name in enumerate(weld_names)}
    line = line_of_node(lines)
    names = [part.name for part in fields(StructuralStress)]
    parts = [(getattr(solved.before, name), getattr(solved.treated, name)[solved.mended]) for name in names]
    changed = np.flatnonzero(np.logical_or.reduce([(before != after).any(axis=1) for before, after in parts]))
    return Stations(
        weld=np.array([place[name] for name in lines.weld])[line],
        part=lines.part[line],
        order=lines.order,
        node=lines.node,
        arc_length=arc_length(lines),
        xyz=lines.xyz,
        thickness=lines.thickness,
        at_end=solved.at_end,
        at_corner=solved.at_corner,
        treated=solved.treated,
        raw_rows=solved.mended[changed],
        raw=StructuralStress(*(before[changed] for before, _ in parts)),
    )


def joined(parts: Sequence[Stations]) -> Stations:
    """Lay stations of several stacks of lines, with the same register of welds, one after the other."""
    if len(parts) == 1:
        return parts[0]
    begin = np.cumsum([0, *(len(part) for part in parts)])
    arrays = {f.name: [getattr(part, f.name) for part in parts] for f in fields(Stations)}
    rows = [part.raw_rows + first for part, first in zip(parts, begin[:-1], strict=True)]
    treated, raw = _joined(arrays.pop("treated")), _joined(arrays.pop("raw"))
    arrays["raw_rows"] = rows
    return Stations(**{name: np.concatenate(some) for name, some in arrays.items()}, treated=treated, raw=raw)


def _joined(parts: Sequence[StructuralStress]) -> StructuralStress:
    names = [part.name for part in fields(StructuralStress)]
    return StructuralStress(*(np.concatenate([getattr(part, name) for part in parts]) for name in names))


def shapes_of(stations: Stations, rows: NDArray[np.intp], rated: RatedCurve, thickness_rule: ThicknessRule) -> Shapes:
    """Stress shapes of some stations, ascending, with the rule of their curve and the size factor of their plates."""
    stress = stations.treated
    mine, ends = np.isin(stations.raw_rows, rows), np.isin(rows, stations.raw_rows)
    part = slice(None) if len(rows) == len(stations) else rows  # all of them without a copy
    return Shapes(
        membrane=stress.membrane[part],
        bending=stress.bending[part],
        in_plane_shear=stress.in_plane_shear[part],
        twist_shear=stress.twist_shear[part],
        size=size_factor(stations.thickness[part], rated.curve, thickness_rule),
        rule=rated.rule,
        raw_ends=RawEnds(
            rows=np.flatnonzero(ends),
            membrane=stations.raw.membrane[mine],
            bending=stations.raw.bending[mine],
            matters=np.ones(np.count_nonzero(ends), dtype=np.bool_),
        ),
    )
