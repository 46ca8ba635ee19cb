"""The worst pair of states, with the components of each pair at the same two states."""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from fatigue.life.endurance.haigh import allowed_amplitudes, endurance_line, utilisations
from fatigue.life.endurance.pairs import plane_range, signed_utilisations, worst_pairs
from fatigue.life.endurance.zonotope import corners, extremes

R = np.array([-1.0, 0.0, 0.5])
PERP = endurance_line("p", "perp", R, np.array([60.0, 92.3, 126.3]))
PAR = endurance_line("l", "par", R, np.array([90.0, 140.0, 190.0]))
SHEAR = endurance_line("t", "shear", R[[0, 2]], np.array([35.0, 70.0]))
LINES = [PERP, PAR, SHEAR]


def naive(states, coefficients):
    """Largest combination of all pairs of states (s, 3), written down as it is defined, and its pair."""
    best = (-np.inf, (0, 0))
    for (i, one), (j, other) in itertools.combinations(enumerate(states), 2):
        u = []
        for line, a, b in zip(LINES, one, other, strict=True):
            low, high = min(a, b), max(a, b)
            sign = -1.0 if abs(low) > abs(high) else 1.0
            if line is SHEAR and sign < 0:
                low, high = -high, -low
            amplitude, mean = (high - low) / 2, (high + low) / 2
            allowed = np.nan if amplitude == 0 else allowed_amplitudes(line, np.array([mean / amplitude]))[0]
            u.append(0.0 if amplitude == 0 else sign * amplitude / allowed)
        of_all = [u[0] ** 2 + u[1] ** 2 - k * u[0] * u[1] + u[2] ** 2 for k in coefficients]
        best = max(best, (max(of_all), (i, j)), key=lambda found: found[0])
    return best


@settings(deadline=None)
@given(
    arrays(float, (5, 3), elements=st.floats(-60.0, 60.0)),
    st.lists(st.floats(-2.0, 2.0), min_size=1, max_size=3),
)
def test_the_worst_pair_is_that_of_all_pairs(states, coefficients):
    """Where the lines have every pair, value and utilisations are those of the definition."""
    states = states - 70.0 * np.array([1.0, 1.0, 0.0])  # in compression, so that the first rows have them
    states[:, 2] *= np.where(np.arange(5) % 2, 1.0, -1.0)
    found = worst_pairs(states[None], LINES, coefficients)
    value, _ = naive(states, coefficients)
    if found.inside[0] and np.isfinite(value):
        assert found.value[0] == pytest.approx(value, rel=1e-9, abs=1e-12)
        one, other = states[found.pair[0]][:, None]
        u = signed_utilisations(one, other, LINES)[0]
        of_all = [u[0] ** 2 + u[1] ** 2 - k * u[0] * u[1] + u[2] ** 2 for k in coefficients]
        assert max(of_all) == pytest.approx(found.value[0], rel=1e-9, abs=1e-12)


def test_ranges_of_all_pairs_in_the_plane():
    """Distances of load cases as they are, of which the farthest pair is the range in the plane."""
    cases = {"LC1": [40, 10], "LC2": [-15, 4], "LC3": [22, -30], "LC4": [5, 25]}
    known = {
        ("LC1", "LC2"): 55.3263047745,
        ("LC1", "LC3"): 43.8634243989,
        ("LC1", "LC4"): 38.0788655293,
        ("LC2", "LC3"): 50.2493781056,
        ("LC2", "LC4"): 29.0,
        ("LC3", "LC4"): 57.5673518585,
    }
    for pair, distance in known.items():
        assert plane_range(np.array([[cases[one] for one in pair]], dtype=float))[0] == pytest.approx(distance)
    assert plane_range(np.array([list(cases.values())], dtype=float))[0] == pytest.approx(57.5673518585)


def test_components_of_a_pair_belong_to_the_same_states():
    """Two loads that pull apart in one component and together in the other never make both ranges at once."""
    loads = np.array([[[30.0, 0.0, 20.0], [30.0, 0.0, -20.0]]])
    states = corners(np.zeros((1, 3)), loads)
    found = worst_pairs(states, [PERP, SHEAR])
    alone = [worst_pairs(states, [line]).value[0] for line in (PERP, SHEAR)]
    np.testing.assert_allclose(alone, [1.0, (40.0 / 35.0) ** 2])
    assert found.value[0] == pytest.approx(max(alone))
    assert found.value[0] < sum(alone)


def test_the_sign_of_the_product_is_that_of_the_larger_stress():
    """Tension across and compression along the weld add up under a positive coefficient."""
    same = np.array([[[60.0, 60.0, 0.0], [-50.0, -50.0, 0.0]]])
    apart = np.array([[[60.0, -60.0, 0.0], [-50.0, 50.0, 0.0]]])
    plain, with_product = (worst_pairs(same, [PERP, PAR], some).value[0] for some in ([], [1.0]))
    assert with_product < plain
    assert worst_pairs(apart, [PERP, PAR], [1.0]).value[0] > plain
    assert worst_pairs(apart, [PERP, PAR], [1.0, 0.5]).value[0] == worst_pairs(apart, [PERP, PAR], [1.0]).value[0]


@settings(deadline=None)
@given(
    st.integers(1, 5).flatmap(lambda k: arrays(float, (k,), elements=st.floats(-40.0, 40.0))), st.floats(-60.0, 60.0)
)
def test_of_one_component_the_full_range_decides(v, static):
    """Of all pairs of corners none is worse than all loads from one end to the other, shear included."""
    for line, c in ((PERP, 0), (SHEAR, 2)):
        loads = np.zeros((1, len(v), 3))
        loads[0, :, c] = v
        s_0 = np.zeros((1, 3))
        s_0[0, c] = static
        low, high, _ = extremes(s_0[:, c], loads[:, :, c])
        if c == 2 and -low[0] > high[0]:
            low, high = -high, -low
        u, inside = utilisations(line, low, high)
        found = worst_pairs(corners(s_0, loads), [line])
        if inside[0]:
            assert np.sqrt(found.value[0]) == pytest.approx(u[0], rel=1e-9, abs=1e-9)


def test_a_pair_above_the_table_is_told_only_where_it_could_decide():
    """A small load on a large static stress lies above the last row; beside a large load it is known to be less."""
    static = np.array([[50.0, 0.0, 0.0]])
    small, large = np.array([[[4.0, 0, 0]]]), np.array([[[4.0, 0, 0], [40.0, 0, 0]]])
    alone = worst_pairs(corners(static, small), [PERP])
    assert not alone.inside[0]
    assert np.sqrt(alone.value[0]) == pytest.approx(54.0 / 126.3)
    assert worst_pairs(corners(static, large), [PERP]).inside[0]


def test_states_that_are_equal_use_nothing():
    """Nothing alternates: the value is 0, and the pair is the first one."""
    found = worst_pairs(np.full((1, 3, 3), 80.0), LINES, [1.0])
    assert found.value[0] == 0.0
    assert found.pair.tolist() == [[0, 1]]
    assert found.inside[0]
