"""What `rainflow` takes for a signal, bit for bit as ever, and what it refuses in one line."""

import array
import warnings
from decimal import Decimal
from fractions import Fraction

import numpy as np
import pandas as pd
import pyarrow as pa
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

import fatigue
from fatigue.errors import CaseError, DataError, FatigueError, NumericalError
from fatigue.life.counting.reversals import cycles_of

PLAIN = [0.0, 3.0, -1.0, 2.0, 0.0]


def counted_plainly(signal, residue):
    """The cycles from the compiled loops alone: range, mean, count, start, end."""
    s = np.array(signal, dtype=np.float64)
    start, end, weight, _ = cycles_of(s[None], recurs=residue == "repeat")
    return np.abs(s[end] - s[start]), 0.5 * (s[start] + s[end]), weight, start, end


def assert_as_ever(signal, residue):
    """Every bit is that of the loops."""
    found = fatigue.rainflow(signal, residue)
    for name, expected in zip(
        ("range", "mean", "count", "start", "end"), counted_plainly(signal, residue), strict=True
    ):
        assert getattr(found, name).tobytes() == expected.tobytes(), name


@pytest.mark.parametrize("residue", ["repeat", "half"])
@pytest.mark.parametrize(
    "signal",
    [
        PLAIN,
        tuple(PLAIN),
        range(5),
        [True, False, True],
        [2**70, 0, 1],
        np.array([2**53 + 1, 0, 2**60]),
        np.array([2**64 - 1, 0], np.uint64),
        np.array([0, 200, 3], np.uint8),
        np.array(PLAIN, np.float32),
        np.array(PLAIN, np.float16),
        np.array(PLAIN, np.longdouble),
        np.array(PLAIN, ">f8"),
        np.array([PLAIN, PLAIN]).T[:, 0],
        np.frombuffer(np.array(PLAIN).tobytes()),
        pd.Series(PLAIN, index=[9, 8, 7, 6, 5]),
        pd.Series([1, 2, 0, 1], dtype="Float64"),
        pd.Series([1, 2, 0, 1], dtype="Int64"),
        pd.Series([1, 2, 1]).astype("category"),
        pd.Index(PLAIN),
        pa.array(PLAIN),
        pa.chunked_array([PLAIN]),
        memoryview(np.array(PLAIN)),
        array.array("d", PLAIN),
        [],
        pd.Series([]),
        np.array([], object),
        [5e-324, 0.0, 5e-324],
    ],
    ids=lambda signal: f"{type(signal).__name__}-{getattr(signal, 'dtype', '')}",
)
def test_numbers_of_all_kinds_are_taken_as_ever(signal, residue):
    """Lists, arrays of any width and order, columns of pandas and Arrow."""
    assert_as_ever(signal, residue)


@given(
    arrays.arrays(st.sampled_from([np.float64, np.float32, np.int64]), st.integers(0, 40), fill=st.nothing()),
    st.sampled_from(["repeat", "half"]),
)
def test_finite_signals_are_counted_as_ever_and_others_refused(signal, residue):
    """No number but that of the loops, no warning, and no other exception than a refusal."""
    with warnings.catch_warnings(), np.errstate(over="ignore", invalid="ignore"):
        warnings.simplefilter("error")
        s = signal.astype(np.float64)
        if np.isfinite(s).all() and (s.size == 0 or np.isfinite(s.max() - s.min())):
            found, expected = fatigue.rainflow(signal, residue), counted_plainly(signal, residue)
            assert found.range.tobytes() == expected[0].tobytes()
            finite = np.isfinite(expected[1])
            assert found.mean[finite].tobytes() == expected[1][finite].tobytes()
            assert np.isfinite(found.mean).all()
        else:
            with pytest.raises(NumericalError):
                fatigue.rainflow(signal, residue)


@pytest.mark.parametrize(
    ("signal", "words"),
    [
        (3.0, "0 dimensions"),
        (np.ones((3, 2)), r"2 dimensions, its shape is \(3, 2\)"),
        (np.array([PLAIN]), "2 dimensions.* as a list or an array of one dimension"),
        (np.ones((2, 2)), "2 dimensions.* Give one signal after the other"),
        (pd.DataFrame({"a": PLAIN}), "2 dimensions"),
        ([[1, 2], [3]], "no array of numbers"),
        (np.array(PLAIN, object), "objects"),
        (pd.Series(PLAIN, dtype=object), "objects"),
        ([1, None, 2], "objects, some of type NoneType"),
        ([Decimal(1), Decimal(3)], "objects, some of type Decimal"),
        ([Fraction(1, 3), 2.0], "objects, some of type Fraction"),
        ([10**400, 0], "no array of numbers .*too large"),
        (None, "one object of type NoneType"),
        ((x for x in PLAIN), "one object of type generator"),
        ({1.0, 2.0}, "one object of type set"),
        ({1: 2.0}, "one object of type dict"),
        (np.array(PLAIN, complex), "complex numbers"),
        ([1 + 0j, 2], "complex numbers"),
        (["1", "2", "1"], "text"),
        ([1, "2"], "text"),
        ([b"1", b"2"], "text"),
        ("0 3 -1", "text"),
        (pd.Series(["1", "2"]), "objects, some of type str"),
        (np.array(["2020-01-01", "2020-01-02"], "datetime64[D]"), "dates"),
        (pd.Series(pd.date_range("2020", periods=3)), "dates"),
        (pd.Series(pd.date_range("2020", periods=3, tz="UTC")), "objects, some of type Timestamp"),
        (np.array([1, 5, 2], "timedelta64[s]"), "time differences"),
        (np.array([(1, 2)], [("a", "f8"), ("b", "f8")]), "records of several fields"),
        (np.ma.array(PLAIN, mask=[0, 1, 0, 0, 0]), "masked array"),
        (np.ma.array(PLAIN), "masked array"),
    ],
    ids=lambda given: given if isinstance(given, str) else type(given).__name__,
)  # fmt: skip
def test_what_is_no_signal_is_refused(signal, words):
    """One line that says what it is instead."""
    with pytest.raises(DataError, match=f"^signal: it .*{words}") as caught:
        fatigue.rainflow(signal, "repeat")
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("signal", "words"),
    [
        ([0.0, np.nan, 1.0], "sample 1 of the signal: the stress is NaN or infinite"),
        ([0.0, 1.0, -np.inf], "sample 2 of the signal"),
        (pd.Series([1, None, 3], dtype="Int64"), "sample 1 of the signal"),
        (pa.array([1.0, 2.0, None]), "sample 2 of the signal"),
        (np.array(["1e4000", "0"], np.longdouble), "sample 0 of the signal"),
        ([-1.7e308, 1.7e308], r"the range from -1.7e\+308 to 1.7e\+308 exceeds"),
        ([1e308, 0.0, -1e308], "exceeds what double precision can hold"),
    ],
    ids=lambda given: given if isinstance(given, str) else type(given).__name__,
)
def test_numbers_that_cannot_be_counted_are_refused(signal, words):
    """A missing or infinite sample by its index; samples too far apart."""
    with pytest.raises(NumericalError, match=words):
        fatigue.rainflow(signal, "half")


def test_a_mean_does_not_overflow():
    """Two large samples near each other: their sum exceeds double precision, their mean does not."""
    cycles = fatigue.rainflow([1.7e308, 1.6e308, 1.7e308], "repeat")
    assert cycles.mean == pytest.approx([1.65e308])


@pytest.mark.parametrize("residue", ["Repeat", "closed", "", None, True, 1, ["half"], np.array(["half"])], ids=str)
def test_an_unknown_residue_is_refused(residue):
    """It was taken for `half` once."""
    with pytest.raises(CaseError, match="is no way to count what does not close") as caught:
        fatigue.rainflow(PLAIN, residue)
    assert isinstance(caught.value, FatigueError)
