"""What figures are given: tables with the columns they draw, a target, values of rows; or one clear line."""

from collections.abc import Iterable, Sequence, Sized
from numbers import Real
from typing import TypeAlias

import numpy as np
import pandas as pd
import pyarrow as pa
from numpy.typing import ArrayLike

from fatigue.errors import DataError, Problem, refuse

ResultTable: TypeAlias = pd.DataFrame | pa.Table
"""A table of a result as ``pandas.read_parquet`` or ``fatigue.read_table`` reads it."""


def frame_of(table: ResultTable, name: str, columns: Sequence[str], *, empty: bool = False) -> pd.DataFrame:
    """Table as a data frame.

    Parameters
    ----------
    name : of the argument
    columns : that the figure draws
    empty : whether no rows make a figure, too

    Raises
    ------
    DataError : no table, without columns that the figure draws, or without rows
    """
    frame = table.to_pandas() if isinstance(table, pa.Table) else table
    if not isinstance(frame, pd.DataFrame):
        what = f"an object of type {type(table).__name__} is no table"
        raise _refusal(name, what, "Give it as pandas.read_parquet or fatigue.read_table reads it")
    if missing := [column for column in columns if column not in frame.columns]:
        what = f"the table lacks the column{'s' if len(missing) > 1 else ''} {', '.join(missing)}"
        raise _refusal(name, what, "Give the table of the result that the docstring names, with all its columns")
    if not (len(frame) or empty):
        raise _refusal(name, "the table has no rows", "Give at least one")
    return frame


def check_target(target_km: float) -> None:
    """Refuse a target mileage that no logarithmic axis can show."""
    if not (isinstance(target_km, Real) and 0.0 < float(target_km) < np.inf):
        raise _refusal("target_km", f"{target_km!r} is no mileage", "Give kilometres, above 0")


def check_one_each(values: ArrayLike, rows: Sized, name: str) -> None:
    """Refuse values that are not one for each row."""
    shape = np.shape(values)
    if not shape or shape[0] != len(rows):
        given = f"{shape[0]} values" if shape and shape[0] != 1 else "one value"
        raise _refusal(name, f"{given} for {len(rows)} row{'s' if len(rows) != 1 else ''}", "Give one for each row")


def check_known(wanted: Iterable[str], known: Iterable[str], name: str, kind: str) -> None:
    """Refuse what has no entry in a mapping that is given beside the table."""
    there = set(known)
    absent = [each for each in dict.fromkeys(wanted) if each not in there]
    refuse(
        DataError, [Problem("figure", name, f"there is none for {kind} {each!r}", "Give it") for each in absent[:10]]
    )


def check_one_weld(points: pd.DataFrame) -> None:
    """Refuse points of several welds where one line is drawn."""
    if (number := points["weld"].nunique()) > 1:
        what = f"these are points of {number} welds, '{points['weld'].iloc[0]}' the first"
        raise _refusal("points", what, "Give the rows of one weld: nodes[nodes['weld'] == name]")


def check_point(points: pd.DataFrame, point: tuple[int, int, str], name: str) -> None:
    """Refuse a part, order and surface that none of some points has."""
    part, order, surface = point
    if not ((points["part"] == part) & (points["order"] == order) & (points["surface"] == surface)).any():
        what = f"no point has the part, order and surface {point!r}"
        raise _refusal(name, what, "Take them from a row of the points")


def _refusal(name: str, what: str, remedy: str) -> DataError:
    return DataError(Problem("figure", name, what, remedy))
