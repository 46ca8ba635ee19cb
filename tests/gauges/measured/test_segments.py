"""A record is cut where it is flagged: nothing flagged is kept, nothing good is lost, bridges are short and inside."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from fatigue.gauges.measured.flags import runs
from fatigue.gauges.measured.segments import at_rate, cut_at, mask_of

MASKS = st.lists(st.booleans(), min_size=1, max_size=60).map(lambda flags: np.array(flags, dtype=bool))


@given(MASKS)
def test_segments_hold_what_is_not_flagged(flagged):
    """Without bridges the kept samples are the good ones, as they were."""
    x = np.arange(len(flagged), dtype=float) ** 2
    cut = cut_at(x, flagged)
    np.testing.assert_array_equal(cut.kept, ~flagged)
    np.testing.assert_array_equal(cut.x[~flagged], x[~flagged])
    assert cut.bridged == 0


@given(MASKS, st.integers(0, 5))
def test_bridges_are_no_longer_than_asked_and_between_good_samples(flagged, most):
    """A gap is kept whole or not at all, and never at an end of the record."""
    x = 2.0 + 0.5 * np.arange(len(flagged))
    cut = cut_at(np.where(flagged, np.nan, x), flagged, most)
    expected = ~flagged
    for first, last in runs(flagged) if (~flagged).any() else []:
        if last - first < most and first > 0 and last < len(x) - 1:
            expected[first : last + 1] = True
    np.testing.assert_array_equal(cut.kept, expected)
    assert cut.bridged == np.count_nonzero(expected & flagged)
    np.testing.assert_allclose(cut.x[expected], x[expected])  # the line goes on
    assert np.isfinite(cut.x).all()


@given(MASKS, st.integers(1, 9), st.integers(1, 9))
def test_segments_at_another_rate_stay_inside(flagged, up, down):
    """A sample of the new rate is kept if and only if its instant lies between two kept neighbours or on one."""
    segments = cut_at(np.zeros(len(flagged)), flagged).segments
    samples = -(-len(flagged) * up // down)
    kept = mask_of(at_rate(segments, up, down), samples)
    for j in range(samples):
        inside = any(first * up <= j * down <= last * up for first, last in segments)
        assert kept[j] == inside


def test_a_line_stands_for_what_is_cut_out():
    """Between good samples it is straight; before the first and behind the last one it is held."""
    x = np.array([np.nan, 1.0, 9.0, 9.0, 4.0, np.nan])
    flagged = np.array([True, False, True, True, False, True])
    cut = cut_at(x, flagged)
    np.testing.assert_allclose(cut.x, [1.0, 1.0, 2.0, 3.0, 4.0, 4.0])
    assert cut.segments == ((1, 1), (4, 4))


def test_nothing_is_left_of_a_record_that_is_flagged_as_a_whole():
    """No segment, and finite samples for the filters."""
    cut = cut_at(np.full(5, np.nan), np.ones(5, dtype=bool), bridge=10)
    assert cut.segments == ()
    assert not cut.kept.any()
    assert np.isfinite(cut.x).all()
