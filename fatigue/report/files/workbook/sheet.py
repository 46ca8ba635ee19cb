"""One table as a sheet: heads that carry the unit once, numbers as numbers, a colour where a limit is near."""

from collections.abc import Iterable, Iterator, Sequence

import numpy as np
import pandas as pd

from fatigue.report.wording import LONGEST
from fatigue.results import Column

HIGH = 0.75  # utilisation that is coloured as near the limit
FORMATS = {
    "head": {"bold": True, "bottom": 1, "text_wrap": True, "valign": "top"},
    "text": {"num_format": "@"},
    "whole": {"num_format": "0"},
    "plain": {"num_format": "0.000"},
    "tenths": {"num_format": "0.0"},
    "large": {"num_format": "#,##0"},
    "years": {"num_format": "#,##0.0"},
    "small": {"num_format": "0.000E+00"},
    "missed": {"font_color": "#9C0006", "bg_color": "#FFC7CE", "bold": True},
    "near": {"font_color": "#7F6000", "bg_color": "#FFEB9C"},
    "title": {"bold": True, "font_size": 16},
    "met": {"bold": True, "font_size": 14, "font_color": "#0B5C8A"},
    "verdict": {"bold": True, "font_size": 14, "font_color": "#9C0006", "bg_color": "#FFC7CE"},
    "label": {"font_color": "#5C6773", "valign": "top"},
    "wrapped": {"text_wrap": True, "valign": "top", "align": "left"},
}
_BY_UNIT = {"km": "large", "a": "years", "1/km": "small", "mm": "tenths", "MPa": "tenths", "1": "plain"}
_TOKENS = {  # how a unit stands in the name of a column
    "km": ["km"],
    "a": ["years"],
    "MPa": ["MPa"],
    "mm": ["mm"],
    "s": ["s"],
    "Hz": ["hz"],
    "m": ["m"],
    "deg": ["deg"],
    "1/km": ["per", "km"],
    "1/s": ["per", "s"],
    "m/s2": ["m", "s2"],
}
_LEADING = ("weld", "part", "node", "order", "surface", "utilisation", "life_km", "life_years", "load_factor")


def heading(column: Column) -> tuple[str, str]:
    """Head of a column in words, and its unit, which is not in the words once more; none for pure numbers.

    >>> heading(Column("life_km_dirlik", "float", "km", ""))
    ('life dirlik', 'km')
    """
    tokens, unit = column.name.split("_"), _TOKENS.get(column.unit, [])
    for at in range(1, len(tokens) - len(unit) + 1 if unit else 0):  # never the first: a column has a name
        if tokens[at : at + len(unit)] == unit:
            tokens = tokens[:at] + tokens[at + len(unit) :]
            break
    words = " ".join(tokens)
    return words, "" if words == column.unit else {"-": "", "a": "years"}.get(column.unit, column.unit)


def leading(columns: Sequence[Column]) -> tuple[Column, ...]:
    """The same columns, those first that say which point it is and whether it lives."""
    first = [column for name in _LEADING for column in columns if column.name == name]
    return (*first, *(column for column in columns if column not in first))


def write_sheet(sheet, pieces: Iterable[pd.DataFrame], columns: Sequence[Column], formats) -> None:  # type: ignore[no-untyped-def]
    """Write a table to a worksheet of xlsxwriter; its rows come in pieces, in their order."""
    for i, column in enumerate(columns):
        words, unit = heading(column)
        sheet.write_string(0, i, f"{words}\n[{unit}]" if unit else words, formats["head"])
        sheet.set_column(i, i, 24 if column.type == "text" else 13)
    looks = [formats[_look(column)] for column in columns]
    row = 0
    for row, values in enumerate(_rows(pieces, columns), start=1):
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
    for i, column in enumerate(columns):
        for rule in _colours(column, formats) if row else ():
            sheet.conditional_format(1, i, row, i, rule)


def _colours(column: Column, formats) -> list[dict[str, object]]:  # type: ignore[no-untyped-def]
    """Rules of colour: a utilisation above 1 and one from 0.75, and a target that is missed; empty cells have none."""
    if column.name == "fulfilled":
        return [{"type": "cell", "criteria": "==", "value": "FALSE", "format": formats["missed"]}]
    if column.name != "utilisation":
        return []
    return [
        {"type": "blanks", "stop_if_true": True, "format": None},
        {"type": "cell", "criteria": ">", "value": 1, "format": formats["missed"], "stop_if_true": True},
        {"type": "cell", "criteria": ">=", "value": HIGH, "format": formats["near"]},
    ]


def _rows(pieces: Iterable[pd.DataFrame], columns: Sequence[Column]) -> Iterator[tuple[str | bool | float | None, ...]]:
    """Cells of a table row by row."""
    for frame in pieces:
        yield from zip(*(_cells(frame[column.name], column) for column in columns), strict=True)


def _cells(values: "pd.Series", column: Column) -> list[str | bool | float | None]:
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
    return _BY_UNIT.get(column.unit, "plain")
