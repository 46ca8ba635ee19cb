"""How a table of the page is written: headings with their units, what a cell says and the value it is sorted by."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from fatigue.report.wording import NOT_AVAILABLE, number, share, whole
from fatigue.report.wording import life as in_words
from fatigue.shown import shortened

LONGEST_TEXT = 400  # letters of a cell: a name of thousands would be a page of its own
_BEYOND = 1e300  # sorts after every number; what is not available sorts last


@dataclass(frozen=True, slots=True)
class Heading:
    """Head of a column: what it holds, its unit, and whether it holds numbers."""

    text: str
    unit: str = ""
    numeric: bool = True


@dataclass(frozen=True, slots=True)
class Cell:
    """One cell: its text, the number it is sorted by (None: its text), a link within the page, a mark for the style."""

    text: str
    value: float | None = None
    link: str = ""
    mark: str = ""


@dataclass(frozen=True, slots=True)
class PageTable:
    """A table of the page; one with a ``label`` gets a filter above it."""

    id: str
    headings: tuple[Heading, ...]
    rows: tuple[tuple[Cell, ...], ...]
    label: str = ""


def text(value: Any) -> Cell:
    """Cell with a name; a dash where there is none."""
    missing = value is None or value != value or value == ""  # noqa: PLR0124
    return Cell(NOT_AVAILABLE if missing else shortened(str(value), LONGEST_TEXT, "…"))


def num(value: Any) -> Cell:
    """Cell with a number of four digits."""
    missing = value is None or value != value  # noqa: PLR0124
    return Cell(number(value), 2 * _BEYOND if missing else float(np.clip(float(value), -_BEYOND, _BEYOND)))


def life(value: Any) -> Cell:
    """Cell with a life, of three digits."""
    return Cell(in_words(value), num(value).value)


def integer(value: Any, *, grouped: bool = False) -> Cell:
    """Cell with a count (grouped) or an id; a dash where there is none."""
    if pd.isna(value):
        return num(None)
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
