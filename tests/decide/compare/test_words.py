"""Causes in words: what is named, in which order, and what is left unsaid."""

import math

import pytest

from fatigue.decide.compare.words import Cause, largest_cause, mode_names, modes_of, why

NAMES = {1: "mode 1 (8 Hz)", 50: "interface mode 50"}


def event(name, log, value=1e-8, other=2e-8, kind="event"):
    """A whole event."""
    return Cause(kind, name, None, None, value, other, log)


def parts(name, mission, per_pass):
    """Both parts of an event: twice as often, four times the damage."""
    return [
        Cause("mission", name, None, None, 1.0, 2.0, mission),
        Cause("per_pass", name, None, None, 1e-6, 4e-6, per_pass),
    ]


def test_the_largest_causes_come_first_and_those_against_them_behind():
    """Two of either direction at most; what is below a fifth of the change is left unsaid."""
    causes = [
        event("small", -0.1), *parts("small", 0.0, -0.1),
        event("second", -0.8), *parts("second", -0.8, 0.0),
        event("back", 0.5), *parts("back", 0.0, 0.5),
        event("first", -2.0), *parts("first", -0.5, -1.5),
    ]  # fmt: skip
    said = why(causes, -2.4, NAMES)
    assert said == (
        "first does 4 times its damage per pass in A and occurs 2 times as often and second occurs 2 times as often; "
        "against it back does 4 times its damage per pass in A"
    )
    assert largest_cause(causes, -2.4).event == "first"
    assert largest_cause(causes, 0.1).event == "back"
    assert largest_cause(causes[:2], 0.1).event == "small"


def test_events_that_come_and_go():
    """In one result only; cycles across events in their own words; a limit without modes."""
    assert why([event("new", -1.0, 0.0, 1e-8)], -1.0, NAMES) == "new comes in"
    assert why([event("old", 1.0, 1e-8, 0.0)], 1.0, NAMES) == "old is gone"
    loop = event("(sequence 1)", -1.0, 0.0, 1e-8, "sequence")
    assert why([loop], -1.0, NAMES) == "what (sequence 1) adds across events comes in"
    turns = event("(sequence 1)", -1.0, -1e-9, 1e-8, "sequence")
    assert why([turns], -1.0, NAMES) == "(sequence 1) relieves in one of them and damages in the other"
    assert why([event("", -0.7, 1.0, 0.5, "limit")], -0.7, NAMES) == "the damage limit is 0.5 instead of 1"


def test_a_life_that_stays_says_nothing_unless_causes_cancel():
    """A few percent are the same; two causes that make up for each other are told."""
    assert why([event("e", 0.04), *parts("e", 0.0, 0.04)], 0.04, NAMES) == ""
    assert why([], 0.0, NAMES) == ""
    assert largest_cause([event("e", 0.0)], 0.0) is None
    said = why([event("e", -1.0), *parts("e", 0.0, -1.0), event("f", 1.0, 1e-8, 0.0)], 0.0, NAMES)
    assert said == "e does 4 times its damage per pass in A and f is gone, which others make up for"


def test_modes_are_named_until_they_make_most_of_it():
    """Those with the sign of their event, the largest first; none where the event only occurs more often."""
    whole = event("e", -1.0)
    modes = [
        Cause("mode", "e", 1, None, 0.0, 0.0, -0.3),
        Cause("mode", "e", 50, None, 0.0, 0.0, 0.4),
        Cause("unit_load", "e", None, "wind", 0.0, 0.0, -0.5),
        Cause("mode", "e", 7, None, 0.0, 0.0, -0.2),
    ]
    assert modes_of([whole, *modes], whole, NAMES) == ["wind", "mode 1 (8 Hz)"]
    assert why([whole, *parts("e", 0.0, -1.0), *modes], -1.0, NAMES).endswith("most of it by wind and mode 1 (8 Hz)")
    assert why([whole, *parts("e", -1.0, 0.0), *modes], -1.0, NAMES) == "e occurs 2 times as often"


def test_less_damage_is_a_percentage():
    """A twelfth is said as 8.33 %."""
    causes = [
        event("e", 2.0),
        Cause("mission", "e", None, None, 1.0, 1.0, 0.0),
        Cause("per_pass", "e", None, None, 12.0, 1.0, 2.0),
    ]
    assert why(causes, 2.0, NAMES) == "e does 8.33 % of its damage per pass in A"


def test_names_of_modes():
    """A normal mode has its frequency; that of an interface mode says nothing."""
    record = {"modes": {"used": [1, 50], "frequency_hz": [8.0694, 329.7], "kind": ["normal", "interface"]}}
    assert mode_names(record) == {1: "mode 1 (8.07 Hz)", 50: "interface mode 50"}


@pytest.mark.parametrize("log", [math.log(1.06), -math.log(1.06)])
def test_the_limit_of_the_same(log):
    """Beyond 5 % a change is one."""
    assert why([event("e", log), *parts("e", 0.0, log)], log, NAMES)
