"""Welds that failed a check which counts, by the rows of the checks: the verdict of a weld follows from them."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from fatigue.results import read_table


def failed_by_checks(folder: Path, case: Mapping[str, Any]) -> frozenset[str]:
    """Names of welds with a row of a check that counts and is not fulfilled; none where no check counts.

    Raises
    ------
    DataError : the table of checks is missing or damaged
    """
    counts = case.get("checks", {}).get("counts", [])
    if not counts:
        return frozenset()
    table = read_table(folder, "checks", ["weld", "check", "fulfilled"])
    columns = (table[name].to_pylist() for name in table.column_names)
    return frozenset(
        weld for weld, check, fulfilled in zip(*columns, strict=True) if check in counts and fulfilled is False
    )
