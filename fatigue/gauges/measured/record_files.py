"""Records of a measurement: ``time_s`` and the columns of channels, each column read when it is asked for."""

import re
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, FatigueError, Problem, refuse
from fatigue.files.hashes import told_apart
from fatigue.gauges.measured.channel_file import ODOMETER, SPEED, Channel
from fatigue.gauges.measured.distance import KM_H_OF, KM_OF, filled, of_odometer, of_speed
from fatigue.gauges.measured.rate import LARGEST_FACTOR, exact_ratio
from fatigue.readers.neutral.event.load_units import stated_unit
from fatigue.readers.neutral.history import uniform_step
from fatigue.readers.neutral.tables import Table, open_table

Floats = NDArray[np.float64]

SPELLINGS = {
    "ue": ("1e-6", "µe", "µε", "um/m", "µm/m", "microstrain", "ustrain", "µstrain"),
    "MPa": ("n/mm2", "n/mm^2", "n/mm²"),
    "km/h": ("kmh", "kph"),
}
_IN_NAME = re.compile(  # what else stands in brackets is part of a name
    r"[\[(]\s*(ue|[µμ][eε]|[uµμ]m/m|[uµμ]strain|microstrain|m?V(?:/V)?|k?N|mm|M?Pa|N/mm\^?[2²]|km(?:/h)?|m(?:/s)?)\s*[\])]\s*$",
    re.IGNORECASE,
)


@dataclass(frozen=True, slots=True, eq=False)
class Record:
    """One record that is open.

    Attributes
    ----------
    table : the file
    name : by which it is told from the other records
    start, step : time of its first sample, and between samples [s]
    ratio : of the rate of the simulation to its own
    """

    table: Table
    name: str
    start: float
    step: float
    ratio: Fraction

    @property
    def samples(self) -> int:
        """Number of samples."""
        return self.table.rows

    @property
    def rate_hz(self) -> float:
        """Sampling rate."""
        return 1.0 / self.step

    @property
    def samples_at_ratio(self) -> int:
        """Number of samples at the rate of the simulation."""
        return -(-self.samples * self.ratio.numerator // self.ratio.denominator)

    def read(self, channel: Channel) -> Floats:
        """Raw samples (t,) of a channel, NaN where there are none."""
        values = self.table.samples(channel.column)
        self.table.refuse()
        return values


def open_records(
    paths: Sequence[Path], channels: Collection[Channel], wanted_hz: float
) -> tuple[tuple[Record, ...], list[Problem]]:
    """Open records that have the columns of all channels, and the warnings about them.

    ``wanted_hz`` is the rate that they are brought to. What other columns they have is not looked at.

    Raises
    ------
    DataError
        the same file twice, no such column, another unit, times that are not uniform, a rate without an exact ratio
    """
    problems = [
        Problem("duplicate", str(path), "is given twice among the records", "Give each record once")
        for i, path in enumerate(paths)
        if path in paths[:i]
    ]
    found: list[Record] = []
    for path, name in zip(paths, told_apart(paths), strict=True):
        try:
            found.append(_opened(path, name, channels, wanted_hz))
        except FatigueError as error:
            problems += error.problems
    refuse(DataError, problems)
    told = [warning for record in found for warning in record.table.warnings]
    return tuple(found), [warning for warning in told if warning.code != "unit_unused"]  # compared here


def _unit_problems(path: Path, channel: Channel) -> Iterator[Problem]:
    """A unit that a record states for a column, in its name, below it or beside it, and that the channel has not."""
    in_name = _IN_NAME.search(channel.column)
    stated = stated_unit(path, channel.column) or (in_name[1] if in_name else "")
    plain = stated.strip(" []()").replace("μ", "µ").lower()  # the Greek letter and the sign of micro
    if plain and plain != channel.unit.lower() and plain not in SPELLINGS.get(channel.unit, ()):
        what = f"the unit is {stated}, and channel '{channel.name}' is in {channel.unit}"
        remedy = "Correct the unit in the table of channels, or convert the values"
        yield Problem("unit", f"{path.name}: column {channel.column}", what, remedy)


def _opened(path: Path, name: str, channels: Collection[Channel], wanted_hz: float) -> Record:
    table = open_table(path)
    columns = ("time_s", *dict.fromkeys(channel.column for channel in channels))
    table.expect(columns, table.position, strict=False)
    refuse(DataError, (problem for channel in channels for problem in _unit_problems(path, channel)))
    time = table.numbers("time_s").astype(np.float64)
    table.refuse()
    step = uniform_step(table, time)
    ratio = exact_ratio(1.0 / step, wanted_hz, table.rows)
    if ratio is None:
        what = f"is sampled at {1.0 / step:.9g} Hz, and the simulation at {wanted_hz:.9g} Hz: no whole numbers up to "
        what += f"{LARGEST_FACTOR} are in this ratio, exactly enough for its {table.rows} samples"
        remedy = "Write it at a rate that has one, from its time stamps, behind an anti-aliasing filter"
        raise DataError(Problem("no_exact_ratio", name, what, remedy))
    return Record(table, name, float(time[0]), step, ratio)


@dataclass(frozen=True, slots=True, eq=False)
class Distances:
    """Distance of every sample of every record [km], where it is from, and what was wrong with it."""

    km: tuple[Floats, ...]
    source: str
    warnings: tuple[Problem, ...]

    @property
    def total(self) -> float:
        """Distance of all records [km]."""
        return float(sum(of_record.sum() for of_record in self.km))


def distances(records: Sequence[Record], reserved: dict[str, Channel], km: float | None) -> Distances:
    """How far the records ran: ``km`` of all together at an even speed, else from an odometer, else from a speed.

    Raises
    ------
    DataError : none of the three; nothing but missing values; no way at all
    """
    if km is not None:
        samples = sum(record.samples * record.step for record in records)
        even = tuple(np.full(record.samples, km * record.step / samples) for record in records)
        return Distances(even, f"{km:g} km as given", ())
    kind = ODOMETER if ODOMETER in reserved else SPEED
    if kind not in reserved:
        what = "how far the records ran is not known, and every number is per km"
        remedy = f"Give --km, or a channel of gauge {ODOMETER} or {SPEED} in the table of channels"
        raise DataError(Problem("no_distance", "--km", what, remedy))
    channel, found, warnings = reserved[kind], [], []
    for record in records:
        values, missing = filled(record.read(channel))
        if missing == len(values):
            raise DataError(_without_values(record, channel))
        if missing:
            what = f"{missing} of {len(values)} samples of the {kind} are missing"
            warnings.append(Problem("distance_gaps", record.name, what, "Lines stand for them: check the distance"))
        ways, backwards = _ways(values, record, channel, kind)
        if backwards:
            what = f"the odometer goes backwards {backwards} times, which is no distance here"
            warnings.append(Problem("odometer_backwards", record.name, what, "Check for a reset, or give --km"))
        found.append(ways)
    result = Distances(tuple(found), f"channel '{channel.name}' ({kind})", tuple(warnings))
    if not result.total > 0.0:
        what = f"the records ran {result.total:g} km by channel '{channel.name}'"
        raise DataError(Problem("no_distance", channel.where, what, "Check the channel, or give --km"))
    return result


def _ways(values: Floats, record: Record, channel: Channel, kind: str) -> tuple[Floats, int]:
    """Distance of every sample [km], and how often an odometer went backwards."""
    if kind == ODOMETER:
        ways, backwards = of_odometer(values)
        return KM_OF[channel.unit] * ways, backwards
    return of_speed(KM_H_OF[channel.unit] * values, record.step), 0


def _without_values(record: Record, channel: Channel) -> Problem:
    what = "the column has no value"
    return Problem("no_values", record.table.where(channel.column), what, "Give --km, or record the channel")
