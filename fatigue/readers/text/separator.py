"""What separates the cells of a text table: the sign that a line declares, or that divides names and rows alike."""

import re
from collections.abc import Sequence
from pathlib import Path

from fatigue.errors import DataError, Problem
from fatigue.readers.text.numbers import split_fields

SEPARATORS = (",", ";", "\t", "|")
_SEP_LINE = re.compile(r'\s*"?sep=(.)"?\s*\Z', re.IGNORECASE)


def declared_separator(line: str) -> str | None:
    """Separator that a line such as ``sep=;`` declares; None of any other line."""
    found = _SEP_LINE.match(line)
    return None if found is None else found[1]


def separator_of(path: Path, header: int, line: str, rows: Sequence[str], declared: str | None) -> str | None:
    """Separator that divides the names in line ``header``, from 0, and most rows alike; None: blanks.

    Raises
    ------
    DataError : another sign is ``declared`` than the one that divides the names
    """
    counts = {s: len(split_fields(line, s)) for s in SEPARATORS}
    if declared is not None:
        other = [s for s in SEPARATORS if s != declared and counts[s] > 1]
        if len(split_fields(line, declared)) == 1 and other:
            what = f"the file declares sep={declared}, and its columns are separated by {other[0]!r}"
            raise DataError(Problem("csv_separator", f"{path.name}: line {header + 1}", what, "Correct one of them"))
        return declared
    candidates = [s for s in SEPARATORS if counts[s] > 1]
    if not candidates:
        words = len(line.split())
        blanks = words > 1 and rows and all(len(split_fields(row, None)) == words for row in rows[:20])
        return None if blanks else ","
    if len(candidates) == 1:
        return candidates[0]
    alike = {s: sum(len(split_fields(row, s)) == counts[s] for row in rows[:20]) for s in candidates}
    return max(candidates, key=lambda s: (alike[s], counts[s]))


def cell_count(line: str, separator: str) -> int:
    """Count the cells of a line, empty ones at its end too."""
    quoted = re.sub(r'"[^"]*"', "", line)
    return quoted.count(separator) + 1
