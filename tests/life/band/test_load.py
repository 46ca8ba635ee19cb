"""Scatter of one record from its pieces: published numbers, closed forms, and 20 000 bootstrap samples beside them."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import t as student

from fatigue.life.band.load import BLOCK, BLOCKS, PIECES, LoadScatter, block_error, mission_scatter, record_error

ORACLE = np.array([3.0, 1, 2, 8, 7, 2, 1, 4, 12, 3, 2, 3])
BY_BLOCK = {  # B5_band.relative_standard_error_by_block
    1: 0.23011168785806793,
    2: 0.23935677693908453,
    3: 0.19837301190396806,
    4: 0.1523826962325812,
    5: 0.14068285846778444,
}


@pytest.mark.parametrize("block", BY_BLOCK)
def test_the_error_by_blocks_is_that_of_the_specification(block):
    """The error by blocks is that of the specification."""
    assert block_error(ORACLE, block) == pytest.approx(BY_BLOCK[block], rel=1e-12)


def test_the_band_of_six_blocks_is_that_of_the_specification():
    """The band of six blocks is that of the specification."""
    scatter = LoadScatter(block_error(ORACLE, 2) * np.sqrt(6 / 5), np.array(5.0))
    assert student.ppf(0.95, 5) == pytest.approx(2.0150483733330233, rel=1e-12)
    assert np.exp(scatter.log_half_width) == pytest.approx(1.6961316206276529, rel=1e-9)  # log_t_band_90_block_2


def test_the_closed_form_is_what_a_bootstrap_of_circular_blocks_scatters_by():
    """The closed form is what a bootstrap of circular blocks scatters by."""
    rng = np.random.default_rng(1)
    pieces = rng.lognormal(0.0, 0.8, PIECES)
    first = rng.integers(0, PIECES, (20_000, BLOCKS, 1))
    drawn = pieces[(first + np.arange(BLOCK)) % PIECES].sum(axis=(1, 2)) / pieces.sum()
    assert drawn.mean() == pytest.approx(1.0, abs=0.01)
    assert drawn.std() == pytest.approx(block_error(pieces), rel=0.02)
    assert record_error(pieces) == pytest.approx(block_error(pieces) * np.sqrt(1.2), rel=1e-14)


@given(
    pieces=st.lists(st.floats(1e-6, 1e6), min_size=PIECES, max_size=PIECES),
    scale=st.floats(1e-9, 1e9),
    turn=st.integers(0, PIECES),
)
def test_scale_and_beginning_do_not_matter(pieces, scale, turn):
    """Scale and beginning do not matter."""
    pieces = np.array(pieces)
    assert record_error(np.roll(scale * pieces, turn)) == pytest.approx(record_error(pieces), rel=1e-9, abs=1e-12)


def test_nothing_scatters_where_pieces_are_equal_or_nothing_damages():
    """Nothing scatters where pieces are equal or nothing damages."""
    assert record_error(np.ones(PIECES)) == pytest.approx(0.0, abs=1e-15)
    assert record_error(np.zeros((2, PIECES))).tolist() == [0.0, 0.0]


def test_of_several_events_the_variances_and_the_degrees_of_freedom_add_up():
    """Of several events the variances and the degrees of freedom add up."""
    share, se = np.array([[0.7], [0.3]]), np.array([[0.2], [0.4]])
    found = mission_scatter(share, se)
    parts = np.array([0.14, 0.12]) ** 2
    assert found.se == pytest.approx(np.sqrt(parts.sum()), rel=1e-14)
    assert found.dof == pytest.approx(parts.sum() ** 2 / (parts**2 / 5).sum(), rel=1e-14)
    assert found.sigma_ln == pytest.approx(found.se * student.ppf(0.95, found.dof) / 1.6448536269514722, rel=1e-9)
    turned = mission_scatter(share[::-1], se[::-1])
    assert (turned.se, turned.dof) == (pytest.approx(found.se), pytest.approx(found.dof))


def test_equal_events_have_the_degrees_of_freedom_of_all_and_one_event_its_own():
    """Equal events have the degrees of freedom of all and one event its own."""
    assert mission_scatter(np.full((4, 1), 0.25), np.full((4, 1), 0.3)).dof == pytest.approx(20.0)
    assert mission_scatter(np.ones((1, 1)), np.full((1, 1), 0.3)).dof == pytest.approx(5.0)
    assert mission_scatter(np.ones((1, 1)), np.zeros((1, 1))).dof == pytest.approx(5.0)
