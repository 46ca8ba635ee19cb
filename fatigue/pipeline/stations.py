"""The weld lines of a body as one long table of stations, cut into blocks for counting."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.life.damage import ThicknessRule, size_factor
from fatigue.pipeline.event_block import Shapes
from fatigue.pipeline.rated_curves import RatedCurve
from fatigue.weld.line import arc_length
from fatigue.weld.structural_stress import LineStress, StructuralStress

BLOCK = 128  # stations; blocks are cut by this number alone, so that results do not depend on threads


@dataclass(frozen=True, slots=True, eq=False)
class Stations:
    """Every node of every line part in the order of the weld register; arrays are (n,) unless said.

    Attributes
    ----------
    weld : index into the register
    part, order, node : identity of the station
    arc_length [mm], xyz (n, 3) [mm], thickness [mm] : where it is
    at_end, at_corner : flags of the line solution
    treated, raw : stress shapes with and without the end treatment, components (n, m) [MPa per unit modal coordinate]
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
    raw: StructuralStress

    def __len__(self) -> int:
        """Count the stations."""
        return len(self.node)


@dataclass(frozen=True, slots=True, eq=False)
class Block:
    """Stations counted together: one S-N curve, and the treated shapes or the raw ones of weld ends."""

    index: int
    rows: NDArray[np.int64]
    curve: str
    raw: bool


def stations_of(lines: Sequence[LineStress], weld_names: Sequence[str]) -> Stations:
    """Lay the solved line parts one after the other, welds in the order of the register."""
    place = {name: i for i, name in enumerate(weld_names)}
    lines = sorted(lines, key=lambda solved: (place[solved.line.weld], solved.line.part))
    parts = [solved.line for solved in lines]
    return Stations(
        weld=np.concatenate([np.full(len(p.node), place[p.weld]) for p in parts]),
        part=np.concatenate([np.full(len(p.node), p.part) for p in parts]),
        order=np.concatenate([p.order for p in parts]),
        node=np.concatenate([p.node for p in parts]),
        arc_length=np.concatenate([arc_length(p) for p in parts]),
        xyz=np.concatenate([p.xyz for p in parts]),
        thickness=np.concatenate([p.thickness for p in parts]),
        at_end=np.concatenate([solved.at_end for solved in lines]),
        at_corner=np.concatenate([solved.at_corner for solved in lines]),
        treated=_joined([solved.treated for solved in lines]),
        raw=_joined([solved.raw for solved in lines]),
    )


def cut_blocks(stations: Stations, curve_of_weld: Sequence[str]) -> list[Block]:
    """Cut the stations into blocks of one curve and at most ``BLOCK``, then the raw values of treated stations."""
    curve = np.array(curve_of_weld)[stations.weld]
    treated_here = np.flatnonzero(
        (stations.treated.membrane != stations.raw.membrane).any(axis=1)
        | (stations.treated.bending != stations.raw.bending).any(axis=1)
    )
    blocks: list[Block] = []
    for rows, raw in ((np.arange(len(stations)), False), (treated_here, True)):
        changes = np.flatnonzero(curve[rows][1:] != curve[rows][:-1]) + 1
        for run in np.split(rows, changes):
            for first in range(0, len(run), BLOCK):
                some = run[first : first + BLOCK]
                blocks.append(Block(len(blocks), some, str(curve[some[0]]), raw))
    return blocks


def shapes_of(
    stations: Stations, block: Block, curves: Mapping[str, RatedCurve], thickness_rule: ThicknessRule
) -> Shapes:
    """Stress shapes of a block with the law of its curve and the size factor of its plates."""
    stress = stations.raw if block.raw else stations.treated
    rated = curves[block.curve]
    return Shapes(
        membrane=stress.membrane[block.rows],
        bending=stress.bending[block.rows],
        in_plane_shear=stress.in_plane_shear[block.rows],
        twist_shear=stress.twist_shear[block.rows],
        size=size_factor(stations.thickness[block.rows], rated.curve, thickness_rule),
        law=rated.law,
        uses_bending_ratio=rated.curve.applies == "dS",
    )


def _joined(pieces: Sequence[StructuralStress]) -> StructuralStress:
    return StructuralStress(
        membrane=np.concatenate([p.membrane for p in pieces]),
        bending=np.concatenate([p.bending for p in pieces]),
        in_plane_shear=np.concatenate([p.in_plane_shear for p in pieces]),
        twist_shear=np.concatenate([p.twist_shear for p in pieces]),
        transverse_shear=np.concatenate([p.transverse_shear for p in pieces]),
    )
