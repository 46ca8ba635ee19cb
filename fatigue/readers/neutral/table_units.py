"""Units that a neutral table states beside the names of its columns, which carry their units already."""

import re
from collections.abc import Iterable

from fatigue.errors import DataError, Problem, refuse
from fatigue.readers.neutral.same_columns import told_once
from fatigue.readers.text.layout import TableLayout

_SUFFIXES = ("s", "mm", "n", "nmm", "hz", "mpa", "km", "deg")
_SPELLINGS = {"sec": "s", "second": "s", "seconds": "s", "sek": "s", "newton": "n", "millimeter": "mm", "°": "deg"}
_ROOTS = ("sqrt(t)", "√t", "√(t)", "t^0.5", "t^(1/2)", "t^1/2", "t½")  # of the mass in t
_COORDINATE = ("mm", *(f"mm{root}" for root in _ROOTS), *(f"{root}mm" for root in _ROOTS))


def column_unit(name: str) -> str:
    """Find the unit in the name of a neutral column, as ``mm`` of ``x_mm``; empty if there is none."""
    suffix = name.strip().rpartition("_")[2]
    return suffix if suffix.lower() in _SUFFIXES and "_" in name else ""


def units_row_warnings(name: str, layout: TableLayout) -> tuple[Problem, ...]:
    """Compare a row of units below the names with the names.

    Returns
    -------
    units that no column name confirms

    Raises
    ------
    DataError : a unit contradicts the name of its column
    """
    stated = zip(layout.names, layout.units, strict=False)
    return checked_units([(f"{name}: column {column.strip()}, row of units", column, unit) for column, unit in stated])


def checked_units(stated: Iterable[tuple[str, str, str]]) -> tuple[Problem, ...]:
    """Compare units with the names of their columns, each given with its place; one mistake of many is told once.

    Returns
    -------
    units that no column name confirms

    Raises
    ------
    DataError : a unit contradicts the name of its column
    """
    found = [stated_unit_problem(where, column, unit) for where, column, unit in stated]
    told = told_once((problem for problem in found if problem is not None), one_by_one=1)
    refuse(DataError, (problem for problem in told if problem.code == "unit"))
    return tuple(told)


def stated_unit_problem(where: str, column: str, unit: str) -> Problem | None:
    """Compare a unit stated for a neutral column with its name: ``unit`` is a contradiction, ``unit_unused`` a warning.

    None where they agree, and for columns of unit loads, whose units are compared with those of the case.
    """
    if re.fullmatch(r"\s*u_[A-Za-z]\w*\s*", column):
        return None
    stated = _plain(unit)
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


def same_unit(one: str, other: str) -> bool:
    """Whether two units are spelled alike, but for brackets, blanks and capital letters.

    >>> same_unit("[kPa]", "kPa"), same_unit("kN", "N")
    (True, False)
    """
    return _plain(one) == _plain(other)


def _plain(unit: str) -> str:
    """The unit in small letters without outer brackets, blanks, signs of multiplication and dots of abbreviations."""
    plain = re.sub(r"[\s*·⋅]|(?<!\d)\.|\.(?!\d)", "", unit.lower().replace("**", "^")).strip("[]<>")
    if plain.count("(") != plain.count(")"):
        plain = plain.strip("()")
    while plain.startswith("(") and plain.endswith(")"):
        plain = plain[1:-1]
    return plain
