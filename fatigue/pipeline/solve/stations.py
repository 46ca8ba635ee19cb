"""Weld lines as one long table of stations."""

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from fatigue.pipeline.solve.modal_stress import ModalStress
from fatigue.pipeline.solve.rated.rated_curves import RatedCurve
from fatigue.readers.neutral.body.welds import Weld
from fatigue.weld.line import LineStack, line_of_node
from fatigue.weld.line_geometry import arc_length
from fatigue.weld.structural_stress import LineStress, RawEnds, StructuralStress

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
    at_end, at_corner, summed_corner : flags of the line solution
    treated : structural stress with treated ends, components (n, m) [MPa per unit modal coordinate]
    raw_ends : stations whose stress the end treatment has changed, and their stress before it
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
    summed_corner: NDArray[np.bool_]
    treated: StructuralStress
    raw_ends: RawEnds

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
    """The nodes of solved line parts as one table; the parts follow each other as their welds do."""
    place = {weld.name: i for i, weld in enumerate(welds)}
    weld = np.array([place[name] for name in lines.weld])[line_of_node(lines)]
    raw_ends, names = solved.raw_ends, [component.name for component in fields(StructuralStress)]
    of_ends = [(getattr(raw_ends.stress, name), getattr(solved.treated, name)[raw_ends.rows]) for name in names]
    changed = np.logical_or.reduce([(raw != treated).any(axis=1) for raw, treated in of_ends])
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
        summed_corner=solved.summed_corner,
        treated=solved.treated,
        raw_ends=RawEnds(raw_ends.rows[changed], StructuralStress(*(raw[changed] for raw, _ in of_ends))),
    )


def joined(blocks: Sequence[Stations]) -> Stations:
    """Stations of several blocks of the same welds, one after the other."""
    if len(blocks) == 1:
        return blocks[0]
    arrays = {f.name: [getattr(block, f.name) for block in blocks] for f in fields(Stations)}
    treated, ends = _joined(arrays.pop("treated")), arrays.pop("raw_ends")
    begin = np.cumsum([0, *(len(block) for block in blocks)])
    rows = np.concatenate([one.rows + first for one, first in zip(ends, begin[:-1], strict=True)])
    del arrays["welds"]
    together = {name: np.concatenate(some) for name, some in arrays.items()}
    raw_ends = RawEnds(rows, _joined([one.stress for one in ends]))
    return Stations(welds=blocks[0].welds, **together, treated=treated, raw_ends=raw_ends)


def _joined(blocks: Sequence[StructuralStress]) -> StructuralStress:
    names = [component.name for component in fields(StructuralStress)]
    return StructuralStress(*(np.concatenate([getattr(block, name) for block in blocks]) for name in names))


def size_of(stations: Stations, rows: NDArray[np.intp], rated: RatedCurve) -> NDArray[np.float64]:
    """Factor of the plates of some stations on the range, each with what its weld attaches."""
    lengths = np.array([rated.at(weld).attachment for weld in stations.welds])
    return rated.size(stations.thickness[rows], lengths[stations.weld[rows]])


def modal_stress(stations: Stations, rows: NDArray[np.intp], rated: RatedCurve) -> ModalStress:
    """Modal stress of some stations, ascending, with the rule of their curve and the size factor of their plates."""
    stress = stations.treated
    some = slice(None) if len(rows) == len(stations) else rows  # all of them without a copy
    raw_ends = stations.raw_ends.at(rows)
    return ModalStress(
        membrane=stress.membrane[some],
        bending=stress.bending[some],
        in_plane_shear=stress.in_plane_shear[some],
        twist_shear=stress.twist_shear[some],
        size=size_of(stations, rows, rated),
        rule=rated.rule,
        raw_ends=raw_ends,
        raw_end_matters=np.ones(len(raw_ends.rows), dtype=np.bool_),
    )
