"""What the lines above the numbers of a history state: names, units, mode numbers, frequencies, counts.

Everything that is stated is used, or refused where two statements disagree.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from fatigue.errors import DataError, Problem, refuse
from fatigue.readers.foreign.histories.header_lines import (
    UNIT_LABEL,
    HeaderRow,
    decimal_sign,
    header_lines,
    listed_names,
)
from fatigue.readers.foreign.histories.header_problems import (
    disagreement,
    label_problem,
    numbers_problem,
    refuse_broken_rows,
    refuse_short_names,
    some_of,
)
from fatigue.readers.foreign.histories.number_rows import NumberRows
from fatigue.readers.text.numbers import Decimal, is_number, plain_number
from fatigue.readers.text.separator import declared_separator
from fatigue.readers.units.channel_names import (
    TIME_UNITS,
    Channel,
    channel,
    stated_frequency,
    without_unit_one,
    written,
)
from fatigue.readers.units.coordinate_units import parse_unit, states_no_unit


@dataclass(frozen=True, slots=True)
class Header:
    """What the header states about the columns.

    Attributes
    ----------
    names : of the columns, in each row of names; empty if the file has none
    channels : what the names and the rows of units, modes and frequencies together state, one for each column
    cells : cells of all lines above the numbers, to recognise them where they are repeated
    free : the other lines, by their number
    """

    names: tuple[tuple[str, ...], ...]
    channels: tuple[Channel, ...]
    cells: tuple[tuple[str, ...], ...]
    free: tuple[tuple[int, str], ...]


def read_header(path: Path, lines: Sequence[str], rows: NumberRows) -> Header:
    """Header that the lines above the numbers make.

    Raises
    ------
    DataError : rows that disagree, names for another number of columns, a row of numbers nobody labelled
    """
    for k, line in enumerate(lines[: rows.first]):
        declared = declared_separator(line)
        if declared is not None and declared != (rows.separator or " "):
            what = f"the file declares sep={declared}, and its columns are separated by {rows.separator or 'blanks'!r}"
            raise DataError(Problem("csv_separator", f"{path}, line {k + 1}", what, "Correct one of them"))
    listed, lines_of_list = listed_names(path, lines[: rows.first], rows.width)
    found = header_lines(lines[: rows.first], rows, lines_of_list)
    names = [row for row in found.rows if row.kind == "names"]
    if not names and listed is None:
        refuse_short_names(path, lines, rows, found.rows)
    if names:
        refuse_broken_rows(path, lines, rows, names[0].line)
    if listed is not None:
        refuse_broken_rows(path, lines, rows, max(lines_of_list))
        names.append(listed)
    channels = [[channel(name) for name in without_unit_one(row.cells)] for row in names]
    merged = _merged(path, names, channels) if names else [channel("")] * rows.width
    sign = decimal_sign(rows)
    for row in found.rows:
        if row.kind == "units":
            merged = [_with_unit(path, row, c, cell) for c, cell in zip(merged, row.cells, strict=True)]
        elif row.kind in ("modes", "frequencies"):
            merged = [_with_number(path, row, c, cell, sign) for c, cell in zip(merged, row.cells, strict=True)]
        elif row.kind == "label":
            raise DataError(label_problem(path, row))
        elif row.kind == "numbers":
            raise DataError(numbers_problem(path, row, names))
    return Header(tuple(row.cells for row in names), tuple(merged), tuple(found.cells), tuple(found.free))


def _merged(path: Path, rows: Sequence[HeaderRow], channels: Sequence[Sequence[Channel]]) -> list[Channel]:
    """Channels of the row of names that names most modes; another row that names other modes is refused."""
    problems = []
    modes = [[c.mode for c in row if not c.is_time] for row in channels]
    complete = [k for k, m in enumerate(modes) if m and all(m) and len(set(m)) == len(m)]
    for k in complete[1:]:
        if channels[k] != channels[complete[0]] and modes[k] != modes[complete[0]]:
            a, b = rows[complete[0]], rows[k]
            problems.append(disagreement(path, a.line, some_of(a.cells), b.line, some_of(b.cells)))
    refuse(DataError, problems)
    timed = [k for k, row in enumerate(channels) if any(c.is_time for c in row)]
    best = next((k for k in complete if k in timed), (complete or timed or [len(rows) - 1])[0])
    result = list(channels[best])
    for k, row in enumerate(channels):
        if k != best:
            result = [_completed(path, rows[best], rows[k], a, b) for a, b in zip(result, row, strict=True)]
    return result


def _completed(path: Path, row: HeaderRow, other: HeaderRow, own: Channel, more: Channel) -> Channel:
    """Channel with what another row of names states about its column."""
    unit, frequency, resolution = own.unit, own.frequency, own.resolution
    if more.unit and own.is_time == more.is_time:
        if unit and unit.lower() != more.unit.lower():
            raise DataError(disagreement(path, row.line, own.name, other.line, more.name))
        unit = more.unit
    if np.isfinite(more.frequency):
        if np.isfinite(frequency) and abs(frequency - more.frequency) > resolution + more.resolution:
            raise DataError(disagreement(path, row.line, own.name, other.line, more.name))
        if not np.isfinite(frequency) or more.resolution < resolution:
            frequency, resolution = more.frequency, more.resolution
    return replace(
        own,
        unit=unit,
        frequency=frequency,
        resolution=resolution,
        mode=own.mode or (0 if own.is_time else more.mode),
        is_time=own.is_time or (more.is_time and not own.mode),
    )


def _with_unit(path: Path, row: HeaderRow, own: Channel, cell: str) -> Channel:
    """Channel with the unit of a row of units."""
    unit = cell.strip().strip("[](){}<>").strip()
    if states_no_unit(unit) or UNIT_LABEL.match(cell):
        return own
    if own.unit and not _same_unit(own.unit, unit):
        raise DataError(disagreement(path, None, f"{own.name} has {own.unit}", row.line, unit))
    return replace(own, unit=own.unit or unit)


def _same_unit(a: str, b: str) -> bool:
    if a.lower() in TIME_UNITS and b.lower() in TIME_UNITS:
        return TIME_UNITS[a.lower()] == TIME_UNITS[b.lower()]
    parsed = parse_unit(a)
    return a.lower() == b.lower() or (parsed is not None and parsed == parse_unit(b))


def _with_number(path: Path, row: HeaderRow, own: Channel, cell: str, decimal: Decimal) -> Channel:
    """Channel with the number of its mode or its frequency from a row with a label."""
    if not (is_number(cell, ".") or is_number(cell, decimal)) or own.is_time:
        return own
    value, half = written(plain_number(cell, "." if is_number(cell, ".") else decimal))
    if row.kind == "frequencies":
        if np.isfinite(own.frequency) and abs(own.frequency - value) > own.resolution + half:
            raise DataError(disagreement(path, None, own.name, row.line, f"{cell} Hz"))
        return replace(own, frequency=value, resolution=half)
    if value != round(value) or value < 1:
        what = f"{cell!r} is no number of a mode"
        raise DataError(Problem("header", f"{path}, line {row.line}", what, "Correct the row, or remove it"))
    if own.mode and own.mode != int(value):
        raise DataError(disagreement(path, None, own.name, row.line, f"mode {int(value)}"))
    return replace(own, mode=int(value))


def header_frequencies(free: Sequence[tuple[int, str]]) -> dict[int, tuple[int, float, float]]:
    """Frequencies listed by mode above the table, as ``Mode 3: 12.5 Hz``: line, frequency, half its last digit."""
    found: dict[int, tuple[int, float, float]] = {}
    for line, text in free:
        mode = re.search(r"\bmode[ _]*(?:no\.?|nr\.?|number|#)?[ _]*(\d{1,6})\b", text, re.IGNORECASE)
        frequency, half = stated_frequency(text)
        if mode and np.isfinite(frequency):
            found[int(mode[1])] = line, frequency, half
    return found
