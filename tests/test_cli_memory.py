"""The command line sets the allocators of its own process."""

import ctypes
import os
import subprocess
import sys

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


def test_a_process_of_its_own_seldom_looks_for_garbage():
    """Not at its end, where every object of the libraries would be visited: they are all left out of it by then."""
    code = (
        "import atexit, gc\n"
        "atexit.register(lambda: print(gc.get_freeze_count() > 1000))  # called after what is registered later\n"
        "from fatigue.__main__ import OBJECTS, collect_rarely\n"
        "collect_rarely()\n"
        "print(gc.get_threshold()[0] == OBJECTS, gc.get_freeze_count())"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["True", "0", "True"]
