"""Lines of a text table, those of one cell joined."""

import re
from collections.abc import Sequence

MOST_BREAKS = 20  # lines of one cell
_LINE_END = re.compile(r"\r\n|\n|\r")


def text_lines(text: str, *, whole: bool = True) -> list[str]:
    """Lines of a text; the last one of a part of a file is left out."""
    lines = _LINE_END.split(text)
    return lines if whole or len(lines) == 1 else lines[:-1]


def whole_cells(lines: Sequence[str]) -> list[str]:
    """Join the lines of a cell in quotation marks, as spreadsheets break them, on its last line; blank ones remain."""
    result = list(lines)
    for k in range(len(lines)):
        joined, end = result[k], k
        while joined.count('"') % 2 and end < min(k + MOST_BREAKS, len(lines) - 1):
            end += 1
            joined = f"{joined} {lines[end]}"
        if end > k and joined.count('"') % 2 == 0:
            result[k : end + 1] = [""] * (end - k) + [joined]
    return result
