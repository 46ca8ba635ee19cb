"""Freed memory is given back wherever that is possible."""

import ctypes

import pyarrow as pa

from fatigue.readers.neutral.spare_memory import give_back


def test_what_is_in_use_stays(monkeypatch):
    """Also with a C library that cannot give anything back."""
    values = pa.array(range(100_000))
    give_back()
    assert values[99_999].as_py() == 99_999
    monkeypatch.setattr(ctypes, "CDLL", lambda _: object())
    give_back()
