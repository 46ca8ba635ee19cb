"""Damage of stored histograms under other laws: oracles of the specification, and random cycles always between."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.life.bounds.histogram import Classes, class_damage, damage_between, damage_of_classes, joined_classes
from fatigue.life.counting.block import HISTOGRAM_BINS, HISTOGRAM_EDGES
from fatigue.life.curves import DamageLaw, catalogue, damage_law, user_curve
from fatigue.life.rule import cycle_damage

ALUMINIUM = 3.6085450346420327
ONE_BIN = {  # loads_oracles.json, B2_whatif.one_bin
    "ranges": [48.8, 49.5, 50.0, 50.3],
    "counts": [10.0, 4.0, 1.0, 2.0],
    "sum_n_x5_low_high_true": [4910667663.029425, 4915354849.581763, 4912787075.546659],
    "sum_n_x3_low_high_true": [2026544.7004550775, 2027047.3554155384, 2026819.2739999997],
}
HAIBACH = {  # B2_whatif.haibach
    "dS_n": [(80.0, 200.0), (60.0, 3000.0), (40.0, 60000.0), (25.0, 900000.0), (15.0, 20000000.0)],
    "knee_dS": 26.606549420889586,
    "utilisation": 0.15064376948267105,
    "utilisation_x1.1": 0.2502591121949146,
    "cutoff_utilisation": 0.032834495189377165,
}


def power(k: float) -> DamageLaw:
    """Law d = x^k."""
    return DamageLaw(np.array([k]), np.zeros(1), np.empty(0), 0.0)


def classes_of(x, n, k: float, of=0) -> Classes:
    """Histogram of cycles, sorted as the counters do it."""
    x, n = np.asarray(x, dtype=float), np.asarray(n, dtype=float)
    bins = np.minimum(((np.log10(np.maximum(x, 1e-3)) + 3.0) * 64.0).astype(int), HISTOGRAM_BINS - 1)
    used, at = np.unique(bins, return_inverse=True)
    count, power_sum = np.bincount(at, n), np.bincount(at, n * x**k)
    return Classes(np.full(len(used), of), used, count, power_sum, np.full(len(used), x.max(initial=0.0)))


@pytest.mark.parametrize(("exponent", "key"), [(5.0, "sum_n_x5_low_high_true"), (3.0, "sum_n_x3_low_high_true")])
def test_bounds_of_one_class_are_those_of_the_specification(exponent, key):
    """Jensen's bound and the chord of one class, and the truth between them."""
    one = classes_of(ONE_BIN["ranges"], ONE_BIN["counts"], ALUMINIUM)
    low, value, high = (float(part[0]) for part in damage_of_classes(one, ALUMINIUM, power(exponent)))
    assert one.count.tolist() == [17.0]
    np.testing.assert_allclose(one.power_sum, 21707323.07313325, rtol=1e-12)
    np.testing.assert_allclose([low, high], ONE_BIN[key][:2], rtol=1e-9)
    assert low < ONE_BIN[key][2] < high
    assert value == (low if exponent > ALUMINIUM else high)


@pytest.mark.parametrize(
    ("k", "other", "gap"),
    [  # B2_whatif.widest_relative_gap_jensen_chord
        (ALUMINIUM, 3.0, 0.0002952867068124476),
        (ALUMINIUM, 5.0, 0.0011259239332659376),
        (ALUMINIUM, 2.0 * ALUMINIUM - 1.0, 0.0026260827409800847),
        (3.0, 5.0, 0.0016187673111269785),
        (3.0, 3.6, 0.00034948131141154803),
        (1.0 / 0.3195, 5.0, 0.0015135525877858491),
    ],
)
def test_widest_gap_between_the_bounds_of_a_class(k, other, gap):
    """The largest gap between chord and Jensen's bound, relative to the latter, is that of the specification."""
    a, b = HISTOGRAM_EDGES[300:302]
    mean = np.linspace(a**k, b**k, 100_001)
    rows = len(mean)
    classes = Classes(np.arange(rows), np.full(rows, 300), np.ones(rows), mean, np.full(rows, np.inf))
    low, jensen, high = damage_of_classes(classes, k, power(other))
    np.testing.assert_allclose(((high - low) / jensen).max(), gap, rtol=1e-8)


@pytest.mark.parametrize(
    ("slopes", "gap"), [((ALUMINIUM, 2 * ALUMINIUM - 1), 0.09839492130167105), ((3.0, 5.0), 0.07460782832131763)]
)
def test_widest_gap_of_the_class_that_holds_the_knee(slopes, gap):
    """A knee at the upper end of its class leaves the ratio of the two slopes over the whole class."""
    a, b = HISTOGRAM_EDGES[300:302]
    knee = b * (1.0 - 1e-12)
    k, below = slopes
    law = DamageLaw(np.array(slopes), np.array([0.0, (below - k) * np.log(knee)]), np.array([knee]), 0.0)
    one = Classes(
        np.array([0]), np.array([300]), np.array([2.0]), np.array([2.0 * (0.5 * (a + b)) ** k]), np.array([b])
    )
    low, value, high = damage_of_classes(one, k, law)
    np.testing.assert_allclose(high / low - 1.0, gap, rtol=1e-9)
    assert low < value < high


def test_haibach_and_cut_off_of_the_specification():
    """Five ranges, each alone in its class: the bounds close on the utilisation of the specification."""
    curve = catalogue()["master-aluminium"]
    x, n = np.array(HAIBACH["dS_n"]).T
    haibach = damage_law(curve, "mean-2sigma", "haibach", 1e7)
    np.testing.assert_allclose(haibach.knees, HAIBACH["knee_dS"], rtol=1e-12)
    classes = classes_of(x, n, ALUMINIUM)
    for law, factor, expected in [
        (haibach, 1.0, HAIBACH["utilisation"]),
        (haibach, 1.1, HAIBACH["utilisation_x1.1"]),
        (damage_law(curve, "mean-2sigma", "cutoff", 1e7), 1.0, HAIBACH["cutoff_utilisation"]),
    ]:
        low, value, high = damage_of_classes(classes, ALUMINIUM, law, factor)
        np.testing.assert_allclose(value, expected, rtol=1e-9)
        assert low <= value <= high


def test_single_cycles_leave_no_gap_on_one_power():
    """All cycles of a class alike and at its edge: lower and upper bound are the same number."""
    for x in (HISTOGRAM_EDGES[200], 37.0):
        low, _, high = damage_of_classes(classes_of([x], [3.0], 3.0), 3.0, power(5.0))
        truth = 3.0 * x**5
        assert low[0] <= truth * (1 + 1e-12)
        assert high[0] >= truth * (1 - 1e-12)
    edge = classes_of([HISTOGRAM_EDGES[200] * (1 + 1e-15)], [3.0], 3.0)
    low, _, high = damage_of_classes(edge, 3.0, power(5.0))
    np.testing.assert_allclose(low, high, rtol=1e-12)


def test_first_class_begins_at_zero_and_last_ends_at_the_largest_range():
    """Ranges below the first edge and above the last one are enclosed; without the largest range the bound is open."""
    small, large = np.array([0.0, 2e-4, 9e-4]), np.array([1e5, 2e5, 4e5])
    for x in (small, large):
        one = classes_of(x, np.ones(3), 3.0)
        for exponent in (2.0, 5.0):
            low, value, high = damage_of_classes(one, 3.0, power(exponent))
            assert low <= (x**exponent).sum() * (1 + 1e-12)
            assert high >= (x**exponent).sum() * (1 - 1e-12)
            assert low <= value <= high
            assert np.isfinite(high)
    last = classes_of(large, np.ones(3), 3.0)
    unknown = Classes(last.of, last.bin, last.count, last.power_sum, np.array([np.inf]))
    low, _, high = damage_of_classes(unknown, 3.0, power(5.0))
    assert low <= (large**5).sum()
    assert high == np.inf


def test_the_same_slope_is_exact():
    """On the slope of the power sums every bound is the power sum, times f^k / A."""
    rng = np.random.default_rng(1)
    x, n = rng.uniform(1e-4, 300.0, 500), rng.integers(1, 5, 500)
    law = damage_law(catalogue()["master-aluminium"], "mean", "none", 1e7)
    found = damage_of_classes(classes_of(x, n, ALUMINIUM), ALUMINIUM, law, 0.7)
    np.testing.assert_allclose(found, np.full((3, 1), (n * cycle_damage(0.7 * x, law)).sum()), rtol=1e-12)


def laws():
    """Laws of one to three powers with and without a cut-off, straight, Haibach's and cut off."""
    aluminium = catalogue()["master-aluminium"]
    of_master = st.sampled_from(["none", "haibach", "cutoff"]).map(
        lambda extension: damage_law(aluminium, "mean-2sigma", extension, 1e7)
    )
    slopes = st.lists(st.floats(1.5, 9.0), min_size=1, max_size=3)

    def own(slopes: list[float], cut: bool, at: float) -> DamageLaw:
        knees = tuple(np.geomspace(1e6, 1e8, 3)[: len(slopes) - 1 + cut].tolist())
        return damage_law(user_curve("own", tuple(slopes), knees, at, "dS", "test"), None, "none", 1e7)

    return st.one_of(of_master, st.builds(own, slopes, st.booleans(), st.floats(5.0, 150.0)))


cycles = st.lists(st.tuples(st.floats(1e-4, 400.0), st.sampled_from([0.5, 1.0, 7.0])), min_size=1, max_size=60)


@settings(max_examples=400, deadline=None)
@given(cycles, st.floats(1.5, 6.0), laws(), st.floats(0.3, 3.0), st.booleans())
def test_random_cycles_are_always_between_the_bounds(found, k, law, factor, dense):
    """Whatever the cycles, laws and factors are, the damage of the cycles lies between, and so does the value."""
    x, n = np.array(found).T
    x = 20.0 + x / 40.0 if dense else x  # many in each class
    truth = (n * cycle_damage(factor * x, law)).sum()
    low, value, high = (float(part[0]) for part in damage_of_classes(classes_of(x, n, k), k, law, factor))
    room = 1e-11 * truth + 1e-300
    assert low - room <= truth <= high + room
    assert low - room <= value <= high + room


@settings(max_examples=100, deadline=None)
@given(st.lists(cycles, min_size=2, max_size=4), laws(), st.floats(0.5, 2.0))
def test_many_points_at_once_are_those_one_by_one(points, law, factor):
    """The damage of a point does not depend on what stands beside it."""
    alone, parts = [], []
    for number, found in enumerate(points):
        x, n = np.array(found).T
        parts.append(classes_of(x, n, 3.0, number))
        alone.append(np.ravel(damage_of_classes(classes_of(x, n, 3.0), 3.0, law, factor)))
    names = ("of", "bin", "count", "power_sum", "largest")
    together = Classes(*(np.concatenate([getattr(part, name) for part in parts]) for name in names))
    of_factor = np.full(len(together), factor)
    found = damage_of_classes(together, 3.0, law, of_factor, len(points) + 1)
    np.testing.assert_allclose(np.transpose(found)[:-1], alone, rtol=1e-12, atol=0.0)
    np.testing.assert_array_equal(np.transpose(found)[-1], 0.0)


@settings(max_examples=200, deadline=None)
@given(cycles, cycles, st.floats(0.0, 1.0), st.floats(0.001, 5.0), laws(), st.integers(0, 2**32 - 1))
def test_loops_join_the_passes_whose_cycles_they_replace(own, closing, part, weight, law, seed):
    """What a loop takes from a pass and what it adds has no bounds alone, and the truth inside with the pass."""
    k = 3.0
    (x, n), (y, m) = np.array(own).T, np.array(closing).T
    taken = np.random.default_rng(seed).random(len(x)) < part
    loop = classes_of(np.concatenate([y, x[taken]]), np.concatenate([m, -n[taken]]), k)
    passes = classes_of(x, n, k).times(weight)
    loop = loop.times(weight * (1.0 - part))
    names = ("of", "bin", "count", "power_sum", "largest")
    both = Classes(*(np.concatenate([getattr(passes, name), getattr(loop, name)]) for name in names))
    low, value, high = (float(p[0]) for p in damage_of_classes(joined_classes(both), k, law, points=1))
    runs = weight * (1.0 - part)
    damage = [(count * cycle_damage(at, law)).sum() for at, count in ((x, n), (y, m), (x[taken], n[taken]))]
    truth = weight * damage[0] + runs * (damage[1] - damage[2])
    room = 1e-8 * (weight * damage[0] + runs * damage[1]) + 1e-300
    assert low - room <= truth <= high + room
    assert low - room <= value <= high + room
    assert high < np.inf


def test_classes_that_lose_more_than_they_have_are_open():
    """A loop alone: cycles taken at one end of a class and added at its other end have no bounds on another slope."""
    loop = classes_of([48.8, 50.3], [1.0, -1.0], ALUMINIUM)
    low, _, high = class_damage(loop, ALUMINIUM, power(5.0))
    assert (low[0], high[0]) == (-np.inf, np.inf)
    found = damage_of_classes(loop, ALUMINIUM, power(ALUMINIUM))
    np.testing.assert_allclose(found, np.full((3, 1), 48.8**ALUMINIUM - 50.3**ALUMINIUM), rtol=1e-12)
    taken = classes_of([48.8, 50.3], [-1.0, -2.0], ALUMINIUM)
    low, value, high = damage_of_classes(taken, ALUMINIUM, power(5.0))
    assert low < -(48.8**5) - 2 * 50.3**5 < high
    assert low <= value <= high


@settings(max_examples=200, deadline=None)
@given(cycles, st.floats(1.5, 6.0), laws(), st.floats(0.3, 3.0))
def test_all_cycles_as_one_class_still_enclose_the_truth(found, k, law, factor):
    """From 0 to the largest range, with nothing but their number and power sum."""
    x, n = np.array(found).T
    count, power_sum = np.array([n.sum()]), np.array([(n * x**k).sum()])
    ends = np.zeros(1), np.array([x.max()])
    low, value, high = (float(part[0]) for part in damage_between(count, power_sum, ends, k, law, factor))
    truth = (n * cycle_damage(factor * x, law)).sum()
    room = 1e-11 * truth + 1e-300
    assert low - room <= truth <= high + room
    assert low - room <= value <= high + room
    assert high < np.inf
