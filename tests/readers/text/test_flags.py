"""Words for yes and no."""

import pytest

from fatigue.readers.text.flags import WORDS_BY_HAND, WORDS_OF_PROGRAMS, flag_of


@pytest.mark.parametrize(("text", "flag"), [("Wahr", True), ("OUI", True), ("", False), ("0", False), ("2", None)])
def test_words_by_hand(text, flag):
    """Any letter case and several languages; an empty cell is no, anything else is neither."""
    assert flag_of(text, WORDS_BY_HAND) is flag


@pytest.mark.parametrize(("text", "flag"), [("True", True), ("FALSE", False), ("", None), ("yes", None)])
def test_words_of_programs(text, flag):
    """What programs write, and no more."""
    assert flag_of(text, WORDS_OF_PROGRAMS) is flag
