"""What a conversion writes down for later: the lines of its welds, and the command that would convert once more."""

from collections.abc import Sequence

from fatigue.readers.neutral.register.weld_register import RegisterRow


def lines_of_welds(rows: Sequence[RegisterRow]) -> dict[str, dict[str, float | None]]:
    """Record the lines of every weld that is assessed, with the thickness confirmed for each."""
    welds: dict[str, dict[str, float | None]] = {}
    for row in rows:
        if row.status == "assess":
            welds.setdefault(row.weld, {})[row.line] = row.thickness if row.confirmed else None
    return welds
