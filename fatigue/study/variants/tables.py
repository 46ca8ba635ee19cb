"""Tables of a study on disk: rows of dataclasses as Parquet with unit and meaning of every column, and as CSV."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.csv as pa_csv
import pyarrow.parquet as pq

from fatigue.files.mishaps import refused_writing
from fatigue.results.dictionary.column import Column
from fatigue.study.quantities import StudyRun
from fatigue.study.variants.varied.expansion import Plan
from fatigue.study.variants.varied.names import shown

Tables = Mapping[str, tuple[tuple[Column, ...], Sequence[Any]]]

_TYPES = {"text": pa.string(), "int": pa.int64(), "flag": pa.bool_(), "float": pa.float64()}
_FORMULA = r"^([=+\-@\t\r])"  # what a spreadsheet would take for one gets an apostrophe before it


@dataclass(frozen=True, slots=True)
class VariantRow:
    """One setting of one variant; fields are columns of ``variants.parquet``."""

    variant: str
    setting: str
    keys: str
    value: float | None
    text: str
    differs: bool


@dataclass(frozen=True, slots=True)
class RunRow:
    """One run; fields are columns of ``runs.parquet``."""

    variant: str
    seed: int
    folder: str
    state: str
    reason: str


def variant_rows(plan: Plan) -> Iterator[VariantRow]:
    """Every setting of every variant; a study that varies nothing has a row without one."""
    base = plan.variants[0].variant.settings
    keys = {aspect.name: ", ".join(sorted(aspect.keys)) for aspect in plan.aspects}
    for planned in plan.variants:
        variant = planned.variant
        if not variant.settings:
            yield VariantRow(variant.name, "", "", None, "", differs=False)
        for name, value in variant.settings.items():
            number = float(value) if isinstance(value, int | float) and not isinstance(value, bool) else None
            yield VariantRow(variant.name, name, keys[name], number, shown(value), differs=value != base[name])


def run_rows(runs: Sequence[StudyRun], folder: Path) -> list[RunRow]:
    """Every run with the way to its folder."""
    return [RunRow(r.variant, r.seed, r.folder.relative_to(folder).as_posix(), r.state, r.reason) for r in runs]


def write_table(folder: Path, name: str, columns: Sequence[Column], rows: Sequence[Any]) -> None:
    """Write ``<name>.parquet`` of the rows; NaN, None and empty texts are null.

    Raises
    ------
    DataError : the disk is full or the place cannot be written
    """
    path = folder / f"{name}.parquet"
    with refused_writing(path):
        pq.write_table(table_of(name, columns, rows), path, compression="zstd", write_page_checksum=True)


def write_csv(folder: Path, name: str, columns: Sequence[Column], rows: Sequence[Any]) -> None:
    """Write ``<name>.csv`` of the rows: UTF-8, decimal points, empty where nothing is available.

    Raises
    ------
    DataError : as ``write_table``
    """
    path, table = folder / f"{name}.csv", table_of(name, columns, rows)
    for i, field in enumerate(table.schema):
        if field.type == pa.string():
            table = table.set_column(i, field, pc.replace_substring_regex(table[i], _FORMULA, r"'\1"))
    with refused_writing(path):
        pa_csv.write_csv(table, path, pa_csv.WriteOptions(quoting_style="needed"))


def table_of(name: str, columns: Sequence[Column], rows: Sequence[Any]) -> pa.Table:
    """Rows as an Arrow table."""
    fields = [pa.field(c.name, _TYPES[c.type], metadata={"unit": c.unit, "description": c.meaning}) for c in columns]
    arrays = [pa.array([_null(getattr(row, f.name)) for row in rows], f.type, from_pandas=True) for f in fields]
    return pa.Table.from_arrays(arrays, schema=pa.schema(fields, metadata={"program": "fatigue", "table": name}))


def _null(value: Any) -> Any:
    return None if value == "" else value
