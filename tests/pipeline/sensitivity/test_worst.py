"""The worst point of a weld under a variant: no more points are counted again than its verdict needs."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatigue.life.curves import damage_law, user_curve
from fatigue.pipeline.sensitivity.closed import Varied, first_slope, stronger, with_haibach
from fatigue.pipeline.sensitivity.worst import MOST_STATIONS, NOWHERE, OPEN, worst_of_welds
from fatigue.results.dictionary.sensitivity import BASES

NAN = np.nan


def judged(truth, upper, first=None, *, lower=None, again=True, few=8):
    """Welds of stations with these utilisations, of which only bounds are known, and the stations counted again."""
    truth, upper = np.atleast_2d(truth).astype(float), np.atleast_2d(upper).astype(float)
    asked = []

    def counted(rows):
        asked.extend(rows.tolist())
        return truth[rows]

    unknown = Varied(np.full_like(upper, NAN), upper, lower=lower)
    toe, first = np.ones(upper.shape, bool), np.array([0, len(upper)] if first is None else first)
    return worst_of_welds(unknown, toe, first, upper, counted if again else None, few), asked


def test_a_weld_that_cannot_fail_is_not_counted_again():
    """Its bound is told, and that it is one."""
    (weld,), asked = judged([[0.01, 0.02]], [[0.05, 0.04]])
    assert (weld.utilisation, weld.fulfilled, BASES[weld.basis], asked) == (0.05, 1, "bound", [])


def test_the_worst_point_may_be_another_one():
    """The point with the largest bound turns out to be better than the next one, which decides."""
    truth = [[0.4, 0.1], [0.9, 0.2], [0.3, 0.3], [0.3, 0.3], [0.3, 0.3]]
    (weld,), asked = judged(truth, [[1.5, 0.1], [1.2, 1.1], [0.8, 0.3], [0.7, 0.3], [0.3, 0.3]])
    assert (weld.utilisation, weld.station, weld.face, BASES[weld.basis]) == (0.9, 1, 0, "recount")
    assert asked == [0, 1, 2]  # one, then two at once


def test_what_fails_for_sure_is_a_bound_from_below():
    """Without a count the lower bound says so."""
    (weld,), asked = judged([[3.0, 0.0]], [[50.0, 0.0]], lower=np.array([[12.0, 0.0]]), again=False)
    assert (weld.utilisation, weld.fulfilled, weld.station, BASES[weld.basis]) == (12.0, 0, NOWHERE, "bound")
    assert asked == []


def test_a_weld_with_too_many_doubtful_points_is_undecided():
    """Its number is the largest that was counted, and it has no verdict."""
    n = MOST_STATIONS + 10
    (weld,), asked = judged(np.full((n, 2), 0.5), np.full((n, 2), 2.0))
    assert (weld.fulfilled, BASES[weld.basis], weld.recounted) == (OPEN, "undecided", MOST_STATIONS)
    assert len(asked) == MOST_STATIONS


@given(
    st.lists(st.tuples(*[st.floats(0.0, 4.0)] * 4, st.booleans()), min_size=1, max_size=30),
    st.integers(1, 4),
)
def test_verdicts_are_those_of_all_points(points, welds):
    """Whatever the bounds, the verdict is that of the largest utilisation, and numbers are on its side."""
    truth = np.array([[a, b] for a, b, *_ in points])
    upper = truth * np.array([[1.0 + c, 1.0 + d] for _, _, c, d, _ in points])
    lower = np.where(np.array([known for *_, known in points])[:, None], 0.9 * truth, 0.0)
    first = np.unique(np.linspace(0, len(points), welds + 1).astype(int))
    found, asked = judged(truth, upper, first, lower=lower)
    assert len(asked) == len(set(asked))
    for weld, (a, b) in zip(found, pairwise(first.tolist()), strict=True):
        largest = truth[a:b].max()
        assert weld.fulfilled == (largest <= 1.0)
        if BASES[weld.basis] == "bound":
            assert weld.utilisation >= largest if weld.fulfilled else weld.utilisation <= largest
        else:
            assert weld.utilisation == pytest.approx(largest)


def test_a_face_without_a_toe_never_decides():
    """Neither by its number nor by its bound."""
    varied = Varied(np.array([[NAN, 0.3]]), np.array([[9.0, 0.3]]))
    (weld,) = worst_of_welds(varied, np.array([[False, True]]), np.array([0, 1]), np.array([[9.0, 0.3]]))
    assert (weld.utilisation, weld.face, BASES[weld.basis]) == (0.3, 1, "exact")


def test_laws_of_the_variants_are_those_of_the_curve():
    """Knee and survival level put on a law are what ``damage_law`` makes of the curve."""
    curve = user_curve("c", (3.0,), (), 90.0, "structural", "test", log10_scatter=0.2)
    plain, haibach = (damage_law(curve, "mean-2sigma", extension, 1e7) for extension in ("none", "haibach"))
    three = damage_law(curve, "mean-3sigma", "haibach", 1e7)
    factor = curve.reference_range["mean-2sigma"] / curve.reference_range["mean-3sigma"]
    pairs = ((with_haibach(plain), haibach), (stronger(haibach, factor), three), (first_slope(haibach), plain))
    for made, expected in pairs:
        for name in ("slopes", "log_constants", "knees"):
            np.testing.assert_allclose(getattr(made, name), getattr(expected, name), rtol=1e-12)
