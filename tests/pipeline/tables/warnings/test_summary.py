"""Warnings of many welds in few lines: nothing is lost, however many there are."""

from collections import Counter

from hypothesis import given
from hypothesis import strategies as st

from fatigue.errors import Problem
from fatigue.pipeline.tables.warnings.summary import MOST_IN_FULL, WarningSummary


def listed(*warnings):
    """List warnings taken in one by one."""
    summary = WarningSummary()
    for warning in warnings:
        summary.add([warning])
    return summary.listed()


def coarse(weld, file="nodes.csv"):
    """Warn of the ends of a weld."""
    return Problem("end_unresolved", f"{file}: weld {weld}", "the edge is long", "Refine it")


def test_a_few_stand_in_full_in_their_order():
    """As they came, whatever their kinds."""
    other = Problem("few_segments", "event 'run'", "5 segments", "Record longer")
    some = [coarse(1), other, *(coarse(i) for i in range(2, MOST_IN_FULL + 1))]
    assert listed(*some) == tuple(some)


def test_one_more_sums_up_the_others_of_a_kind():
    """Number and welds; another kind in between stays as it is."""
    other = Problem("few_segments", "event 'run'", "5 segments", "Record longer")
    first = [coarse(f"A{i}") for i in range(MOST_IN_FULL)]
    *in_full, summed = listed(*first, coarse("roof left"), other, coarse("B1"), coarse("B1"))
    assert in_full == [*first, other]
    assert summed.code == "end_unresolved"
    assert summed.count == 3
    assert str(summed) == (
        "nodes.csv: weld roof left, B1: 3 more of this kind, the first 20 are listed one by one. "
        "Do what is said of those."
    )


def test_places_are_gathered_by_file():
    """Welds, columns, and what names no file."""
    places = ["a.csv: weld X", "b.csv: column c", "a.csv: weld Y", "b.csv: column d", "event 'run'", "event 'stop'"]
    *_, summed = listed(*(Problem("some_code", place, "what", "Do it") for place in ["here"] * MOST_IN_FULL + places))
    assert summed.where == "a.csv: weld X, Y; b.csv: column c, column d; event 'run', event 'stop'"


warnings = st.builds(coarse, st.integers(0, 99).map("W{}".format), st.sampled_from(["n.csv", "f.csv"]))


@given(st.lists(st.one_of(warnings, st.just(Problem("some_code", "here", "what", "Do it"))), max_size=200))
def test_every_warning_is_counted_and_every_weld_named(some):
    """By kind; no more entries than fit a page; the same however they are handed over."""
    found = listed(*some)
    at_once = WarningSummary()
    at_once.add(some)
    assert found == at_once.listed()
    numbers = Counter()
    for warning in found:
        numbers[warning.code] += warning.count
    assert numbers == Counter(warning.code for warning in some)
    assert max(Counter(warning.code for warning in found).values(), default=0) <= MOST_IN_FULL + 1
    for warning in some:
        file, _, weld = warning.where.partition(": weld ")
        mine = [w.where for w in found if w.code == warning.code and file in w.where]
        assert any(weld in place.partition(file)[2].replace(": weld", ",").split(";")[0].split(", ") for place in mine)
