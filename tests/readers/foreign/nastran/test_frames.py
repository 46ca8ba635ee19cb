"""Coordinate systems of NASTRAN against their definitions."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.errors import DataError
from fatigue.readers.foreign.nastran.frames import FrameCard, Frames

POINTS = ((1.0, 2.0, 3.0), (1.0, 2.0, 8.0), (4.0, 2.0, 5.0))  # z is the basic z, x is the basic x
TURNED = ((1.0, 2.0, 3.0), (1.0, 6.0, 3.0), (1.0, 2.0, -7.0))  # z is the basic y, x is -z, so y is -x


def frames(**cards):
    """Systems by their id, ``c5=FrameCard(...)``; grid n lies at (n, n^2, 0)."""
    by_id = {int(name[1:]): card for name, card in cards.items()}
    return Frames("deck.bdf", by_id, lambda grid: np.array([grid, grid**2, 0.0]))


def test_axes_of_three_points():
    """Origin, a point on z, a point in the x-z plane: any such point gives the same axes, one in each row."""
    plain = frames(c5=FrameCard("R", 0, POINTS)).frame(5)
    np.testing.assert_allclose(plain.axes, np.eye(3), atol=1e-15)
    assert plain.origin.tolist() == [1.0, 2.0, 3.0]
    turned = frames(c5=FrameCard("R", 0, TURNED)).frame(5)
    np.testing.assert_allclose(turned.axes, [[0, 0, -1], [-1, 0, 0], [0, 1, 0]], atol=1e-15)


@pytest.mark.parametrize(
    ("kind", "given_as", "local"),
    [
        ("R", (2.0, 3.0, 4.0), (2.0, 3.0, 4.0)),
        ("C", (2.0, 30.0, 4.0), (3.0**0.5, 1.0, 4.0)),
        ("C", (2.0, -90.0, -4.0), (0.0, -2.0, -4.0)),
        ("S", (2.0, 30.0, 0.0), (1.0, 0.0, 3.0**0.5)),
        ("S", (2.0, 90.0, 60.0), (1.0, 3.0**0.5, 0.0)),
        ("S", (2.0, 180.0, 12.0), (0.0, 0.0, -2.0)),
    ],
)
def test_points_in_each_kind_of_system(kind, given_as, local):
    """Radius, angles in degrees and height; in a spherical system the first angle is measured from z."""
    found = frames(c5=FrameCard(kind, 0, TURNED)).position(5, given_as)
    x, y, z = local
    np.testing.assert_allclose(found, np.add([1.0, 2.0, 3.0], [-y, z, -x]), atol=1e-14)


def test_a_system_in_a_system():
    """Its points are in the coordinates of its reference, cylindrical here; grids serve as points, too."""
    inner = FrameCard("R", 5, ((2.0, 90.0, 1.0), (2.0, 90.0, 2.0), (3.0, 90.0, 1.0)))
    both = frames(c5=FrameCard("C", 0, POINTS), c9=inner, c7=FrameCard("R", grids=(0, 1, 2)))
    np.testing.assert_allclose(both.frame(9).origin, [1.0, 4.0, 4.0], atol=1e-14)
    np.testing.assert_allclose(both.frame(9).axes, [[0, 1, 0], [-1, 0, 0], [0, 0, 1]], atol=1e-14)
    by_grids = both.frame(7)
    np.testing.assert_allclose(by_grids.axes[2], np.array([1.0, 1.0, 0.0]) / 2**0.5, atol=1e-15)
    np.testing.assert_allclose(by_grids.axes[1], [0.0, 0.0, 1.0], atol=1e-15)


@settings(deadline=None, max_examples=60)
@given(st.sampled_from("RCS"), st.integers(0, 10**6))
def test_directions_are_those_in_which_the_coordinates_grow(kind, seed):
    """Row k is the unit vector in which the point moves with its k-th coordinate; orthonormal and right-handed."""
    rng = np.random.default_rng(seed)
    card = FrameCard(kind, 0, tuple(map(tuple, rng.normal(size=(3, 3)))))
    system = frames(c5=card)
    at = np.array([rng.uniform(1, 3), rng.uniform(20, 160), rng.uniform(-170, 170)])
    axes = system.axes_at(5, system.position(5, tuple(at)))
    step = 1e-5
    for k in range(3):
        moved = [system.position(5, tuple(at + sign * step * np.eye(3)[k])) for sign in (1, -1)]
        along = moved[0] - moved[1]
        np.testing.assert_allclose(axes[k], along / np.linalg.norm(along), atol=1e-6)
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(axes) == pytest.approx(1.0)


def test_on_the_axis_the_systems_own_directions_hold():
    """A radius of zero has no direction of its own."""
    system = frames(c5=FrameCard("C", 0, POINTS))
    np.testing.assert_allclose(system.axes_at(5, np.array([1.0, 2.0, 9.0])), np.eye(3), atol=1e-15)


@pytest.mark.parametrize(
    ("cards", "words"),
    [
        ({}, "coordinate system 5: it does not exist"),
        ({"c5": FrameCard("R", 6, POINTS), "c6": FrameCard("R", 5, POINTS)}, "it refers to itself"),
        ({"c5": FrameCard("R", 0, ((0.0, 0, 0), (0.0, 0, 1), (0.0, 0, 7)))}, "its three points lie on a line"),
        ({"c5": FrameCard("R", 0, ((0.0, 0, 0), (0.0, 0, 0), (1.0, 0, 0)))}, "its three points lie on a line"),
        ({"c5": FrameCard("R", 0, ((0.0, 0, 0), (0.0, 0, 1e3), (1e-8, 0, 7)))}, "its three points lie on a line"),
    ],
)
def test_systems_that_are_none(cards, words):
    """Missing, going round in a circle, or without a plane; asked for again, the answer is the same."""
    system = frames(**cards)
    for _ in range(2):
        with pytest.raises(DataError, match=words):
            system.frame(5)
