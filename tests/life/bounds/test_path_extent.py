"""What is said of paths without a history holds for the histories, and is as close as it can be where that is known."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.life.bounds.path_bound import path_length
from fatigue.life.bounds.path_extent import least_range, path_extent, path_limits
from fatigue.life.records.spool import create_spool


def drawn(seed, modes, samples, points):
    """Modal coordinates about a level, and four stresses of some points."""
    rng = np.random.default_rng(seed)
    q = np.cumsum(rng.normal(size=(modes, samples)), axis=1) * rng.uniform(0.0, 2.0, (modes, 1)) + rng.normal(
        size=(modes, 1)
    )
    return q, rng.normal(size=(4, points, modes)) * rng.integers(0, 2, (4, points, 1))


@settings(deadline=None, max_examples=100)
@given(st.integers(0, 2**32 - 1), st.integers(1, 6), st.integers(2, 50), st.sampled_from(["half", "repeat"]))
def test_limits_hold(seed, modes, samples, residue):
    """No path is longer, no shear ranges further, and none less far than is said, at either face."""
    q, (m, b, p, t) = drawn(seed, modes, samples, 5)
    extent = path_extent(q, residue, np.cov(q, bias=True).reshape(modes, modes))
    limits = path_limits((m, b), (p, t), 3.0, extent)
    for face, side in enumerate((1.0, -1.0)):
        normal, shear = (m + side * b) @ q, (p + side * t) @ q
        scale = 1e-12 * np.abs(q).max() * modes * samples
        assert (limits.length[:, face] >= path_length(normal, shear, 3.0, residue) - scale).all()
        ranges = np.ptp(shear, axis=1)
        assert (limits.shear_range[:, face] >= ranges - scale).all()
        assert (least_range(p + side * t, extent) <= ranges + scale).all()


def test_one_coordinate_is_known_exactly():
    """A sine in one coordinate: its range is seen, above and below; steps of equal length make the length exact."""
    turn = 2.0 * np.pi * np.arange(64) / 64
    q = np.stack([np.cos(turn), np.sin(turn)])  # steps of one length, in all directions alike
    extent = path_extent(q, "repeat", np.cov(q, bias=True))
    zero, one, other = np.zeros((1, 2)), np.array([[1.0, 0.0]]), np.array([[0.0, 1.0]])
    limits = path_limits((one, zero), (other, zero), 1.0, extent)
    assert limits.length[0] == pytest.approx(np.full(2, 128.0 * np.sin(np.pi / 64)), rel=1e-8)
    limits = path_limits((zero, zero), (other, zero), 3.0, extent)
    assert least_range(other, extent) == pytest.approx([2.0], rel=1e-8)
    assert limits.shear_range[0] == pytest.approx([2.0, 2.0], rel=1e-6)


@pytest.mark.parametrize("residue", ["half", "repeat"])
def test_a_record_on_disk_is_read_in_chunks(residue, tmp_path):
    """The same numbers as of the record in memory."""
    q, _ = drawn(3, 4, 70_000, 1)
    spool = create_spool(tmp_path / "q", q.shape, np.dtype(np.float64))
    spool[:, :] = q
    covariance = np.cov(q, bias=True)
    one, other = path_extent(q, residue, covariance), path_extent(spool, residue, covariance)
    for name in ("axes", "ranges", "extremes"):
        np.testing.assert_allclose(getattr(other, name), getattr(one, name), rtol=1e-9)
    assert (one.steps, one.recurs) == (other.steps, other.recurs)
    np.testing.assert_allclose(other.products.directions, one.products.directions, rtol=1e-7)


def test_a_coordinate_at_rest_adds_nothing():
    """Its range is 0 in every direction that others do not have."""
    q = np.stack([np.sin(np.arange(20.0)), np.full(20, 7.0)])
    extent = path_extent(q, "half", np.cov(q, bias=True))
    zero, rest = np.zeros((1, 2)), np.array([[0.0, 1.0]])
    limits = path_limits((zero, zero), (rest, zero), 3.0, extent)
    assert limits.shear_range.max() == pytest.approx(0.0, abs=1e-12)
    assert limits.length.max() == pytest.approx(0.0, abs=1e-12)
