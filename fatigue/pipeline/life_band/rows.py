"""Rows of ``band.parquet``: points come a few at a time, and go as soon as all of their weld are there."""

from collections.abc import Mapping, Sequence
from itertools import groupby
from typing import Any

import numpy as np

from fatigue.case import LifeBand
from fatigue.life.band.quantiles import SURVIVALS
from fatigue.life.mission import Plan
from fatigue.pipeline.life_band.lines import LineSurvival, survival_of_line
from fatigue.pipeline.life_band.lives import LifeOfPoint, MissionHistogram, life_of_point, slope_of_damage
from fatigue.pipeline.life_band.points import BandPoint
from fatigue.pipeline.life_band.scatter import REASONS, CountedPieces, load_scatter
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.results import TableWriter, coded

FACES = ("top", "bottom")


class BandRows:
    """Writer of the bands of points whose pieces and histograms are counted some at a time, in the order of welds."""

    def __init__(self, table: TableWriter, loads: Sequence[EventLoad], plan: Plan, asked: LifeBand) -> None:
        self._table, self._loads, self._plan, self._asked = table, loads, plan, asked
        self._waiting: list[LifeOfPoint] = []

    def add(
        self,
        points: Sequence[BandPoint],
        pieces: np.ndarray,
        loops: np.ndarray,
        histograms: Mapping[int, MissionHistogram],
    ) -> None:
        """Have the bands of some more points written; those of the last weld wait for the rest of it.

        ``pieces`` (n, e, p) and ``loops`` (n, l) as of ``CountedPieces``; ``histograms`` of the points on curves with
        knees, by their place.
        """
        self._waiting += lives_of_points(points, pieces, loops, histograms, self._loads, self._plan, self._asked)
        last = self._waiting[-1].point.weld
        begin = next(i for i, found in enumerate(self._waiting) if found.point.weld == last)
        self._write(self._waiting[:begin])
        self._waiting = self._waiting[begin:]

    def flush(self) -> None:
        """Write what is waiting."""
        self._write(self._waiting)
        self._waiting = []

    def _write(self, lives: Sequence[LifeOfPoint]) -> None:
        if lives:
            self._table.write(band_columns(lives, self._asked, self._plan.target_km))


def lives_of_points(
    points: Sequence[BandPoint],
    pieces: np.ndarray,
    loops: np.ndarray,
    histograms: Mapping[int, MissionHistogram],
    loads: Sequence[EventLoad],
    plan: Plan,
    asked: LifeBand,
) -> list[LifeOfPoint]:
    """The lives of some points as bands."""
    nothing = MissionHistogram(np.zeros(0), np.zeros(0))
    own = [histograms.get(place, nothing) for place in range(len(points))]
    slope = np.array([slope_of_damage(point, of) for point, of in zip(points, own, strict=True)])
    scatter, reason = load_scatter(points, CountedPieces(pieces, loops, slope), loads, plan)
    of_load = zip(
        *(x.tolist() for x in (scatter.se, scatter.dof, scatter.log_half_width, scatter.sigma_ln)), strict=True
    )
    return [
        life_of_point(point, load, REASONS[why], of, asked)
        for point, load, why, of in zip(points, of_load, reason.tolist(), own, strict=True)
    ]


def band_columns(lives: Sequence[LifeOfPoint], asked: LifeBand, target_km: float) -> dict[str, Any]:
    """Columns of some points, all of their welds."""
    lines: dict[tuple[str, int], LineSurvival] = {}
    of_line = [(found.point.weld, found.point.face) for found in lives]
    order = sorted(range(len(lives)), key=lambda i: of_line[i])
    for key, places in groupby(order, key=lambda i: of_line[i]):
        lines[key] = survival_of_line([lives[i] for i in places], asked, target_km)
    points, line = [found.point for found in lives], [lines[key] for key in of_line]
    return {
        "weld": _texts([point.weld for point in points]),
        "part": np.array([point.part for point in points]),
        "node": np.array([point.node for point in points]),
        "order": np.array([point.order for point in points]),
        "surface": coded(np.array([point.face for point in points]), FACES),
        "life_km": np.array([point.life_km for point in points]),
        "se_load": np.array([found.se for found in lives]),
        "dof": np.array([found.dof for found in lives]),
        "life_km_load_low": np.array([found.low_km for found in lives]),
        "life_km_load_high": np.array([found.high_km for found in lives]),
        **{f"life_km_{p}": np.array([found.lives_km[p] for found in lives]) for p in SURVIVALS},
        "band_reason": _texts([found.reason for found in lives]),
        "sigma_ln_N": np.array([np.nan if f.strength is None else f.strength.sigma_ln for f in lives]),
        "line_survival_at_target": np.array([one.at_target for one in line]),
        "line_life_km_p50": np.array([one.median_km for one in line]),
        "line_reason": _texts([one.reason for one in line]),
    }


def _texts(values: Sequence[str]) -> Any:
    """A column of texts, empty ones as nothing."""
    names = sorted(set(values) - {""})
    return coded(np.array([names.index(value) if value else -1 for value in values]), names)
