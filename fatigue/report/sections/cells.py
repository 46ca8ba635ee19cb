"""How a table of the page is written: headings with their units, what a cell says and the value it is sorted by."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Literal, TypeAlias

import numpy as np
import pandas as pd

from fatigue import digits
from fatigue.report.wording import NOT_AVAILABLE, number, share, whole
from fatigue.report.wording import life as in_words
from fatigue.shown import shortened

LONGEST_TEXT = 400  # letters of a cell: a name of thousands would be a page of its own
Written: TypeAlias = Literal["", "result", "life", "given"]
_BEYOND = 1e300  # sorts after every number; what is not available sorts last


@dataclass(frozen=True, slots=True)
class Heading:
    """Head of a column: what it holds, its unit, and whether it holds numbers."""

    text: str
    unit: str = ""
    numeric: bool = True


@dataclass(frozen=True, slots=True)
class Cell:
    """One cell: its text, the number it is sorted by (None: its text), a link within the page, a mark for the style.

    A number is ``written`` as the others of its column: as a result, a life or as it was given; empty: as its text
    says. ``after`` stands behind it.
    """

    text: str
    value: float | None = None
    link: str = ""
    mark: str = ""
    written: Written = field(default="", compare=False)
    after: str = ""


@dataclass(frozen=True, slots=True)
class PageTable:
    """A table of the page; one with a ``label`` gets a filter above it."""

    id: str
    headings: tuple[Heading, ...]
    rows: tuple[tuple[Cell, ...], ...]
    label: str = ""

    @property
    def shown(self) -> "PageTable":
        """The same table with one unit and one notation down every column of numbers; see ``fatigue.digits``."""
        if not (self.rows and self.headings):
            return self
        columns = [_column(*column) for column in zip(self.headings, zip(*self.rows, strict=True), strict=True)]
        headings, texts = zip(*columns, strict=True)
        return replace(self, headings=headings, rows=tuple(zip(*texts, strict=True)))


def _column(heading: Heading, cells: tuple[Cell, ...]) -> tuple[Heading, tuple[Cell, ...]]:
    """Heading and cells of a column, its numbers written alike."""
    at = [i for i, cell in enumerate(cells) if cell.written]
    if not at:
        return heading, cells
    values = [_number(cells[i].value) for i in at]
    ways = {cells[i].written for i in at}
    if ways == {"life"} and heading.unit == "km":
        texts, unit = digits.lives(values)
        heading = replace(heading, unit=unit)
    else:
        texts = digits.as_given(values) if ways == {"given"} else digits.results(values)
    shown = list(cells)
    for i, written in zip(at, texts, strict=True):
        shown[i] = replace(cells[i], text=written + cells[i].after)
    return heading, tuple(shown)


def _number(value: float | None) -> float:
    """The number of a cell, from what it is sorted by."""
    if value is None or value > _BEYOND:
        return math.nan
    return math.copysign(math.inf, value) if abs(value) == _BEYOND else value


def text(value: Any) -> Cell:
    """Cell with a name; a dash where there is none."""
    missing = value is None or value != value or value == ""  # noqa: PLR0124
    return Cell(NOT_AVAILABLE if missing else shortened(str(value), LONGEST_TEXT, "…"))


def num(value: Any, written: Written = "result") -> Cell:
    """Cell with a number, by default a result; alone it has four digits, in a table it is written as its column."""
    missing = value is None or value != value  # noqa: PLR0124
    sorted_by = 2 * _BEYOND if missing else float(np.clip(float(value), -_BEYOND, _BEYOND))
    return Cell(number(value), sorted_by, written=written)


def given(value: Any) -> Cell:
    """Cell with a quantity that was given: a length, a frequency."""
    return num(value, "given")


def life(value: Any) -> Cell:
    """Cell with a life, of three digits."""
    return Cell(in_words(value), num(value).value, written="life")


def integer(value: Any, *, grouped: bool = False) -> Cell:
    """Cell with a count (grouped) or an id; a dash where there is none."""
    if pd.isna(value):
        return Cell(NOT_AVAILABLE, 2 * _BEYOND)
    return Cell(whole(int(value)) if grouped else str(int(value)), float(value))


def percent(value: Any) -> Cell:
    """Cell with a share."""
    return Cell(share(value), -_BEYOND if value != value else float(value))  # noqa: PLR0124


def verdict(fulfilled: Any) -> Cell:
    """Cell that says whether a target is met: in words and a sign, not in colour alone."""
    return Cell("✓ met", 1.0, mark="met") if fulfilled else Cell("✕ missed", 0.0, mark="missed")


def linked(weld: str, links: Mapping[str, str]) -> Cell:
    """Cell with the name of a weld, and the link to its page where it has one."""
    return Cell(shortened(weld, LONGEST_TEXT, "…"), link=links.get(weld, ""))


def span(low: float, high: float, written: Callable[[Any], str] = number) -> Cell:
    """Cell with the range of a quantity, sorted by its lower end; one number where both ends read the same."""
    ends = written(low), written(high)
    return Cell(ends[0] if ends[0] == ends[1] or pd.isna(low) else " to ".join(ends), num(low).value)
