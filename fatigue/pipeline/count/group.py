"""One group of welds under all events: everything its rows in the result tables need."""

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.life.mission import Plan
from fatigue.pipeline.count.event_block import EventBlock
from fatigue.pipeline.count.mission_block import MissionBlock
from fatigue.pipeline.count.piece import Piece, Rules, counted_at, estimated
from fatigue.pipeline.count.settle import Screening, settle
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.solve.rated_curves import RatedCurve
from fatigue.pipeline.solve.stations import Stations, shapes_of

_OF_EVENT = tuple(f.name for f in fields(EventBlock) if f.name not in ("verdict", "histogram"))
_OF_MISSION = tuple(f.name for f in fields(MissionBlock) if f.name not in ("governing", "verdict"))


@dataclass(frozen=True, slots=True, eq=False)
class GroupResult:
    """Results of the stations of one group of welds, in the order of its stations; few arrays, to be stored or sent.

    Attributes
    ----------
    of_events : (e, f, n, 2) what an `EventBlock` says of every event: its fields but verdict and histogram, in order
    verdicts : (e, n, 2) the verdict of every event
    of_mission : (f, n, 2) the fields of the `MissionBlock` but the two that follow
    governing, verdict : (n, 2) of the mission
    tier : (n,) index into `piece.TIERS`, 0 where cycles were counted
    """

    of_events: NDArray[np.float64]
    verdicts: NDArray[np.int8]
    of_mission: NDArray[np.float64]
    governing: NDArray[np.int64]
    verdict: NDArray[np.int8]
    tier: NDArray[np.int8]

    @property
    def events(self) -> tuple[EventBlock, ...]:
        """Every event, histograms left out: views of the arrays."""
        nothing = np.zeros((len(self.tier), 2, 0, 2))
        return tuple(
            EventBlock(**dict(zip(_OF_EVENT, event, strict=True)), verdict=verdict, histogram=nothing)
            for event, verdict in zip(self.of_events, self.verdicts, strict=True)
        )

    @property
    def mission(self) -> MissionBlock:
        """All events together: views of the arrays."""
        numbers = dict(zip(_OF_MISSION, self.of_mission, strict=True))
        return MissionBlock(**numbers, governing=self.governing, verdict=self.verdict)


def assess_group(
    stations: Stations,
    curve_of_weld: Sequence[RatedCurve],
    loads: Sequence[EventLoad],
    plan: Plan,
    screening: Screening | None,
) -> GroupResult:
    """Count every event at every station of a group of welds, or at those that screening leaves to be counted.

    Raises
    ------
    NumericalError : stress or damage exceeds double precision
    """
    curve_of = np.array([rated.curve.name for rated in curve_of_weld])[stations.weld]
    result = _no_result(len(loads), len(stations))
    for name, rated in {rated.curve.name: rated for rated in curve_of_weld}.items():
        rows = np.flatnonzero(curve_of == name)
        shapes = shapes_of(stations, rows, rated)
        rules = Rules(rated.yield_MPa, rated.mean_stress, _weld_names(stations, rows))
        if screening is None:
            pieces = counted_at(np.arange(len(rows)), shapes, loads, estimated(shapes, loads, rules), plan, rules)
        else:
            pieces = settle(shapes, stations.weld[rows], stations.toe[rows], loads, plan, screening, rules)
        for piece in pieces:
            _put(piece, rows[piece.rows], result)
    return result


def arrays_of(result: GroupResult) -> dict[str, NDArray[Any]]:
    """Give the arrays of a result by name; ``GroupResult(**arrays)`` makes it again."""
    return {field.name: getattr(result, field.name) for field in fields(GroupResult)}


def _no_result(events: int, stations: int) -> GroupResult:
    """Make room for the result of so many stations."""
    return GroupResult(
        of_events=np.empty((events, len(_OF_EVENT), stations, 2)),
        verdicts=np.empty((events, stations, 2), np.int8),
        of_mission=np.empty((len(_OF_MISSION), stations, 2)),
        governing=np.empty((stations, 2), np.int64),
        verdict=np.empty((stations, 2), np.int8),
        tier=np.empty(stations, np.int8),
    )


def _put(piece: Piece, rows: NDArray[np.intp], result: GroupResult) -> None:
    """Write a piece to the rows of the group that it is about."""
    for e, event in enumerate(piece.events):
        for f, name in enumerate(_OF_EVENT):
            result.of_events[e, f, rows] = getattr(event, name)
        result.verdicts[e, rows] = event.verdict
    for f, name in enumerate(_OF_MISSION):
        result.of_mission[f, rows] = getattr(piece.mission, name)
    result.governing[rows], result.verdict[rows] = piece.mission.governing, piece.mission.verdict
    result.tier[rows] = piece.tier


def _weld_names(stations: Stations, rows: NDArray[np.intp]) -> str:
    names = sorted({stations.welds[i].name for i in stations.weld[rows]})
    return f"welds {names[0]} to {names[-1]}"
