"""A share of the damaged files that ``python -m tests.fuzz`` makes, and the judge that looks at them."""

import random

import numpy as np
import pytest

from fatigue.errors import DataError, Problem
from tests.fuzz import damage
from tests.fuzz.judge import FINDINGS, Sound, compared, damaged, judged, sound
from tests.fuzz.sources import Source, sources

SHARE = 8  # damaged files of each source


@pytest.fixture(scope="module")
def every(tmp_path_factory) -> list[Source]:
    """All sound files."""
    pytest.importorskip("h5py")
    return sources(tmp_path_factory.mktemp("sources"))


def test_no_damage_crashes_or_goes_unseen(every, tmp_path):
    """Every reader refuses, warns, or reads what a text without a checksum cannot tell from the sound one."""
    bad = []
    for source in every:
        expected = sound(source, tmp_path / "sound")
        outcomes = [judged(source, expected, 0, number, tmp_path / "damaged") for number in range(SHARE)]
        bad += [outcome for outcome in outcomes if outcome.kind in FINDINGS]
    assert bad == []


def test_damage_is_drawn_again_the_same(every):
    """A number stands for one file."""
    assert damaged(every[0], 3, 17) == damaged(every[0], 3, 17)
    assert damaged(every[0], 3, 17) != damaged(every[0], 3, 18)


def test_every_damage_changes_most_files():
    """No damage is an empty threat."""
    text = b"time,q_1\n0.0,1.5\n0.1,2.5\n0.2,3.5\n"
    for kind in {*damage.BINARY, *damage.TEXT}:
        changed = [kind(text, random.Random(seed)) != text for seed in range(20)]
        assert sum(changed) >= 12, kind.__name__


@pytest.mark.parametrize(
    ("after", "kind"),
    [
        ({"mode": [1, 2], "q": [0.5, 1.5]}, "same"),
        ({"mode": [1, 2], "q": [0.5, np.nan]}, "nan"),
        ({"mode": [1, 2], "q": [0.5, 1.6]}, "values"),
        ({"mode": [1, 3], "q": [0.5, 1.5]}, "ids"),
        ({"mode": [1, 2], "q": [0.5]}, "fewer"),
        ({"mode": [1, 2, 3], "q": [0.5, 1.5]}, "more"),
        ({"mode": [1, 2]}, "fewer"),
    ],
)
def test_what_the_judge_calls_a_change(after, kind):
    """Kinds of difference between two readings."""
    before = {"mode": np.array([1, 2]), "q": np.array([0.5, 1.5])}
    assert compared(before, {name: np.array(values) for name, values in after.items()})[0] == kind


@pytest.mark.parametrize(
    ("error", "kind"),
    [
        (DataError(Problem("a", "b", "c", "d")), "refused"),
        (DataError(Problem("a", "b", "two\nlines", "d")), "refused"),  # a line end is spelled out
        (DataError(), "message"),
        (ValueError("x"), "traceback"),
        (RecursionError("x"), "traceback"),
    ],
)
def test_what_the_judge_finds(tmp_path, error, kind):
    """A refusal is one line; anything else that is raised is a finding."""

    def read(_path):
        raise error

    source = Source("s", "s.txt", {"s.txt": b"1\n2\n3\n"}, read, (damage.cut_start,))
    assert judged(source, Sound({}, frozenset()), 0, 0, tmp_path / "d").kind == kind
