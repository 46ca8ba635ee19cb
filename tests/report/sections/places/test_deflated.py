"""Columns inside the page: the smallest type that holds them, and nothing lost."""

import base64
import zlib

import numpy as np
import pytest

from fatigue.report.sections.places.deflated import deflated
from tests.report.reading import inflated


@pytest.mark.parametrize(
    ("array", "code"),
    [
        (np.array([0, 255]), "u1"),
        (np.array([0, 256]), "u2"),
        (np.array([-1, 70_000]), "i4"),
        (np.array([2**40]), "f8"),
        (np.array([1.5, np.inf, np.nan]), "f4"),
        (np.zeros(0, dtype=np.int64), "u1"),
    ],
)
def test_columns_take_the_smallest_type_and_read_back(array, code):
    """Beside another column, infinite and missing values included."""
    written = deflated({"a": array, "b": np.array([3, 1, 2])})
    assert written["heads"][0] == ["a", code, len(array)]
    read = inflated(written)
    np.testing.assert_array_equal(read["a"], array)
    np.testing.assert_array_equal(read["b"], [3, 1, 2])


def test_first_bytes_stand_before_second_bytes():
    """As the script of the page puts them together again."""
    written = deflated({"n": np.array([0x0201, 0x0403])})
    assert zlib.decompress(base64.b64decode(written["deflate"])) == b"\x01\x03\x02\x04"
