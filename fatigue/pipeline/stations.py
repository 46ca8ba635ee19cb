"""Weld lines as one long table of stations."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.life.damage import ThicknessRule, size_factor
from fatigue.pipeline.rated_curves import RatedCurve
from fatigue.pipeline.shapes import Shapes
from fatigue.weld.line import arc_length, stacked
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
        arc_length=arc_length(stacked(parts)),
        xyz=np.concatenate([p.xyz for p in parts]),
        thickness=np.concatenate([p.thickness for p in parts]),
        at_end=np.concatenate([solved.at_end for solved in lines]),
        at_corner=np.concatenate([solved.at_corner for solved in lines]),
        treated=_joined([solved.treated for solved in lines]),
        raw=_joined([solved.raw for solved in lines]),
    )


def treated_rows(stations: Stations) -> NDArray[np.intp]:
    """Find the stations whose stress the end treatment has changed."""
    changed = (stations.treated.membrane != stations.raw.membrane) | (stations.treated.bending != stations.raw.bending)
    return np.flatnonzero(changed.any(axis=1))


def shapes_of(
    stations: Stations,
    stress: StructuralStress,
    rows: NDArray[np.intp],
    rated: RatedCurve,
    thickness_rule: ThicknessRule,
) -> Shapes:
    """Stress shapes of some stations, treated or raw, with the law of their curve and the size factor of their plates.

    ``stress`` is ``stations.treated`` or ``stations.raw``.
    """
    return Shapes(
        membrane=stress.membrane[rows],
        bending=stress.bending[rows],
        in_plane_shear=stress.in_plane_shear[rows],
        twist_shear=stress.twist_shear[rows],
        size=size_factor(stations.thickness[rows], rated.curve, thickness_rule),
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
