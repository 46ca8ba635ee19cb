"""The weld register: every weld with its worst point, which alone decides its verdict."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from fatigue.life.mission import Plan
from fatigue.pipeline.mission_block import MissionBlock
from fatigue.pipeline.model import Model
from fatigue.pipeline.rows import FACES
from fatigue.readers.weld_register import RegisterRow
from fatigue.results import WELDS
from fatigue.weld.line import length


@dataclass(frozen=True, slots=True, eq=False)
class PointLives:
    """What the register needs of every point; arrays are (n, 2): stations by faces.

    ``governing`` is the index of the event with the largest share of the damage, -1 where nothing damages.
    """

    life_km: NDArray[np.float64]
    utilisation: NDArray[np.float64]
    load_factor: NDArray[np.float64]
    governing: NDArray[np.int64]

    @classmethod
    def empty(cls, stations: int) -> Self:
        """Room for so many stations."""
        return cls(
            life_km=np.full((stations, 2), np.nan),
            utilisation=np.full((stations, 2), np.nan),
            load_factor=np.full((stations, 2), np.nan),
            governing=np.full((stations, 2), -1),
        )

    def put(self, rows: NDArray[np.int64], block: MissionBlock) -> None:
        """Take over the results of a block."""
        self.life_km[rows] = block.life_km
        self.utilisation[rows] = block.utilisation
        self.load_factor[rows] = block.load_factor
        self.governing[rows] = block.governing


@dataclass(frozen=True, slots=True)
class WorstPoint:
    """The toe point of a weld with the shortest life: index of weld, station and face."""

    weld: int
    station: int
    face: int


def toe_faces(model: Model) -> NDArray[np.bool_]:
    """Mark the faces that carry a weld toe: (n, 2)."""
    faces = {"top": (True, False), "bottom": (False, True), "both": (True, True)}
    return np.array([faces[weld.surface] for weld in model.welds])[model.stations.weld]


def worst_points(model: Model, lives: PointLives) -> tuple[WorstPoint, ...]:
    """Find the worst toe point of every weld; the first along the line where several are equal."""
    utilisation = np.where(toe_faces(model), lives.utilisation, -1.0)
    worst = []
    for weld in range(len(model.welds)):
        stations = np.flatnonzero(model.stations.weld == weld)
        at, face = divmod(int(utilisation[stations].argmax()), 2)
        worst.append(WorstPoint(weld, int(stations[at]), face))
    return tuple(worst)


def weld_rows(model: Model, plan: Plan, lives: PointLives, worst: Sequence[WorstPoint]) -> dict[str, Any]:
    """Rows of ``welds.parquet``: every weld of the case."""
    lines = [[s.line for s in model.lines if s.line.weld == weld.name] for weld in model.welds]
    stations, at = model.stations, [(p.station, p.face) for p in worst]
    life = np.array([lives.life_km[i] for i in at])
    events = [*(p.event for p in plan.passes), None]
    curves = [model.curves[name] for name in model.curve_of_weld]
    return {
        "weld": [weld.name for weld in model.welds],
        "status": ["assessed"] * len(model.welds),
        "reason": [""] * len(model.welds),
        "description": [weld.description for weld in model.welds],
        "closed": [weld.closed for weld in model.welds],
        "parts": [len(parts) for parts in lines],
        "nodes": [len({int(n) for part in parts for n in part.node}) for parts in lines],
        "length_mm": [sum(length(part) for part in parts) for parts in lines],
        "thickness_min_mm": [min(float(part.thickness.min()) for part in parts) for parts in lines],
        "thickness_max_mm": [max(float(part.thickness.max()) for part in parts) for parts in lines],
        "surface": [weld.surface for weld in model.welds],
        "curve": [rated.curve.name for rated in curves],
        "survival": [rated.survival for rated in curves],
        "end_length_mm": [np.nan if weld.end_length is None else weld.end_length for weld in model.welds],
        "life_km": life,
        "life_years": life / plan.km_per_year,
        "utilisation": [lives.utilisation[i] for i in at],
        "fulfilled": [bool(lives.utilisation[i] <= 1.0) for i in at],
        "load_factor": [lives.load_factor[i] for i in at],
        "worst_part": [stations.part[p.station] for p in worst],
        "worst_order": [stations.order[p.station] for p in worst],
        "worst_node": [stations.node[p.station] for p in worst],
        "worst_surface": [FACES[p.face] for p in worst],
        "worst_arc_length_mm": [stations.arc_length[p.station] for p in worst],
        "governing_event": [events[lives.governing[i]] for i in at],
    }


def excluded_rows(excluded: Sequence[RegisterRow]) -> dict[str, Any]:
    """Rows of ``welds.parquet`` for the lines that are listed and not assessed, with the reason."""
    rows: dict[str, Any] = {column.name: [None] * len(excluded) for column in WELDS}
    return rows | {
        "weld": [row.weld for row in excluded],
        "status": ["excluded"] * len(excluded),
        "reason": [row.reason or row.status for row in excluded],
        "description": [row.description for row in excluded],
        "nodes": [row.nodes for row in excluded],
        "length_mm": [row.length for row in excluded],
    }
