"""Blocks of an ANSYS archive: lines of fixed columns whose widths a format such as ``(3i9,6e21.13e3)`` states."""

import re
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from fatigue.errors import DataError, Problem

_PART = re.compile(r"(\d*)(?:p,?\d*)?([ieIEfFgGdD])(\d+)(?:\.\d+)?(?:[eE]\d+)?")
_WHOLE = re.compile(r"\s*-?\d+\s*\Z")


class Field(NamedTuple):
    """A column of a line: where it is, and whether it holds whole numbers."""

    start: int
    end: int
    is_whole: bool


class Lines:
    """Lines of an archive, one after another, with their numbers from 1."""

    def __init__(self, source: str, lines: list[str]) -> None:
        self.source = source
        self.lines = lines
        self.at = 0

    def __iter__(self) -> Iterator[str]:
        """Lines that are left."""
        while self.at < len(self.lines):
            self.at += 1
            yield self.lines[self.at - 1]

    def next(self, what: str) -> str:
        """Next line, which has to be there."""
        if self.at >= len(self.lines):
            raise self.cut(what)
        self.at += 1
        return self.lines[self.at - 1]

    @property
    def where(self) -> str:
        """The line read last."""
        return f"{self.source}, line {self.at}"

    def damaged(self, what: str) -> DataError:
        """Refusal at the line read last."""
        return DataError(
            Problem("archive_damaged", self.where, what, "Write it again with CDWRITE,DB, or copy it whole")
        )

    def cut(self, what: str) -> DataError:
        """Refusal of a file that ends too early."""
        return DataError(
            Problem(
                "cut", self.where, f"the archive ends within {what}", "Write it again with CDWRITE,DB, or copy it whole"
            )
        )


def fields_of(lines: Lines) -> list[Field]:
    """Columns that the next line, a format in brackets, states."""
    text = lines.next("a block").strip()
    if not (text.startswith("(") and text.endswith(")")):
        raise lines.damaged(f"a format in brackets was expected, and {text[:40]!r} stands there")
    fields: list[Field] = []
    for part in text[1:-1].replace(" ", "").split(","):
        found = _PART.fullmatch(part)
        repeat, width = (int(found[1] or 1), int(found[3])) if found else (0, 0)
        if found is None or not 0 < repeat <= 100 or not 0 < width <= 40:
            raise lines.damaged(f"the format {text[:40]!r} is not read")
        for _ in range(repeat):
            start = fields[-1].end if fields else 0
            fields.append(Field(start, start + width, found[2] in "iI"))
    return fields


def numbers(lines: Lines, line: str, fields: list[Field]) -> list[float]:
    """Numbers of a line, as many as it has columns; those behind its end are left out.

    ANSYS leaves out what is zero at the end of a line of NBLOCK; a column of blanks within is zero.
    """
    text = line.rstrip()
    found = []
    for field in fields:
        if field.start >= len(text):
            break
        found.append(number(lines, text[field.start : field.end]))
    if len(text) > fields[-1].end:
        raise lines.damaged(f"{text[fields[-1].end :].strip()[:20]!r} stands behind the last column")
    return found


def number(lines: Lines, text: str) -> float:
    """A number; blank is zero, stars are one that did not fit."""
    word = text.strip().upper().replace("D", "E")
    if not word:
        return 0.0
    try:
        value = float(word.replace("_", "?"))
    except ValueError:
        also = ": a number did not fit in its column" if "*" in word else ""
        raise lines.damaged(f"{word[:24]!r} is no number{also}") from None
    if not np.isfinite(value):
        raise lines.damaged(f"{word[:24]!r} is no finite number")
    return value


def whole_numbers(lines: Lines, line: str, fields: list[Field]) -> list[int]:
    """Whole numbers of a line."""
    text = line.rstrip()
    words = [text[field.start : field.end] for field in fields if field.start < len(text)]
    if len(text) > fields[-1].end:
        raise lines.damaged(f"{text[fields[-1].end :].strip()[:20]!r} stands behind the last column")
    bad = next((word for word in words if not _WHOLE.match(word)), None)
    if bad is not None:
        raise lines.damaged(f"{bad.strip()[:20]!r} is no whole number")
    return [int(word) for word in words]
