"""Tables of time and modal coordinates, whatever they were read from: which columns are time, which are modes."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem
from fatigue.files.naming import composed
from fatigue.readers.foreign.histories.foreign_history import ForeignHistory, check_values
from fatigue.readers.foreign.histories.header import Header, header_frequencies
from fatigue.readers.foreign.histories.statements import stated_time_unit
from fatigue.readers.units.channel_names import Channel, seconds_per, unit_of_time
from fatigue.readers.units.coordinate_units import states_no_unit

_COUNT_NAME = re.compile(
    r"\s*(?:unnamed: \d+|index|idx|#|n[or]\.?|(?:lfd|lfd\.)[ _]?nr\.?|(?:sample|row|point|record|step|zeile|punkt)s?"
    r"(?:[ _]?(?:no\.?|nr\.?|number|index|count))?|__index_level_\d+__)\s*\Z",
    re.IGNORECASE,
)

Vectors = NDArray[np.float64]


def history_of_table(
    path: Path,
    header: Header,
    table: Vectors,
    lines: NDArray[np.int64] | None,
    columns: Mapping[str, int] | None,
    time_column: str | None,
) -> ForeignHistory:
    """Time and modal coordinates of a table (t, c), as ``read_text_history`` says.

    ``lines`` are those of the samples in the file, from 1; None where it has none.
    """
    channels, kept, warnings = _filled(path, header.channels, table)
    header = replace(header, channels=tuple(channels), names=tuple(tuple(n[k] for k in kept) for n in header.names))
    table = table[:, kept]
    if len(kept) < 2:
        raise DataError(Problem("bad_table", str(path), "a single column", "Export time and coordinates"))
    mapped = None if columns is None else [_column(path, header, name) for name in columns]
    times = _times(path, header, time_column)
    seconds = _seconds(path, header, channels, times, table, lines)
    taken = [k for k in range(len(channels)) if k not in times] if mapped is None else mapped
    mode = np.array([channels[k].mode for k in taken] if columns is None else list(columns.values()), np.int64)
    listed = header_frequencies(header.free)
    frequency, resolution = _frequencies(path, [channels[k] for k in taken], mode, listed)
    return check_values(
        ForeignHistory(
            str(path),
            mode,
            frequency,
            tuple(channels[k].name or f"column {k + 1}" for k in taken),
            seconds,
            np.ascontiguousarray(table[:, taken].T),
            warnings,
            unit=tuple(channels[k].unit for k in taken),
            resolution=resolution,
            lines=lines,
        )
    )


def _filled(
    path: Path, channels: Sequence[Channel], table: Vectors
) -> tuple[list[Channel], list[int], tuple[Problem, ...]]:
    """Channels but for nameless empty columns, as spreadsheets leave them, and counts of the rows; and warnings."""
    count = np.arange(len(table))
    timed, kept, warnings = any(c.is_time for c in channels), [], []
    for k, own in enumerate(channels):
        empty = np.isnan(table[:, k]).all()
        if (own.name and not _COUNT_NAME.match(own.name)) or not (timed or (empty and not own.name)):
            kept.append(k)
        elif own.name or not empty:
            if not (np.array_equal(table[:, k], count) or np.array_equal(table[:, k], count + 1)):
                kept.append(k)
                continue
            named = f"is named {own.name!r}" if own.name else "has no name"
            what = f"column {k + 1} {named} and counts the rows; it is left out"
            warnings.append(Problem("row_count", str(path), what, "Export without it"))
    return [channels[k] for k in kept], kept, tuple(warnings)


def _times(path: Path, header: Header, wanted: str | None) -> list[int]:
    """Positions of the columns of time: that which is wanted, those with a name of time, or the first of nameless."""
    channels = header.channels
    if wanted is not None:
        if (
            all(wanted not in names for names in header.names)
            and wanted.isdecimal()
            and 1 <= int(wanted) <= len(channels)
        ):
            return [int(wanted) - 1]
        return [_column(path, header, wanted, "time column")]
    named = [k for k, c in enumerate(channels) if c.is_time]
    if named or not header.names:
        return named or [0]
    shown = ", ".join(repr(c.name) for c in channels[:8])
    raise DataError(
        Problem(
            "no_time",
            str(path),
            f"no column is named time; the columns are {shown}",
            "Name it, or its position from 1, with --time-column",
        )
    )


def _column(path: Path, header: Header, name: str, what: str = "column") -> int:
    """Position of a named column; its unit may be left out where that is clear."""
    name = composed(name)
    bases = tuple(c.base for c in header.channels)
    for written in (*header.names, bases):
        names = [composed(other) for other in written]
        if names.count(name) > 1:
            raise DataError(
                Problem("column_twice", str(path), f"{names.count(name)} columns are named {name!r}", "Rename them")
            )
        if name in names:
            return names.index(name)
    shown = ", ".join(c.name for c in header.channels[:8])
    raise DataError(Problem("no_column", str(path), f"there is no {what} {name!r}", f"Name some of {shown}"))


def _seconds(
    path: Path,
    header: Header,
    channels: Sequence[Channel],
    times: Sequence[int],
    table: Vectors,
    lines: NDArray[np.int64] | None,
) -> Vectors:
    """Times in seconds, by the unit that names, rows of units or free text state."""
    stated = stated_time_unit(path, header.free)
    found = []
    for k in times:
        own = channels[k]
        unit = own.unit if own.is_time else unit_of_time(own.name) or own.unit
        factor = seconds_per(unit) if unit else None
        if unit and factor is None:
            where, what = f"{path}, column {own.name!r}", f"{unit!r} is no unit of time"
            raise DataError(Problem("time_unit", where, what, "Write s, ms, us, min or h"))
        if stated is not None and factor is not None and factor != seconds_per(stated[1]):
            what = f"two statements of the header disagree: time in {stated[1]}, and {own.name!r} in {unit}"
            raise DataError(Problem("header", f"{path}, line {stated[0]}", what, "Correct one of them"))
        factor = factor or (seconds_per(stated[1]) if stated else None) or Fraction(1)
        found.append(table[:, k] * factor.numerator / factor.denominator)
    for k, other in zip(times[1:], found[1:], strict=True):
        if not np.allclose(other, found[0], rtol=1e-9, atol=0.0):
            row = int(np.argmax(~np.isclose(other, found[0], rtol=1e-9, atol=0.0)))
            place = f", line {lines[row]}" if lines is not None else ""
            what = f"time is repeated before every curve, and differs: {found[0][row]:.9g} s in column {times[0] + 1}, "
            what += f"{other[row]:.9g} s in column {k + 1}"
            remedy = "Export all curves at the same instants, with one column of time"
            raise DataError(Problem("several_times", f"{path}{place}, sample {row + 1}", what, remedy))
    return np.array(found[0])


def _frequencies(
    path: Path, channels: Sequence[Channel], mode: NDArray[np.int64], listed: Mapping[int, tuple[int, float, float]]
) -> tuple[Vectors, Vectors]:
    """Frequencies (m,) that names and header state, and half a unit of their last digits [Hz]."""
    frequency = np.array([c.frequency for c in channels])
    resolution = np.array([c.resolution for c in channels])
    for k, m in enumerate(mode.tolist()):
        if m not in listed:
            continue
        line, value, half = listed[m]
        if np.isfinite(frequency[k]) and abs(frequency[k] - value) > resolution[k] + half:
            what = f"two statements of the header disagree: {value:g} Hz for mode {m}, and {channels[k].name!r}"
            raise DataError(Problem("header", f"{path}, line {line}", what, "Correct one of them"))
        if not np.isfinite(frequency[k]):
            frequency[k], resolution[k] = value, half
    return frequency, resolution


def with_unit(where: str, own: Channel, unit: str) -> Channel:
    """Channel with the unit that the file states beside its name; none where it says that there is none, as ``-``.

    Raises
    ------
    DataError : its name states another unit
    """
    unit = "" if states_no_unit(unit) else unit
    if unit and own.unit and unit.lower() != own.unit.lower():
        what = f"its name states {own.unit}, its metadata {unit}"
        raise DataError(Problem("header", where, what, "Correct one of them"))
    return replace(own, unit=own.unit or unit)
