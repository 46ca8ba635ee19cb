"""The tables of a result in formats that people open: an Excel workbook, and CSV files."""

from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pyarrow as pa

from fatigue.errors import DataError, Problem, given_path
from fatigue.files.extras import install_command
from fatigue.files.mishaps import cannot_write, refused_writing
from fatigue.report.wording import LONGEST
from fatigue.results import (
    ASSESSED,
    CSV_TABLES,
    TABLES,
    WORKBOOK,
    Column,
    enlist,
    read_provenance,
    row_count,
    row_groups,
)
from fatigue.results.belonging import MARK
from fatigue.results.provenance import curves_of_status
from fatigue.results.tables import table_path

_MOST_ROWS = 1_048_575  # of an Excel sheet, below its header
_SHEETS = ("nodes", "welds", "band", "sensitivity", "checks")  # tables of the workbook, those of them that a result has
_FIXED_DATE = (1980, 1, 1)  # the same result gives the same bytes


def refuse_without_xlsxwriter() -> None:
    """Refuse to write a workbook where the package for it is not installed.

    Raises
    ------
    DataError : the package xlsxwriter is not installed
    """
    try:
        import xlsxwriter  # noqa: F401, PLC0415  (an optional extra)
    except ImportError:
        raise DataError(
            Problem(
                "no_xlsxwriter",
                WORKBOOK,
                "writing a workbook needs the package xlsxwriter",
                f"Run: {install_command('xlsxwriter')}, or write CSV",
            )
        ) from None


def write_xlsx(folder: Path | str, into: Path | None = None) -> Path:
    """Write ``nodes.xlsx``: all points, welds, sensitivity and checks where they are, and what every column means.

    Headers are frozen and carry the unit, columns can be filtered, numbers are numbers, and texts that begin with an
    equals sign stay texts. An infinite life is written as "> 1e+12"; what is not available is empty. The hash of the
    result is a property of the workbook. A sheet of welds, sensitivity or checks that would be too long says so in
    place of its rows. ``into`` is another folder to write to, where it is not listed as a document of the result.

    Raises
    ------
    DataError : the package xlsxwriter is not installed, no finished result, or more points than a sheet holds
    """
    refuse_without_xlsxwriter()
    import xlsxwriter  # noqa: PLC0415

    folder = given_path(folder, "folder")
    record = read_provenance(folder)
    points = row_count(folder, "nodes")
    if points > _MOST_ROWS:
        raise DataError(
            Problem(
                "too_many_rows",
                WORKBOOK,
                f"{points} points do not fit into a sheet of {_MOST_ROWS} rows",
                "Use nodes.parquet or CSV",
            )
        )
    path = (into or folder) / WORKBOOK
    options = {
        "constant_memory": True,
        "strings_to_formulas": False,
        "strings_to_urls": False,
        "strings_to_numbers": False,
        "tmpdir": str(path.parent),
    }
    with _writing_xlsx(path), xlsxwriter.Workbook(str(path), options) as book:
        book.set_properties({"title": _title(record), "created": pd.Timestamp(*_FIXED_DATE).to_pydatetime()})
        if "result" in record:
            book.set_custom_property(MARK, record["result"])
        formats = {name: book.add_format(look) for name, look in _FORMATS.items()}
        names = [name for name in _SHEETS if name in ASSESSED or table_path(folder, name).exists()]
        for name in names:
            sheet, rows = book.add_worksheet(name), row_count(folder, name)
            if rows > _MOST_ROWS:
                sheet.write_string(0, 0, f"{rows} rows do not fit into a sheet: use {name}.parquet or CSV")
            else:
                _write_sheet(sheet, row_groups(folder, name), TABLES[name], formats)
        _write_meanings(book.add_worksheet("columns"), names, formats)
    if into is None:
        enlist(folder, path)
    return path


def _title(record: Mapping[str, Any]) -> str:
    """Title of a result, which says so where it rests on unverified curves."""
    return f"{record['title']} (unverified curves)" if curves_of_status(record, "unverified") else str(record["title"])


@contextmanager
def _writing_xlsx(path: Path) -> Iterator[None]:
    """Tell why a workbook cannot be written, also where its package wraps what the system says."""
    from xlsxwriter.exceptions import FileCreateError  # noqa: PLC0415

    try:
        with refused_writing(path):
            yield
    except FileCreateError as error:
        said = next((cause for cause in error.args if isinstance(cause, OSError)), OSError(str(error)))
        raise cannot_write(path, said) from error


_FORMATS = {
    "head": {"bold": True, "bottom": 1, "text_wrap": True, "valign": "top"},
    "text": {"num_format": "@"},
    "whole": {"num_format": "0"},
    "plain": {"num_format": "0.000"},
    "large": {"num_format": "#,##0"},
    "small": {"num_format": "0.000E+00"},
    "missed": {"font_color": "#B3261E", "bold": True},
}
_LARGE = {  # lives, of which whole kilometres are enough
    column.name for table in _SHEETS for column in TABLES[table] if "life" in column.name and column.unit in ("km", "a")
}


def _write_sheet(sheet, groups: Iterable[pa.Table], columns: tuple[Column, ...], formats) -> None:  # type: ignore[no-untyped-def]
    for i, column in enumerate(columns):
        unit = f"\n[{column.unit}]" if column.unit != "-" else ""
        sheet.write_string(0, i, f"{column.name}{unit}", formats["head"])
        sheet.set_column(i, i, 24 if column.type == "text" else 13)
    looks = [formats[_look(column)] for column in columns]
    row = 0
    for row, values in enumerate(_rows(groups, columns), start=1):
        for i, value in enumerate(values):
            if value is None:
                continue
            write = (
                sheet.write_string
                if isinstance(value, str)
                else sheet.write_boolean
                if isinstance(value, bool)
                else sheet.write_number
            )
            write(row, i, value, looks[i])
    sheet.freeze_panes(1, 1)
    sheet.autofilter(0, 0, row, len(columns) - 1)


def _rows(groups: Iterable[pa.Table], columns: tuple[Column, ...]) -> Iterator[tuple[str | bool | float | None, ...]]:
    """Cells of a table row by row, from its row groups."""
    for group in groups:
        frame = group.to_pandas()
        yield from zip(*(_cells(frame[column.name], column) for column in columns), strict=True)


def _cells(values: pd.Series, column: Column) -> list[str | bool | float | None]:
    """Values of a column as a sheet takes them; None leaves a cell empty."""
    if column.type == "text":
        return [None if pd.isna(v) else str(v) for v in values]
    if column.type == "flag":
        return [None if pd.isna(v) else bool(v) for v in values]
    numbers = values.to_numpy(dtype=np.float64, na_value=np.nan)
    return [f"> {LONGEST:g}" if v == np.inf else float(v) if np.isfinite(v) else None for v in numbers]


def _look(column: Column) -> str:
    if column.type != "float":
        return {"text": "text", "int": "whole", "flag": "text"}[column.type]
    return "large" if column.name in _LARGE else "small" if column.name == "damage_per_km" else "plain"


def _write_meanings(sheet, tables: Iterable[str], formats) -> None:  # type: ignore[no-untyped-def]
    for i, (name, width) in enumerate((("table", 12), ("column", 30), ("unit", 14), ("meaning", 100))):
        sheet.write_string(0, i, name, formats["head"])
        sheet.set_column(i, i, width)
    row = 1
    for table in tables:
        for column in TABLES[table]:
            for i, words in enumerate((table, column.name, column.unit, column.meaning)):
                sheet.write_string(row, i, words)
            row += 1
    sheet.freeze_panes(1, 0)


def write_csv(folder: Path | str, into: Path | None = None) -> list[Path]:
    """Write tables of points, events, cycles, welds and, where they are, ranges, load spectra, bench programmes as CSV.

    They are UTF-8 with decimal points. Infinite lives are written as ``inf``, what is not available is empty. A text
    that a spreadsheet would take for a formula gets an apostrophe before it. ``into`` is another folder to write to,
    where they are not listed as documents of the result.

    Raises
    ------
    DataError : no finished result in the folder
    """
    folder = given_path(folder, "folder")
    read_provenance(folder)
    paths = []
    for name in CSV_TABLES:
        if name not in ASSESSED and not table_path(folder, name).exists():
            continue
        texts = [column.name for column in TABLES[name] if column.type == "text"]
        paths.append((into or folder) / f"{name}.csv")
        with refused_writing(paths[-1]), paths[-1].open("w", encoding="utf-8", newline="") as file:
            for number, group in enumerate(row_groups(folder, name)):
                frame = group.to_pandas(types_mapper={pa.int64(): pd.Int64Dtype()}.get)  # "33", not "33.0", beside none
                for text in texts:
                    frame[text] = frame[text].map(_harmless, na_action="ignore")
                frame.to_csv(file, index=False, header=number == 0, lineterminator="\n")
    if into is None:
        enlist(folder, *paths)
    return paths


def _harmless(text: str) -> str:
    return f"'{text}" if text.startswith(("=", "+", "-", "@", "\t", "\r")) else text
