"""Lists of modes as they are typed: ``1-6,31-52``."""

import re

from fatigue.errors import CaseError, Problem

MOST_MODES = 100_000  # of one range


def mode_list(text: str, where: str = "list of modes") -> tuple[int, ...]:
    """Read a list of modes such as ``1-6,31-52``.

    Raises
    ------
    CaseError : anything else
    """
    modes: list[int] = []
    for part in text.split(","):
        found = re.fullmatch(r"\s*(\d{1,18})(?:-(\d{1,18}))?\s*", part, re.ASCII)
        first, last = (int(found[1]), int(found[2] or found[1])) if found else (0, -1)
        if not 0 <= last - first <= MOST_MODES:
            shown = part if len(part) <= 40 else part[:37] + "..."
            raise CaseError(Problem("bad_modes", where, f"{shown!r} is no mode or range", "Write 1-6,31-52"))
        modes += range(first, last + 1)
    return tuple(modes)
