"""Values of Arrow columns as arrays."""

import numpy as np
import pyarrow as pa
import pytest

from fatigue.readers.neutral.column_values import (
    codes_of,
    distinct_texts,
    floats_of,
    holds_names,
    is_number,
    numbers_of_texts,
    seconds_of,
)


@pytest.mark.parametrize(
    ("kind", "dtype"),
    [
        (pa.float16(), np.float64),
        (pa.float32(), np.float32),
        (pa.int64(), np.float64),
        (pa.decimal128(5, 1), np.float64),
    ],
)
def test_floats(kind, dtype):
    """Single precision stays, all else is double; an empty cell is NaN."""
    column = pa.chunked_array([pa.array([np.float16(1) if kind == pa.float16() else 1, None], kind)])
    values = floats_of(column)
    assert values.dtype == dtype
    np.testing.assert_array_equal(values, [1.0, np.nan])


def test_what_is_no_column_of_floats():
    """Texts are none; nothing at all is NaN."""
    assert floats_of(pa.chunked_array([["1.5"]])) is None
    assert np.isnan(floats_of(pa.chunked_array([pa.nulls(2)]))).all()


@pytest.mark.parametrize(("unit", "second"), [("s", 1), ("ms", 10**3), ("us", 10**6), ("ns", 10**9)])
def test_seconds(unit, second):
    """Durations of every resolution; one that is missing is NaN."""
    column = pa.chunked_array([pa.array([3 * second, None], pa.duration(unit))])
    np.testing.assert_array_equal(seconds_of(column), [3.0, np.nan])


def test_whole_numbers_in_texts():
    """Only where all texts are such, coded or not."""
    assert numbers_of_texts(pa.chunked_array([["7", "12"]]).dictionary_encode()).to_pylist() == [7, 12]
    assert numbers_of_texts(pa.chunked_array([["7", "12.5"]])).to_pylist() == ["7", "12.5"]


def test_distinct_texts_over_chunks():
    """Sorted and trimmed, each once; empty cells take the default, also where it stands there already."""
    column = pa.chunked_array([["b", " a", None], ["", "a "]])
    names, code = distinct_texts(column, "b")
    assert names == ("a", "b")
    assert code.tolist() == [1, 0, 1, 1, 0]


def test_codes_that_no_row_has():
    """A name that stands in the dictionary alone is none of the column."""
    coded = pa.DictionaryArray.from_arrays(pa.array([2, None], pa.int32()), ["x", "y", "z"])
    assert codes_of(coded, 9).tolist() == [2, 9]
    assert distinct_texts(pa.chunked_array([coded]), "none")[0] == ("none", "z")


def test_what_can_be_a_name():
    """Texts and whole numbers are names, fractions are not; a number in a text is told from a word."""
    assert holds_names(pa.chunked_array([["a"]]).dictionary_encode())
    assert holds_names(pa.chunked_array([[1]]))
    assert not holds_names(pa.chunked_array([[1.5]]))
    assert [is_number(value) for value in ("1e3", "seam", 5)] == [True, False, False]
