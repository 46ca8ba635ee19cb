"""Units that a file states for its columns of unit loads and of channels, compared with the units of these."""

from collections.abc import Collection, Iterable, Iterator, Sequence
from pathlib import Path

from fatigue.errors import DataError, Problem
from fatigue.life.records.unit_load import LoadSource
from fatigue.readers.neutral.columns import DAMAGE
from fatigue.readers.neutral.files import open_columns
from fatigue.readers.neutral.table_units import checked_units, same_unit
from fatigue.readers.text.layout import table_layout


def column_names(path: Path | None) -> list[str]:
    """Names of the columns of a record, without reading it; none where it cannot be opened, which its reader tells."""
    return [name for name, _ in _head(path)]


def load_unit_problems(record: Path | None, loads: Iterable[LoadSource]) -> Iterator[Problem]:
    """Refusals of columns whose stated unit is not that of their load; ``record`` is the file of the event itself."""
    for load in loads:
        path = record if load.way == "column" else load.path
        if path is None or load.way not in ("column", "file"):
            continue
        stated = dict(_head(path)).get(load.column, "")
        if stated and not same_unit(stated, load.unit):
            what = f"the unit is {stated}, and the unit load '{load.name}' is in {load.unit}"
            remedy = f"Give the values in {load.unit}, by a history of its own with `scale`"
            yield Problem("unit", f"{path.name}: column {load.column}", what, remedy)


def stated_unit(path: Path, column: str) -> str:
    """Unit that a table states for a column, empty where it states none."""
    return dict(_head(path)).get(column, "")


def without_units_of(path: Path, known: Collection[str], warnings: Sequence[Problem]) -> list[Problem]:
    """Warnings about a record, but for those about the units of ``known`` columns, which are compared elsewhere."""
    others = [warning for warning in warnings if warning.code != "unit_unused"]
    if len(others) == len(warnings):
        return others
    of_row = ", row of units" if path.suffix.lower() == ".csv" else ""
    stated = ((f"{path.name}: column {name}{of_row}", name, unit) for name, unit in _head(path) if name not in known)
    return [*checked_units(stated), *others]


def _head(path: Path | None) -> list[tuple[str, str]]:
    """Names of the columns of a table and the units it states for them, empty where it states none."""
    if path is None:
        return []
    try:
        if path.suffix.lower() == ".csv":
            layout = table_layout(path, ())
            names, units = layout.names, layout.units
        else:
            columns = open_columns(path, ())
            names, units = columns.names, columns.units
    except (*DAMAGE, DataError):
        return []
    given = [*units, *[""] * (len(names) - len(units))]
    return [(name.strip(), unit) for name, unit in zip(names, given, strict=False)]
