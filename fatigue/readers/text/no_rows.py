"""Why a text holds no table of numbers: the line that comes nearest to a row of numbers, and what is wrong with it."""

import itertools
import re
from collections.abc import Sequence
from pathlib import Path

from fatigue.errors import Problem
from fatigue.readers.text.numbers import is_gap, is_number, split_fields
from fatigue.readers.units.channel_names import time_unit_in

THOUSANDS = re.compile(r"[+-]?\d{1,3}(?:[.,' \u00a0\u202f]\d{3})+(?:[.,]\d*)?\Z")
_SEPARATORS = ("\t", ";", ",", "|", None)
_RUN_TOGETHER = re.compile(r"[-+]?\d*\.\d+(?:[EDed][-+]?\d+)?(?:[-+]?\d*\.\d+(?:[EDed][-+]?\d+)?)+\Z")
_WITH_UNIT = re.compile(r"[-+]?\d+(?:[.,]\d*)?\s+[^\W\d]+\Z")
_LOOKED_AT = 300


def no_rows_problem(path: Path, lines: Sequence[str]) -> Problem:
    """Refusal of a text without two rows of numbers."""
    head = lines[:_LOOKED_AT]
    for separator in _SEPARATORS:
        rows = [split_fields(line, separator) for line in head]
        for k, (cells, below) in enumerate(itertools.pairwise(rows)):
            if len(cells) > 3 and time_unit_in(cells[0]) is not None and _on_its_side(cells) and _on_its_side(below):
                what = "the table lies on its side, with one row for each channel"
                return Problem("no_table", f"{path}, line {k + 1}", what, "Export one column for each channel")
    nearest = [found for separator in _SEPARATORS if (found := _nearest(head, separator)) is not None]
    if nearest:
        _, line, cell = max(nearest, key=lambda found: (found[0], -found[1]))
        what, remedy = _wrong(cell)
        return Problem("no_table", f"{path}, line {line}", f"no row of numbers: {what}", remedy)
    what = f"no row of numbers in the first {len(lines)} lines"
    return Problem("no_table", str(path), what, "Export time and modal coordinates as columns of text")


def _number(cell: str) -> bool:
    return is_number(cell, ".") or is_number(cell, ",")


def _on_its_side(cells: Sequence[str]) -> bool:
    """Whether a row holds a word and numbers behind it."""
    return len(cells) > 3 and not _number(cells[0]) and all(map(_number, cells[1:]))


def _nearest(head: Sequence[str], separator: str | None) -> tuple[float, int, str] | None:
    """First line with most numbers: their share of its cells, its line number, its first cell that is no number."""
    best: tuple[float, int, str] | None = None
    for k, line in enumerate(head):
        cells = split_fields(line, separator)
        told = sum(_number(cell) or is_gap(cell) for cell in cells)
        begun = bool(cells) and _number(cells[0])
        wrong = next((c for c in cells if not (_number(c) or is_gap(c)) and (begun or re.search(r"\d", c))), None)
        if wrong is None or (len(cells) == 1 and not _RUN_TOGETHER.match(wrong)):
            continue
        share = 1.0 if _RUN_TOGETHER.match(wrong) or THOUSANDS.match(wrong) else told / len(cells)
        if share >= 0.5 and (best is None or share > best[0]):
            best = share, k + 1, wrong
    return best


def _wrong(cell: str) -> tuple[str, str]:
    """Say what is wrong with a cell, and what to do."""
    shown = repr(cell if len(cell) <= 40 else cell[:37] + "...")
    if THOUSANDS.match(cell):
        return f"{shown} has thousands separators", "Export without thousands separators"
    if _RUN_TOGETHER.match(cell):
        return f"in {shown} numbers stand without anything between them", "Export with blanks between the columns"
    if _WITH_UNIT.match(cell):
        return f"{shown} is a number with a unit", "Export plain numbers, with the units in the header"
    if re.match(r"\d{8}T\d|\d{14}\Z", cell):
        return f"{shown} is a date, where seconds from the start of the run are needed", "Export the time in seconds"
    return f"{shown} is no number", "Export plain columns of numbers below one line of names"
