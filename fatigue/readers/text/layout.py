"""How a text table with one row of names is laid out: encoding, separator, decimal sign, names, first row of values.

Only the head of the file is looked at. Lines above the names that say nothing (``sep=;``, comments, blank lines) are
passed over; a row of units below the names is kept, to be compared with them.
"""

import re
from collections import Counter
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from fatigue.errors import DataError, Problem
from fatigue.readers.text.encoding import HEAD_BYTES, Encoding, encoding_of, marked_encoding, nul_problem
from fatigue.readers.text.lines import text_lines, whole_cells
from fatigue.readers.text.numbers import Decimal, is_number, split_fields
from fatigue.readers.text.separator import SEPARATORS, cell_count, declared_separator, separator_of

COMMENTS = ("#", "%", "!", "//")
SAMPLE_LINES = 200
_KEYS = ("weld", "mode", "node", "element", "column", "time_s")  # of the tables of the neutral format
HEADER_LINES = 100  # within which names are broken over several lines

_ROOT_OF_MASS = r"(?:sqrt\((?:k?g|t)\)|(?:k?g|t)(?:\^|\*\*)0\.5)"  # of coordinates of modes of unit mass
_UNIT = re.compile(
    r"(?:[\[(<].*[\])>]|-|s|sec|sek|ms|msec|us|µs|min|h|k?Hz|rad/s|mm|cm|m|in|inch|ft"
    r"|k?N(?:[.* ]?m?m)?|lbf?|[hkMG]?Pa|m?bar|psi|k?g|t|m/s(?:\^?2|²)?|km(?:/h)?|deg|rad|°C?|K|%"
    r"|ue|[µμ][eε]|[uµμ]m/m|m?V(?:/V)?"
    rf"|m?m[*· ]?{_ROOT_OF_MASS}|{_ROOT_OF_MASS}[*· ]?m?m)\Z",
    re.IGNORECASE,
)
_THOUSANDS = re.compile(r"[+-]?\d{1,3}(?:,\d{3})+")


@dataclass(frozen=True, slots=True)
class TableLayout:
    """Layout of a table with names.

    Attributes
    ----------
    encoding : of the file
    separator : between cells; None: any number of blanks
    decimal : sign in numbers; None: the head holds whole numbers only
    names : of the columns, trimmed at the end of the line only
    units : row of units below the names; empty if there is none
    first : number of lines above the first row of values
    line : line of the names, from 1
    fortran : whether exponents of Fortran, or minus signs of typography, were seen in the head
    padded : whether blanks stand between a separator and a quotation mark
    """

    encoding: Encoding
    separator: str | None
    decimal: Decimal | None
    names: tuple[str, ...]
    units: tuple[str, ...]
    first: int
    line: int
    fortran: bool
    padded: bool = False


def table_layout(path: Path, texts: Collection[str]) -> TableLayout:
    """Layout of a file; ``texts`` are columns of names, whose cells say nothing of decimal signs.

    Raises
    ------
    OSError : the file cannot be read
    DataError : no names, bytes that no encoding explains, a separator that contradicts the one declared
    """
    with path.open("rb") as file:
        head = file.read(HEAD_BYTES)
    encoding = marked_encoding(head)
    whole = len(head) < HEAD_BYTES
    if encoding != "utf-8" or not _decodes(head, whole=whole):
        data = path.read_bytes()
        encoding = encoding_of(path, data)
        head = data[: HEAD_BYTES - HEAD_BYTES % 4]
    text = head.decode(encoding, errors="replace").removeprefix("\ufeff")
    if "\0" in text:
        raise DataError(nul_problem(path, text[: text.index("\0")].count("\n") + 1))
    return layout_of(path, text_lines(text, whole=whole), encoding, lambda name: name not in texts)


def layout_of(path: Path, lines: Sequence[str], encoding: Encoding, is_numeric: Callable[[str], bool]) -> TableLayout:
    """Layout of the lines of a file, or of its first ones, as ``table_layout``.

    ``is_numeric`` tells which columns, by name, hold numbers and so the decimal sign.
    """
    at, declared, comment = 0, None, None
    if not lines[0].strip():
        raise DataError(_no_names(path))
    lines = whole_cells(lines[:HEADER_LINES]) + list(lines[HEADER_LINES:])
    for at, line in enumerate(lines):
        if found := declared_separator(line):
            declared = found
        elif line.lstrip().startswith(COMMENTS):
            comment = at
        elif line.strip():
            break
    else:
        raise DataError(_no_names(path))
    rows = [line for line in lines[at + 1 : at + 1 + SAMPLE_LINES] if line.strip()]
    header = at
    if comment is not None and (named := _commented(lines[comment], lines[at], declared)):
        rows, header, names_line, first = [lines[at], *rows], comment, named, at
    else:
        names_line, first = lines[at], at + 1
    separator = separator_of(path, header, names_line, rows, declared)
    names = _as_wide_as(_names(names_line, separator), rows, separator)
    units: tuple[str, ...] = ()
    if rows and (found_units := _unit_row(rows[0], separator, len(names))):
        units, rows = found_units, rows[1:]
        first = next(k for k in range(first, len(lines)) if lines[k].strip()) + 1
    padded = separator is not None and any(re.search(rf'{re.escape(separator)}[ \t]+"', row) for row in rows)
    layout = TableLayout(encoding, separator, None, names, units, first, header + 1, fortran=False, padded=padded)
    return _with_numbers(path, layout, rows, is_numeric)


def _no_names(path: Path) -> Problem:
    return Problem("empty_table", path.name, "the first line is empty", "Write the column names there")


def _decodes(head: bytes, *, whole: bool) -> bool:
    """Whether the head of a file is UTF-8; a letter may be cut at its end."""
    try:
        head.decode("utf-8")
    except UnicodeDecodeError as error:
        return not whole and error.start >= len(head) - 3
    return True


def _commented(comment: str, row: str, declared: str | None) -> str | None:
    """Names that stand in a comment right above the numbers, as numpy writes them."""
    text = comment.strip().lstrip("#%!/").strip()
    for separator in (declared,) if declared else (*SEPARATORS, None):
        values, names = split_fields(row, separator), split_fields(text, separator)
        numbers = [is_number(v, ".") or is_number(v, ",") for v in values]
        known = any(name in _KEYS for name in names) and not any(value in _KEYS for value in values)
        numbered = any(numbers) and not any(is_number(n, ".") for n in names)
        if len(values) > 1 and len(values) == len(names) and (known or numbered):
            return text
    return None


def _names(line: str, separator: str | None) -> list[str]:
    fields = split_fields(line, separator)
    if separator is None or len(fields) == line.count(separator) + 1:
        return fields
    return fields + [""] * max(0, cell_count(line, separator) - len(fields))


def _as_wide_as(names: Sequence[str], rows: Sequence[str], separator: str | None) -> tuple[str, ...]:
    """Names with as many empty ones at their end as the rows have empty cells."""
    if separator is None or not rows:
        return tuple(names)
    filled = max((k + 1 for k, name in enumerate(names) if name.strip()), default=0)
    width = {cell_count(row, separator) for row in rows}
    wanted = width.pop() if len(width) == 1 else len(names)
    if wanted > len(names) and any(len(split_fields(row, separator)) > len(names) for row in rows):
        return tuple(names)  # cells without a name hold something, which is told
    return (*names[: max(filled, wanted)], *[""] * (wanted - len(names)))


def _unit_row(row: str, separator: str | None, width: int) -> tuple[str, ...]:
    """Cells of a row below the names that holds units only; empty if it holds anything else."""
    cells = split_fields(row, separator)
    if not any(cells) or len(cells) > width or not all(_UNIT.match(c) for c in cells if c):
        return ()
    if len(cells) == width > 1 and all(c == "-" for c in cells):
        return tuple(cells)
    if not any(len(c) > 1 or c in ("s", "m", "N") for c in cells):
        return ()
    return (*cells, *[""] * (width - len(cells)))


def _with_numbers(
    path: Path, layout: TableLayout, rows: Sequence[str], is_numeric: Callable[[str], bool]
) -> TableLayout:
    """Layout with the decimal sign of the numeric columns, and whether they have exponents of Fortran."""
    numeric = [k for k, name in enumerate(layout.names) if is_numeric(name.strip())]
    signs: Counter[str] = Counter()
    first: dict[str, str] = {}
    commas: set[str] = set()
    fortran = False
    for row in rows:
        cells = split_fields(row, layout.separator)
        for k in numeric:
            cell = cells[k] if k < len(cells) else ""
            for sign in ".,":
                if sign in cell and is_number(cell, sign):  # type: ignore[arg-type]
                    signs[sign] += 1
                    commas |= {cell} if sign == "," else set()
                    first.setdefault(sign, cell)
                    fortran |= re.search("[DQdq\u2212]|\\d[+-]", cell) is not None
    if layout.separator == "," and signs[","] and all(map(_THOUSANDS.fullmatch, commas)):
        what = f"{first[',']} may have a decimal comma or a thousands separator"
        raise DataError(Problem("decimal_sign", path.name, what, "Write points, and no thousands separators"))
    if len(signs) == 2:
        what = f"numbers are written with points ({first['.']}) and with commas ({first[',']})"
        raise DataError(Problem("decimal_sign", path.name, what, "Write one decimal sign, and no thousands separators"))
    known = signs["."] or layout.separator == ","
    decimal: Decimal | None = "," if signs[","] else "." if known else None
    return replace(layout, decimal=decimal, fortran=fortran)
