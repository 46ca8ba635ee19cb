"""Channels of a measurement as somebody lists them: column in the records, gauge that is read, unit, range."""

import difflib
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fatigue.errors import DataError, Problem, refuse
from fatigue.gauges.measured.distance import KM_H_OF, KM_OF
from fatigue.readers.neutral.tables import Table, open_table

ODOMETER, SPEED, TEMPERATURE = "odometer", "speed", "temperature"
RESERVED = {ODOMETER: tuple(KM_OF), SPEED: tuple(KM_H_OF), TEMPERATURE: ("degC", "K")}
STRAIN_UNITS = ("ue", "mV/V", "V", "MPa")
TEXTS = ("channel", "file_column", "gauge", "bridge", "unit", "sync_group")

Term = tuple[str, float]


@dataclass(frozen=True, slots=True)
class Channel:
    """One channel of the records.

    Attributes
    ----------
    name : of the channel
    where : file and row, for messages
    column : of the records
    terms : gauges that it reads, each with its weight; one with weight 1, or those of a bridge; none: not of strain
    reserved : odometer, speed, temperature, or "" of strain
    unit : of its samples, once calibrated; of mV/V and V the calibration makes ue
    full_scale_ue : range of the amplifier [ue], None: not known
    sync_group : channels that were sampled together
    E : modulus that made stress of strain [MPa], of channels in MPa
    """

    name: str
    where: str
    column: str
    terms: tuple[Term, ...]
    reserved: str
    unit: str
    full_scale_ue: float | None = None
    sync_group: str = ""
    E: float | None = None

    @property
    def gauge(self) -> str:
        """What it reads: the name of a gauge, or the terms of a bridge."""
        if len(self.terms) == 1 and self.terms[0][1] == 1.0:
            return self.terms[0][0]
        return "; ".join(f"{name}:{weight:g}" for name, weight in self.terms)

    @property
    def ue_per_unit(self) -> float:
        """Strain [ue] of one unit of its calibrated samples."""
        return 1.0 if self.E is None else 1e6 / self.E


@dataclass(frozen=True, slots=True)
class Channels:
    """The channels of strain, and those of distance that there are."""

    strain: tuple[Channel, ...]
    reserved: dict[str, Channel]
    warnings: tuple[Problem, ...]


def read_channels(path: Path, gauges: Collection[str], *, strict: bool = False) -> Channels:
    """Read the table of channels, whose gauges are among those of another table.

    Raises
    ------
    DataError
        a channel twice, without a gauge or with one that there is not, a unit that there is not, MPa without a modulus
    """
    table = open_table(path, texts=TEXTS)
    table.expect(("channel", "unit"), (*TEXTS, "full_scale_ue", "E_MPa"), strict=strict)
    names, code = table.groups("channel")
    table.unique({"channel": code}, {"channel": names})
    texts = {name: table.texts(name, default="") for name in TEXTS}
    scale = table.numbers("full_scale_ue", default=np.nan)
    modulus = table.numbers("E_MPa", default=np.nan)
    for name, values in (("full_scale_ue", scale), ("E_MPa", modulus)):
        low = values <= 0.0
        table.report(low, "bad_value", name, f"{values[int(low.argmax())]:g} is not above 0", "Give more than 0")
    table.refuse()
    channels = []
    for row in range(table.rows):
        of_row = {name: values[row] for name, values in texts.items()}
        terms, problems = _terms(table, row, of_row["gauge"], of_row["bridge"], gauges)
        channel = Channel(
            name=of_row["channel"],
            where=f"{path.name}: channel '{of_row['channel']}' ({table.row_name(row)})",
            column=of_row["file_column"] or of_row["channel"],
            terms=terms,
            reserved=of_row["gauge"] if of_row["gauge"] in RESERVED else "",
            unit=of_row["unit"],
            full_scale_ue=None if np.isnan(scale[row]) else float(scale[row]),
            sync_group=of_row["sync_group"],
            E=None if np.isnan(modulus[row]) else float(modulus[row]),
        )
        table.problems.extend((*problems, *_unit_problems(channel)))
        channels.append(channel)
    table.refuse()
    strain = tuple(channel for channel in channels if not channel.reserved)
    refuse(DataError, _as_a_whole(path, channels, strain, gauges))
    reserved = {channel.reserved: channel for channel in channels if channel.reserved}
    return Channels(strain, reserved, tuple(table.warnings))


def _terms(
    table: Table, row: int, gauge: str, bridge: str, gauges: Collection[str]
) -> tuple[tuple[Term, ...], list[Problem]]:
    """What a channel reads, and what is wrong with that."""
    if bool(gauge) == bool(bridge):
        what = "names both a gauge and a bridge" if gauge else "names no gauge"
        remedy = f"Give a gauge of the table of gauges, a bridge (A:1; B:-1), or one of {', '.join(RESERVED)}"
        return (), [Problem("channel_gauge", table.where("gauge", row), what, remedy)]
    if gauge in RESERVED:
        return (), []
    where = table.where("bridge" if bridge else "gauge", row)
    items = bridge.split(";") if bridge else [f"{gauge}:1"]
    terms = [(name.strip(), _weight(weight)) for name, _, weight in (item.rpartition(":") for item in items)]
    problems = []
    for item, (name, weight) in zip(items, terms, strict=True):
        if not np.isfinite(weight) or weight == 0.0:
            what = f"{item.strip()!r} is no gauge with a weight apart from 0"
            problems.append(Problem("bad_bridge", where, what, "Write A:1; B:-1"))
        elif name not in gauges:
            near = difflib.get_close_matches(name, gauges, n=1)
            remedy = f"Write {near[0]!r}" if near else "Add a row to the table of gauges, or remove the channel"
            problems.append(Problem("unknown_gauge", where, f"there is no gauge {name!r}", remedy))
    return tuple(terms), problems


def _weight(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return np.nan


def _unit_problems(channel: Channel) -> Iterator[Problem]:
    known = RESERVED.get(channel.reserved, STRAIN_UNITS)
    if channel.unit not in known:
        what = f"{channel.unit!r} is no unit of {channel.reserved or 'strain'}"
        yield Problem("unit", channel.where, what, f"Give one of {', '.join(known)}")
    if channel.unit == "MPa" and channel.E is None:
        what = "is in MPa, and the modulus that made stress of its strain is not given"
        yield Problem("missing_modulus", channel.where, what, "Give E_MPa, or the strain itself in ue")
    if channel.unit != "MPa" and channel.E is not None:
        what = f"has a modulus E_MPa and is in {channel.unit}, of which it is no part"
        yield Problem("unused_modulus", channel.where, what, "Leave E_MPa empty, or correct the unit to MPa")


def _as_a_whole(
    path: Path, channels: list[Channel], strain: tuple[Channel, ...], gauges: Collection[str]
) -> Iterator[Problem]:
    """What is wrong with the table beside its rows."""
    if not strain:
        yield Problem("no_channels", path.name, "names no channel of a gauge", "Give one row for each channel")
    for name in RESERVED:
        if len([1 for channel in channels if channel.reserved == name]) > 1:
            yield Problem("duplicate", path.name, f"has several channels of {name}", "Keep one of them")
        if name in gauges:
            what = f"{name!r} names what a channel measures, and a gauge has this name"
            yield Problem("reserved_name", path.name, what, "Rename the gauge")
