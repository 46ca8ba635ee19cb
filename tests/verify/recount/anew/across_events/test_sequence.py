"""Cycles across events by putting passes one behind the other, against the numbers of the specification."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatigue.verify.recount.anew.across_events import sequence
from fatigue.verify.recount.anew.across_events.loop import cycles_between
from fatigue.verify.recount.anew.across_events.sequence import net_cycles
from fatigue.verify.recount.anew.across_events.turns import Turns, of_places, turning_points
from fatigue.verify.recount.anew.across_events.unknown_order import open_and_closed, paired
from fatigue.verify.recount.anew.curve import RecountCurve, curve_named
from fatigue.verify.recount.anew.cycles import count_cycles

EMPTY = [-2, 1, -3, 5, -1, 3, -4, 4, -2]
LOADED = [32, 16, 40, 30, 43, 21, 41, 22, 38, 21, 45, 26, 40, 30, 43, 30]
LOOP = [(EMPTY, True), ([0, 30], False), (LOADED, True), ([30, 0], False)]


def turns_of(event, membrane, bending=None, *, recurs):
    """Turning points of a pass given by its samples."""
    m = np.array(membrane, dtype=float)
    b = np.zeros(len(m)) if bending is None else np.array(bending, dtype=float)
    cycles = count_cycles(m + b, recurs=recurs)
    at = turning_points(m + b, cycles)
    return Turns(event, m[at], b[at], at.astype(float), of_places(cycles, at), recurs)


def power_curve(k):
    """Damage ``S^k``."""
    return RecountCurve((k,), ((0.0, 0.0),), (), 0.0, False, None, 0.0, (0.0, np.inf))


def added(order, turns, k):
    """What a loop adds, as a sum of powers."""
    net = net_cycles(order, turns)
    return net.count @ np.abs(net.stress[net.end] - net.stress[net.start]) ** k


@pytest.mark.parametrize(("k", "expected"), [(3.0, 70004.0), (5.0, 238677332.0)])
def test_the_loop_of_the_specification(k, expected):
    """Empty, load, loaded, unload: 70004 for k = 3, and the same from every entry on."""
    turns = {i: turns_of(i, s, recurs=recurs) for i, (s, recurs) in enumerate(LOOP)}
    for shift in range(4):
        assert added([(i + shift) % 4 for i in range(4)], turns, k) == pytest.approx(expected, rel=1e-13)


def test_the_bending_ratio_of_a_cycle_across_events_is_that_of_its_two_instants():
    """Aluminium, 4 mm: damage of the concatenated passes less that of the events."""
    records = [
        ([-8, 4, -12, 20, -4, 12, -16, 16, -8], [1, -2, 3, -6, 2, -5, 4, -3, 1], True),
        ([0, 45], [0, 12], False),
        (
            [53, 31, 55, 45, 58, 36, 56, 37, 53, 36, 60, 41, 55, 45, 58, 45],
            [12, 9, 14, 12, 15, 10, 13, 11, 12, 8, 16, 12, 13, 12, 15, 12],
            True,
        ),
        ([45, 0], [12, 0], False),
    ]
    turns = {i: turns_of(i, m, b, recurs=recurs) for i, (m, b, recurs) in enumerate(records)}
    curve = curve_named("master-aluminium", {"curve": {"survival": "mean-2sigma"}}, {})

    def damage(of, start, end):
        rows = cycles_between(of, start, end)
        dS = rows["range_MPa"] * 4.0 ** (2 / 9) / curve.bending_factor(rows["bending_ratio"])
        return curve.damage(dS)

    net = net_cycles([0, 1, 2, 3], turns)
    assert net.count @ damage(net, net.start, net.end) == pytest.approx(8.32234332251934e-06, rel=1e-9)
    closing = cycles_between(net, *net.closing)
    largest = closing["range_MPa"].argmax()
    assert closing["range_MPa"][largest] == 88.0
    assert closing["bending_ratio"][largest] == pytest.approx(0.13636363636363635)
    base = [of.cycles.count @ damage(of, of.cycles.start, of.cycles.end) for of in turns.values()]
    expected = [2.134470094016236e-07, 1.1391701407016234e-06, 8.174674187697746e-07, 1.1391701407016234e-06]
    np.testing.assert_allclose(base, expected, rtol=1e-9)


def test_a_loop_may_take_damage_away():
    """Two events of one cycle each that are the halves of one: a cycle less; and the case of two levels."""
    turns = {i: turns_of(i, s, recurs=True) for i, s in enumerate(([5, -5], [-5, 5]))}
    assert added([0, 1], turns, 3.0) == -1000.0
    net = net_cycles([0, 1], turns)
    assert net.count.sum() == -1.0
    two = {0: turns_of(0, [5, -5], recurs=True), 1: turns_of(1, [45, 25], recurs=True)}
    assert added([0, 1], two, 3.0) == 116000.0
    assert added([0, 1], {**two, 1: turns_of(1, [12, 2], recurs=True)}, 3.0) == 2940.0


def test_the_bound_of_an_unknown_order():
    """Five events, pairs of the highest peaks with the lowest valleys, less what closes already."""
    events = [*LOOP, ([0, 9, -7, 6, -2, 3], True)]
    weights = [1.5, 1.5, 1.5, 1.5, 40.0]
    turns = [turns_of(i, s, recurs=recurs) for i, (s, recurs) in enumerate(events)]
    residues, replaced = [], 0.0
    for one, weight in zip(turns, weights, strict=True):
        open_, closed = open_and_closed(one)
        residues.append(one.stress[open_])
        own, s = one.cycles, one.stress
        replaced += weight * (own.count @ np.abs(s[own.end] - s[own.start]) ** 3)
        replaced -= weight * np.sum(np.abs(s[closed.end] - s[closed.start]) ** 3)
    ranges, counts = paired(residues, weights)
    assert counts @ ranges**3 == pytest.approx(805705.5, rel=1e-12)
    assert replaced == pytest.approx(271513.5, rel=1e-12)
    assert residues[0].tolist() == [-2, 1, -3, 5, -4, 4, -2]
    assert residues[2].tolist() == [32, 16, 45, 26, 43, 30]


def test_a_level_pass_is_a_peak_and_a_valley():
    """Two constant levels in any order are one cycle for each pair of stints."""
    residues = [
        one.stress[open_and_closed(one)[0]]
        for one in (turns_of(0, [3, 3], recurs=True), turns_of(1, [10, 10], recurs=False))
    ]
    ranges, counts = paired(residues, [2.0, 5.0])
    assert (ranges.tolist(), counts.tolist()) == ([7.0], [2.0])


passes_of_events = st.lists(
    st.tuples(st.lists(st.integers(-4, 4), min_size=2, max_size=9), st.booleans()), min_size=1, max_size=4
)


@given(passes_of_events, st.lists(st.integers(0, 3), min_size=1, max_size=5), st.integers(-50, 50))
def test_number_of_passes_order_and_level_change_nothing(events, order, level):
    """Passes beyond the first add their own each; a loop has no first entry; a common level is in no range."""
    order = [i % len(events) for i in order]
    turns = {i: turns_of(i, s, recurs=recurs) for i, (s, recurs) in enumerate(events)}
    found = added(order, turns, 3.0)
    assert added([*order[1:], order[0]], turns, 3.0) == found
    shifted = {i: turns_of(i, np.array(s) + level, recurs=recurs) for i, (s, recurs) in enumerate(events)}
    assert added(order, shifted, 3.0) == found
    once = sequence.PASSES
    try:
        for passes in (1, 3):
            sequence.PASSES = passes
            assert added(order, turns, 3.0) == found
    finally:
        sequence.PASSES = once
    if all(events[i][1] for i in order) and len(set(order)) == 1:
        assert found == 0.0


@given(passes_of_events, st.lists(st.integers(0, 3), min_size=2, max_size=6))
def test_no_order_exceeds_the_bound(events, order):
    """Whatever the loop, the pairs of all its stints do at least as much."""
    order = [i % len(events) for i in order]
    turns = {i: turns_of(i, s, recurs=recurs) for i, (s, recurs) in enumerate(events)}
    residues, replaced = [], 0.0
    for i in set(order):
        one, stints = turns[i], order.count(i)
        open_, closed = open_and_closed(one)
        residues.append((one.stress[open_], float(stints)))
        own, s = one.cycles, one.stress
        replaced += stints * (own.count @ np.abs(s[own.end] - s[own.start]) ** 3)
        replaced -= stints * np.sum(np.abs(s[closed.end] - s[closed.start]) ** 3)
    ranges, counts = paired([r for r, _ in residues], [w for _, w in residues])
    assert added(order, turns, 3.0) <= counts @ ranges**3 - replaced + 1e-9
