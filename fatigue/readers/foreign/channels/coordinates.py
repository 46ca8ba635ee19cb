"""Modal coordinates among the channels of a file: which groups hold them, and on which one time base."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from fatigue.errors import DataError, Problem
from fatigue.files.naming import composed
from fatigue.readers.foreign.channels.group import ChannelGroup, RecordedChannel
from fatigue.readers.foreign.histories.foreign_history import ForeignHistory
from fatigue.readers.foreign.histories.header import Header
from fatigue.readers.foreign.histories.table_history import history_of_table, with_unit
from fatigue.readers.units.channel_names import Channel, channel, without_unit_one

_TIME = RecordedChannel("time", "s")
_CALLED_Q = re.compile(r"(?:\A|.*[^a-z])(?:q|eta|modal[ _]?coord\w*)[ _.(\[]*\d+[)\] ]*\Z", re.IGNORECASE | re.DOTALL)
_OF_BODY = re.compile(r"(.*?)[^a-z0-9]*(?:q|eta|modal[ _]?coord\w*)[ _.(\[]*\d+[)\] ]*\Z", re.IGNORECASE | re.DOTALL)
_LOAD = "u_"


def coordinates_of(
    path: Path, groups: Sequence[ChannelGroup], columns: Mapping[str, int] | None, time_column: str | None
) -> ForeignHistory:
    """Modal coordinates of a file of channels: those whose names have a number, or those that ``columns`` names.

    Groups with the same instants are one. Where some are called ``q`` and a number, only these are coordinates;
    channels without number are left out beside others that have one.

    Parameters
    ----------
    columns, time_column : as of ``read_text_history``

    Raises
    ------
    DataError
        no such channels, or some without time, some on different time bases, coordinates of several bodies or
        runs; whatever ``history_of_table`` refuses
    """
    groups = [group for group in groups if group.channels]
    if not groups:
        raise DataError(Problem("no_coordinates", str(path), "the file has no channels", "Export them again"))
    says_q = any(called_q(one.name) for group in groups for one in group.channels)
    taken = [(group, _taken(group, columns, time_column, says_q=says_q)) for group in groups]
    used = [(group, at) for group, at in taken if at]
    if columns is None and not any(_mode(group, k) for group, at in used for k in at):
        used = [(group, list(range(len(group.channels)))) for group in groups]  # to be joined in order
    if columns is None:
        _refuse_several_runs(path, used)
        _refuse_several_bodies(path, used)
    if not used:
        named = ", ".join(repr(name) for name in list(columns or ())[:8])
        what = f"none of the channels {named} is there; the file has {_listed(groups)}"
        raise DataError(Problem("no_column", str(path), what, "Correct the table of --columns"))
    first = used[0][0]
    if other := next((group for group, _ in used[1:] if not group.same_times(first)), None):
        what = f"its channels have different time bases: {first.called}, {other.called}"
        remedy = "Name the channels of one by --columns (a file of 'column,mode'), or export one file for each"
        raise DataError(Problem("several_times", str(path), what, remedy))
    if first.time is None and time_column is None and not _names_time(used):
        what = f"{first.called}: {first.without_time or 'the file gives its channels no time'}"
        raise DataError(Problem("no_time", str(path), what, "Export the channels with their time"))
    warnings = dict.fromkeys(warning for group, _ in used for warning in group.warnings)
    return _history(path, used, columns, time_column, (*warnings, *_left_out(path, groups, used)))


def called_q(name: str) -> bool:
    """Whether a channel is called as modal coordinates are, as ``q_12``."""
    return _CALLED_Q.match(channel(name).base) is not None


def _history(
    path: Path,
    used: Sequence[tuple[ChannelGroup, list[int]]],
    columns: Mapping[str, int] | None,
    time_column: str | None,
    warnings: tuple[Problem, ...],
) -> ForeignHistory:
    """History of the chosen channels, which are on one time base."""
    own = [(group.channels[k], group.name) for group, at in used for k in at]
    values = [group.values(at) for group, at in used]
    time = used[0][0].time
    if time is not None and time_column is None:
        own, values = [(_TIME, ""), *own], [time[None], *values]
    names = tuple(one.name for one, _ in own)
    channels = []
    for (one, group), name in zip(own, without_unit_one(names), strict=True):
        place = f"{path}, group {group!r}" if group else str(path)
        stated = _with_number(channel(name), one)
        channels.append(with_unit(f"{place}, channel {one.name!r}", stated, one.unit))
    table = np.concatenate(values).T.astype(np.float64, copy=False)
    history = history_of_table(path, Header((names,), tuple(channels), (), ()), table, None, columns, time_column)
    return replace(history, warnings=(*history.warnings, *warnings))


def _taken(
    group: ChannelGroup, columns: Mapping[str, int] | None, time_column: str | None, *, says_q: bool
) -> list[int]:
    """Positions of the channels that are coordinates, unit loads or time; where some are called q, only these."""
    names = [one.name for one in group.channels]
    if columns is not None:
        wanted = {composed(name) for name in (*columns, *filter(None, [time_column]))}
        return [k for k, name in enumerate(names) if {composed(name), composed(channel(name).base)} & wanted]
    numbered = [k for k, name in enumerate(names) if _mode(group, k) and (not says_q or called_q(name))]
    beside = [
        k
        for k, name in enumerate(names)
        if k not in numbered and (name == time_column or name.startswith(_LOAD) or _is_own_time(group, k))
    ]
    return sorted([*numbered, *beside]) if numbered else []


def _refuse_several_runs(path: Path, used: Sequence[tuple[ChannelGroup, list[int]]]) -> None:
    """Refuse groups with the same coordinates, as analyses or subcases are: each is an event of its own."""
    first: dict[str, ChannelGroup] = {}
    for group, at in used:
        for name in (group.channels[k].name for k in at if _mode(group, k)):
            if first.setdefault(name, group) is not group:
                what = f"channel {name!r} is in groups {first[name].name!r} and {group.name!r}"
                table = f"fatigue channels {path} --group {group.name!r} -o q.parquet"
                remedy = f"Give each as an event, written by: {table}; or name those to take by --columns"
                raise DataError(Problem("several_runs", str(path), what, remedy))


def _refuse_several_bodies(path: Path, used: Sequence[tuple[ChannelGroup, list[int]]]) -> None:
    """Refuse coordinates called q of several bodies: modes of one would fill the gaps of another."""
    bodies: dict[str, str] = {}
    for group, at in used:
        for k in at:
            name = group.channels[k].name
            if called := _OF_BODY.match(channel(name).base):
                bodies.setdefault(called[1].lower(), name)
    if len(bodies) > 1:
        shown = ", ".join(repr(name) for name in list(bodies.values())[:4])
        what = f"the channels are coordinates of {len(bodies)} bodies: {shown}"
        remedy = "Name those of one body by --columns (a file of 'column,mode')"
        raise DataError(Problem("several_bodies", str(path), what, remedy))


def _mode(group: ChannelGroup, k: int) -> int:
    return group.channels[k].mode or channel(group.channels[k].name).mode


def _with_number(own: Channel, one: RecordedChannel) -> Channel:
    """Channel with the number of its mode and the frequency that the file states beside its name."""
    if np.isfinite(one.frequency):
        own = replace(own, frequency=one.frequency, resolution=one.resolution)
    return replace(own, mode=one.mode or own.mode)


def _is_own_time(group: ChannelGroup, k: int) -> bool:
    """Whether a channel is the time of a group that has none of its own."""
    return group.time is None and channel(group.channels[k].name).is_time


def _names_time(used: Sequence[tuple[ChannelGroup, list[int]]]) -> bool:
    return any(channel(group.channels[k].name).is_time for group, at in used for k in at)


def _left_out(
    path: Path, groups: Sequence[ChannelGroup], used: Sequence[tuple[ChannelGroup, list[int]]]
) -> tuple[Problem, ...]:
    """Warning about channels that are no coordinates."""
    taken = {(id(group), k) for group, at in used for k in at}
    rest = [
        (group, one.name)
        for group in groups
        for k, one in enumerate(group.channels)
        if (id(group), k) not in taken and not channel(one.name).is_time
    ]
    if not rest:
        return ()
    others = {group.name for group, _ in rest} - {group.name for group, _ in used}
    where = f", all of group {', '.join(sorted(map(repr, others)))} among them" if others else ""
    what = f"{len(rest)} channels that name no mode are left out: {', '.join(repr(name) for _, name in rest[:5])}"
    return (Problem("channels_left_out", str(path), what + where, "Name them by --columns if they are coordinates"),)


def _listed(groups: Sequence[ChannelGroup]) -> str:
    names = [one.name for group in groups for one in group.channels]
    return ", ".join(repr(name) for name in names[:8]) + (f" and {len(names) - 8} more" if len(names) > 8 else "")
