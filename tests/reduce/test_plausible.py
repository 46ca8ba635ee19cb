"""Bodies that cannot be meant, and slender ones that can."""

import numpy as np
import pytest

from fatigue.reduce.plausible import size_problems

STEEL = 7.85e-9  # t/mm3


@pytest.mark.parametrize(
    ("sides", "volume"),
    [
        ((1000.0, 0.0, 0.0), 1000.0 * 60.0 * 60.0),  # a straight beam: all of its nodes on one line
        ((18000.0, 0.0, 0.0), 18000.0 * 7700.0),  # a rail
        ((400.0, 200.0, 0.0), 400.0 * 200.0 * 40.0),  # a thick plate: all of its nodes in one plane
    ],
)
def test_beams_and_plates_have_no_box_of_their_own(sides, volume):
    """A straight beam or flat plate of steel is a body; the same in kg for t is none."""
    xyz = np.array([[0.0, 0.0, 0.0], sides])
    assert not list(size_problems(xyz, STEEL * volume, "K", "units"))
    if sides[0] < 5000.0:
        (problem,) = size_problems(xyz, 1e3 * STEEL * volume, "K", "units")
        assert "heavier than osmium" in problem.what
