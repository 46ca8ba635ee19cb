"""What the lines above the numbers of a history state: names, units, mode numbers, frequencies, counts.

Everything that is stated is used, or refused where two statements disagree.
"""

import re
from collections.abc import Collection, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from fatigue.errors import DataError, Problem, refuse
from fatigue.readers.foreign.histories.rows import Rows, is_rule
from fatigue.readers.text.layout import COMMENTS
from fatigue.readers.text.numbers import Decimal, is_number, plain_number, split_fields
from fatigue.readers.text.separator import SEPARATORS, declared_separator
from fatigue.readers.units.channel_names import (
    TIME_UNITS,
    Channel,
    channel,
    stated_frequency,
    time_unit_in,
    without_unit_one,
    written,
)
from fatigue.readers.units.coordinate_units import parse_unit, states_no_unit

_LISTED = re.compile(
    r"[^\w\"']*(?:channel|chan|column|col|signal|kanal|spalte|ch)?\.?\s*(\d{1,4})\s*[:=.)\]\t;, -]+\s*"
    r"([\"'$.]*[^\W\d].*?)\s*\Z",
    re.IGNORECASE,
)
_BRACKETED = re.compile(r"\[[^\]]*\]|\([^)]*\)|<[^>]*>|\{[^}]*\}")
_LIKE_A_NUMBER = re.compile("[-+.,\u2212]?\\d")
_FREE_LABEL = re.compile(
    r"\W*(samples|channels|points|[xy]0|delta_?[xt]|[xy]_dimension|x_columns|date|time_pref|separator|operator)\W*\Z",
    re.IGNORECASE,
)
_TYPES = ("double", "float", "single", "real", "real*8", "float64", "float32", "numeric", "number")
_OTHER_UNITS = ("rad", "deg", "n", "kn", "nm", "hz", "v", "mv", "pa", "mpa", "%", "m/s", "m/s^2", "mm/s", "volts")
_UNIT_LABEL = re.compile(r"\W*(units?|einheit(en)?|y_unit_label|unit_label|x_unit_label|dimension)\W*\Z", re.IGNORECASE)
_COUNT_LABEL = re.compile(r"\W*(channel|chan|ch|column|col|signal|kanal|spalte)s?\W*\Z", re.IGNORECASE)
_MODE_LABEL = re.compile(r"\W*(modes?|moden?|no|nr|number|id|ids|mode[ _]?(no|nr|number|id)s?)\W*\Z", re.IGNORECASE)
_HZ_LABEL = re.compile(r"(freq|eigenfreq|f\b|.*\bhz\b)", re.IGNORECASE)


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


@dataclass(slots=True)
class _Row:
    """A line of the header with a cell for every column."""

    line: int
    cells: tuple[str, ...]
    kind: str


@dataclass(slots=True)
class _Found:
    rows: list[_Row] = field(default_factory=list)
    free: list[tuple[int, str]] = field(default_factory=list)
    cells: list[tuple[str, ...]] = field(default_factory=list)


def read_header(path: Path, lines: Sequence[str], rows: Rows) -> Header:
    """Read the lines above the numbers.

    Raises
    ------
    DataError : rows that disagree, names for another number of columns, a row of numbers nobody labelled
    """
    for k, line in enumerate(lines[: rows.first]):
        declared = declared_separator(line)
        if declared is not None and declared != (rows.separator or " "):
            what = f"the file declares sep={declared}, and its columns are separated by {rows.separator or 'blanks'!r}"
            raise DataError(Problem("csv_separator", f"{path}, line {k + 1}", what, "Correct one of them"))
    listed, lines_of_list = _listed(path, lines[: rows.first], rows.width)
    found = _rows_of(lines[: rows.first], rows, lines_of_list)
    names = [row for row in found.rows if row.kind == "names"]
    if not names and listed is None:
        _refuse_short_names(path, lines, rows, found.rows)
    if names:
        _refuse_broken_rows(path, lines, rows, names[0].line)
    if listed is not None:
        names.append(listed)
    channels = [[channel(name) for name in without_unit_one(row.cells)] for row in names]
    merged = _merged(path, names, channels) if names else [channel("")] * rows.width
    sign = _sign(rows)
    for row in found.rows:
        if row.kind == "units":
            merged = [_with_unit(path, row, c, cell) for c, cell in zip(merged, row.cells, strict=True)]
        elif row.kind in ("modes", "frequencies"):
            merged = [_with_number(path, row, c, cell, sign) for c, cell in zip(merged, row.cells, strict=True)]
        elif row.kind == "label":
            raise DataError(_label_problem(path, row))
        elif row.kind == "numbers":
            raise DataError(_numbers_problem(path, row, names))
    return Header(tuple(row.cells for row in names), tuple(merged), tuple(found.cells), tuple(found.free))


def _sign(rows: Rows) -> Decimal:
    """Tell the decimal sign that numbers of the header may have besides a point: the rows may be whole numbers."""
    return "." if rows.separator == "," else ","


def _rows_of(head: Sequence[str], rows: Rows, listed: Collection[int]) -> _Found:
    """Sort the lines above the numbers into rows of cells, one for every column, and free text."""
    found = _Found()
    for k, line in enumerate(head):
        if is_rule(line) or k + 1 in listed:
            continue
        found.cells.append(tuple(split_fields(line, rows.separator)))
        cells = _cells_of(line, rows)
        if cells is None and found.rows and _is_lone_time_unit(line):
            cells = (line.strip(), *[""] * (rows.width - 1))
        if cells is None:
            found.free.append((k + 1, line))
            continue
        kind = _kind(cells, _sign(rows))
        if kind == "numbers" and line.lstrip().startswith(COMMENTS) and _counts_columns(cells):
            continue
        if kind == "free":
            found.free.append((k + 1, line))
        elif kind != "types":
            found.rows.append(_Row(k + 1, cells, kind))
    return found


def _cells_of(line: str, rows: Rows) -> tuple[str, ...] | None:
    """Cells of a line, if it has one for every column whatever divides it."""
    text = re.sub(r"\A\s*(?:[#%!]+|//)\s?", "", line)
    for separator in dict.fromkeys((rows.separator, "\t", ";", ",")):
        cells = split_fields(text, separator)
        if len(cells) == rows.width:
            return tuple(cells)
        if separator is not None and len(cells) == rows.width + 1 and cells[-1].lower() == "comment":
            return tuple(cells[:-1])  # LabVIEW's last column, which is empty in the rows
        if separator == rows.separator and _cell_count(text, separator) == rows.width > len(cells) > 0:
            return tuple(cells + [""] * (rows.width - len(cells)))  # the last columns have no name
    if rows.separator is None:  # units that stand apart from their names
        bracketed = _BRACKETED.findall(text)
        if len(bracketed) == rows.width and not _BRACKETED.sub("", text).strip():
            return tuple(bracketed)
        cells = split_fields(re.sub(r"\s+([\[(][^\])]*[\])])", r"\1", text), None)
        if len(cells) == rows.width:
            return tuple(cells)
    apart = [cell.strip("'\" ") for cell in re.split(r"\s{2,}|\t", text.strip())]
    return tuple(apart) if len(apart) == rows.width and rows.width > 1 else None


def _cell_count(text: str, separator: str | None) -> int:
    return 0 if separator is None else re.sub(r'"[^"]*"', "", text).count(separator) + 1


def _kind(cells: tuple[str, ...], decimal: Decimal) -> str:
    """Tell names, units, types of data, and rows of numbers with and without a label."""
    label, rest = cells[0], [cell for cell in cells[1:] if cell]
    filled = [cell for cell in cells if cell]
    numbers = [is_number(cell, ".") or is_number(cell, decimal) for cell in rest]
    if label.strip("[](){}<> ").lower() in TIME_UNITS and rest and all(cell == "1" for cell in rest):
        return "units"
    if rest and all(numbers) and not _FREE_LABEL.match(label):
        if _COUNT_LABEL.match(label) and [float(cell) for cell in rest if cell.isdecimal()] in _counts(len(rest)):
            return "types"  # it only counts the columns
        return "numbers" if is_number(label, ".") or is_number(label, decimal) else _kind_of_label(label)
    if not rest and re.search(r"[\s:=]", label) and time_unit_in(label) is None and not _is_unit(label):
        return "free"  # a sentence, in a table whose every line ends in separators
    if re.fullmatch(r"date|datum", label, re.IGNORECASE) and rest and all(channel(c).mode for c in rest):
        return "names" if not any(c[0].isdigit() for c in rest) else "free"
    of_units = all(_is_unit(cell) for cell in filled) and (
        len(filled) > 1 or re.search(r"[\[(]", filled[0]) or (filled[0].lower() in TIME_UNITS and len(cells) > 1)
    )
    tests = {
        "free": _FREE_LABEL.match(label),
        "types": all(cell.lower() in _TYPES for cell in filled),
        "units": of_units or (_UNIT_LABEL.match(label) and rest and all(_is_unit(cell) for cell in rest)),
    }
    return next((kind for kind, found in tests.items() if found), "names")


def _counts(columns: int) -> list[list[float]]:
    """Give the numbers of so many columns after the first, counted from 0, 1 or 2."""
    return [[float(k + first) for k in range(columns)] for first in (0, 1, 2)]


def _counts_columns(cells: Sequence[str]) -> bool:
    """Whether a row only counts the columns, from 0 or 1."""
    return list(cells) in ([str(k + first) for k in range(len(cells))] for first in (0, 1))


def _kind_of_label(label: str) -> str:
    """Tell what numbers are by the word in front of them."""
    if not label or time_unit_in(label) is not None:
        return "names"
    return "frequencies" if _HZ_LABEL.match(label) else "modes" if _MODE_LABEL.match(label) else "label"


def _is_unit(cell: str) -> bool:
    bare = cell.strip().strip("[](){}<>").strip()
    known = bare.lower() in TIME_UNITS or bare.lower() in _OTHER_UNITS or parse_unit(bare) is not None
    return known or states_no_unit(bare) or re.fullmatch(r"\s*[\[(<].*[\])>]\s*", cell) is not None


def _is_lone_time_unit(line: str) -> bool:
    """Whether a line below the names holds nothing but a unit of time, which is that of the first column."""
    bare = line.strip().strip("\"'")
    inside = _BRACKETED.fullmatch(bare)
    return (bare[1:-1] if inside else bare).strip().lower() in TIME_UNITS


def _listed(path: Path, head: Sequence[str], width: int) -> tuple[_Row | None, Collection[int]]:
    """Read names from a list of channels, one a line and numbered; it has to have as many as there are columns.

    Returns
    -------
    the names as a row, None if there is no list, and the lines it takes
    """
    found = [(k + 1, int(m[1]), m[2]) for k, line in enumerate(head) if (m := _LISTED.match(line))]
    for first, (line, number, _) in enumerate(found):
        run = [f for k, f in enumerate(found[first:]) if f[:2] == (line + k, number + k)]
        if len(run) < 2 or number not in (0, 1):
            continue
        names = [name.strip("\"' ") for _, _, name in run]
        timed = any(time_unit_in(name) is not None for name in names)
        if len(names) == width - 1 and not timed:
            names = ["time", *names]
        if len(names) != width:
            what = f"{len(names)} channels are listed above rows of {width} numbers"
            raise DataError(Problem("column_count", f"{path}, line {line}", what, "Export again, or remove the list"))
        return _Row(line, tuple(names), "names"), range(line, line + len(run))
    return None, ()


def _refuse_broken_rows(path: Path, lines: Sequence[str], rows: Rows, names: int) -> None:
    """Refuse a row of values below the names that a word or a lost line end makes look like a line of the header."""
    for at in range(names, rows.first):
        line = lines[at]
        cells = split_fields(line, rows.separator)
        numbers = [is_number(cell, ".") or is_number(cell, _sign(rows)) for cell in cells]
        if (
            len(cells) > 1
            and _LIKE_A_NUMBER.match(cells[0])
            and 2 * sum(numbers) >= len(cells)
            and not line.lstrip().startswith(COMMENTS)
        ):
            wrong = next((cell for cell, number in zip(cells, numbers, strict=True) if not number), "")
            what = (
                f"{wrong!r} stands in a row of values" if len(cells) == rows.width else f"a row of {len(cells)} cells"
            )
            what += f" in a table of {rows.width} columns" if len(cells) != rows.width else ""
            if not wrong and len(cells) == rows.width:
                what = f"a row of numbers ({_some(cells)}) stands among the lines of the header"
            raise DataError(Problem("bad_row", f"{path}, line {at + 1}", what, "Correct the row, or remove it"))


def _refuse_short_names(path: Path, lines: Sequence[str], rows: Rows, above: Sequence[_Row]) -> None:
    """Refuse names right above the numbers that are fewer or more than the columns."""
    units = {row.line for row in above}
    near = [k for k in range(rows.first) if not is_rule(lines[k]) and k + 1 not in units]
    if not near:
        return
    text = re.sub(r"\A\s*(?:[#%!]+|//)\s?", "", lines[near[-1]])
    for separator in dict.fromkeys((rows.separator, *SEPARATORS)):
        cells = split_fields(text, separator)
        told = sum(channel(c).mode > 0 for c in cells) + sum(time_unit_in(c) is not None for c in cells)
        if len(cells) < 2 or (time_unit_in(cells[0]) is None and told < 0.6 * len(cells)) or told < 2:
            continue
        what = f"{len(cells)} names stand above rows of {rows.width} numbers"
        if len(cells) == rows.cells > rows.width:
            what += f"; {cells[rows.width]!r} and what follows it hold nothing" if len(cells) > rows.width + 1 else ""
            what += f"; {cells[-1]!r} holds nothing" if len(cells) == rows.width + 1 else ""
        remedy = "Export a name for every column, and a column for every name"
        points = any("." in line for line in lines[rows.first : rows.first + 50])
        if rows.separator == "," and not points and len(cells) < rows.width <= 2 * len(cells):
            what += "; commas seem to stand both between the columns and in the numbers"
            remedy = "Write semicolons between the columns, or points in the numbers"
        raise DataError(Problem("column_count", f"{path}, line {near[-1] + 1}", what, remedy))


def _merged(path: Path, rows: Sequence[_Row], channels: Sequence[Sequence[Channel]]) -> list[Channel]:
    """Take the row of names that names most modes; another that names other modes is refused."""
    problems = []
    modes = [[c.mode for c in row if not c.is_time] for row in channels]
    complete = [k for k, m in enumerate(modes) if m and all(m) and len(set(m)) == len(m)]
    for k in complete[1:]:
        if channels[k] != channels[complete[0]] and modes[k] != modes[complete[0]]:
            a, b = rows[complete[0]], rows[k]
            problems.append(_disagreement(path, a.line, _some(a.cells), b.line, _some(b.cells)))
    refuse(DataError, problems)
    timed = [k for k, row in enumerate(channels) if any(c.is_time for c in row)]
    best = next((k for k in complete if k in timed), (complete or timed or [len(rows) - 1])[0])
    result = list(channels[best])
    for k, row in enumerate(channels):
        if k != best:
            result = [_completed(path, rows[best], rows[k], a, b) for a, b in zip(result, row, strict=True)]
    return result


def _completed(path: Path, row: _Row, other: _Row, own: Channel, more: Channel) -> Channel:
    """Add what another row of names states about a column."""
    unit, frequency, resolution = own.unit, own.frequency, own.resolution
    if more.unit and own.is_time == more.is_time:
        if unit and unit.lower() != more.unit.lower():
            raise DataError(_disagreement(path, row.line, own.name, other.line, more.name))
        unit = more.unit
    if np.isfinite(more.frequency):
        if np.isfinite(frequency) and abs(frequency - more.frequency) > resolution + more.resolution:
            raise DataError(_disagreement(path, row.line, own.name, other.line, more.name))
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


def _with_unit(path: Path, row: _Row, own: Channel, cell: str) -> Channel:
    """Add the unit of a row of units."""
    unit = cell.strip().strip("[](){}<>").strip()
    if states_no_unit(unit) or _UNIT_LABEL.match(cell):
        return own
    if own.unit and not _same_unit(own.unit, unit):
        raise DataError(_disagreement(path, None, f"{own.name} has {own.unit}", row.line, unit))
    return replace(own, unit=own.unit or unit)


def _same_unit(a: str, b: str) -> bool:
    if a.lower() in TIME_UNITS and b.lower() in TIME_UNITS:
        return TIME_UNITS[a.lower()] == TIME_UNITS[b.lower()]
    parsed = parse_unit(a)
    return a.lower() == b.lower() or (parsed is not None and parsed == parse_unit(b))


def _with_number(path: Path, row: _Row, own: Channel, cell: str, decimal: Decimal) -> Channel:
    """Add the number of a mode or its frequency from a row with a label."""
    if not (is_number(cell, ".") or is_number(cell, decimal)) or own.is_time:
        return own
    value, half = written(plain_number(cell, "." if is_number(cell, ".") else decimal))
    if row.kind == "frequencies":
        if np.isfinite(own.frequency) and abs(own.frequency - value) > own.resolution + half:
            raise DataError(_disagreement(path, None, own.name, row.line, f"{cell} Hz"))
        return replace(own, frequency=value, resolution=half)
    if value != round(value) or value < 1:
        what = f"{cell!r} is no number of a mode"
        raise DataError(Problem("header", f"{path}, line {row.line}", what, "Correct the row, or remove it"))
    if own.mode and own.mode != int(value):
        raise DataError(_disagreement(path, None, own.name, row.line, f"mode {int(value)}"))
    return replace(own, mode=int(value))


def _numbers_problem(path: Path, row: _Row, names: Sequence[_Row]) -> Problem:
    """Refusal of a row of numbers without a label among the rows of the header."""
    what = f"a row of numbers ({_some(row.cells)}) stands above the rows of values"
    below = [name for name in names if name.line > row.line]
    if below:
        what = f"a row of numbers ({_some(row.cells)}) stands above the names in line {below[0].line}"
    remedy = "Remove it, or say in its first cell what it holds: Mode, or Frequency [Hz]"
    return Problem("header", f"{path}, line {row.line}", what, remedy)


def _label_problem(path: Path, row: _Row) -> Problem:
    """Refusal of a row of numbers whose label says neither mode nor frequency, as one of factors."""
    what = f"a row of numbers named {row.cells[0]!r} stands above the rows of values, and is not understood"
    remedy = "Apply what it says to the values and remove it, or name it Mode or Frequency [Hz]"
    return Problem("header", f"{path}, line {row.line}", what, remedy)


def _disagreement(path: Path, line: int | None, one: str, other_line: int, other: str) -> Problem:
    where = f"{path}, line {other_line}" if line is None else f"{path}, lines {line} and {other_line}"
    what = f"two statements of the header disagree: {one}, and {other}"
    return Problem("header", where, what, "Correct one of them, or remove it")


def _some(cells: Sequence[str]) -> str:
    shown = ", ".join(cells[:6])
    return f"{shown} ..." if len(cells) > 6 else shown


def header_frequencies(free: Sequence[tuple[int, str]]) -> dict[int, tuple[int, float, float]]:
    """Find frequencies listed by mode above the table, as ``Mode 3: 12.5 Hz``: line, frequency, half its last digit."""
    found: dict[int, tuple[int, float, float]] = {}
    for line, text in free:
        mode = re.search(r"\bmode[ _]*(?:no\.?|nr\.?|number|#)?[ _]*(\d{1,6})\b", text, re.IGNORECASE)
        frequency, half = stated_frequency(text)
        if mode and np.isfinite(frequency):
            found[int(mode[1])] = line, frequency, half
    return found
