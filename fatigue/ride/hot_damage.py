"""Damage inside and outside the hot stretches of a channel, and whether an alarm tells of it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.results import read_codes, read_table
from fatigue.ride.alarm import AlarmRow
from fatigue.ride.flutter import Tracked
from fatigue.ride.placed import edges_of, inside, placed_damage
from fatigue.side_by_side import in_order
from fatigue.why.points import Chosen, Points

Floats = NDArray[np.float64]
NAN = float("nan")
FACES = ("top", "bottom")
MOST_WELDS = 2000  # those with the highest utilisation, as of load spectra
POINTS_AT_ONCE = 8


@dataclass(frozen=True, slots=True)
class HotDamageRow:
    """Damage of an event at the worst point of a weld, inside and outside the hot stretches of a channel."""

    weld: str
    part: int
    node: int
    order: int
    surface: str
    event: str
    channel: str
    damage_per_km: float
    damage_per_km_inside: float
    share_inside: float
    length_share_inside: float
    intensity: float

    @property
    def is_denser_inside(self) -> bool:
        """Whether the hot stretches hold more of the damage than of the length."""
        return self.share_inside > self.length_share_inside


def worst_of_welds(folder: Path) -> Chosen:
    """The worst counted point of every weld, of more than ``MOST_WELDS`` welds those with the highest utilisation."""
    weld, _ = read_codes(folder, "nodes", "weld")
    tier, tiers = read_codes(folder, "nodes", "screened")
    table = read_table(folder, "nodes", ["utilisation", "toe"])
    counted = np.array([name == "" for name in [*tiers, ""]])[tier]
    utilisation = np.where(table["toe"].to_numpy() & counted, table["utilisation"].to_numpy(), -1.0)
    rows = pd.Series(utilisation).groupby(weld).idxmax().to_numpy()
    kept = np.sort(rows[np.argsort(-utilisation[rows], kind="stable")[:MOST_WELDS]])
    what = f"the worst point of every weld, {len(kept)}"
    if len(kept) < len(rows):
        what = f"the worst points of the {len(kept)} of {len(rows)} welds with the shortest lives"
    return Chosen(kept, np.full(len(kept), "worst of its weld", dtype=object), np.arange(len(kept)), what)


def hot_damage_rows(
    points: Points, load: EventLoad, passes_per_km: float, channels: Sequence[Tracked], threads: int | None = None
) -> list[HotDamageRow]:
    """Damage of one event in and out of the hot stretches of each of its channels, point by point."""
    spans = [of.hot_spans for of in channels]
    edges = edges_of(spans)
    blocks = [points.of(slice(i, i + POINTS_AT_ONCE)) for i in range(0, len(points), POINTS_AT_ONCE)]
    placed = passes_per_km * np.concatenate(
        list(in_order(lambda some: placed_damage(some, load, edges), blocks, threads))
    )
    return [
        _row(points, i, of, placed[i], inside(own, edges), _length_share(own, load))
        for of, own in zip(channels, spans, strict=True)
        for i in range(len(points))
    ]


def _row(
    points: Points, i: int, of: Tracked, placed: Floats, is_inside: NDArray[np.bool_], length: float
) -> HotDamageRow:
    damage, within, without = float(placed.sum()), float(placed[is_inside].sum()), float(placed[~is_inside].sum())
    has_both = 0.0 < length < 1.0 and without > 0.0
    known = of.track is not None
    return HotDamageRow(
        weld=str(points.weld[i]),
        part=int(points.part[i]),
        node=int(points.node[i]),
        order=int(points.order[i]),
        surface=FACES[points.face[i]],
        event=of.record.event,
        channel=of.record.name,
        damage_per_km=damage,
        damage_per_km_inside=within if known else NAN,
        share_inside=within / damage if known and damage > 0.0 else NAN,
        length_share_inside=length if known else NAN,
        intensity=(within / length) / (without / (1.0 - length)) if known and has_both else NAN,
    )


def _length_share(spans: Sequence[tuple[float, float]], load: EventLoad) -> float:
    """Share of the kept part of an event that lies in some stretches."""
    begin, end = load.counted.start, load.counted.start + load.duration
    return sum(max(0.0, min(until, end) - max(since, begin)) for since, until in spans) / load.duration


def worst_row(rows: Sequence[HotDamageRow], damage_limit: Mapping[str, float]) -> HotDamageRow:
    """The row of the weld with the largest damage, each by what the weld may bear."""
    return max(rows, key=lambda row: row.damage_per_km / damage_limit[row.weld])


def told(alarm: AlarmRow, worst: HotDamageRow) -> AlarmRow:
    """The row of an alarm with the damage in the hot stretches of its channel, and whether the alarm tells of it.

    ``yes``: it goes off, and the hot stretches hold more of the damage than of the length; ``missed``: they do, and it
    does not; ``nothing_to_tell``: they do not; ``no_hot_stretch``: there are none. Empty where no alarm can be had.
    """
    share, length = worst.share_inside, worst.length_share_inside
    alarm = replace(alarm, damage_share_inside_hot=share, hot_km_share=length)
    if np.isnan(length) or alarm.alarms is None:
        return alarm
    if length == 0.0:
        return replace(alarm, told="no_hot_stretch")
    if not worst.is_denser_inside:
        return replace(alarm, told="nothing_to_tell")
    return replace(alarm, told="yes" if alarm.alarms else "missed")
