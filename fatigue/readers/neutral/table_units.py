"""Units that a neutral table states beside the names of its columns, which carry their units already."""

import re

from fatigue.errors import DataError, Problem, refuse
from fatigue.readers.text.layout import TableLayout

_SUFFIXES = ("s", "mm", "n", "nmm", "hz", "mpa", "km")
_SPELLINGS = {"sec": "s", "second": "s", "seconds": "s", "sek": "s", "newton": "n", "millimeter": "mm"}
_COORDINATE = ("mm", "mm*sqrt(t)", "mm*t^0.5", "sqrt(t)*mm", "t^0.5*mm", "t^0.5mm", "mmsqrt(t)")


def column_unit(name: str) -> str:
    """Find the unit in the name of a neutral column, as ``mm`` of ``x_mm``; empty if there is none."""
    suffix = name.strip().rpartition("_")[2]
    return suffix if suffix.lower() in _SUFFIXES and "_" in name else ""


def units_row_doubts(name: str, layout: TableLayout) -> tuple[Problem, ...]:
    """Compare a row of units below the names with the names.

    Returns
    -------
    units that no column name confirms

    Raises
    ------
    DataError : a unit contradicts the name of its column
    """
    problems: list[Problem] = []
    doubts: list[Problem] = []
    for column, unit in zip(layout.names, layout.units, strict=False):
        doubt = stated_unit_doubt(f"{name}: column {column.strip()}, row of units", column, unit)
        if doubt is not None:
            (problems if doubt.code == "unit" else doubts).append(doubt)
    refuse(DataError, problems)
    return tuple(doubts)


def stated_unit_doubt(where: str, column: str, unit: str) -> Problem | None:
    """Compare a unit stated for a neutral column with its name: ``unit`` contradicts it, ``unit_unused`` is a doubt."""
    stated = re.sub(r"[\s.·]", "", unit.strip("[]()<> ")).lower()
    stated = _SPELLINGS.get(stated, stated)
    own = column_unit(column)
    is_coordinate = re.fullmatch(r"\s*q_-?\d+\s*", column) is not None
    if stated in ("", "-", "1", own.lower()) or (is_coordinate and stated in _COORDINATE):
        return None
    if own or is_coordinate:
        means = own or "mm, or mm*sqrt(t) for modes of unit mass"
        remedy = f"Convert the values to {own or 'the units N, mm, t, s'}, or bring them in by `fatigue convert`"
        return Problem("unit", where, f"the unit is {unit}, and the column is one of {means}", remedy)
    return Problem("unit_unused", where, f"the unit {unit} is not used", "Remove it, or check the values")
