"""What is said of the largest half cycle of a path moves by no more than its bound where its points do."""

import numpy as np
import pytest

from fatigue.verify.recount.anew.curve import RecountCurve
from fatigue.verify.recount.anew.shear.path import HalfCycles, half_cycles
from fatigue.verify.recount.anew.shear.rounding import EQUAL, bound_of_largest, spread_of_largest, sums_bounds


def circle(n, random):
    """Arcs about the first point, on which rounding decides what is as far as never before."""
    turn = np.linspace(0.0, random.uniform(1.0, 6.0), n)
    far = np.repeat(np.sort(random.uniform(0.2, 1.0, 5)), n // 5 + 1)[:n]
    return np.vstack([[0.0, 0.0], far[:, None] * np.stack([np.cos(turn), np.sin(turn)], axis=1)])


KINDS = {
    "noise": lambda n, random: random.normal(size=(n, 2)),
    "smooth": lambda n, random: np.stack([np.convolve(random.normal(size=n), np.ones(9), "same") for _ in range(2)], 1),
    "walk": lambda n, random: random.normal(size=(n, 2)).cumsum(axis=0),
    "lattice": lambda n, random: random.integers(-3, 4, (n, 2)).astype(float),
    "line": lambda n, random: np.outer(random.normal(size=n), [1.0, 2.0]),
    "at rest": lambda n, random: np.repeat(random.normal(size=(n // 3 + 1, 2)), 3, axis=0),
    "a round": lambda n, random: np.tile(KINDS["smooth"](n // 3, random), (3, 1)),
    "arcs": circle,
    "ellipse": lambda n, random: np.stack(
        [np.cos(np.arange(n) / 3.0), random.uniform() * np.sin(np.arange(n) / 3.0)], 1
    ),
}


def said(path: HalfCycles, e: float) -> np.ndarray:
    """Factor and moment of the largest half cycle, with their bounds: (2, 2)."""
    p = np.maximum(path.length / path.range, 1.0)
    top = path.range >= EQUAL * path.range.max()
    own = (path.length_bound + 2.0 * e * p) / path.range, path.moment_bound
    values = float(p[top].max()), float(path.moment[top].max())
    bounds = [
        bound_of_largest(v, *both, path, 2.0 * e)
        for v, both in zip(values, zip((p, path.moment), own, strict=True), strict=True)
    ]
    return np.array([values, bounds])


@pytest.mark.parametrize("recurs", [True, False])
@pytest.mark.parametrize("kind", KINDS)
def test_bounds_on_the_largest_half_cycle_hold(kind, recurs):
    """All points moved at random by rounding of many sizes."""
    random = np.random.default_rng(5)
    for size in (1e-12, 1e-10, 1e-9, 1e-8, 1e-6, 1e-4, 1e-2):
        z = KINDS[kind](int(random.integers(15, 40)), random)
        e = size * float(np.ptp(z, axis=0).max())
        turn, far = random.uniform(0.0, 2.0 * np.pi, len(z)), e * random.uniform(size=len(z))
        moved = z + far[:, None] * np.stack([np.cos(turn), np.sin(turn)], axis=1)
        before, after = (said(half_cycles(one, recurs=recurs, rounding=e), e) for one in (z, moved))
        assert (np.abs(after[0] - before[0]) <= before[1]).all()


@pytest.mark.parametrize("kind", ["noise", "smooth", "walk"])
def test_bounds_are_small_where_rounding_is(kind):
    """A ten-thousand-millionth of the range leaves what is said of an ordinary path to a millionth."""
    random = np.random.default_rng(6)
    bounds = []
    for _ in range(10):
        z = KINDS[kind](100, random)
        e = 1e-11 * float(np.ptp(z, axis=0).max())
        bounds.append(said(half_cycles(z, recurs=True, rounding=e), e)[1])
    assert np.median(bounds) < 1e-6
    assert np.min(bounds) > 0.0


def test_no_rounding_has_no_bound():
    """Points that are exact leave all as it is."""
    z = np.random.default_rng(7).normal(size=(50, 2))
    assert not said(half_cycles(z, recurs=True), 0.0)[1].any()


def test_equal_ranges_that_rounding_swaps_are_as_far_apart_as_they_are():
    """Of two events the larger factor counts where their ranges are equal, and either where rounding decides."""
    factors, own, pairs = np.array([1.2, 1.5]), np.array([1e-6, 2e-6]), np.arange(2)

    def bound(ranges, rho):
        return spread_of_largest(1.5, factors, own, np.array(ranges), pairs, rho)

    assert bound([100.0, 100.0], 1e-9) == 2e-6
    assert bound([100.0, 99.0], 1e-9) == 1e-6
    assert bound([100.0, 100.0 * EQUAL], 1e-9) == pytest.approx(0.3, abs=1e-5)
    assert bound([100.0, 100.0], 1e-6) == pytest.approx(0.3, abs=1e-5)


@pytest.mark.parametrize("kind", ["noise", "smooth", "walk", "line"])
def test_bounds_on_the_sums_hold(kind):
    """Sums by range, length and moment on a straight curve move by less than their bounds, and these are small."""
    random, alpha = np.random.default_rng(8), 0.5
    curve = RecountCurve((3.0,), ((0.0, 0.0),), (), 0.0, False, None, 0.0, (0.0, np.inf))
    for size in (1e-12, 1e-10, 1e-8):
        for _ in range(3):
            z = KINDS[kind](50, random)
            e = size * float(np.ptp(z, axis=0).max())
            sums = []
            for one in (z, z + e * random.uniform(-0.7, 0.7, z.shape)):
                path = half_cycles(one, recurs=True, rounding=e)
                equivalent = (1.0, np.maximum(path.length / path.range, 1.0), 1.0 + alpha * path.moment)
                sums.append([0.5 * curve.damage(factor * path.range).sum() for factor in equivalent])
            bounds = sums_bounds(path, path.range, 2.0 * e, 2.0 * e, len(z), alpha, curve)
            assert list(bounds) == ["by_range", "by_length", "by_moment"]
            assert (np.abs(np.subtract(*sums)) <= list(bounds.values())).all()
            assert (np.array(list(bounds.values())) <= 1e5 * size * np.array(sums[0])).all()
