"""One group of welds under all events: everything its rows in the result tables need."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from fatigue.life.mission import Plan
from fatigue.pipeline.event_block import EventBlock
from fatigue.pipeline.event_load import EventLoad
from fatigue.pipeline.mission_block import MissionBlock
from fatigue.pipeline.model import Model, toe_faces
from fatigue.pipeline.piece import Piece, Rules, counted_at, estimated
from fatigue.pipeline.settle import Screening, settle
from fatigue.pipeline.stations import shapes_of

Arrays = TypeVar("Arrays", EventBlock, MissionBlock)

_OF_EVENT = tuple(f.name for f in fields(EventBlock) if f.name not in ("verdict", "histogram"))
_OF_MISSION = tuple(f.name for f in fields(MissionBlock) if f.name not in ("governing", "verdict"))


@dataclass(frozen=True, slots=True, eq=False)
class GroupResult:
    """Results of the stations of one group of welds, in the order of its stations.

    Attributes
    ----------
    events : of every event, histograms left out
    mission : of all events together
    tier : (n,) index into `piece.TIERS`, 0 where cycles were counted
    """

    events: tuple[EventBlock, ...]
    mission: MissionBlock
    tier: NDArray[np.int8]


def assess_group(model: Model, loads: Sequence[EventLoad], plan: Plan, screening: Screening | None) -> GroupResult:
    """Count every event at every station of a group of welds, or at those that screening leaves to be counted.

    Raises
    ------
    NumericalError : stress or damage exceeds double precision
    """
    stations, toe = model.stations, toe_faces(model)
    curve_of = np.array(model.curve_of_weld)[stations.weld]
    curve = model.case.curve
    found: list[tuple[NDArray[np.intp], Piece]] = []
    for name in dict.fromkeys(curve_of.tolist()):
        rows = np.flatnonzero(curve_of == name)
        shapes = shapes_of(stations, rows, model.curves[name], curve.thickness_rule)
        rules = Rules(curve.yield_MPa, curve.mean_stress == "asme", _weld_names(model, rows))
        if screening is None:
            pieces = counted_at(np.arange(len(rows)), shapes, loads, estimated(shapes, loads, rules), plan, rules)
        else:
            pieces = settle(shapes, stations.weld[rows], toe[rows], loads, plan, screening, rules)
        found += [(rows[piece.rows], piece) for piece in pieces]
    events = tuple(_joined([(rows, p.events[e]) for rows, p in found], EventBlock) for e in range(len(loads)))
    mission = _joined([(rows, p.mission) for rows, p in found], MissionBlock)
    tier = np.empty(len(stations), dtype=np.int8)
    for rows, piece in found:
        tier[rows] = piece.tier
    return GroupResult(events, mission, tier)


def arrays_of(result: GroupResult) -> dict[str, NDArray[Any]]:
    """Lay a result out as few plain arrays, to be stored or sent: reading many small ones takes longer."""
    return {
        "events": np.stack([np.stack([getattr(event, name) for name in _OF_EVENT]) for event in result.events]),
        "verdicts": np.stack([event.verdict for event in result.events]),
        "mission": np.stack([getattr(result.mission, name) for name in _OF_MISSION]),
        "governing": result.mission.governing,
        "verdict": result.mission.verdict,
        "tier": result.tier,
    }


def result_of(arrays: Mapping[str, NDArray[Any]]) -> GroupResult:
    """Take a result from the arrays of `arrays_of`."""
    numbers, verdicts, tier = arrays["events"], arrays["verdicts"], arrays["tier"]
    nothing = np.zeros((len(tier), 2, 0, 2))
    mission = dict(zip(_OF_MISSION, arrays["mission"], strict=True))
    return GroupResult(
        events=tuple(
            EventBlock(**dict(zip(_OF_EVENT, event, strict=True)), verdict=verdict, histogram=nothing)
            for event, verdict in zip(numbers, verdicts, strict=True)
        ),
        mission=MissionBlock(**mission, governing=arrays["governing"], verdict=arrays["verdict"]),
        tier=tier,
    )


def _joined(pieces: Sequence[tuple[NDArray[np.intp], Arrays]], kind: type[Arrays]) -> Arrays:
    """Put the arrays of all pieces at the places of their rows."""
    n = sum(len(rows) for rows, _ in pieces)
    joined: dict[str, NDArray[Any]] = {}
    for field in fields(kind):
        first: NDArray[Any] = getattr(pieces[0][1], field.name)
        joined[field.name] = np.empty((n, *first.shape[1:]), dtype=first.dtype)
        for rows, block in pieces:
            joined[field.name][rows] = getattr(block, field.name)
    return kind(**joined)


def _weld_names(model: Model, rows: NDArray[np.intp]) -> str:
    names = sorted({model.welds[i].name for i in model.stations.weld[rows]})
    return f"welds {names[0]} to {names[-1]}"
