"""Whether the checks that are to decide the verdict are made at all."""

from collections.abc import Iterator
from typing import Any

from fatigue.case.problems import clash
from fatigue.errors import Problem

NEEDS = {  # what makes a check: a table of the case and a key in it
    **dict.fromkeys(("throat_perp", "throat_par", "throat_root"), ("body", "weld_throats")),
    **dict.fromkeys(("hot_spot", "nominal", "parent"), ("body", "stress_points")),
    "interaction": ("checks", "interaction"),
    "endurance": ("checks", "endurance"),
}


def counts_problems(raw: dict[str, Any]) -> Iterator[Problem]:
    """Refusal of every check in ``[checks] counts`` that the case does not ask for: it would decide nothing."""
    checks = raw.get("checks")
    counts = checks.get("counts") if isinstance(checks, dict) else None
    for check in counts if isinstance(counts, list) else ():
        table, key = NEEDS.get(check, ("", "")) if isinstance(check, str) else ("", "")
        given = raw.get(table)
        if table and not (isinstance(given, dict) and given.get(key)):
            what = f"{check!r} is to decide, but {table}.{key} is not given"
            yield clash("checks.counts", what, f"Give {table}.{key}, or remove {check!r}")
