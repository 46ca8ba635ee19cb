"""Hot spots: read-outs at printed distances, with printed weights."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatigue.weld.beside.hot_spot import EDGE, FACE, SETS, matching_set, sets_of

LINEAR, QUADRATIC = (120.0, -3.0, 0.0), (120.0, -9.4, 0.5)


def read(field, distances):
    """Stress of a polynomial field at some distances from the toe."""
    return np.polynomial.polynomial.polyval(np.asarray(distances), field)


@pytest.mark.parametrize(
    ("kind", "distances", "stress", "name", "hot_spot"),
    [
        (FACE, [4.0, 10.0], [108.0, 90.0], "a fine", 120.06),
        (FACE, [5.0, 15.0], [105.0, 75.0], "a coarse", 120.0),
        (FACE, [4.0, 9.0, 14.0], [90.4, 71.4, 72.4], "a quadratic", 120.0),
        (EDGE, [4.0, 8.0, 12.0], [90.4, 73.6, 69.6], "b fine", 120.0),
        (EDGE, [5.0, 15.0], [105.0, 75.0], "b coarse", 120.0),
    ],
)
def test_extrapolation_with_the_printed_weights(kind, distances, stress, name, hot_spot):
    """The stress at the toe of a plate of 10 mm; the printed 1.67 and 0.67 leave 0.002 t of the gradient."""
    found = matching_set(kind, np.array(distances), 10.0)
    assert found is not None
    assert found.name == name
    assert found.weights @ np.array(stress) == pytest.approx(hot_spot, rel=1e-12)


@pytest.mark.parametrize("one", SETS)
def test_weights_of_a_set_extrapolate_to_the_toe(one):
    """A constant is kept; a linear field is met, but for the printed digits of the fine set."""
    distances, weights = np.array(one.distances), np.array(one.weights)
    assert weights.sum() == pytest.approx(1.0, rel=1e-12)
    left = {"a fine": -0.002}.get(one.name, 0.0)
    assert weights @ distances == pytest.approx(left, abs=1e-12)
    if distances.size == 3:
        assert weights @ distances**2 == pytest.approx(0.0, abs=1e-12)


@given(st.sampled_from(sets_of(FACE)), st.floats(0.5, 100.0), st.floats(-1.0, 1.0), st.sampled_from([0, 1]))
def test_distances_of_type_a_may_be_off_by_a_hundredth_of_the_thickness(one, thickness, off, place):
    """Up to 1 % of the thickness the set is recognised, beyond it none is."""
    distances = thickness * np.array(one.distances)
    distances[place] += 0.01 * thickness * off
    assert matching_set(FACE, distances, thickness) is one
    distances[place] += np.copysign(0.011 * thickness, off) * 2.0
    assert matching_set(FACE, distances, thickness) is None


@given(st.sampled_from(sets_of(EDGE)), st.floats(0.5, 100.0), st.floats(-0.1, 0.1))
def test_distances_of_type_b_do_not_know_the_thickness(one, thickness, off):
    """Up to 0.1 mm the set is recognised, whatever the plate; one more read-out makes another set."""
    distances = np.array(one.distances)
    distances[0] += off
    assert matching_set(EDGE, distances, thickness) is one
    assert matching_set(EDGE, distances + 0.25, thickness) is None
    assert matching_set(EDGE, np.append(distances, 40.0), thickness) is None


def test_sets_are_not_mixed():
    """Distances of one type are none of the other, and those of no set are none."""
    assert matching_set(FACE, np.array([4.0, 8.0, 12.0]), 50.0) is None
    assert matching_set(EDGE, np.array([4.0, 10.0]), 10.0) is None
    assert matching_set(FACE, np.array([0.4, 1.5]), 1.0) is None
    assert matching_set(FACE, np.array([]), 10.0) is None
