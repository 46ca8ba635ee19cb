"""Lines of a text table; the lines of a cell that is broken over several are joined."""

import re
from collections.abc import Sequence

MOST_BREAKS = 20  # lines of one cell
_LINE_END = re.compile(r"\r\n|\n|\r")


def text_lines(text: str, *, whole: bool = True) -> list[str]:
    """Lines of a text; where it is not ``whole``, without the last one, which may be cut."""
    lines = _LINE_END.split(text)
    return lines if whole or len(lines) == 1 else lines[:-1]


def whole_cells(lines: Sequence[str]) -> list[str]:
    """Lines in which a cell that a spreadsheet broke in quotation marks stands on its last line; blank ones remain."""
    result = list(lines)
    for k in range(len(lines)):
        joined, end = result[k], k
        while joined.count('"') % 2 and end < min(k + MOST_BREAKS, len(lines) - 1):
            end += 1
            joined = f"{joined} {lines[end]}"
        if end > k and joined.count('"') % 2 == 0:
            result[k : end + 1] = [""] * (end - k) + [joined]
    return result
