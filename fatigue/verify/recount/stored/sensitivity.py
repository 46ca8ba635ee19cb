"""The table of welds under other assumptions: its rows, what follows in all of them, and which are counted again."""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from fatigue.results import TABLES, read_table
from fatigue.verify.recount.anew.point import Values
from fatigue.verify.recount.stored.compare import TOLERANCE, ColumnCheck, Row, compare_keys

PLACE = ("part", "node", "order", "surface")
AT_A_POINT = ("exact", "recount", "counted")  # bases of rows that name the point that decides
OTHERS = 2  # rows of each variant beside the worst one, where some are drawn


def sensitivity_of(folder: Path) -> list[dict[str, Any]]:
    """Rows of the table; none where a result is older than it.

    Raises
    ------
    DataError : the file is damaged
    """
    if not (folder / "sensitivity.parquet").exists():
        return []
    rows: list[dict[str, Any]] = read_table(
        folder, "sensitivity", [column.name for column in TABLES["sensitivity"]]
    ).to_pylist()
    return rows


def where(row: Mapping[str, Any]) -> str:
    """Place of a row in words."""
    return f"weld {row['weld']}, {row['variant']}"


def missing_rows(rows: Sequence[Mapping[str, Any]], variants: Sequence[str], welds: Sequence[str]) -> ColumnCheck:
    """Check that every weld has one row of every variant."""
    found = pd.MultiIndex.from_tuples([(row["weld"], row["variant"]) for row in rows], names=["weld", "variant"])
    return compare_keys("sensitivity", found, [(weld, variant) for weld in welds for variant in variants])


def chosen_rows(rows: Sequence[Mapping[str, Any]], *, sample: int | None, seed: int) -> list[int]:
    """Rows that are counted again: of each variant the worst one, those that flip, a bound, and others as drawn.

    ``sample`` is how many there are at most beside the worst one, of each kind; None: all.
    """
    rng = np.random.default_rng(seed)
    by_variant: dict[str, list[int]] = {}
    for number, row in enumerate(rows):
        if row["basis"] != "as assessed":
            by_variant.setdefault(row["variant"], []).append(number)
    chosen: list[int] = []
    for numbers in by_variant.values():
        if sample is None:
            chosen += numbers
            continue
        worst = max(numbers, key=lambda number: float(rows[number]["utilisation"]))
        flips = [number for number in numbers if rows[number]["flips"]][: min(sample, OTHERS)]
        bounds = [number for number in numbers if rows[number]["basis"] not in AT_A_POINT][: min(sample, 1)]
        drawn = rng.permutation(numbers).tolist()[: min(sample, OTHERS)]
        chosen += dict.fromkeys([worst, *flips, *bounds, *drawn])
    return chosen


def consistent(rows: Sequence[Mapping[str, Any]], welds: pd.DataFrame) -> Iterator[Row]:
    """All rows as they follow from their own columns, and from the assessed ``welds``.

    What changes nothing has the worst point and the utilisation of the assessment; a bound names no point.
    """
    for row in rows:
        assessed, used, basis = welds.loc[row["weld"]], float(row["utilisation"]), row["basis"]
        expected: Values = {}
        if basis == "as assessed":
            expected = {name: int(assessed[f"worst_{name}"]) for name in PLACE[:3]}
            expected |= {"surface": assessed["worst_surface"], "utilisation": float(assessed["utilisation"])}
            used = expected["utilisation"]
        elif basis not in AT_A_POINT:
            expected = dict.fromkeys(PLACE[:3]) | {"surface": ""}
        fulfilled = None if basis == "undecided" else used <= 1.0
        before = bool(assessed["utilisation"] <= 1.0)
        expected |= {"fulfilled": fulfilled, "flips": fulfilled is not None and fulfilled != before}
        closest = min(abs(used - 1.0), abs(float(assessed["utilisation"]) - 1.0))
        unsure = dict.fromkeys(("fulfilled", "flips"), np.inf if closest <= TOLERANCE else 0.0)
        yield Row(where(row), row, expected, {}, bounds=unsure)
