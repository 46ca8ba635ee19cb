"""Columns of one table as numpy arrays; what is wrong with them is told with file, column, row and value.

A column is read when it is asked for, so a large Parquet file never stands in memory as a whole. Mistakes in the values
are collected and raised together by ``Table.refuse``: until then an array with a mistake in it must not be used. Rows
are counted from 1, the header not included.
"""

import difflib
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.types as pt
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem, refuse
from fatigue.naming import composed
from fatigue.readers.neutral.files import Columns, open_columns, other_format

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
    warnings : unknown columns and other doubts
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
        """Refuse a table without a required column; an unknown column is a doubt, or a mistake where strict."""
        if missing := list(self._missing_columns(required)):
            if (other := other_format(self.path)) is not None and len(missing) == len(required):
                raise DataError(other)
            raise DataError(*self.problems, *missing)
        found_wrong = self.problems if strict else self.warnings
        found_wrong += self._nameless_columns()
        known = (*required, *optional)
        for name in (name for name in self.position if name not in known):
            near = difflib.get_close_matches(name, set(known) - self.position.keys(), n=1)
            remedy = f"Rename it to {near[0]!r}" if near else "Remove it"
            found = Problem("unknown_column", self.where(name), "the column is unknown and not read", remedy)
            found_wrong.append(found)

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
        """Raise everything found so far."""
        refuse(DataError, self.problems)

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

    def integers(self, name: str, *, default: int | None = None) -> NDArray[np.int64]:
        """Whole numbers (r,), exact to the last digit; an empty cell or an absent column takes the default.

        Without a default that is a mistake, as are fractions, what is beyond 64 bits, and what a floating-point column
        may have rounded: beyond 2^53 two neighbouring ids become one there.
        """
        if name in self.position:
            column = _numbers_of_texts(self._column(name))
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
        """Values of a column of integers or decimals; what is no whole number of 64 bits is a mistake."""
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
        """Truth values (r,), true and false or 1 and 0; an empty cell or an absent column takes the default."""
        column = self._column(name) if name in self.position else pa.chunked_array([pa.nulls(self.rows)])
        if pt.is_boolean(column.type):
            return np.array(column.fill_null(default).to_numpy(), dtype=np.bool_)
        if _is_text(column.type):
            words = [text.lower() for text in self.texts(name, default=str(default))]
            values = np.array([{"true": 1, "false": 0}.get(word, np.nan) for word in words])
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
        kind = column.type.value_type if pt.is_dictionary(column.type) else column.type
        if not (_is_text(kind) or pt.is_integer(kind) or pt.is_null(kind)):
            self._mistyped(name, column, "text")
            return ("",), np.zeros(self.rows, dtype=np.int32)
        if not pt.is_dictionary(column.type):
            column = column.cast(pa.string()).dictionary_encode()
        chunks = column.unify_dictionaries().chunks
        stored = [composed(text or "") for text in chunks[0].dictionary.cast(pa.string()).to_pylist()]
        stored.append("")  # position -1 stands for an empty cell
        names, merged = np.unique(np.array([text or default or "" for text in stored], object), return_inverse=True)
        places = [codes_of(chunk, len(stored) - 1) for chunk in chunks]
        place = places[0] if len(places) == 1 else np.concatenate(places)
        used = np.zeros(names.size, dtype=np.bool_)
        used[merged[np.bincount(place, minlength=len(stored)) > 0]] = True
        code = (np.cumsum(used, dtype=np.int32) - 1)[merged][place]
        if names[0] == "" and used[0] and default is None:
            self.report(code == 0, "missing_value", name, "the text is missing", "Give a text")
        return tuple(names[used]), code

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

    def _nameless_columns(self) -> Iterator[Problem]:
        """Tell columns without a name that hold something; spreadsheets write empty ones, which are nothing."""
        for position, name in enumerate(self.columns.names):
            if composed(name) or not self.rows:
                continue
            column = self.columns.read(position)
            filled = [value for value in column.to_pylist() if value is not None and str(value).strip()]
            if filled:
                where = f"{self.path.name}: column {position + 1}"
                what = f"the column has no name and is not read, it holds {str(filled[0])[:30]!r}"
                yield Problem("unknown_column", where, what, "Give it a name, or remove it")

    def _missing_columns(self, required: Collection[str]) -> Iterator[Problem]:
        present = ", ".join(name for name in self.position if name)
        for name in required:
            if name not in self.position:
                yield Problem(
                    "missing_column", self.where(name), "the column is missing", f"Add it; the columns are {present}"
                )

    def _column(self, name: str) -> pa.ChunkedArray:
        return self.columns.read(self.position[name])

    def _floats(self, name: str) -> NDArray[Any]:
        """Values of a column as floating-point numbers, empty cells and an absent column as NaN."""
        column = self._column(name) if name in self.position else None
        if column is None or pt.is_null(column.type):
            return np.full(self.rows, np.nan)
        if pt.is_decimal(column.type) or pt.is_integer(column.type):
            return np.asarray(column.cast(pa.float64(), safe=False).to_numpy())  # beyond 2^53 rounded
        if pt.is_floating(column.type):
            values = np.asarray(column.to_numpy())
            return values.astype(np.float64) if values.dtype == np.float16 else values
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
        wrong = (row for row, value in enumerate(values) if value is not None and not _is_number(value))
        row = next(wrong, 0)
        self.problems.append(
            Problem("bad_type", self.where(name, row), f"{values[row]!r} is not {wanted}", f"Give {wanted}")
        )
        self.spoilt.add(name)


def open_table(path: Path, *, texts: Collection[str] = ()) -> Table:
    """Open a table; ``texts`` are the columns of names, which stay texts even where they look like numbers."""
    return named(path, open_columns(path, texts))


def named(path: Path, columns: Columns) -> Table:
    """Make a table of columns that are open; two of one name are refused."""
    position: dict[str, int] = {}
    problems = [
        Problem("duplicate_column", f"{path.name}: column {name}", "the column appears twice", "Remove one of them")
        for i, stored in enumerate(columns.names)
        if (name := composed(stored)) and position.setdefault(name, i) != i
    ]
    refuse(DataError, problems)
    return Table(path, columns, position, warnings=list(columns.doubts))


def seconds_of(durations: pa.ChunkedArray) -> NDArray[np.float64]:
    """Durations in seconds (r,), NaN where one is missing."""
    ticks = {"s": 1, "ms": 10**3, "us": 10**6, "ns": 10**9}[durations.type.unit]
    return np.asarray(durations.cast(pa.int64()).to_numpy()).astype(np.float64) / ticks


def codes_of(texts: pa.DictionaryArray, missing: int) -> NDArray[np.integer]:
    """Codes of a coded column (r,), those of empty cells ``missing``."""
    codes = texts.indices if texts.null_count == 0 else texts.indices.fill_null(missing)
    return np.asarray(codes.to_numpy())


def _numbers_of_texts(column: pa.ChunkedArray) -> pa.ChunkedArray:
    """Whole numbers of a column whose texts are all such, as ids are that a program keeps as texts; else the column."""
    if pt.is_dictionary(column.type):
        column = column.cast(column.type.value_type)
    if not _is_text(column.type):
        return column
    try:
        return column.cast(pa.int64())
    except pa.ArrowException:
        return column


def _is_text(kind: pa.DataType) -> bool:
    return bool(pt.is_string(kind) or pt.is_large_string(kind) or pt.is_string_view(kind))


def _is_number(value: object) -> bool:
    """Whether a value is a text that Arrow reads as a number."""
    try:
        pa.scalar(value, pa.string()).cast(pa.float64())
    except (pa.ArrowException, TypeError):
        return False
    return True


def _first(values: NDArray[Any], bad: NDArray[np.bool_]) -> float:
    """First marked value, for a message; any value where nothing is marked."""
    return float(values[bad.argmax()])
