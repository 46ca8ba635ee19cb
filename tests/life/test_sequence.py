"""Cycles across events: against published numbers, against the record written out, and as what they must never be."""

from collections.abc import Sequence
from itertools import permutations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from fatigue.life.counting.residue import BlockResidue, residue_of_rows
from fatigue.life.counting.rows import count_histories
from fatigue.life.curves import DamageLaw, catalogue, damage_law, user_curve
from fatigue.life.rule import CycleRule, size_factor
from fatigue.life.sequence import Residues, convex_damage, count_loop, loop_at_factors, residues_of, unknown_order
from tests import naive_sequence as naive

Floats = NDArray[np.float64]

EMPTY = [-2, 1, -3, 5, -1, 3, -4, 4, -2]
LOADED = [32, 16, 40, 30, 43, 21, 41, 22, 38, 21, 45, 26, 40, 30, 43, 30]
EVENTS = {"empty": EMPTY, "load": [0, 30], "loaded": LOADED, "unload": [30, 0]}
HALF = {"empty": False, "load": True, "loaded": False, "unload": True}
ORDER = ["empty", "load", "loaded", "unload"]

ONE = np.ones(1)
passes = st.lists(st.integers(-5, 5), min_size=1, max_size=12)
loops = st.lists(st.tuples(passes, st.booleans()), min_size=1, max_size=6)


def power_law(k: float) -> CycleRule:
    """Damage S^k."""
    return CycleRule(DamageLaw(np.array([k]), np.zeros(1), np.empty(0), 0.0), False)


def residues(
    events: Sequence[Sequence[float]], half: Sequence[bool], bending: Sequence[Sequence[float]] = ()
) -> Residues:
    """Residues of events at one point, of membrane stress alone unless bending is given."""
    rows = [np.array(event, dtype=float)[None] for event in events]
    of_bending = [np.array(b, dtype=float)[None] for b in bending] or [0.0 * row for row in rows]
    found = [residue_of_rows(m, b) for m, b in zip(rows, of_bending, strict=True)]
    return residues_of(found, [np.zeros(1)] * len(rows), [np.zeros(1)] * len(rows), list(half))


def added(events: Sequence[Sequence[float]], half: Sequence[bool], k: float) -> float:
    """T of one loop of these events in their order, damage S^k."""
    found = count_loop(residues(events, half), tuple(range(len(events))), ONE, power_law(k))
    assert found.damage[0, 0] == pytest.approx(found.power_sum[0, 0], rel=1e-12, abs=1e-9)
    return float(found.damage[0, 0])


@pytest.mark.parametrize(("k", "expected"), [(3.0, 70004.0), (5.0, 238677332.0)])
def test_transitions_of_the_reference_loop(k: float, expected: float) -> None:
    """Empty, load, loaded, unload; also as the explicit record of several passes for each stint."""
    found = added([EVENTS[name] for name in ORDER], [HALF[name] for name in ORDER], k)
    assert found == pytest.approx(expected, rel=1e-12)
    record = [x for name, n in zip(ORDER, (3, 1, 2, 1), strict=True) for x in EVENTS[name] * n]
    base = {n: (naive.damage_half if HALF[n] else naive.damage_repeat)(EVENTS[n], k) for n in ORDER}
    total = 3 * base["empty"] + base["load"] + 2 * base["loaded"] + base["unload"] + found
    assert total == pytest.approx(naive.damage_repeat(record, k), rel=1e-12)
    assert total == pytest.approx({3.0: 208601.0, 5.0: 326275193.0}[k], rel=1e-12)


@pytest.mark.parametrize(("m2", "M2", "expected"), [(25, 45, 116000.0), (2, 12, 2940.0)])
def test_two_levels(m2: float, M2: float, expected: float) -> None:
    """``(M2 - m1)^k + max(M1 - m2, 0)^k - (M1 - m1)^k - (M2 - m2)^k``."""
    assert added([[-5, 5], [m2, M2]], [False, False], 3.0) == pytest.approx(expected, rel=1e-12)


def test_transitions_may_be_negative() -> None:
    """One cycle in turn, two apart."""
    assert added([[5, -5], [-5, 5]], [False, False], 3.0) == pytest.approx(-1000.0, rel=1e-12)


M = {
    "empty": [-8, 4, -12, 20, -4, 12, -16, 16, -8],
    "load": [0, 45],
    "loaded": [53, 31, 55, 45, 58, 36, 56, 37, 53, 36, 60, 41, 55, 45, 58, 45],
    "unload": [45, 0],
}
B = {
    "empty": [1, -2, 3, -6, 2, -5, 4, -3, 1],
    "load": [0, 12],
    "loaded": [12, 9, 14, 12, 15, 10, 13, 11, 12, 8, 16, 12, 13, 12, 15, 12],
    "unload": [12, 0],
}


def test_bending_ratios_are_those_of_the_two_instants() -> None:
    """Membrane and bending on the aluminium master curve, 4 mm; two of the passes are written out twice and more."""
    curve = catalogue()["master-aluminium"]
    rule = CycleRule(damage_law(curve, "mean-2sigma", "none", 1e7), True)
    size = size_factor(np.array([4.0]), curve, "actual")
    found = count_loop(
        residues([M[n] for n in ORDER], [HALF[n] for n in ORDER], [B[n] for n in ORDER]), (0, 1, 2, 3), size, rule
    )
    assert found.damage[0, 0] == pytest.approx(8.32234332251934e-06, rel=1e-12)
    assert found.max_range[0, 0] == pytest.approx(88.0, rel=1e-12)
    stints = list(zip(ORDER, (3, 1, 2, 1), strict=True))
    m, b = (np.array([x for name, n in stints for x in part[name] * n], dtype=float)[None] for part in (M, B))
    explicit = count_histories(m, b, size, np.zeros((1, 2)), "repeat", rule).damage[0]
    alone = np.zeros(2)
    for name, n in stints:
        one = (np.array(part[name], dtype=float)[None] for part in (M, B))
        alone += n * count_histories(*one, size, np.zeros((1, 2)), "half" if HALF[name] else "repeat", rule).damage[0]
    assert alone + found.damage[0] == pytest.approx(explicit, rel=1e-12)
    assert explicit[0] == pytest.approx(1.2875959469667007e-05, rel=1e-12)


@settings(deadline=None)
@given(loops, st.sampled_from([1.0, 3.0, 5.0]))
def test_transitions_make_the_sum_that_of_the_record_written_out(loop: list[tuple[list[int], bool]], k: float) -> None:
    """Random loops with plateaus, ties, constant passes and half entries; the `rainflow` package counts the record."""
    names = [str(i) for i in range(len(loop))]
    events, half = (
        dict(zip(names, [e for e, _ in loop], strict=True)),
        dict(zip(names, [h for _, h in loop], strict=True)),
    )
    expected = naive.transitions(events, half, names, k)
    assert added(list(events.values()), list(half.values()), k) == pytest.approx(expected, rel=1e-12, abs=1e-6)


@settings(deadline=None)
@given(passes)
def test_loop_of_one_event_adds_nothing(event: list[int]) -> None:
    """To the last bit: an event that follows on itself is what it is counted as."""
    assert added([event], [False], 3.7) == 0.0


@settings(deadline=None)
@given(loops, st.integers(0, 5), st.integers(-50, 50))
def test_turning_the_order_and_a_common_offset_change_nothing(
    loop: list[tuple[list[int], bool]], turn: int, offset: int
) -> None:
    """A loop begins anywhere, and a dead load that all events have makes no cycle."""
    events, half = [e for e, _ in loop], [h for _, h in loop]
    turn %= len(loop)
    expected = added(events, half, 3.0)
    turned = added(events[turn:] + events[:turn], half[turn:] + half[:turn], 3.0)
    shifted = added([[x + offset for x in e] for e in events], half, 3.0)
    assert (turned, shifted) == pytest.approx((expected, expected), rel=1e-12, abs=1e-6)


def test_constants_of_the_events_are_offsets_of_their_residues() -> None:
    """Carried beside the samples, membrane and bending apart, they do what they do in the samples."""
    found = residue_of_rows(np.array([EMPTY], dtype=float), np.zeros((1, 9)))
    beside = residues_of(
        [found, found], [np.zeros(1), np.array([30.0])], [np.zeros(1), np.array([2.0])], [False, False]
    )
    inside = residues([EMPTY, [x + 30.0 for x in EMPTY]], [False, False], [[0.0] * 9, [2.0] * 9])
    rule = CycleRule(power_law(3.6).law, True)
    a, b = (count_loop(r, (0, 1), ONE, rule).damage for r in (beside, inside))
    assert a == pytest.approx(b, rel=1e-12)


KNEE = user_curve("knee", (3.0, 5.0), (2e6, 1e8), 80.0, "structural", "test")


@pytest.mark.parametrize("k", [3.0, None])
def test_transitions_under_factors_are_those_of_scaled_residues(k: float | None) -> None:
    """On a straight curve they scale with f^k; on one with a knee they are counted at every factor."""
    rule = power_law(k) if k else CycleRule(damage_law(KNEE, None, "none", 1e7), False)
    events = [[3.0 * x for x in EVENTS[name]] for name in ORDER]
    half = [HALF[name] for name in ORDER]
    factors = np.exp(0.3 * np.arange(5)) * 0.4
    found = loop_at_factors(
        residues(events, half), (0, 1, 2, 3), ONE, rule, np.full((1, 2), 0.4), np.full((1, 2), 0.3), 5
    )
    scaled = [
        count_loop(residues([[f * x for x in e] for e in events], half), (0, 1, 2, 3), ONE, rule) for f in factors
    ]
    assert found[0, 0] == pytest.approx([s.damage[0, 0] for s in scaled], rel=1e-11)
    if k:
        assert found[0, 0] == pytest.approx(found[0, 0, 0] * (factors / 0.4) ** k, rel=1e-11)


def test_unknown_order_of_the_reference_events() -> None:
    """The highest peak with the lowest valley, with the weights of five events, less what they have already."""
    events = [*EVENTS.values(), [0, 9, -7, 6, -2, 3]]
    stints = np.array([1.5, 1.5, 1.5, 1.5, 40.0]) / 1000.0
    found = unknown_order(residues(events, [*HALF.values(), False]), stints, ONE, power_law(3.0))
    assert found[0, 0] == pytest.approx(534.192, rel=1e-12)


@settings(deadline=None, max_examples=60)
@given(st.lists(passes, min_size=2, max_size=4), st.sampled_from([2.0, 3.0, 5.0]))
def test_no_order_exceeds_the_bound(events: list[list[int]], k: float) -> None:
    """Every order of the events in one run of a loop."""
    n = len(events)
    bound = float(unknown_order(residues(events, [False] * n), np.ones(n), ONE, power_law(k))[0, 0])
    own = sum(naive.damage_repeat(e, k) for e in events)
    pairs = naive.pairing_sum([(naive.residue(e), 1.0) for e in events], k)
    assert bound == pytest.approx(
        pairs - sum(naive.damage_repeat(naive.residue(e), k) for e in events), rel=1e-9, abs=1e-6
    )
    for order in permutations(range(n)):
        of_order = added([events[i] for i in order], [False] * n, k)
        assert of_order <= bound + 1e-9 * (own + abs(bound) + 1.0)


@settings(deadline=None, max_examples=60)
@given(st.lists(passes, min_size=2, max_size=3), st.floats(0.0, 0.6), st.integers(20, 60))
def test_bound_holds_with_a_knee_bending_and_mean_stress(events: list[list[int]], bend: float, level: int) -> None:
    """The first slope extended, r = 0 and f_M of the largest stress are no less than any cycle's damage."""
    curve = catalogue()["master-steel"]
    rule = CycleRule(damage_law(curve, "mean-2sigma", "haibach", 1e7), True, 300.0, True)
    stress = [[6.0 * x + 4.0 * level for x in e] for e in events]
    both = residues(
        [[(1 - bend) * x for x in e] for e in stress], [False] * len(events), [[bend * x for x in e] for e in stress]
    )
    size, n = np.full(1, 1.7), len(events)
    bound = unknown_order(both, np.ones(n), size, rule)
    for order in permutations(range(n)):
        assert (count_loop(both, order, size, rule).damage <= bound * (1 + 1e-9) + 1e-15).all()


def test_convex_damage_takes_all_slopes_where_the_curve_flattens() -> None:
    """A curve that is less steep below its knee lies above its first slope there."""
    curve = user_curve("odd", (5.0, 3.0), (1e6,), 80.0, "structural", "test")
    assert convex_damage(CycleRule(damage_law(curve, None, "none", 1e7), False)).exponents.tolist() == [5.0, 3.0]
    assert convex_damage(CycleRule(damage_law(KNEE, None, "none", 1e7), False)).exponents.tolist() == [3.0]


def test_no_points_have_no_transitions() -> None:
    """A block without stations."""
    none = BlockResidue(np.empty(0), np.empty(0), np.empty((0, 2), np.int64), np.empty((0, 2), np.int64))
    of_none = residues_of([none], [np.empty(0)], [np.empty(0)], [False])
    assert count_loop(of_none, (0,), np.empty(0), power_law(3.0)).damage.shape == (0, 2)
    assert unknown_order(of_none, np.ones(1), np.empty(0), power_law(3.0)).shape == (0, 2)
