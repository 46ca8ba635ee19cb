"""Block programmes: published numbers, closed forms, and that no other programme does better."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from fatigue.errors import NumericalError
from fatigue.life.bench import MOST_CYCLES, block_cycles, cover, least_squares, unreached
from fatigue.life.curves import catalogue, damage_law
from fatigue.life.rule import CycleRule, size_factor

ALUMINIUM = catalogue()["master-aluminium"]
RULE = CycleRule(damage_law(ALUMINIUM, "mean-2sigma", "none", 1e7), True)
THICKNESS = np.array([4.0, 3.0, 6.0, 5.0])
MEMBRANE = np.array([[3.0, 0.5, 1.0], [0.2, 4.0, -1.0], [1.0, -2.0, 3.0], [2.0, 2.0, 2.0]])
BENDING = np.array([[1.0, 0.0, 0.5], [0.1, 1.5, 0.3], [0.5, -0.4, 2.0], [-0.5, 0.3, 0.2]])
RANGES = np.array([[8.0, 0.0, 0.0], [0.0, 7.0, 0.0], [0.0, 0.0, 9.0], [5.0, 5.0, 0.0], [5.0, -5.0, 4.0]])
TARGET = np.array([0.5, 0.8, 0.3, 0.6])
UNIT_DAMAGE = np.array(
    [
        [
            2.825129894783698e-07,
            9.782621392008587e-11,
            1.240841694672213e-08,
            7.949915981166454e-08,
            9.21744615214888e-08,
        ],
        [
            1.9349833115554896e-11,
            4.3599282952885e-07,
            6.380121291366387e-10,
            1.5675898813592914e-07,
            1.5415094784613065e-07,
        ],
        [
            1.122890955177019e-08,
            3.854651120410914e-08,
            1.3089742493106158e-06,
            3.3406978692768516e-10,
            8.289551936698373e-07,
        ],
        [
            9.860399783881144e-09,
            2.8641294554623386e-08,
            6.057170617865689e-08,
            5.230858543838862e-08,
            3.578894927660626e-10,
        ],
    ]
)
SHARE = UNIT_DAMAGE / TARGET[:, None]


def four_points(**changes):
    """One cycle of each block at the four points, top faces."""
    size = size_factor(THICKNESS, ALUMINIUM, "actual")
    given = {"membrane": MEMBRANE, "bending": BENDING, "side": np.ones(4), "size": size, "ranges": RANGES, "rule": RULE}
    return block_cycles(**(given | changes))


def test_damage_of_one_cycle():
    """Each block with its own bending ratio at each point."""
    np.testing.assert_allclose(four_points().damage, UNIT_DAMAGE, rtol=1e-12)


def test_least_squares():
    """Three of five blocks, one point a half short."""
    found = least_squares(SHARE)
    expected = [74661.52487345895, 0.0, 229343.9112480046, 6065676.237318598, 0.0]
    np.testing.assert_allclose(found.cycles, expected, rtol=1e-6)
    assert found.norm == pytest.approx(0.4853032722791968, rel=1e-9)
    achieved = [1.012309620044758, 1.1887462977592245, 1.0102333357926399, 0.5531914803184802]
    np.testing.assert_allclose(found.achieved, achieved, rtol=1e-9)
    assert found.method == "least_squares"


def test_cover():
    """All points reached, three of them by the same factor too much."""
    found = cover(SHARE)
    expected = [685413.9033962839, 0.0, 476023.14524998085, 10789968.913832417, 0.0]
    np.testing.assert_allclose(found.cycles, expected, rtol=1e-6)
    assert found.tau == pytest.approx(2.1146769751694565, rel=1e-9)
    np.testing.assert_allclose(found.achieved, [found.tau, found.tau, found.tau, 1.0], rtol=1e-9)


@pytest.mark.parametrize("method", [least_squares, cover])
def test_as_many_blocks_as_points_meet_every_target(method):
    """The solution of the linear system, where it is positive."""
    found = method(SHARE[:3, :3])
    np.testing.assert_allclose(found.cycles, [1762165.3890782993, 1834580.151113833, 160046.03604033266], rtol=1e-9)
    np.testing.assert_allclose(found.cycles, np.linalg.solve(SHARE[:3, :3], np.ones(3)), rtol=1e-9)
    np.testing.assert_allclose(found.achieved, 1.0, rtol=1e-12)


def test_whole_cycles_are_rounded_up_and_evaluated_again():
    """Few cycles of a strong block: what rounding does is told."""
    share = SHARE[:3, :3] * 1e5
    found = cover(share)
    assert found.whole_cycles.tolist() == [18.0, 19.0, 2.0]
    np.testing.assert_allclose(found.achieved_whole, share @ [18.0, 19.0, 2.0], rtol=1e-14)
    np.testing.assert_allclose(found.achieved, 1.0, rtol=1e-12)


def test_one_block_at_two_points():
    """Closed forms: least squares sum(A) / sum(A^2), cover 1 / min(A)."""
    share = np.array([[1e-6], [4e-6]])
    assert least_squares(share).cycles == pytest.approx([5e-6 / 17e-12], rel=1e-12)
    found = cover(share)
    assert found.cycles == pytest.approx([1e6], rel=1e-12)
    assert found.tau == pytest.approx(4.0, rel=1e-12)


def test_of_programmes_that_cover_alike_the_shorter_one_is_taken():
    """A block twice as strong everywhere halves the cycles."""
    found = cover(np.array([[1e-6, 2e-6], [3e-6, 6e-6]]))
    assert found.cycles == pytest.approx([0.0, 5e5], rel=1e-9)


def test_of_blocks_that_do_the_same_the_strongest_is_run():
    """One shape at three levels on a curve of one slope: least squares leaves the weak ones alone, too."""
    share = np.array([[1e-6, 3e-6, 1e-24], [3e-6, 9e-6, 3e-24]])
    for method in (least_squares, cover):
        found = method(share)
        assert found.cycles[[0, 2]].tolist() == [0.0, 0.0]
        assert found.cycles[1] > 0.0
    assert least_squares(share).cycles[1] == pytest.approx(12e-6 / 90e-12, rel=1e-7)


def test_faces_phases_and_sizes():
    """At the bottom bending counts against; all signs turned are the same cycle; r of pure membrane stress is 0."""
    bottom = four_points(side=-np.ones(4))
    np.testing.assert_allclose(bottom.range, np.abs((MEMBRANE - BENDING) @ RANGES.T), rtol=1e-14)
    np.testing.assert_array_equal(four_points(ranges=-RANGES).damage, four_points().damage)
    pure = four_points(bending=0 * BENDING, size=np.ones(4))
    assert (pure.bending_ratio == 0.0).all()
    np.testing.assert_allclose(pure.equivalent_range, pure.range / (1.23 / 1.007), rtol=1e-12)


def test_opposite_loads_cancel():
    """A block whose loads do away with each other does no damage, and no programme needs it."""
    found = four_points(
        membrane=np.ones((4, 3)), bending=np.zeros((4, 3)), ranges=np.array([[5.0, -5.0, 0.0], [1.0, 0.0, 0.0]])
    )
    assert (found.damage[:, 0] == 0.0).all()
    for method in (least_squares, cover):
        assert method(found.damage).cycles[0] == 0.0


def test_a_cut_off_leaves_points_unreached():
    """A range below it does nothing; what would take longer than anybody waits is no reaching either."""
    share = np.array([[1e-6, 0.0], [0.0, 0.0], [0.5 / MOST_CYCLES, 0.0], [0.0, 2.0 / MOST_CYCLES]])
    assert unreached(share).tolist() == [False, True, True, False]
    rule = CycleRule(damage_law(ALUMINIUM, "mean-2sigma", "cutoff", 1e6), True)
    assert unreached(four_points(rule=rule, ranges=1e-3 * RANGES).damage).all()


def test_points_too_far_apart_are_told():
    """No programme at all is an error, not a number."""
    with pytest.raises(NumericalError, match="no programme was found"):
        cover(np.array([[1e-3, 0.0], [0.0, 0.0]]))


shares = st.integers(1, 5).flatmap(
    lambda p: st.integers(1, 4).flatmap(
        lambda b: st.lists(st.lists(st.floats(-9.0, -4.0) | st.none(), min_size=b, max_size=b), min_size=p, max_size=p)
    )
)


def share_of(logs):
    """Shares from their logarithms, 0 for None."""
    return np.array([[0.0 if x is None else 10.0**x for x in row] for row in logs])


@settings(max_examples=25, deadline=None)
@given(shares, st.lists(st.lists(st.floats(0.0, 9.0) | st.none(), min_size=4, max_size=4), min_size=8, max_size=8))
def test_cover_reaches_every_target_and_no_other_programme_spreads_less(logs, others):
    """1 <= A n <= tau, also for whole cycles from below; any other programme has at least this tau."""
    share = share_of(logs)
    assume(not unreached(share).any())
    found = cover(share)
    assert (found.cycles >= 0.0).all()
    assert (found.achieved >= 1.0 - 1e-12).all()
    assert found.achieved.max() <= found.tau * (1.0 + 1e-12)
    assert (found.achieved_whole >= found.achieved * (1.0 - 1e-14)).all()
    for other in others:
        achieved = share @ [0.0 if x is None else 10.0**x for x in other[: share.shape[1]]]
        if achieved.min() > 0.0:
            assert achieved.max() / achieved.min() >= found.tau * (1.0 - 1e-7)


@settings(max_examples=25, deadline=None)
@given(shares)
def test_tau_of_two_blocks_is_the_smallest_of_all_mixtures(logs):
    """Every mixture of two blocks by a scan of the corners where two points are equal, the best one is found."""
    share = share_of(logs)
    assume(share.shape[1] >= 2 and not unreached(share[:, :2]).any())
    share = share[:, :2]
    mixtures = [np.array([1.0, 0.0]), np.array([0.0, 1.0])]
    for first in share:
        for second in share:
            a, b = first - second
            if a * b < 0.0:
                mixtures.append(np.abs([b, a]))
    mixtures += [np.array([1.0, 10.0**x]) for x in np.linspace(-9, 9, 200)]
    achieved = [share @ mixture for mixture in mixtures]
    best = min(one.max() / one.min() for one in achieved if one.min() > 0.0)
    assert cover(share).tau == pytest.approx(best, rel=1e-7)


@settings(max_examples=25, deadline=None)
@given(shares)
def test_least_squares_is_the_least(logs):
    """Proof by the conditions of Karush, Kuhn and Tucker: no block could be run more or less and come closer."""
    share = share_of(logs)
    assume(not unreached(share).any())
    found = least_squares(share)
    scale = np.where(share.max(axis=0) > 0.0, share.max(axis=0), 1.0)
    scaled = share / scale
    downhill = scaled.T @ (1.0 - found.achieved)
    close = 1e-9 * found.achieved + 1.1e-10  # a shorter programme within 1e-9, solved to 1e-10, is taken as as close
    assert (found.cycles >= 0.0).all()
    assert (downhill <= scaled.T @ close).all()
    gap = np.vdot(scale * found.cycles, np.abs(downhill))  # no block runs that should not: products are 0 but for close
    assert gap <= close @ (np.abs(1.0 - found.achieved) + 3.0 * found.achieved)
