"""What is said before the numbers, each where it belongs and nowhere else."""

from dataclasses import replace

import pytest

from fatigue.point.page.notes import facts_of_band, notes_of


@pytest.fixture
def plain(results, gathered):
    """The worst point of a weld with a toe on either face."""
    return gathered(results("plain"), "A")


def changed(found, **row):
    """The same with other values in its row."""
    stored = found.stored.copy()
    for name, value in row.items():
        stored[name] = value
    return replace(found, stored=stored)


def said(found):
    """All notes."""
    return " ".join(notes_of(found))


def test_where_the_weld_is_worst(plain, results, gathered):
    """At the point itself, or where and how much worse."""
    assert "The worst point of its weld" in said(plain)
    other = gathered(results("plain"), "A", order=4, surface=plain.surface)
    times = other.stored["life_km"] / plain.stored["life_km"]
    assert f"The weld is worst at order {plain.station.order}, node {plain.station.node}" in said(other)
    assert f"the life here is {times:.4g}"[:24] in said(other)
    in_parts = gathered(results("corner"), "A", order=2, surface="top")
    assert "worst at part " in said(in_parts) or "The worst point of its weld" in said(in_parts)


def test_flags_of_the_line(plain):
    """Ends, corners, and corners whose forces are one sum."""
    inner = changed(plain, at_end=False)
    assert "weld end" not in said(inner)
    assert "In the treated zone of a weld end" in said(changed(plain, at_end=True))
    assert "At a corner of the weld line" in said(changed(inner, at_corner=True))
    summed = said(changed(inner, at_corner=True, summed_corner=True))
    assert "one sum of both legs" in summed
    assert "At a corner of the weld line" not in summed


def test_merged_cycles_and_short_records(plain):
    """Only where there are more than are listed; only where the damage scatters."""
    assert "drawn as one" not in said(plain)
    assert "Of 2\u202f000\u202f000 cycles" in said(replace(plain, cycle_rows=2_000_000))
    for cov, words in ((0.4, "scatters by 40.0 %"), (float("nan"), "by an amount that is not known")):
        rows = plain.why.diagnosis.assign(record_too_short=True, damage_cov=cov, verdict="valid")
        assert words in said(replace(plain, why=replace(plain.why, diagnosis=rows)))
        steady = rows.assign(record_too_short=False)
        assert words not in said(replace(plain, why=replace(plain.why, diagnosis=steady)))


def test_a_life_beyond_all_numbers_has_no_band(plain):
    """More than 1e12 km needs no scatter."""
    assert facts_of_band(plain)[0][0] == "Life, 90 % band of load"
    assert facts_of_band(changed(plain, life_km=2e12)) == []
