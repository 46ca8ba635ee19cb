"""Columns of one table as numpy arrays; what is wrong with them is told with file, column, row and value.

A column is read when it is asked for, so a large Parquet file never stands in memory as a whole. Mistakes in the values
are collected and raised together by ``Table.refuse``: until then an array with a mistake in it must not be used. Rows
are counted from 1, the header not included.
"""

import difflib
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.types as pt
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem, refuse
from fatigue.readers.neutral.column_names import missing_columns, nameless_columns, positions_of, unknown_columns
from fatigue.readers.neutral.column_values import (
    distinct_texts,
    floats_of,
    holds_names,
    is_number,
    is_text,
    numbers_of_texts,
    seconds_of,
)
from fatigue.readers.neutral.columns import Columns
from fatigue.readers.neutral.files import open_columns, other_format
from fatigue.readers.neutral.same_columns import told_once
from fatigue.readers.neutral.table_units import checked_units
from fatigue.readers.text.flags import WORDS_OF_PROGRAMS, flag_of

LARGEST = 2**63 - 1  # id
MOST_GUESSES = 20  # at what an unknown text was meant to be: each compares it with all that are known


@dataclass(frozen=True, slots=True, eq=False)
class Table:
    """An open table of the neutral format.

    Attributes
    ----------
    path : the file
    columns : its columns
    position : where each column stands, by its trimmed name
    problems : mistakes found so far
    warnings : unknown columns and others
    spoilt : columns with a mistake in their values, from which nothing more is concluded
    """

    path: Path
    columns: Columns
    position: dict[str, int]
    problems: list[Problem] = field(default_factory=list)
    warnings: list[Problem] = field(default_factory=list)
    spoilt: set[str] = field(default_factory=set)

    @property
    def rows(self) -> int:
        """Number of rows."""
        return self.columns.rows

    def expect(self, required: Collection[str], optional: Collection[str], *, strict: bool) -> None:
        """Refuse a table without a required column; an unknown column is a warning, or a mistake where strict."""
        file = self.path.name
        if missing := list(missing_columns(file, self.position, required)):
            if (other := other_format(self.path)) is not None and len(missing) == len(required):
                raise DataError(other)
            raise DataError(*told_once((*self.problems, *missing)))
        found = self.problems if strict else self.warnings
        found += told_once(
            (*nameless_columns(file, self.columns), *unknown_columns(file, self.position, (*required, *optional)))
        )

    def where(self, column: str, row: int | None = None) -> str:
        """Name a place in the file; ``row`` is an index from 0."""
        place = f"{self.path.name}: column {column}"
        return place if row is None else f"{place}, {self.row_name(row)}"

    def row_name(self, row: int) -> str:
        """Name a row as counted in the file, from 1."""
        number = row if self.columns.numbers is None else int(self.columns.numbers[row])
        return f"row {number + 1}"

    def single_precision(self, names: Collection[str]) -> bool:
        """Whether every one of these columns is stored as float32."""
        return all(self.columns.kinds[self.position[name]] == pa.float32() for name in names)

    def report(self, bad: NDArray[np.bool_], code: str, column: str, what: str, remedy: str) -> None:
        """Note a mistake at the first row marked in ``bad``, with the number of further rows; one for each column."""
        if column in self.spoilt or not bad.any():
            return
        row, more = int(bad.argmax()), int(np.count_nonzero(bad)) - 1
        also = f" (and {more} more row{'s' if more > 1 else ''})" if more else ""
        self.problems.append(Problem(code, self.where(column, row), what + also, remedy))
        self.spoilt.add(column)

    def refuse(self) -> None:
        """Raise everything found so far; what is the same in many columns is told once."""
        refuse(DataError, told_once(self.problems))

    def numbers(
        self, name: str, *, default: float | None = None, least: float | None = None, above: float | None = None
    ) -> NDArray[Any]:
        """Numbers (r,), float32 where the file has float32, else float64.

        An empty cell or an absent column takes the default; without a default it is a mistake, as is an infinity.
        """
        values = self._floats(name)
        if default is not None:
            values = np.where(np.isnan(values), values.dtype.type(default), values)
        if not np.isfinite(values).all():
            missing, infinite = np.isnan(values) & (default is None), np.isinf(values)
            self.report(missing, "missing_value", name, "the value is missing or NaN", "Give a number")
            self.report(
                infinite, "bad_value", name, f"{_first(values, infinite)} is not finite", "Give a finite number"
            )
        if least is not None:
            low = values < least
            self.report(
                low, "bad_value", name, f"{_first(values, low):g} is below {least:g}", f"Give at least {least:g}"
            )
        if above is not None:
            low = values <= above
            self.report(
                low, "bad_value", name, f"{_first(values, low):g} is not above {above:g}", f"Give more than {above:g}"
            )
        return values

    def samples(self, name: str) -> NDArray[np.float64]:
        """Samples (r,) of a measured channel as they are: an empty cell is NaN, and an infinity is no mistake."""
        return self._floats(name).astype(np.float64)

    def integers(self, name: str, *, default: int | None = None) -> NDArray[np.int64]:
        """Whole numbers (r,), exact to the last digit; an empty cell or an absent column takes the default.

        Without a default an empty cell is a mistake. So are fractions, numbers beyond 64 bits, and numbers that a
        floating-point column may have rounded: beyond 2^53 two neighbouring ids become one there.
        """
        if name in self.position:
            column = numbers_of_texts(self._column(name))
            if pt.is_integer(column.type) or pt.is_decimal(column.type):
                return self._exact(name, column, default)
        values = self.numbers(name, default=default)
        broken = np.isfinite(values) & (values != np.rint(values))
        self.report(broken, "bad_value", name, f"{_first(values, broken)} is not a whole number", "Give a whole number")
        inexact = np.isfinite(values) & (np.abs(values) >= 2.0 ** (np.finfo(values.dtype).nmant + 1))
        what = f"{_first(values, inexact):.0f} is too large for a floating-point column to hold exactly"
        self.report(inexact, "bad_value", name, what, f"Store whole numbers up to {LARGEST} without point and exponent")
        return np.where(np.isfinite(values) & ~inexact, values, 0).astype(np.int64)

    def _exact(self, name: str, column: pa.ChunkedArray, default: int | None) -> NDArray[np.int64]:
        """Values of a column of integers or decimals; any that is no whole number of 64 bits is a mistake."""
        missing = np.asarray(column.is_null().to_numpy()) if column.null_count else np.zeros(self.rows, np.bool_)
        if default is None:
            self.report(missing, "missing_value", name, "the value is missing or NaN", "Give a number")
        try:
            whole = column.cast(pa.int64())
        except pa.ArrowException:
            values = [0 if value is None else value for value in column.to_pylist()]
            broken = np.array([value != int(value) for value in values])
            what = f"{values[broken.argmax()]} is not a whole number"
            self.report(broken, "bad_value", name, what, "Give a whole number")
            large = np.array([abs(value) > LARGEST for value in values])
            what = f"{values[large.argmax()]} is beyond the largest id, {LARGEST}"
            self.report(large, "bad_value", name, what, "Number anew")
            return np.zeros(self.rows, np.int64)
        if whole.null_count:
            whole = whole.fill_null(default or 0)
        return np.asarray(whole.to_numpy())

    def flags(self, name: str, *, default: bool) -> NDArray[np.bool_]:
        """Flags (r,), written true and false or 1 and 0; an empty cell or an absent column takes the default."""
        column = self._column(name) if name in self.position else pa.chunked_array([pa.nulls(self.rows)])
        if pt.is_boolean(column.type):
            return np.array(column.fill_null(default).to_numpy(), dtype=np.bool_)
        if is_text(column.type):
            said = [flag_of(text, WORDS_OF_PROGRAMS) for text in self.texts(name, default=str(default))]
            values = np.array([np.nan if flag is None else flag for flag in said])
        else:
            values = self.numbers(name, default=default)
        wrong = ~np.isin(values, [0, 1])
        if wrong.any():
            self.report(wrong, "bad_value", name, f"{column[int(wrong.argmax())]} is not a flag", "Give true or false")
        return np.array(values == 1, dtype=np.bool_)

    def texts(self, name: str, *, default: str | None = None) -> list[str]:
        """Trimmed texts (r,); an empty cell or an absent column takes the default, without one it is a mistake."""
        names, code = self.groups(name, default=default)
        return [names[i] for i in code]

    def groups(self, name: str, *, default: str | None = None) -> tuple[tuple[str, ...], NDArray[np.int32]]:
        """Distinct texts of a column in sorted order, and which of them each row holds (r,)."""
        if name not in self.position:
            return (default or "",), np.zeros(self.rows, dtype=np.int32)
        column = self._column(name)
        if not holds_names(column):
            self._mistyped(name, column, "text")
            return ("",), np.zeros(self.rows, dtype=np.int32)
        names, code = distinct_texts(column, default or "")
        if names and names[0] == "" and default is None:
            self.report(code == 0, "missing_value", name, "the text is missing", "Give a text")
        return names, code

    def choices(self, name: str, values: Sequence[str], allowed: Sequence[str]) -> None:
        """Note a text that is none of the allowed ones."""
        wrong = ~np.isin(values, allowed)
        what = f"{values[int(wrong.argmax())]!r} is not one of {', '.join(allowed)}"
        self.report(wrong, "bad_value", name, what, f"Give one of {', '.join(allowed)}")

    def known(
        self, name: str, names: Sequence[str], code: NDArray[np.int32], allowed: Collection[str], of: str
    ) -> None:
        """Note every text of ``groups`` that another table does not have."""
        unknown = [(i, text) for i, text in enumerate(names) if text and text not in allowed]
        for count, (i, text) in enumerate(unknown):
            near = difflib.get_close_matches(text, allowed, n=1) if count < MOST_GUESSES else []
            remedy = f"Write {near[0]!r}" if near else f"Add it to {of} or remove its rows"
            where = self.where(name, int((code == i).argmax()))
            self.problems.append(Problem("unknown_id", where, f"{text!r} is not one of {of}", remedy))

    def complete(self, name: str, names: Sequence[str], wanted: Sequence[str], of: str) -> None:
        """Note every wanted text that no row has."""
        present = set(names)
        for text in wanted:
            if text not in present and name not in self.spoilt:
                self.problems.append(
                    Problem("missing_id", self.where(name), f"{name} {text!r} has no {of}", f"Add its {of}")
                )

    def unique(
        self, keys: Mapping[str, NDArray[np.integer]], labels: Mapping[str, Sequence[str]] | None = None
    ) -> None:
        """Note rows that repeat a key; ``labels`` are the texts behind a column of ``groups``."""
        if not self.spoilt.isdisjoint(keys):
            return
        columns = tuple(keys.values())
        order = np.lexsort(columns[::-1])
        same = np.all([column[order[1:]] == column[order[:-1]] for column in columns], axis=0)
        if not same.any():
            return
        again = int(np.flatnonzero(same)[np.argmin(order[1:][same])])
        row, first = order[again + 1], order[again]
        text = labels or {}
        key = ", ".join(f"{name} {text[name][k[row]] if name in text else k[row]}" for name, k in keys.items())
        self.problems.append(
            Problem(
                "duplicate",
                self.where(", ".join(keys), row),
                f"{key} repeats {self.row_name(first)}",
                "Keep one of the rows",
            )
        )

    def _column(self, name: str) -> pa.ChunkedArray:
        return self.columns.read(self.position[name])

    def _floats(self, name: str) -> NDArray[Any]:
        """Values of a column as floating-point numbers, empty cells and an absent column as NaN."""
        if name not in self.position:
            return np.full(self.rows, np.nan)
        column = self._column(name)
        if (values := floats_of(column)) is not None:
            return values
        if pt.is_temporal(column.type) and name.endswith("_s"):
            return self._seconds(name, column)
        self._mistyped(name, column, "a number")
        return np.zeros(self.rows)

    def _seconds(self, name: str, column: pa.ChunkedArray) -> NDArray[Any]:
        """Values of a column of durations [s]; dates and times of day are a mistake."""
        if pt.is_duration(column.type):
            return seconds_of(column)
        what = f"the column holds dates or times of day, as {column[0].as_py()}, where seconds are needed"
        remedy = "Give seconds from the start of the run"
        self.problems.append(Problem("date_column", self.where(name), what, remedy))
        self.spoilt.add(name)
        return np.zeros(self.rows)

    def _mistyped(self, name: str, column: pa.ChunkedArray, wanted: str) -> None:
        """Note the first value of the wrong kind; in a column of texts the first that could not be a number."""
        values = column.to_pylist()
        wrong = (row for row, value in enumerate(values) if value is not None and not is_number(value))
        row = next(wrong, 0)
        self.problems.append(
            Problem("bad_type", self.where(name, row), f"{values[row]!r} is not {wanted}", f"Give {wanted}")
        )
        self.spoilt.add(name)


def open_table(path: Path, *, texts: Collection[str] = ()) -> Table:
    """Open a table; ``texts`` are the columns of names, which stay texts even where they look like numbers."""
    return named(path, open_columns(path, texts))


def named(path: Path, columns: Columns) -> Table:
    """Make a table of columns that are open; two of one name are refused, and units that contradict the names."""
    table = Table(path, columns, positions_of(path.name, columns), warnings=list(columns.warnings))
    stated = ((name, unit) for name, unit in zip(columns.names, columns.units, strict=False) if unit)
    of_file = checked_units((table.where(name.strip()), name, unit) for name, unit in stated)
    table.warnings.extend(of_file)
    return table


def _first(values: NDArray[Any], bad: NDArray[np.bool_]) -> float:
    """First marked value, for a message; any value where nothing is marked."""
    return float(values[bad.argmax()])
