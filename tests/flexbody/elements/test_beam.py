"""The beam element against closed forms, and in every direction of space."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.flexbody.elements.beam import beam_stiffness
from fatigue.flexbody.mass import rigid_motions

EA, EI, GJ = 7.0e8, 3.0e6, 2.0e6
COORDINATE = st.floats(-3.0, 3.0)


def one_beam(start, end):
    """Stiffness of one beam."""
    return beam_stiffness(np.array([start]), np.array([end]), EA, EI, GJ)[0]


def test_cantilever_along_x():
    """Tip of a clamped beam: L/EA, L^3/3EI, L/GJ, L/EI and L^2/2EI between force and rotation."""
    L = 2.5
    tip = np.linalg.inv(one_beam((0.0, 0.0, 0.0), (L, 0.0, 0.0))[6:, 6:])
    expected = np.diag([L / EA, L**3 / (3 * EI), L**3 / (3 * EI), L / GJ, L / EI, L / EI])
    expected[1, 5] = expected[5, 1] = L**2 / (2 * EI)  # a force along y turns the tip about z
    expected[2, 4] = expected[4, 2] = -(L**2) / (2 * EI)  # one along z about -y
    assert tip == pytest.approx(expected, rel=1e-12, abs=1e-18)


@settings(max_examples=30)
@given(st.tuples(*6 * [COORDINATE]))
def test_symmetric_free_of_rigid_motion_and_the_same_in_every_direction(ends):
    """Six rigid motions, the others as of a beam along x: eigenvalues do not tell where it points."""
    start, end = np.array(ends[:3]), np.array(ends[3:])
    L = np.linalg.norm(end - start)
    if L < 0.1:
        return
    k = one_beam(start, end)
    assert k == pytest.approx(k.T, abs=1e-9 * abs(k).max())
    R = rigid_motions(np.repeat([start, end], 6, axis=0), np.tile(np.arange(6), 2))
    assert k @ R == pytest.approx(0.0, abs=1e-8 * abs(k).max())
    along_x = np.linalg.eigvalsh(one_beam((0.0, 0.0, 0.0), (L, 0.0, 0.0)))
    assert np.linalg.eigvalsh(k) == pytest.approx(along_x, abs=1e-9 * along_x.max())


def test_ends_may_be_exchanged_and_many_come_at_once():
    """A beam from b to a is the beam from a to b with its ends exchanged; stiffnesses may differ from beam to beam."""
    a, b = np.array([0.3, -1.0, 2.0]), np.array([1.7, 0.2, 0.9])
    two = beam_stiffness(np.array([a, b]), np.array([b, a]), np.array([EA, EA]), [EI, EI], np.array([GJ, 2 * GJ]))
    assert two.shape == (2, 12, 12)
    change = np.r_[6:12, 0:6]
    assert one_beam(b, a)[np.ix_(change, change)] == pytest.approx(two[0], rel=1e-12, abs=1e-3)
    assert two[1] == pytest.approx(beam_stiffness(b[None], a[None], EA, EI, 2 * GJ)[0])
