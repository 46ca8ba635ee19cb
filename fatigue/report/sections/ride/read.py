"""The tables of a ride, read where one was made, channel by channel."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from fatigue.report.result import ShownResult
from fatigue.results import RIDDEN, read_table
from fatigue.results.tables import table_path

TRACK = "flutter_track"  # long, and of no use but to be drawn: the page does without it
NEEDED = tuple(name for name in RIDDEN if name != TRACK)


@dataclass(frozen=True, slots=True, eq=False)
class HeardChannel:
    """One channel of one event.

    Attributes
    ----------
    stretches : its rows of ``flutter``
    track : its rows of ``flutter_track``, none where that is not there
    modes : its rows of ``coincidence``
    welds : its rows of ``hot_damage`` and with them ``severity``, the damage over what the weld may bear [1/km]
    is_of_bogie : whether the alarm of a bogie was looked at
    told : what the alarm tells of the damage, empty where that is not known
    """

    event: str
    channel: str
    stretches: pd.DataFrame
    track: pd.DataFrame
    modes: pd.DataFrame
    welds: pd.DataFrame
    is_of_bogie: bool
    told: str

    @property
    def is_tracked(self) -> bool:
        """Whether a dominant frequency is known of it."""
        return bool(self.stretches["frequency_hz"].notna().any())

    @property
    def hot(self) -> pd.DataFrame:
        """Its hot stretches."""
        return self.stretches[self.stretches["hot"].to_numpy(dtype=bool)]

    @property
    def length_share(self) -> float:
        """Share of the event in hot stretches; NaN without a track."""
        if len(self.welds):
            return float(self.welds["length_share_inside"].iloc[0])
        length = (self.stretches["end_s"] - self.stretches["start_s"]).to_numpy()
        hot = self.stretches["hot"].to_numpy(dtype=bool)
        return float(length[hot].sum() / length.sum()) if self.is_tracked else np.nan

    @property
    def hunting_hz(self) -> float:
        """Dominant frequency of the hot stretches, or of the whole event without any [Hz]; NaN without a track."""
        compared = self.modes["f_hunt_hz"].dropna()
        if len(compared):
            return float(compared.iloc[0])
        slices = self.track.loc[self.track["hot"].to_numpy(dtype=bool), "frequency_hz"]
        if len(slices):
            return float(slices.median())
        of = self.hot if len(self.hot) else self.stretches
        return float(of["frequency_hz"].median()) if self.is_tracked else np.nan

    @property
    def worst(self) -> "pd.Series[Any] | None":
        """The row of the weld that the event damages most, each by what it may bear; None where it damages none."""
        if not len(self.welds) or not self.welds["severity"].max() > 0.0:
            return None
        return self.welds.loc[self.welds["severity"].idxmax()]

    @property
    def reason(self) -> str:
        """Why it has no track, or what its stretches are to be read with."""
        reason = self.stretches["reason"].iloc[0]
        return reason if isinstance(reason, str) else ""


@dataclass(frozen=True, slots=True, eq=False)
class ShownRide:
    """What the channels of a ride say; ``said`` is what the provenance has of it."""

    channels: tuple[HeardChannel, ...]
    tables: Mapping[str, pd.DataFrame]
    said: Mapping[str, Any]

    @property
    def bogies(self) -> tuple[HeardChannel, ...]:
        """Channels of bogies; all of them where none is of a bogie."""
        return tuple(of for of in self.channels if of.is_of_bogie) or self.channels


def read_ride(folder: Path, result: ShownResult) -> ShownRide | None:
    """Tables of a ride, read; None where no ride was made."""
    if not all(table_path(folder, name).is_file() for name in NEEDED):
        return None
    tables = {name: read_table(folder, name).to_pandas() for name in NEEDED}
    damage, of_all = tables["hot_damage"], float(result.record["mission"].get("damage_limit", 1.0))
    limit = (
        result.assessed.set_index("weld")["damage_limit"].astype(np.float64).fillna(of_all)
    )  # empty in older results
    tables["hot_damage"] = damage.assign(severity=damage["damage_per_km"] / damage["weld"].map(limit))
    track = read_table(folder, TRACK).to_pandas() if table_path(folder, TRACK).is_file() else None
    return ShownRide(_channels(tables, track), tables, result.record.get("ride", {}))


def _channels(tables: Mapping[str, pd.DataFrame], track: pd.DataFrame | None) -> tuple[HeardChannel, ...]:
    """Channels in the order of the table of stretches, each with its own rows."""
    stretches, modes, welds = (_by_channel(tables[name]) for name in ("flutter", "coincidence", "hot_damage"))
    slices = {} if track is None else _by_channel(track)
    no_slices = pd.DataFrame({name: np.empty(0) for name in ("time_s", "frequency_hz", "hot")})
    told = {
        (row.event, row.channel): row.told if isinstance(row.told, str) else "" for row in tables["alarm"].itertuples()
    }
    return tuple(
        HeardChannel(
            event=str(key[0]),
            channel=str(key[1]),
            stretches=of,
            track=slices.get(key, no_slices),
            modes=modes.get(key, tables["coincidence"].head(0)),
            welds=welds.get(key, tables["hot_damage"].head(0)),
            is_of_bogie=key in told,
            told=told.get(key, ""),
        )
        for key, of in stretches.items()
    )


def _by_channel(rows: pd.DataFrame) -> dict[Any, pd.DataFrame]:
    """Rows of every event and channel, in the order of the table."""
    return dict(list(rows.groupby(["event", "channel"], sort=False)))
