"""A case without [report]: what the hash of a result is made of."""

import json
import tomllib

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatigue.case import numbers_text
from tests.case.case_text import MINIMAL, OWN_CURVE

TABLE = '[report]\nauthor = "A [mission]"  # who\n'


@pytest.mark.parametrize(
    "text",
    [
        MINIMAL + "\n" + TABLE,
        MINIMAL + "\n\n# signed by\n\n" + TABLE + "\n\n",
        MINIMAL.replace("[mission]", TABLE + "\n[mission]"),
        TABLE + MINIMAL.lstrip(),
        MINIMAL.replace("[mission]", "  [ report ] # here\nauthor = 'B'\n[mission]"),
        (MINIMAL + "\n" + TABLE).replace("\n", "\r\n"),
    ],
)
def test_the_rest_is_the_case(text):
    """Keys and values of all other tables."""
    case = tomllib.loads(text)
    del case["report"]
    cut = numbers_text(text)
    assert tomllib.loads(cut) == case
    assert "author" not in cut


def test_an_identity_that_comes_later_leaves_the_text_to_the_letter():
    """So that the hash of the result stays: at the end, and between two tables."""
    assert numbers_text(MINIMAL + "\n" + TABLE) == MINIMAL
    assert numbers_text(MINIMAL.replace("[mission]", TABLE + "\n[mission]")) == MINIMAL


def test_a_text_without_it_is_as_it_is():
    """Also where the word stands elsewhere, and where the text is no TOML."""
    for text in (MINIMAL, MINIMAL + OWN_CURVE, 'title = """\n[report]\n"""\n', "[report", ""):
        assert numbers_text(text) == text


@pytest.mark.parametrize(
    "text",
    [
        'report.author = "A"\n' + MINIMAL,
        'report = {author = "A"}\n' + MINIMAL,
        'title = """\n[report]\n"""\n[report]\n',
    ],
)
def test_other_ways_of_writing_it_have_one_text(text):
    """Which no author changes, and any other key does."""
    other = text.replace('"A"', '"B, C"')
    assert numbers_text(text) == numbers_text(other) != numbers_text(text + "\n[counting]\nupsample = 1\n")
    assert "report" not in json.loads(numbers_text(text))


@given(st.text(alphabet=st.characters(exclude_categories=["Cs", "Cc"]), max_size=40))
def test_no_author_changes_it(name):
    """Whatever the name, also with brackets and signs of TOML."""
    quoted = name.replace("\\", "\\\\").replace('"', '\\"')
    assert numbers_text(f'{MINIMAL}\n[report]\nauthor = "{quoted}"\n') == MINIMAL
