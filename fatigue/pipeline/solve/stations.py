"""Weld lines as one long table of stations."""

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from fatigue.pipeline.solve.modal_stress import RawEnds, Shapes
from fatigue.pipeline.solve.rated_curves import RatedCurve
from fatigue.readers.neutral.body import Weld
from fatigue.weld.line import LineStack, line_of_node
from fatigue.weld.line_geometry import arc_length
from fatigue.weld.structural_stress import LineStress, StructuralStress

TOES = {"top": (True, False), "bottom": (False, True), "both": (True, True)}  # on the top and on the bottom face


@dataclass(frozen=True, slots=True, eq=False)
class Stations:
    """Every node of every line part of some welds, in the order of the welds; arrays are (n,) unless said.

    Attributes
    ----------
    welds : the welds
    weld : index into ``welds``, ascending
    part, order, node : identity of the station
    arc_length [mm], xyz (n, 3) [mm], thickness [mm] : where it is
    toe : (n, 2) faces that carry a weld toe
    at_end, at_corner : flags of the line solution
    treated : stress shapes, components (n, m) [MPa per unit modal coordinate]
    raw_rows, raw : (e,) stations whose stress the end treatment has changed, and the shapes without it, (e, m)
    """

    welds: tuple[Weld, ...]
    weld: NDArray[np.int64]
    part: NDArray[np.int64]
    order: NDArray[np.int64]
    node: NDArray[np.int64]
    arc_length: NDArray[np.float64]
    xyz: NDArray[np.float64]
    thickness: NDArray[np.float64]
    toe: NDArray[np.bool_]
    at_end: NDArray[np.bool_]
    at_corner: NDArray[np.bool_]
    treated: StructuralStress
    raw_rows: NDArray[np.intp]
    raw: StructuralStress

    def __len__(self) -> int:
        """Count the stations."""
        return len(self.node)

    @property
    def names(self) -> list[str]:
        """Names of the welds."""
        return [weld.name for weld in self.welds]

    @property
    def first(self) -> NDArray[np.intp]:
        """First station of every weld, and the number of stations behind them."""
        return np.searchsorted(self.weld, np.arange(len(self.welds) + 1))


def stations_of(lines: LineStack, solved: LineStress, welds: Sequence[Weld]) -> Stations:
    """Lay out the nodes of solved line parts, which follow each other as their welds do."""
    place = {weld.name: i for i, weld in enumerate(welds)}
    weld = np.array([place[name] for name in lines.weld])[line_of_node(lines)]
    names = [part.name for part in fields(StructuralStress)]
    parts = [(getattr(solved.before, name), getattr(solved.treated, name)[solved.mended]) for name in names]
    changed = np.flatnonzero(np.logical_or.reduce([(before != after).any(axis=1) for before, after in parts]))
    return Stations(
        welds=tuple(welds),
        weld=weld,
        part=lines.part[line_of_node(lines)],
        order=lines.order,
        node=lines.node,
        arc_length=arc_length(lines),
        xyz=lines.xyz,
        thickness=lines.thickness,
        toe=np.array([TOES[one.surface] for one in welds])[weld],
        at_end=solved.at_end,
        at_corner=solved.at_corner,
        treated=solved.treated,
        raw_rows=solved.mended[changed],
        raw=StructuralStress(*(before[changed] for before, _ in parts)),
    )


def joined(parts: Sequence[Stations]) -> Stations:
    """Lay stations of several stacks of lines, parts of the same welds, one after the other."""
    if len(parts) == 1:
        return parts[0]
    begin = np.cumsum([0, *(len(part) for part in parts)])
    arrays = {f.name: [getattr(part, f.name) for part in parts] for f in fields(Stations)}
    rows = [part.raw_rows + first for part, first in zip(parts, begin[:-1], strict=True)]
    treated, raw = _joined(arrays.pop("treated")), _joined(arrays.pop("raw"))
    arrays["raw_rows"] = rows
    del arrays["welds"]
    together = {name: np.concatenate(some) for name, some in arrays.items()}
    return Stations(welds=parts[0].welds, **together, treated=treated, raw=raw)


def _joined(parts: Sequence[StructuralStress]) -> StructuralStress:
    names = [part.name for part in fields(StructuralStress)]
    return StructuralStress(*(np.concatenate([getattr(part, name) for part in parts]) for name in names))


def shapes_of(stations: Stations, rows: NDArray[np.intp], rated: RatedCurve) -> Shapes:
    """Stress shapes of some stations, ascending, with the law of their curve and the size factor of their plates."""
    stress = stations.treated
    mine, ends = np.isin(stations.raw_rows, rows), np.isin(rows, stations.raw_rows)
    part = slice(None) if len(rows) == len(stations) else rows  # all of them without a copy
    return Shapes(
        membrane=stress.membrane[part],
        bending=stress.bending[part],
        in_plane_shear=stress.in_plane_shear[part],
        twist_shear=stress.twist_shear[part],
        size=rated.size(stations.thickness[part]),
        law=rated.law,
        uses_bending_ratio=rated.curve.applies == "dS",
        raw_ends=RawEnds(
            rows=np.flatnonzero(ends),
            membrane=stations.raw.membrane[mine],
            bending=stations.raw.bending[mine],
            matters=np.ones(np.count_nonzero(ends), dtype=np.bool_),
        ),
    )
