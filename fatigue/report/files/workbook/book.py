"""A result as a workbook: cover with the verdict, hot spots, welds and points by utilisation, what columns mean."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from fatigue.errors import DataError, Problem, given_path
from fatigue.files.extras import install_command
from fatigue.files.mishaps import cannot_write, refused_writing
from fatigue.report.files.workbook.cover import write_cover
from fatigue.report.files.workbook.sheet import FORMATS, heading, leading, write_sheet
from fatigue.report.hot_spots.of_result import HOT_SPOTS, NEEDED, hot_spots
from fatigue.results import (
    ASSESSED,
    TABLES,
    WORKBOOK,
    Column,
    assessed,
    enlist,
    read_provenance,
    read_table,
    read_welds,
    row_count,
)
from fatigue.results.belonging import MARK
from fatigue.results.provenance import curves_of_status
from fatigue.results.tables import table_path

_MOST_ROWS = 1_048_575  # of an Excel sheet, below its header
_AT_ONCE = 20_000  # rows as Python objects
_SHEETS = ("welds", "nodes", "band", "sensitivity", "checks")  # tables of the workbook, those of them that a result has
_ABOUT = {
    "hot spots": "connected stretches of high damage with their worst points, worst first",
    "welds": "the register, by utilisation; welds that are not assessed at its end",
    "nodes": "every point, by utilisation",
    "band": "how far another record would move each life, and what a share of all reaches",
    "sensitivity": "utilisation of every weld with one assumption changed at a time",
    "checks": "what is checked beside the normal stress at the toe",
    "columns": "name, unit and meaning of every column",
}
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
    """Write ``nodes.xlsx``: a cover with the verdict, hot spots, welds, all points, and what every column means.

    Rows stand by their utilisation, which is coloured from 0.75 and above 1. Headers are frozen and carry the unit
    once, columns can be filtered, numbers are numbers, and texts that begin with an equals sign stay texts. An infinite
    life is written as "> 1e+12"; what is not available is empty. The hash of the result is a property of the workbook.
    A sheet of welds, sensitivity or checks that would be too long says so in place of its rows. ``into`` is another
    folder to write to, where it is not listed as a document of the result.

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
        formats = {name: book.add_format(look) for name, look in FORMATS.items()}
        tables = [name for name in _SHEETS if name in ASSESSED or table_path(folder, name).exists()]
        columns = {"hot spots": HOT_SPOTS} | {name: leading(TABLES[name]) for name in tables}
        about = {name: words for name, words in _ABOUT.items() if name in columns or name == "columns"}
        write_cover(book.add_worksheet("verdict"), record, _title(record), read_welds(folder), about, formats)
        write_sheet(book.add_worksheet("hot spots"), [_hot_spots(folder)], HOT_SPOTS, formats)
        for name in tables:
            sheet, rows = book.add_worksheet(name), row_count(folder, name)
            if rows > _MOST_ROWS:
                sheet.write_string(0, 0, f"{rows} rows do not fit into a sheet: use {name}.parquet or CSV")
            else:
                write_sheet(sheet, _by_utilisation(folder, name), columns[name], formats)
        _write_meanings(book.add_worksheet("columns"), columns, formats)
    if into is None:
        enlist(folder, path)
    return path


def _hot_spots(folder: Path) -> pd.DataFrame:
    """All hot spots of a result."""
    return hot_spots(read_table(folder, "nodes", NEEDED).to_pandas(), assessed(read_welds(folder))).table


def _by_utilisation(folder: Path, name: str) -> Iterator[pd.DataFrame]:
    """Rows of a table in pieces, the largest utilisation first and none last; in its own order where it has none."""
    table = read_table(folder, name).combine_chunks()
    order = np.arange(table.num_rows)
    if "utilisation" in table.column_names:
        order = np.argsort(-table["utilisation"].to_numpy(zero_copy_only=False).astype(float), kind="stable")
    for start in range(0, table.num_rows, _AT_ONCE):
        yield table.take(order[start : start + _AT_ONCE]).to_pandas()


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


def _write_meanings(sheet, tables: Mapping[str, Sequence[Column]], formats) -> None:  # type: ignore[no-untyped-def]
    heads = (("sheet", 12), ("header", 34), ("name in the tables", 30), ("unit", 14), ("meaning", 100))
    for i, (name, width) in enumerate(heads):
        sheet.write_string(0, i, name, formats["head"])
        sheet.set_column(i, i, width)
    row = 1
    for table, columns in tables.items():
        for column in columns:
            words, _ = heading(column)
            for i, text in enumerate((table, words, column.name, column.unit, column.meaning)):
                sheet.write_string(row, i, text)
            row += 1
    sheet.freeze_panes(1, 0)
