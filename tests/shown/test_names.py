"""Texts of somebody else on a screen: nothing unseen, nothing endless."""

import logging
import unicodedata

from hypothesis import given
from hypothesis import strategies as st

from fatigue.shown import VisibleFormatter, few, shortened, spelled_out, visible

UNSEEN = ("Cc", "Cf", "Cs", "Zl", "Zp")


@given(st.text())
def test_nothing_unseen_is_left(text):
    """No character of control or direction passes, and every other one does."""
    shown = visible(text)
    assert not [c for c in shown if unicodedata.category(c) in UNSEEN]
    assert [c for c in text if unicodedata.category(c) not in UNSEEN] == [
        c for c in text if c in shown and unicodedata.category(c) not in UNSEEN
    ]
    assert spelled_out(text).isascii()


def test_every_unseen_character_is_known():
    """All of Unicode: what is unseen is escaped, all else is left alone."""
    for c in map(chr, range(0x110000)):
        assert (visible(c) == c) == (unicodedata.category(c) not in UNSEEN)


def test_escapes_are_those_of_python():
    """A reader can write the character in a program."""
    assert visible("a\n\x1b[31m\u202e\u200b\x85é中") == r"a\n\x1b[31m\u202e\u200b\x85é中"
    assert visible("a\n\tb", keep="\n") == "a\n\\tb"


@given(st.text(), st.integers(8, 80))
def test_a_long_text_is_cut_in_its_middle(text, longest):
    """Never longer than asked, with its own beginning and end; a short one is left alone."""
    cut = shortened(text, longest)
    assert len(cut) == min(len(text), longest)
    assert cut == text or (text.startswith(cut.split("...")[0]) and text.endswith(cut[-1]))


def test_a_few_of_many():
    """The first are named, the others counted."""
    assert few([1, 2, 3]) == "1, 2, 3"
    assert few([1, 2, 3, 4]) == "1, 2, 3 and 1 more"
    assert len(few(["x" * 5000])) == 60


def test_a_name_cannot_begin_a_line_of_the_log():
    """The end of a line in a name is written as its escape."""
    record = logging.LogRecord("fatigue", logging.INFO, "", 0, "event '%s'", ("a\nWARNING b\x1b[2J",), None)
    assert VisibleFormatter("%(levelname)s %(message)s").format(record) == r"INFO event 'a\nWARNING b\x1b[2J'"
