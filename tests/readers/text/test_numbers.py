"""Numbers as programs of several countries and decades write them."""

import pyarrow as pa
import pytest

from fatigue.readers.text.numbers import as_numbers, is_gap, is_number, plain_number, split_fields, written_apart


@pytest.mark.parametrize(
    ("text", "decimal", "value"),
    [
        ("1.5D+03", ".", 1500.0),
        ("1.0+103", ".", 1e103),
        ("-.5", ".", -0.5),
        ("\u22122,5E1", ",", -25.0),
        ("2,5-3", ",", 0.0025),
    ],
)
def test_spellings_of_a_number(text, decimal, value):
    """Fortran exponents, with and without letter, decimal commas and the typographic minus."""
    assert is_number(text, decimal)
    assert float(plain_number(text, decimal)) == value
    assert as_numbers(pa.chunked_array([[text]]), decimal).to_pylist() == [value]


@pytest.mark.parametrize("text", ["1,5", "1+3", "1.2.3", "1e", "٣", "0x10", ""])
def test_what_is_no_number(text):
    """It stays as it is, and a column with it is no column of numbers."""
    assert not is_number(text, ".")
    assert plain_number(text, ".") == text


@pytest.mark.parametrize("text", ["", "NaN", "n/a", "-inf", "-nan(ind)", "1.#QNAN", "null"])
def test_gaps(text):
    """Cells that say that there is no number."""
    assert is_gap(text)
    assert not is_gap("0")


def test_touching_columns():
    """A sign behind an exponent begins the next number; elsewhere it is the exponent itself."""
    assert written_apart("1.0E+01-2.0E+02 3.0+103") == "1.0E+01 -2.0E+02 3.0+103"


def test_fields():
    """Quotation marks and blanks go, an empty cell in the middle stays, those at the end go."""
    assert split_fields('"a;b"; ;2;;', ";") == ["a;b", "", "2"]
    assert split_fields("'x y'  1.0E+01-2.0E+02", None) == ["x y", "1.0E+01", "-2.0E+02"]


def test_one_decimal_sign_for_a_column():
    """Where the sign is not known, all cells have one or the other; an empty one is null."""
    assert as_numbers(pa.chunked_array([["1,5", ""]]), None).to_pylist() == [1.5, None]
    assert as_numbers(pa.chunked_array([["1,5", "1.5"]]), None) is None
