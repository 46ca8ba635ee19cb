"""Numbers of a punch file, and the refusal of a line of it."""

from pathlib import Path

from fatigue.errors import DataError, Problem


def real(path: Path, at: int, text: str) -> float:
    """A number of a field; ``at`` counts lines from 0."""
    try:
        return float(text.strip().upper().replace("D", "E").replace("_", "?"))
    except ValueError:
        raise damaged(path, at, f"{text.strip()!r} is no number") from None


def damaged(path: Path, at: int, found: str) -> DataError:
    """Refusal at a line, from 0."""
    return DataError(
        Problem("punch_damaged", f"{path}, line {at + 1}", found, "Copy the punch file again in text mode")
    )
