"""Stored numbers against recounted ones: the largest difference in each column and where it is."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from fatigue.errors import Problem
from fatigue.results import TABLES

TOLERANCE = 1e-6  # two programs written apart agree to this
LOAD_FACTOR_STEP = 2e-4  # below the largest factor that meets the target, where damage jumps or bends with the load
UPPER_BOUNDS = {"damage_per_km", "damage_per_pass", "utilisation", "max_range_MPa", "multiaxial_bound",
                "utilisation_asme"}  # fmt: skip
OF_SPECTRUM = {"irregularity", "outside_share", "peaks_per_s", "samples_per_peak"}  # exact where bounds stand, too
INVERSE = {"life_km", "life_years", "life_km_raw_end", "life_km_dirlik", "life_km_tb", "life_km_same_ratio",
           "load_factor", "life_km_load_low", "life_km_load_high"}  # fmt: skip
LOWER_BOUNDS = {"life_km", "life_years", "life_km_raw_end", "load_factor"}


@dataclass(frozen=True, slots=True)
class ColumnCheck:
    """One column of a result table: how many values were recounted, and the one that differs most.

    ``difference`` is relative; ``where``, ``found`` (in the table) and ``expected`` (recounted) belong to that value.
    """

    table: str
    column: str
    unit: str
    compared: int
    difference: float
    tolerance: float
    where: str
    found: Any
    expected: Any

    @property
    def passed(self) -> bool:
        """Whether the largest difference is within the tolerance."""
        return self.difference <= self.tolerance


@dataclass(frozen=True, slots=True)
class Recount:
    """What a recount of a result found.

    ``choice`` says which welds it was made for where not for all of them; ``strangers`` are the files in the folder
    that belong to another result.
    """

    folder: Path
    points: int
    points_in_all: int
    columns: tuple[ColumnCheck, ...]
    choice: str = ""
    strangers: tuple[Problem, ...] = ()

    @property
    def passed(self) -> bool:
        """Whether every column agrees and every file belongs to the result."""
        return not self.strangers and all(column.passed for column in self.columns)

    def as_record(self) -> dict[str, Any]:
        """Record for machines."""
        return {
            "folder": str(self.folder),
            "points": self.points,
            "points_in_all": self.points_in_all,
            "passed": self.passed,
            "columns": [asdict(column) | {"passed": column.passed} for column in self.columns],
            **({"choice": self.choice} if self.choice else {}),
            "strangers": [asdict(problem) for problem in self.strangers],
        }

    def as_text(self) -> str:
        """Text for people: the columns that differ with their place, else the largest difference of each table."""
        wrong = [column for column in self.columns if not column.passed]
        verdict = "agree with the recount" if not wrong else f"{len(wrong)} of {len(self.columns)} columns differ"
        if self.strangers:
            verdict = "" if not self.columns else f"{verdict}; "
            verdict += f"{len(self.strangers)} files of the folder do not belong to its result"
        lines = [
            f"{self.folder}: {self.points} of {self.points_in_all} points recounted from the input files: {verdict}"
        ]
        lines += [f"  recounted: {self.choice}"] if self.choice else []
        lines += [f"  {problem}" for problem in self.strangers]
        for column in wrong:
            unit = "" if column.unit == "-" else f" {column.unit}"
            values = f"{_shown(column.found)} where the recount has {_shown(column.expected)}{unit}"
            difference = f"difference {column.difference:.2g}, {column.where}"
            lines.append(f"  {column.table}.{column.column}: {values} ({difference})")
        for table in dict.fromkeys(column.table for column in self.columns):
            checked = [column for column in self.columns if column.table == table]
            worst = max(checked, key=lambda column: column.difference / column.tolerance)
            lines.append(
                f"  {table}: {len(checked)} columns, {sum(c.compared for c in checked)} values, largest difference "
                f"{worst.difference:.2g} in {worst.column}"
            )
        return "\n".join(lines)


@dataclass(frozen=True, slots=True)
class Row:
    """Recounted values of one row of a table.

    ``scale`` gives the size a difference in a column is relative to where that is not the value itself;
    ``is_bound`` marks a row that stands for a proven bound. ``bounds`` are what rounding may do to a column, of lives
    and load factors to their inverse.
    """

    where: str
    found: Mapping[str, Any]
    expected: Mapping[str, Any]
    scale: Mapping[str, float]
    is_bound: bool = False
    bounds: Mapping[str, float] = field(default_factory=dict)


def compare(table: str, rows: Sequence[Row], tolerance: Mapping[str, float]) -> list[ColumnCheck]:
    """Check of every recounted column of a table, in the order of the table."""
    units = {column.name: column.unit for column in TABLES[table]}
    checks = []
    for name in (name for name in units if any(name in row.expected for row in rows)):
        compared = [row for row in rows if name in row.expected and not (row.is_bound and _is_undefined(name, row))]
        if not compared:  # every row stands for a bound that says nothing of this column
            continue
        differences = np.array([_difference(name, row) for row in compared])
        worst = compared[int(differences.argmax())]
        checks.append(
            ColumnCheck(
                table=table,
                column=name,
                unit=units[name],
                compared=len(compared),
                difference=float(differences.max()),
                tolerance=tolerance.get(name, TOLERANCE),
                where=worst.where,
                found=worst.found[name],
                expected=worst.expected[name],
            )
        )
    return checks


def merged(checks: Sequence[ColumnCheck]) -> list[ColumnCheck]:
    """Checks of the same columns at different rows joined, in the order of the tables: the worst difference of each."""
    by_column: dict[tuple[str, str], list[ColumnCheck]] = {}
    for check in checks:
        by_column.setdefault((check.table, check.column), []).append(check)
    tables = dict.fromkeys(check.table for check in checks)
    names = {table: [column.name for column in TABLES[table.partition(",")[0]]] for table in tables}
    joined = []
    for table, name in sorted(by_column, key=lambda at: (list(tables).index(at[0]), names[at[0]].index(at[1]))):
        same = by_column[table, name]
        worst = max(same, key=lambda check: check.difference / check.tolerance)
        joined.append(replace(worst, compared=sum(check.compared for check in same)))
    return joined


def compare_keys(table: str, found: pd.Index, keys: Sequence[Any]) -> ColumnCheck:
    """Check of which rows a table has: none dropped, none twice, none from elsewhere."""
    expected = pd.MultiIndex.from_tuples(keys, names=found.names) if found.nlevels > 1 else pd.Index(keys)
    astray = [*found[found.duplicated()], *expected.symmetric_difference(found.drop_duplicates())]
    return ColumnCheck(
        table=table,
        column=", ".join(found.names),
        unit="rows",
        compared=len(expected),
        difference=float(len(astray)),
        tolerance=0.5,  # rows
        where=f"first {astray[0]}" if astray else "",
        found=len(found),
        expected=len(expected),
    )


def _is_undefined(name: str, row: Row) -> bool:
    """Whether a row that stands for a bound says nothing exact about a column."""
    is_exact = "dirlik" in name or "_tb" in name or name in OF_SPECTRUM
    missing = row.found[name] is None or row.found[name] != row.found[name]
    return missing or not (is_exact or name in UPPER_BOUNDS | LOWER_BOUNDS)


def _difference(name: str, row: Row) -> float:
    """Relative difference of a value; none where it is large and yet within what rounding may do."""
    difference = _relative_difference(name, row)
    bound = row.bounds.get(name, 0.0)
    is_rounding = difference > TOLERANCE and _is_rounding(name, row.found[name], row.expected[name], bound)
    return 0.0 if is_rounding else difference


def _relative_difference(name: str, row: Row) -> float:
    """Relative difference of a value, 1 between texts and flags that differ, infinite between a number and none."""
    found, expected = row.found[name], row.expected[name]
    if isinstance(expected, str):
        return float(expected != ("" if pd.isna(found) else found))
    if not isinstance(expected, float):
        return float(found != expected)
    found = np.nan if found is None else float(found)
    if found == expected or (np.isnan(found) and np.isnan(expected)):
        return 0.0
    if not (np.isfinite(found) and np.isfinite(expected)):
        within = row.is_bound and ((name in UPPER_BOUNDS) == (found > expected))
        return 0.0 if within else np.inf
    excess = found - expected
    if row.is_bound and name in UPPER_BOUNDS | LOWER_BOUNDS:
        excess = min(excess, 0.0) if name in UPPER_BOUNDS else max(excess, 0.0)
    if excess == 0.0:  # on the right side of a bound, also of one that is 0
        return 0.0
    size = max(row.scale.get(name, 0.0), abs(expected))
    return abs(excess) / size if size > 0 else np.inf


def _is_rounding(name: str, found: Any, expected: Any, bound: float) -> bool:
    """Whether a difference is within what rounding may do."""
    if bound == 0.0 or isinstance(expected, bool | str) or found is None:
        return bound == np.inf
    found, expected = float(found), float(expected)
    if name in INVERSE:
        with np.errstate(divide="ignore"):
            found, expected = (float(np.divide(1.0, value)) for value in (found, expected))
    return bound == np.inf or abs(found - expected) <= bound


def _shown(value: Any) -> str:
    return f"{value:.10g}" if isinstance(value, float) else str(value)
