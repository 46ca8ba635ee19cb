"""The layout of an exported text: a head with its version, blocks of numbers, and an end that tells it is whole.

``fatigue export 1 Abaqus 2023`` begins it. A block has a line ``*name columns rows words``, then its rows of numbers;
``*end`` is the last line. A row that lacks a number, a block that lacks a row, or a text without its end is refused.
"""

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import TextIO

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem
from fatigue.readers.text.encoding import unreadable

VERSION = 1
HEAD = re.compile(r"\Afatigue export (\d+) (\S+) ?([^\r\n]*)\r?\n")
_BLOCK = re.compile(r"\*(\w+) +(\d{1,3}) +(\d{1,12})\.?(?: +(.*))?\Z")
_NAMES = frozenset({"nodes", "elements", "sections", "layered", "mode", "static", "shape", "forces"})
_ANEW = "Write it again with the script (fatigue request), or copy it whole"
_AT_ONCE = 20_000  # rows turned into numbers together


@dataclass(frozen=True, slots=True, eq=False)
class Block:
    """A block of numbers (r, c), with its name, its words and the line of its head, from 1."""

    name: str
    words: str
    line: int
    values: NDArray[np.float64]


def is_export(head: str) -> bool:
    """Whether a text begins as our scripts begin theirs."""
    return HEAD.match(head) is not None


def blocks(path: Path, wanted: frozenset[str] | None = None) -> Iterator[Block]:
    """Blocks of an exported text, one after another; of those that are not ``wanted`` only the head is read.

    Raises
    ------
    DataError : another version, a text that is cut, a row that is not of so many finite numbers
    """
    try:
        with path.open(encoding="ascii", errors="replace") as file:
            number = _head(path, file)
            while True:
                line = file.readline()
                number += 1
                if not line:
                    what = "the text ends without *end: its end is missing"
                    raise DataError(Problem("cut", f"{path}, line {number}", what, _ANEW))
                text = line.strip()
                if text == "*end":
                    return
                if not text:
                    continue
                found = _BLOCK.match(text)
                if found is None:
                    raise damaged(path, number, f"the head of a block was expected, and {text[:40]!r} stands there")
                name, columns, rows = found[1], int(found[2]), int(found[3])
                if name not in _NAMES:
                    raise damaged(path, number, f"*{name} is no block of the layout ({', '.join(sorted(_NAMES))})")
                if wanted is None or name in wanted:
                    values = _numbers(path, file, number, columns, rows, name == "mode")
                    yield Block(name, (found[4] or "").strip(), number, values)
                elif sum(1 for _ in islice(file, rows)) != rows:
                    raise damaged(path, number, f"the block *{name} is to have {rows} rows, and the text ends before")
                number += rows
    except OSError as error:
        raise unreadable(path, error) from error


def solver_of(path: Path) -> str:
    """Program that the text comes from, with its version."""
    with path.open(encoding="ascii", errors="replace") as file:
        found = HEAD.match(file.readline())
    return f"{found[2]} {found[3]}".strip() if found else ""


def _head(path: Path, file: TextIO) -> int:
    found = HEAD.match(file.readline())
    if found is None:
        raise damaged(path, 1, "it does not begin with 'fatigue export'")
    if int(found[1]) != VERSION:
        what = f"the layout has version {found[1]}, and {VERSION} is read"
        remedy = "Write the script anew with `fatigue request`, and export again"
        raise DataError(Problem("other_version", f"{path}, line 1", what, remedy))
    return 1


def _numbers(path: Path, file: TextIO, head: int, columns: int, rows: int, lacking: bool) -> NDArray[np.float64]:
    """Rows of a block; ``lacking`` allows nan, which stands for the mass of a mode that is not known."""
    pieces: list[NDArray[np.float64]] = []
    done = 0
    while done < rows:
        lines = list(islice(file, min(_AT_ONCE, rows - done)))
        if not lines:
            raise damaged(path, head + done + 1, f"a block of {rows} rows ends behind {done}")
        words = "".join(lines).replace("D", "E").split()
        try:
            values = np.array(words, np.float64)
        except ValueError:
            values = np.empty(0)
        if values.size != columns * len(lines) or not (lacking or np.isfinite(values).all()):
            raise _row_problem(path, lines, head + done + 1, columns)
        pieces.append(values.reshape(len(lines), columns))
        done += len(lines)
    return np.concatenate(pieces) if pieces else np.zeros((0, columns))


def _row_problem(path: Path, lines: list[str], first: int, columns: int) -> DataError:
    """The first row that is not of so many numbers."""
    for number, line in enumerate(lines, first):
        words = line.split()
        bad = next((word for word in words if not _is_number(word)), None)
        if bad is not None:
            return damaged(path, number, f"{bad[:30]!r} is no number")
        if len(words) != columns:
            return damaged(path, number, f"{len(words)} numbers stand in a row of {columns}")
    return damaged(path, first, f"rows of {columns} numbers were expected")


def _is_number(word: str) -> bool:
    try:
        return math.isfinite(float(word.replace("D", "E")))
    except ValueError:
        return False


def damaged(path: Path, line: int, what: str) -> DataError:
    """Refusal of a text at a line, from 1."""
    return DataError(Problem("export_damaged", f"{path}, line {line}", what, _ANEW))
