"""The ride as a story: a finished result, the channels of its events, and what they say beside the damage.

Channels are read and cut to the kept part of their events. Their hunting is tracked, its hot stretches are compared
with the modes of equipment and with the rule of the alarm; comfort, vibration of equipment and running behaviour are
evaluated. Then the worst point of every weld is solved and counted once more, event by event, to see how much of the
damage lies in the hot stretches.
"""

import logging
from collections.abc import Callable, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from fatigue.case import Case
from fatigue.errors import CaseError, DataError, Problem, given_path, no_threads, refuse
from fatigue.files.hashes import sha256
from fatigue.life.mission import Plan
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.mission.events import event_loads
from fatigue.pipeline.mission.plan import mission_plan
from fatigue.pipeline.solve.assessed_body import assessed_body
from fatigue.pipeline.solve.weld_groups import weld_groups
from fatigue.results import ASSESSED, RIDDEN, adding, finished_result, upsampling_factors
from fatigue.ride.alarm import alarm_rows
from fatigue.ride.bands import band_problems
from fatigue.ride.channel import ChannelRecord
from fatigue.ride.coincidence import coincidence_rows
from fatigue.ride.example import no_channels
from fatigue.ride.flutter import Tracked, flutter_rows, flutter_track_rows, tracked
from fatigue.ride.hot_damage import HotDamageRow, hot_damage_rows, told, worst_of_welds, worst_row
from fatigue.ride.records import channel_records
from fatigue.ride.standards.comfort import comfort_rows
from fatigue.ride.standards.equipment import equipment_rows, limits_of
from fatigue.ride.standards.running import running_rows
from fatigue.ride.stationarity import stationarity_row
from fatigue.ride.summary import RideSummary
from fatigue.ride.tables import Rows, write_tables
from fatigue.stages import stage
from fatigue.vibration.standards.environment import VibrationTable
from fatigue.why.points import Points, gather_points

log = logging.getLogger(__name__)

Progress = Callable[[str, int, int], None]


def ride(
    folder: Path | str,
    *,
    case_file: Path | str | None = None,
    threads: int | None = None,
    no_lock: bool = False,
    progress: Progress = lambda label, done, total: None,
) -> RideSummary:
    """What the channels of the events of a finished result say; the tables are written into its folder.

    Parameters
    ----------
    folder : result of an assessment
    case_file : its case with the channels; by default where the provenance of the result says
    threads : that count points, by default one per processor core; the numbers do not depend on it
    no_lock : for a file system without locks, see ``fatigue.assess``
    progress : called with a label, events done and events in all

    Raises
    ------
    DataError : no finished result in the folder, its inputs are gone or have changed, or a channel cannot be had
    CaseError : the case has no channels, or rules that make no sense
    """
    refuse(CaseError, no_threads(threads))
    folder = given_path(folder, "folder")
    case_file = None if case_file is None else given_path(case_file, "case_file")
    stage("reading the result and its case")
    record = finished_result(folder, ASSESSED, ("nodes",), no_lock=no_lock)
    body = assessed_body(record, folder, case_file)
    case = body.case
    if not any(event.channel for event in case.mission.event):
        raise CaseError(no_channels(case))
    limits = limits_of(case)
    channels, warnings = channel_records(case)
    refuse(DataError, band_problems(case, channels))
    for problem in warnings:
        log.warning("%s", problem)
    plan, _ = mission_plan(body, threads)
    with adding(folder, record, RIDDEN, no_lock=no_lock) as addition:
        stage("tracking the hunting of the channels (%d)", len(channels))
        of_channel = [tracked(one, case.ride) for one in channels]
        tables = tables_of_channels(case, channels, of_channel, limits)

        stage("preparing the records of the events (%d)", len(plan.passes))
        groups = weld_groups(body, addition.scratch / "forces")
        chosen = worst_of_welds(folder)
        points = gather_points(folder, groups, chosen)
        loads = event_loads(groups, plan, addition.scratch / "histories", threads, upsampling_factors(record))
        stage("counting the cycles of %d points", len(points))
        tables["hot_damage"] = _hot_damage(points, loads, plan, of_channel, threads, progress)
        worst = _worst(tables["hot_damage"], points)
        tables["alarm"] = [told(row, worst[row.event, row.channel]) for row in tables["alarm"]]

        stage("writing tables")
        write_tables(addition.tables, tables, addition.result)
        addition.publish({"ride": _said(case, channels, chosen.what, warnings)})
    return RideSummary(case.title, _events(channels), chosen.what, tables, worst, tuple(warnings))


def tables_of_channels(
    case: Case, channels: Sequence[ChannelRecord], of_channel: Sequence[Tracked], limits: VibrationTable
) -> dict[str, Rows]:
    """Rows of every table that follows from the channels alone, event by event."""
    rules = case.ride
    tables: dict[str, list[Any]] = {
        "flutter": [row for of in of_channel for row in flutter_rows(of)],
        "flutter_track": [row for of in of_channel for row in flutter_track_rows(of)],
        "stationarity": [stationarity_row(one) for one in channels],
        "coincidence": [],
        "alarm": alarm_rows(of_channel, rules),
        "comfort": comfort_rows(channels, rules),
        "equipment": equipment_rows(channels, rules, limits),
        "running": running_rows(channels, rules),
    }
    for event in _events(channels):
        by_name = {one.name: one for one in channels if one.event == event}
        own = [of for of in of_channel if of.record.event == event]
        tables["coincidence"] += coincidence_rows(event, own, rules, by_name)
    return dict(tables)


def _events(channels: Sequence[ChannelRecord]) -> tuple[str, ...]:
    """Names of the events with channels, in their order."""
    return tuple(dict.fromkeys(one.event for one in channels))


def _hot_damage(
    points: Points,
    loads: Sequence[EventLoad],
    plan: Plan,
    of_channel: Sequence[Tracked],
    threads: int | None,
    progress: Progress,
) -> list[HotDamageRow]:
    """Damage inside and outside the hot stretches of every channel, event by event."""
    rows: list[HotDamageRow] = []
    for number, (load, one_pass) in enumerate(zip(loads, plan.passes, strict=True)):
        progress("ride", number, len(loads))
        own = [of for of in of_channel if of.record.event == one_pass.event]
        if own:
            rows += hot_damage_rows(points, load, one_pass.passes_per_km, own, threads)
    progress("ride", len(loads), len(loads))
    return rows


def _worst(rows: Sequence[HotDamageRow], points: Points) -> dict[tuple[str, str], HotDamageRow]:
    """Where each event damages most, by event and channel."""
    limit = dict(zip(points.weld.tolist(), points.damage_limit.tolist(), strict=True))
    keys = dict.fromkeys((row.event, row.channel) for row in rows)
    return {key: worst_row([row for row in rows if (row.event, row.channel) == key], limit) for key in keys}


def _said(case: Case, channels: Sequence[ChannelRecord], points: str, warnings: Sequence[Problem]) -> dict[str, Any]:
    """What the provenance of a result has of its ride: channels with their files, the rules, the warnings."""
    records = {(one.event, one.name): one for one in channels}
    listed = []
    for event in case.mission.event:
        for channel in event.channel:
            path, one = case.resolve(channel.history or event.history or ""), records[event.name, channel.name]
            listed.append(
                {"event": event.name}
                | channel.model_dump(exclude={"history"})
                | {
                    "file": channel.history or event.history,
                    "sha256": sha256(path),
                    "samples": one.values.size,
                    "step_s": one.step,
                    "start_s": one.start,
                }
            )
    table = case.ride.vibration_table
    return {
        "points": points,
        "channels": listed,
        "rules": case.ride.model_dump(by_alias=True),
        "vibration_table": None if table is None else {"file": table, "sha256": sha256(case.resolve(table))},
        "warnings": [asdict(problem) for problem in warnings],
    }
