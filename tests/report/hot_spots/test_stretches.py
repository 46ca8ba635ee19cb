"""Stretches of high damage: against the definition, spelled out, and by their properties."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from fatigue.report.hot_spots.stretches import stretches


def neighbours(lengths, rings):
    """Stations before and behind each one of some lines, one after the other."""
    before, behind, start = [], [], 0
    for length, ring in zip(lengths, rings, strict=True):
        at = np.arange(start, start + length)
        ends = (at[-1], at[0]) if ring else (-1, -1)
        before += [ends[0], *at[:-1]]
        behind += [*at[1:], ends[1]]
        start += length
    return np.array(before), np.array(behind)


def found(damage, ring=False, counted=None):
    """Hot spots of one line as tuples: worst, first, last."""
    damage = np.array(damage, dtype=float)
    before, behind = neighbours([len(damage)], [ring])
    counted = np.ones(len(damage), dtype=bool) if counted is None else np.array(counted)
    of = stretches(damage, counted, before, behind)
    return list(zip(of.worst.tolist(), of.first.tolist(), of.last.tolist(), strict=True)), of


def plainly(damage, counted, before, behind):
    """By definition: of each station the connected run of those with half of its damage."""
    spots = {}
    for i in np.flatnonzero(counted & (damage > 0.0)):
        run = {int(i)}
        for way in (before, behind):
            at = way[i]
            while at >= 0 and at not in run and damage[at] >= 0.5 * damage[i]:
                run.add(int(at))
                at = way[at]
        rivals = [j for j in run if counted[j]]
        if min(rivals, key=lambda j: (-damage[j], j)) == i:
            spots[int(i)] = run
    return spots


def test_two_peaks_with_a_deep_valley_are_two_hot_spots():
    """The flanks below half belong to none."""
    spots, of = found([1.0, 4.0, 2.0, 1.4, 3.0])
    assert spots == [(1, 1, 2), (4, 4, 4)]
    assert of.of_station.tolist() == [-1, 0, 0, -1, 1]


def test_a_ripple_above_half_is_no_hot_spot_of_its_own():
    """A valley of half the smaller peak or more joins both."""
    assert found([4.0, 1.4, 3.0])[0] == [(0, 0, 0), (2, 2, 2)]
    assert found([4.0, 2.0, 3.0])[0] == [(0, 0, 2)]


def test_a_ring_goes_round():
    """A stretch runs through the start of a ring, and may be all of it."""
    assert found([4.0, 1.0, 0.5, 3.0], ring=True)[0] == [(0, 3, 0)]
    assert found([4.0, 1.0, 0.5, 3.0])[0] == [(0, 0, 0), (3, 3, 3)]
    spots, of = found([3.0, 4.0, 3.0], ring=True)
    assert len(spots) == 1
    assert of.whole.tolist() == [True]
    assert of.of_station.tolist() == [0, 0, 0]


def test_of_equal_damage_the_first_is_the_worst():
    """A plateau is one hot spot, on a line and around a ring."""
    assert found([2.0, 2.0, 2.0])[0] == [(0, 0, 2)]
    assert found([2.0, 2.0, 2.0], ring=True)[1].worst.tolist() == [0]


def test_nothing_damaged_is_no_hot_spot_and_no_toe_ends_one():
    """Zero opens none; a station without toe separates."""
    assert found([0.0, 0.0])[0] == []
    assert found([4.0, np.nan, 3.0])[0] == [(0, 0, 0), (2, 2, 2)]
    assert found([])[0] == []


def test_a_bound_prolongs_a_stretch_and_is_no_worst_point():
    """What was not counted may be as bad as its bound, and is never named as the worst."""
    assert found([4.0, 3.0, 1.0], counted=[True, False, True])[0] == [(0, 0, 1)]
    assert found([4.0, 9.0, 3.0], counted=[True, False, True])[0] == [(0, 0, 2)]
    assert found([4.0], counted=[False])[0] == []


lines = st.lists(
    st.tuples(
        st.lists(st.sampled_from([0.0, 0.3, 0.5, 0.9, 1.0, 1.7, 2.0, 4.0, np.nan]), min_size=1, max_size=9),
        st.booleans(),
    ),
    min_size=1,
    max_size=4,
)


@given(lines, st.integers(0, 2**32 - 1))
def test_all_lines_at_once_give_what_the_definition_says(drawn, seed):
    """Every hot spot of the definition, no other, each with its stations; none shares a station with another."""
    damage = np.array([d for of_line, _ in drawn for d in of_line])
    counted = np.random.default_rng(seed).random(len(damage)) < 0.8
    before, behind = neighbours([len(of_line) for of_line, _ in drawn], [ring for _, ring in drawn])
    of, expected = stretches(damage, counted, before, behind), plainly(damage, counted, before, behind)
    assert of.worst.tolist() == sorted(expected)
    for k, worst in enumerate(of.worst.tolist()):
        assert set(np.flatnonzero(of.of_station == k).tolist()) == expected[worst]


@given(lines)
def test_what_is_in_no_hot_spot_lies_on_the_flank_of_a_worse_one(drawn):
    """Every damaged station is in one, or a walk over half of its own damage leads to something worse."""
    damage = np.array([d for of_line, _ in drawn for d in of_line])
    counted = np.ones(len(damage), dtype=bool)
    before, behind = neighbours([len(of_line) for of_line, _ in drawn], [ring for _, ring in drawn])
    of = stretches(damage, counted, before, behind)
    for i in np.flatnonzero((damage > 0.0) & (of.of_station < 0)):
        run, go = {int(i)}, [int(i)]
        while go:
            at = go.pop()
            for j in (before[at], behind[at]):
                if j >= 0 and j not in run and damage[j] >= 0.5 * damage[i]:
                    run.add(int(j))
                    go.append(int(j))
        assert damage[list(run)].max() > damage[i]
