"""The command line sets the allocators of its own process."""

import ctypes
import os

from fatigue.cli.memory import HEAPS, LARGE, SPARE, hold_little


def test_large_blocks_are_not_held(monkeypatch):
    """All limits of the C library are set; one that has none is left alone."""
    monkeypatch.setenv("ARROW_DEFAULT_MEMORY_POOL", "mimalloc")
    told = []
    library = type("Library", (), {"mallopt": lambda _, name, value: told.append((name, value))})
    monkeypatch.setattr(ctypes, "CDLL", lambda _: library())
    hold_little()
    assert told == [(-8, HEAPS), (-3, LARGE), (-1, SPARE)]
    monkeypatch.setattr(ctypes, "CDLL", lambda _: object())
    hold_little()


def test_a_chosen_allocator_of_arrow_is_kept(monkeypatch):
    """Otherwise Arrow uses that of the C library."""
    monkeypatch.setattr(ctypes, "CDLL", lambda _: object())
    monkeypatch.setenv("ARROW_DEFAULT_MEMORY_POOL", "jemalloc")
    hold_little()
    assert os.environ["ARROW_DEFAULT_MEMORY_POOL"] == "jemalloc"
    monkeypatch.delenv("ARROW_DEFAULT_MEMORY_POOL")
    hold_little()
    assert os.environ["ARROW_DEFAULT_MEMORY_POOL"] == "system"
