"""Weld lines on disk come back as they were, one by one and as stacks of neighbours, to several threads at once."""

import gc
from concurrent.futures import ThreadPoolExecutor
from dataclasses import fields, replace

import numpy as np
import pytest

from fatigue.readers.neutral import line_file as line_file_module
from fatigue.readers.neutral.line_file import line_file
from fatigue.weld.line import stacked
from tests.weld_lines import ring, straight

LINES = [
    replace(straight([10.0] * (2 + i), edge_mid=np.arange(3 + i) % 2 == 1), weld=f"W{i}", end_length=float(i))
    for i in range(4)
] + [replace(ring(9), weld="ring"), replace(straight([5.0]), weld="end", part=2, corner_end=True)]


def assert_same(found, wanted):
    """Compare all that is said of lines."""
    for name in (field.name for field in fields(wanted) if field.init):
        np.testing.assert_array_equal(getattr(found, name), getattr(wanted, name))


@pytest.mark.parametrize("at_once", [2, 100])
def test_lines_come_back(monkeypatch, at_once):
    """However many are written or read together."""
    monkeypatch.setattr(line_file_module, "AT_ONCE", at_once)
    monkeypatch.setattr(line_file_module, "NODES_AT_ONCE", at_once)
    stored = line_file(stacked(LINES))
    assert (len(stored), stored.weld) == (6, ("W0", "W1", "W2", "W3", "ring", "end"))
    assert stored.begin.tolist() == [0, 3, 7, 12, 18, 27, 29]
    for found, wanted in zip(stored, LINES, strict=True):
        assert_same(found, wanted)
    for some in (slice(0, 6), slice(None), slice(2, 5), slice(4, 99)):
        assert_same(stored.lines(some), stacked(LINES[some]))


def test_threads_read_at_the_same_time():
    """Each its own lines."""
    stored = line_file(stacked(LINES))
    with ThreadPoolExecutor(4) as pool:
        found = list(pool.map(lambda i: stored.lines(slice(i, i + 1)), [*range(6)] * 20))
    for i, stack in enumerate(found):
        assert_same(stack, stacked(LINES[i % 6 : i % 6 + 1]))


def test_the_file_is_closed_with_the_object():
    """No file stays open when nobody asks for lines any more."""
    stored = line_file(stacked(LINES))
    file = stored.file
    del stored
    gc.collect()
    assert file.closed
