"""Names and units of unit loads: from the deck, or as the user says; no unit is made up."""

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatigue.errors import CaseError
from fatigue.readers.convert.loads.names import NAME, LoadName, name_of, named_loads
from fatigue.readers.foreign.fe.static_case import Heading, StaticCase


def cases(*headings):
    """Subcases from 1001 on with these headings."""
    return [StaticCase(k, k, Heading(*texts), "a.op2") for k, texts in enumerate(headings, 1001)]


def names(*headings):
    """Names of subcases with these headings."""
    return [load.name for load in named_loads(cases(*headings), ())]


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("TUNNEL PRESSURE, 1 kPa", "tunnel_pressure_1_kpa"),
        ("1 g vertical", "load_1_g_vertical"),
        ("Drücke außen", "drucke_auen"),
        ("---", ""),
        ("", ""),
        ("x" * 60, "x" * 40),
        ("a title of a subcase that goes on for very long indeed", "a_title_of_a_subcase_that_goes_on_for"),
    ],
)
def test_a_name_is_made_of_the_letters_and_digits_of_a_title(text, name):
    """Small letters joined by _, never a digit first, cut between words."""
    assert name_of(text) == name


@given(st.lists(st.tuples(st.text(max_size=60), st.text(max_size=60), st.text(max_size=60)), max_size=8))
def test_names_are_names_and_differ(headings):
    """Whatever titles are, names are those of columns and unique."""
    found = names(*headings)
    assert len(found) == len(set(found)) == len(headings)
    assert all(NAME.match(name) for name in found)


def test_the_text_that_tells_subcases_apart_names_them():
    """Subtitle before label before title; a text that all subcases share names none of many, and a single one."""
    assert names(("run", "pressure", ""), ("run", "coupler", "")) == ["pressure", "coupler"]
    assert names(("run", "static", "up"), ("run", "static", "down")) == ["up", "down"]
    assert names(("run", "static", ""), ("run", "static", "")) == ["subcase_1001", "subcase_1002"]
    assert names(("run", "", "")) == ["run"]
    assert names(("", "up", ""), ("", "", "down"), ("", "", "")) == ["up", "down", "subcase_1003"]
    assert names(("", "up", "a"), ("", "up", "b"), ("", "down", "c")) == ["up", "up_1002", "down"]


def test_the_unit_is_the_subcase_unless_it_is_given():
    """One is then the load as it was run; given, one is one of the unit."""
    own, given = named_loads(cases(("", "a", ""), ("", "b", "")), [LoadName(1002, "coupler", 250.0, "kN")])
    assert (own.name, own.unit, own.amount, own.is_unit_known) == ("a", "subcase 1001", 1.0, False)
    assert (given.name, given.unit, given.amount, given.is_unit_known) == ("coupler", "kN", 250.0, True)


def test_a_name_that_the_user_gives_wins_over_a_title():
    """The other gets the number of its subcase."""
    found = named_loads(cases(("", "up", ""), ("", "down", "")), [LoadName(1002, "up", 1.0, "kN")])
    assert [load.name for load in found] == ["up_1001", "up"]


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (
            [(7, "a", 1.0, "N")],
            "--unit-load-name 7: the files have no static subcase 7; those that they have: 1001, 1002",
        ),
        ([(1001, "a", 1.0, "N"), (1001, "b", 1.0, "N")], "--unit-load-name 1001: the subcase is named twice"),
        ([(1001, "a", 1.0, "N"), (1002, "a", 1.0, "N")], "--unit-load-name 1002: 'a' names another subcase, too"),
    ],
)
def test_names_that_fit_no_subcase_are_refused(given, said):
    """An unknown subcase, one of two names, two of one name."""
    with pytest.raises(CaseError, match=re.escape(said)):
        named_loads(cases(("", "", ""), ("", "", "")), [LoadName(*one) for one in given])


def test_a_subcase_of_two_files_cannot_be_named():
    """It is not known which of them is meant."""
    two = [StaticCase(1, 1, source="a.op2"), StaticCase(2, 1, source="b.op2")]
    assert [load.name for load in named_loads(two, ())] == ["subcase_1", "subcase_1_1"]
    with pytest.raises(CaseError, match=r"2 files of unit loads have a subcase 1: a.op2, b.op2"):
        named_loads(two, [LoadName(1, "a", 1.0, "N")])


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ((1, "a-b", 1.0, "N"), "'a-b' is no name"),
        ((1, "1a", 1.0, "N"), "'1a' is no name"),
        ((1, "a", 0.0, "N"), "0 N cannot have been applied"),
        ((1, "a", float("nan"), "N"), "nan N cannot"),
        ((1, "a", 1.0, " "), "the unit is empty"),
    ],
)
def test_what_is_no_name_amount_or_unit_is_refused(given, said):
    """Each with the subcase."""
    with pytest.raises(CaseError, match=f"--unit-load-name 1: {said}"):
        LoadName(*given)
