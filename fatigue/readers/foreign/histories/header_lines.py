"""The lines above the numbers of a history, sorted: rows of names, units and numbers, lists of channels, free text."""

import re
from collections.abc import Collection, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from fatigue.errors import DataError, Problem
from fatigue.readers.foreign.histories.number_rows import NumberRows, is_rule
from fatigue.readers.text.layout import COMMENTS
from fatigue.readers.text.numbers import Decimal, is_number, split_fields
from fatigue.readers.units.channel_names import (
    TIME_UNITS,
    channel,
    time_unit_in,
)
from fatigue.readers.units.coordinate_units import parse_unit, states_no_unit

_LISTED = re.compile(
    r"[^\w\"']*(?:channel|chan|column|col|signal|kanal|spalte|ch)?\.?\s*(\d{1,4})\s*[:=.)\]\t;, -]+\s*"
    r"([\"'$.]*[^\W\d].*?)\s*\Z",
    re.IGNORECASE,
)
_LETTERED = re.compile(r"\s*([A-Z]{1,2})(?:\s*[:=.)\t]|\s{2,})\s*([\"'$.]*[^\W\d].*?)\s*\Z")
_BRACKETED = re.compile(r"\[[^\]]*\]|\([^)]*\)|<[^>]*>|\{[^}]*\}")
_FREE_LABEL = re.compile(
    r"\W*(samples|channels|points|[xy]0|delta_?[xt]|[xy]_dimension|x_columns|date|time_pref|separator|operator)\W*\Z",
    re.IGNORECASE,
)
_TYPES = ("double", "float", "single", "real", "real*8", "float64", "float32", "numeric", "number")
_OTHER_UNITS = ("rad", "deg", "n", "kn", "nm", "hz", "v", "mv", "pa", "mpa", "%", "m/s", "m/s^2", "mm/s", "volts")
UNIT_LABEL = re.compile(r"\W*(units?|einheit(en)?|y_unit_label|unit_label|x_unit_label|dimension)\W*\Z", re.IGNORECASE)
_QUANTITY = re.compile(r"[/^²³*]|\A[\d.]|\A(?:[munkcd]?m|ft|in)[23]\Z")  # its number is an exponent, not that of a mode
_COUNT_LABEL = re.compile(r"\W*(channel|chan|ch|column|col|signal|kanal|spalte)s?\W*\Z", re.IGNORECASE)
_MODE_LABEL = re.compile(r"\W*(modes?|moden?|no|nr|number|id|ids|mode[ _]?(no|nr|number|id)s?)\W*\Z", re.IGNORECASE)
_HZ_LABEL = re.compile(r"(freq|eigenfreq|f\b|.*\bhz\b)", re.IGNORECASE)


@dataclass(slots=True)
class HeaderRow:
    """A line of the header with a cell for every column."""

    line: int
    cells: tuple[str, ...]
    kind: str


@dataclass(slots=True)
class HeaderLines:
    """The lines above the numbers, sorted.

    Attributes
    ----------
    rows : lines with a cell for every column
    free : the other lines, by their number
    cells : cells of all lines but rules and lists
    """

    rows: list[HeaderRow] = field(default_factory=list)
    free: list[tuple[int, str]] = field(default_factory=list)
    cells: list[tuple[str, ...]] = field(default_factory=list)


def header_lines(head: Sequence[str], rows: NumberRows, listed: Collection[int]) -> HeaderLines:
    """Lines above the numbers, sorted into rows of cells, one for every column, and free text."""
    found = HeaderLines()
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
        kind = _kind(cells, decimal_sign(rows))
        if kind == "numbers" and line.lstrip().startswith(COMMENTS) and _counts_columns(cells):
            continue
        if kind == "names" and any(_states_units(row, cells) for row in found.rows if row.kind == "names"):
            kind = "units"
        if kind == "free":
            found.free.append((k + 1, line))
        elif kind != "types":
            found.rows.append(HeaderRow(k + 1, cells, kind))
    return found


def _states_units(names: HeaderRow, cells: Sequence[str]) -> bool:
    """Whether a row below names is one of units, of whatever quantities: below the name of the time is one of time."""
    timed = [below for name, below in zip(names.cells, cells, strict=True) if channel(name).is_time]
    newly_named = (below for name, below in zip(names.cells, cells, strict=True) if not channel(name).mode)
    is_below = any(below.strip("[](){}<> ").lower() in TIME_UNITS for below in timed)
    return is_below and not any(channel(below).mode and not _QUANTITY.search(below) for below in newly_named)


def decimal_sign(rows: NumberRows) -> Decimal:
    """Decimal sign that numbers of the header may have besides a point: the rows may be whole numbers."""
    return "." if rows.separator == "," else ","


def _cells_of(line: str, rows: NumberRows) -> tuple[str, ...] | None:
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
    """Kind of a row: names, units, types of data, or numbers with and without a label."""
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
        "units": of_units or (UNIT_LABEL.match(label) and rest and all(_is_unit(cell) for cell in rest)),
    }
    return next((kind for kind, found in tests.items() if found), "names")


def _counts(columns: int) -> list[list[float]]:
    """Numbers of so many columns after the first, counted from 0, 1 or 2."""
    return [[float(k + first) for k in range(columns)] for first in (0, 1, 2)]


def _counts_columns(cells: Sequence[str]) -> bool:
    """Whether a row only counts the columns, from 0 or 1."""
    return list(cells) in ([str(k + first) for k in range(len(cells))] for first in (0, 1))


def _kind_of_label(label: str) -> str:
    """Kind of numbers by the word in front of them."""
    if not label or time_unit_in(label) is not None:
        return "names"
    return "frequencies" if _HZ_LABEL.match(label) else "modes" if _MODE_LABEL.match(label) else "label"


def _is_unit(cell: str) -> bool:
    bare = cell.strip().strip("[](){}<>").strip()
    known = bare.lower() in TIME_UNITS or bare.lower() in _OTHER_UNITS or parse_unit(bare) is not None
    return known or states_no_unit(bare) or re.fullmatch(r"\s*[\[(<].*[\])>]\s*", cell) is not None


def _is_lone_time_unit(line: str) -> bool:
    """Whether a line below the names holds nothing but a unit of time, the unit of the first column."""
    bare = line.strip().strip("\"'")
    inside = _BRACKETED.fullmatch(bare)
    return (bare[1:-1] if inside else bare).strip().lower() in TIME_UNITS


def listed_names(path: Path, head: Sequence[str], width: int) -> tuple[HeaderRow | None, Collection[int]]:
    """Names in a list of channels, one a line, numbered or lettered; it has to have as many as there are columns.

    Returns
    -------
    the names as a row, None if there is no list, and the lines it takes
    """
    if lettered := _lettered_names(head, width):
        return lettered
    found = [(k + 1, int(m[1]), m[2]) for k, line in enumerate(head) if (m := _LISTED.match(line))]
    for first, (line, number, _) in enumerate(found):
        listed = [f for k, f in enumerate(found[first:]) if f[:2] == (line + k, number + k)]
        if len(listed) < 2 or number not in (0, 1):
            continue
        names = [name.strip("\"' ") for _, _, name in listed]
        timed = any(time_unit_in(name) is not None for name in names)
        if len(names) == width - 1 and not timed:
            names = ["time", *names]
        if len(names) != width:
            what = f"{len(names)} channels are listed above rows of {width} numbers"
            raise DataError(Problem("column_count", f"{path}, line {line}", what, "Export again, or remove the list"))
        return HeaderRow(line, tuple(names), "names"), range(line, line + len(listed))
    return None, ()


def _lettered_names(head: Sequence[str], width: int) -> tuple[HeaderRow, Collection[int]] | None:
    """Names in a legend of letters, one a line: ``A: Time (sec)``; a row of these letters alone belongs to it."""
    letters = [_letters(k) for k in range(width)]
    for first in range(len(head) - width + 1):
        found = [_LETTERED.match(line) for line in head[first : first + width]]
        if width < 2 or not all(found) or [m[1] for m in found if m] != letters:
            continue
        names = tuple(m[2].strip("\"' ") for m in found if m)
        alone = [k + 1 for k, line in enumerate(head) if re.split(r"[\s,;]+", line.strip(" \t\"',;")) == letters]
        return HeaderRow(first + 1, names, "names"), [*range(first + 1, first + width + 1), *alone]
    return None


def _letters(k: int) -> str:
    """Letters of a column as spreadsheets count them: A to Z, AA to ZZ."""
    return chr(65 + k) if k < 26 else _letters(k // 26 - 1) + chr(65 + k % 26)
