"""The time of a group that has it as one of its channels."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from fatigue.readers.foreign.channels.group import ChannelGroup
from fatigue.readers.units.channel_names import channel, seconds_per


def with_own_time(group: ChannelGroup) -> ChannelGroup:
    """The group on the time that one of its channels is, in seconds; as it is where none is, or several that differ."""
    named = [k for k, one in enumerate(group.channels) if channel(one.name).is_time]
    if group.time is not None or not named:
        return group
    at, *again = named
    if again and not all(np.array_equal(row, rows[0]) for rows in [group.values(named)] for row in rows):
        return replace(group, without_time=f"{len(named)} of its channels are named time, and they differ")
    unit = channel(group.channels[at].name).unit or group.channels[at].unit
    factor = seconds_per(unit) if unit else 1
    if factor is None:
        return replace(group, without_time=f"its time is in {unit!r}, which is no unit of time")
    kept = [k for k in range(len(group.channels)) if k not in named]

    def values(wanted: Sequence[int]) -> NDArray[np.floating]:
        return group.values([kept[k] for k in wanted])

    return replace(
        group,
        channels=tuple(group.channels[k] for k in kept),
        time=np.asarray(group.values([at])[0], np.float64) * float(factor),
        values=values,
        without_time="",
    )
