"""One group of welds under all events: everything its rows in the result tables need."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from fatigue.life.mission import Plan, life_km, mission_sum
from fatigue.pipeline.event_block import EventBlock, assess_event_block, bounded_event, event_damage, no_overflow
from fatigue.pipeline.event_load import EventLoad
from fatigue.pipeline.mission_block import MissionBlock, mission_block
from fatigue.pipeline.model import Model, toe_faces
from fatigue.pipeline.rated_curves import RatedCurve
from fatigue.pipeline.settle import TIERS, Screening, settle
from fatigue.pipeline.stations import shapes_of, treated_rows

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
    raw_life_km : (n, 2) life without the end treatment [km], NaN where that was not counted
    tier : (n,) index into `settle.TIERS`, 0 where cycles were counted
    """

    events: tuple[EventBlock, ...]
    mission: MissionBlock
    raw_life_km: NDArray[np.float64]
    tier: NDArray[np.int8]


@dataclass(frozen=True, slots=True, eq=False)
class _Piece:
    """Stations of one curve that were all counted, or all settled by the same tier."""

    rows: NDArray[np.intp]
    events: tuple[EventBlock, ...]
    mission: MissionBlock
    tier: np.int8


def assess_group(model: Model, loads: Sequence[EventLoad], plan: Plan, screening: Screening | None) -> GroupResult:
    """Count every event at every station of a group of welds, or at those that screening leaves to be counted.

    Raises
    ------
    NumericalError : stress or damage exceeds double precision
    """
    stations, toe = model.stations, toe_faces(model)
    curve_of = np.array(model.curve_of_weld)[stations.weld]
    pieces: list[_Piece] = []
    for name in dict.fromkeys(curve_of.tolist()):
        rows = np.flatnonzero(curve_of == name)
        if screening is None:
            pieces.append(_counted(model, rows, loads, plan))
        else:
            pieces += _settled(model, rows, toe[rows], loads, plan, screening)
    events = tuple(_joined([(p.rows, p.events[e]) for p in pieces], EventBlock) for e in range(len(loads)))
    mission = _joined([(p.rows, p.mission) for p in pieces], MissionBlock)
    tier = np.empty(len(stations), dtype=np.int8)
    for piece in pieces:
        tier[piece.rows] = piece.tier

    raw_life = mission.life_km.copy()
    treated = treated_rows(stations)
    raw_life[treated] = np.nan
    treated = treated[tier[treated] == 0]
    for name in dict.fromkeys(curve_of[treated].tolist()):
        rows = treated[curve_of[treated] == name]
        raw_life[rows] = _raw_life(model, rows, loads, plan)
    return GroupResult(events, mission, raw_life, tier)


def arrays_of(result: GroupResult) -> dict[str, NDArray[Any]]:
    """Lay a result out as few plain arrays, to be stored or sent: reading many small ones takes longer."""
    return {
        "events": np.stack([np.stack([getattr(event, name) for name in _OF_EVENT]) for event in result.events]),
        "verdicts": np.stack([event.verdict for event in result.events]),
        "mission": np.stack([getattr(result.mission, name) for name in _OF_MISSION]),
        "governing": result.mission.governing,
        "verdict": result.mission.verdict,
        "raw_life_km": result.raw_life_km,
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
        raw_life_km=arrays["raw_life_km"],
        tier=tier,
    )


def _raw_life(model: Model, rows: NDArray[np.intp], loads: Sequence[EventLoad], plan: Plan) -> NDArray[np.float64]:
    """Count all events at stations of one curve without the end treatment, for their life alone, (n, 2) [km]."""
    curve, stations = model.case.curve, model.stations
    shapes = shapes_of(stations, stations.raw, rows, _curve_at(model, rows), curve.thickness_rule)
    damage = []
    for load in loads:
        with no_overflow(load.counted.event, _weld_names(model, rows)):
            damage.append(event_damage(shapes, load, curve.yield_MPa, curve.mean_stress == "asme"))
    return life_km(mission_sum(np.stack(damage), plan.passes), plan.damage_limit)


def _counted(model: Model, rows: NDArray[np.intp], loads: Sequence[EventLoad], plan: Plan) -> _Piece:
    """Count all events at stations of one curve."""
    curve, rated = model.case.curve, _curve_at(model, rows)
    shapes = shapes_of(model.stations, model.stations.treated, rows, rated, curve.thickness_rule)
    events = []
    for load in loads:
        with no_overflow(load.counted.event, _weld_names(model, rows)):
            events.append(assess_event_block(shapes, load, curve.yield_MPa, curve.mean_stress == "asme"))
    return _piece(rows, events, plan, rated, np.int8(0))


def _settled(
    model: Model,
    rows: NDArray[np.intp],
    toe: NDArray[np.bool_],
    loads: Sequence[EventLoad],
    plan: Plan,
    screening: Screening,
) -> Iterator[_Piece]:
    """Screen stations of one curve, count the rest."""
    curve, rated = model.case.curve, _curve_at(model, rows)
    settled = settle(
        shapes_of(model.stations, model.stations.treated, rows, rated, curve.thickness_rule),
        model.stations.weld[rows],
        toe,
        loads,
        plan,
        screening,
        curve.yield_MPa,
        curve.mean_stress == "asme",
        _weld_names(model, rows),
    )
    for some, events in settled.counted:
        yield _piece(rows[some], events, plan, rated, np.int8(0))
    for tier in range(1, len(TIERS)):
        some = np.flatnonzero(settled.tier == tier)
        if some.size:
            bounded = [
                bounded_event(e.at(some), b.at(some)) for e, b in zip(settled.estimates, settled.bounds, strict=True)
            ]
            yield _piece(rows[some], bounded, plan, rated, np.int8(tier))


def _piece(
    rows: NDArray[np.intp], events: Sequence[EventBlock], plan: Plan, rated: RatedCurve, tier: np.int8
) -> _Piece:
    """Weight the events with the mission; only that needs their histograms, which are large."""
    mission = mission_block(events, plan, rated.law)
    nothing = np.zeros((len(rows), 2, 0, 2))
    return _Piece(rows, tuple(replace(event, histogram=nothing) for event in events), mission, tier)


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


def _curve_at(model: Model, rows: NDArray[np.intp]) -> RatedCurve:
    return model.curves[model.curve_of_weld[model.stations.weld[rows[0]]]]


def _weld_names(model: Model, rows: NDArray[np.intp]) -> str:
    names = sorted({model.welds[i].name for i in model.stations.weld[rows]})
    return f"welds {names[0]} to {names[-1]}"
