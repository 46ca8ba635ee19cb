"""What the band of a point takes over from the assessment: its life, its curve, and the line of weld it is on."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from fatigue.life.band.line import tributary_lengths
from fatigue.life.mission import Plan
from fatigue.pipeline.count.result import GroupResult
from fatigue.pipeline.count.worst import WorstPoint
from fatigue.pipeline.solve.model import Model
from fatigue.pipeline.solve.rated.rated_curves import RatedCurve
from fatigue.pipeline.solve.stations import Stations

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class WeldLine:
    """One face of a weld with a toe: life [km] and length [mm] of every station, and their part and order, (i,) each.

    Lives of stations that a bound has settled are lower bounds.
    """

    weld: str
    face: int
    part: NDArray[np.int64]
    order: NDArray[np.int64]
    life_km: Floats
    length_mm: Floats

    @cached_property
    def place(self) -> dict[tuple[int, int], int]:
        """Place of a station by part and order."""
        return {key: i for i, key in enumerate(zip(self.part.tolist(), self.order.tolist(), strict=True))}


@dataclass(frozen=True, slots=True, eq=False)
class BandPoint:
    """A point whose life is given as a band.

    ``stress`` (c,) is the modal stress of its face [MPa per unit coordinate]; ``life_km``, ``damage_per_km`` and
    ``damage_limit`` are those that were assessed, ``is_bound`` where a bound settled it; ``line`` is None where no
    survival of lines is wanted or its face has no toe.
    """

    weld: str
    part: int
    node: int
    order: int
    face: int
    stress: Floats
    rated: RatedCurve
    life_km: float
    damage_per_km: float
    damage_limit: float
    is_bound: bool
    line: WeldLine | None


def band_points(
    model: Model, result: GroupResult, points: list[WorstPoint], plan: Plan, *, with_lines: bool
) -> list[BandPoint]:
    """The points of a group of welds whose histograms are kept."""
    stations, mission = model.stations, result.mission
    keys = {(point.weld, point.face) for point in points} if with_lines else set()
    lines = {key: _line(stations, result, *key) for key in sorted(keys)}
    treated = stations.treated
    found = []
    for point in points:
        at, rated = point.station, model.curve_of_weld[point.weld]
        side = 1.0 if point.face == 0 else -1.0
        found.append(
            BandPoint(
                weld=stations.welds[point.weld].name,
                part=int(stations.part[at]),
                node=int(stations.node[at]),
                order=int(stations.order[at]),
                face=point.face,
                stress=treated.membrane[at] + side * treated.bending[at],
                rated=rated,
                life_km=float(mission.life_km[at, point.face]),
                damage_per_km=float(mission.damage_per_km[at, point.face]),
                damage_limit=rated.damage_limit(plan.damage_limit),
                is_bound=bool(result.tier[at] != 0),
                line=lines.get((point.weld, point.face)) if stations.toe[at, point.face] else None,
            )
        )
    return found


def _line(stations: Stations, result: GroupResult, weld: int, face: int) -> WeldLine:
    """One face of a weld; the last node of a closed line in one part is joined to its first."""
    rows = np.arange(*stations.first[weld : weld + 2])
    part = stations.part[rows]
    length = np.zeros(len(rows))
    parts = np.unique(part)
    for one in parts:
        own = part == one
        length[own] = tributary_lengths(stations.arc_length[rows[own]])
    if stations.welds[weld].closed and len(parts) == 1 and len(rows) > 1:
        gap = float(np.linalg.norm(stations.xyz[rows[-1]] - stations.xyz[rows[0]]))
        length[[0, -1]] += 0.5 * gap
    return WeldLine(
        weld=stations.welds[weld].name,
        face=face,
        part=part,
        order=stations.order[rows],
        life_km=result.mission.life_km[rows, face].copy(),
        length_mm=length,
    )
