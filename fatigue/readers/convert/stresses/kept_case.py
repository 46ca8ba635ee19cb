"""Whether a case that was kept names the stress points that were converted beside it."""

import tomllib
from collections.abc import Iterator
from pathlib import Path

from fatigue.errors import Problem


def points_not_in_case(points: str, kept_case: Path | None) -> Iterator[Problem]:
    """Warning that a kept case does not read the stress points of the conversion."""
    if kept_case is None:
        return
    try:
        named = tomllib.loads(kept_case.read_text(encoding="utf-8-sig"))["body"].get("stress_points")
    except (OSError, ValueError, AttributeError, KeyError, TypeError, RecursionError):  # its check will say so
        return
    if named is None:
        what = "the case that is kept does not name the stress points"
        remedy = f"Add stress_points = {points!r} and modal_stresses to [body], or convert without --keep-case"
        yield Problem("stress_points_not_in_case", str(kept_case), what, remedy)
