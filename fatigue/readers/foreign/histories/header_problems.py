"""What is wrong with the lines above the numbers of a history: broken rows, names that are too few, contradictions."""

import re
from collections.abc import Sequence
from pathlib import Path

from fatigue.errors import DataError, Problem
from fatigue.readers.foreign.histories.header_lines import HeaderRow, decimal_sign
from fatigue.readers.foreign.histories.number_rows import NumberRows, is_rule
from fatigue.readers.text.layout import COMMENTS
from fatigue.readers.text.numbers import is_number, split_fields
from fatigue.readers.text.separator import SEPARATORS
from fatigue.readers.units.channel_names import (
    channel,
    time_unit_in,
)

_LIKE_A_NUMBER = re.compile("[-+.,\u2212]?\\d")


def refuse_broken_rows(path: Path, lines: Sequence[str], rows: NumberRows, names: int) -> None:
    """Refuse a row of values below the names that a word or a lost line end makes look like a line of the header."""
    for at in range(names, rows.first):
        line = lines[at]
        cells = split_fields(line, rows.separator)
        numbers = [is_number(cell, ".") or is_number(cell, decimal_sign(rows)) for cell in cells]
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
                what = f"a row of numbers ({some_of(cells)}) stands among the lines of the header"
            raise DataError(Problem("bad_row", f"{path}, line {at + 1}", what, "Correct the row, or remove it"))


def refuse_short_names(path: Path, lines: Sequence[str], rows: NumberRows, above: Sequence[HeaderRow]) -> None:
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


def numbers_problem(path: Path, row: HeaderRow, names: Sequence[HeaderRow]) -> Problem:
    """Refusal of a row of numbers without a label among the rows of the header."""
    what = f"a row of numbers ({some_of(row.cells)}) stands above the rows of values"
    below = [name for name in names if name.line > row.line]
    if below:
        what = f"a row of numbers ({some_of(row.cells)}) stands above the names in line {below[0].line}"
    remedy = "Remove it, or say in its first cell what it holds: Mode, or Frequency [Hz]"
    return Problem("header", f"{path}, line {row.line}", what, remedy)


def label_problem(path: Path, row: HeaderRow) -> Problem:
    """Refusal of a row of numbers whose label says neither mode nor frequency, as one of factors."""
    what = f"a row of numbers named {row.cells[0]!r} stands above the rows of values, and is not understood"
    remedy = "Apply what it says to the values and remove it, or name it Mode or Frequency [Hz]"
    return Problem("header", f"{path}, line {row.line}", what, remedy)


def disagreement(path: Path, line: int | None, one: str, other_line: int, other: str) -> Problem:
    """Refusal of two statements that disagree; ``line`` None: what one says is not in a single line."""
    where = f"{path}, line {other_line}" if line is None else f"{path}, lines {line} and {other_line}"
    what = f"two statements of the header disagree: {one}, and {other}"
    return Problem("header", where, what, "Correct one of them, or remove it")


def some_of(cells: Sequence[str]) -> str:
    """Text of the first cells of a row."""
    shown = ", ".join(cells[:6])
    return f"{shown} ..." if len(cells) > 6 else shown
