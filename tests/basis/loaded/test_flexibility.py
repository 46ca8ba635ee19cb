"""What is said of local flexibility: a strong and a weak basis of the free beam, and what a case may lack."""

from dataclasses import replace

import numpy as np
import pytest

from fatigue.basis.loaded.flexibility import flexibility
from tests.basis.loaded_beam import POINTS, loaded_beam
from tests.free_beam import free_beam

BEAM = free_beam()
DOF = list(POINTS.values())


def test_a_basis_with_residual_modes_is_complete():
    """Ratio 1 to 1e-9 in all directions, no warning, and the rigid modes add nothing."""
    found = flexibility(loaded_beam(BEAM, BEAM.with_residual(3, DOF)))
    assert [(row.point, row.direction) for row in found.rows] == list(POINTS)
    assert [row.unit for row in found.rows] == ["mm/N", "1/(N mm)", "mm/N", "mm/N"]
    np.testing.assert_allclose([row.ratio for row in found.rows], 1.0, rtol=1e-9)
    assert all(row.enough and not row.reason for row in found.rows)
    assert not found.warnings
    assert "in all 4 directions" in found.said[0]


def test_a_basis_without_them_says_where_it_is_too_stiff():
    """Normal modes alone: below 1, most so under a moment, and the sentence names the place."""
    found = flexibility(loaded_beam(BEAM, BEAM.normal(3)))
    ratio = {(row.point, row.direction): row.ratio for row in found.rows}
    assert max(ratio.values()) < 1.0
    assert min(ratio, key=ratio.__getitem__) == ("left end", "ry")
    assert "most at left end ry" in found.said[0]
    assert {row.normal_share for row in found.rows} == {1.0}
    assert not found.warnings


def test_shares_of_normal_and_interface_modes_sum_up():
    """What normal modes and interface modes add is the whole."""
    for row in flexibility(loaded_beam(BEAM, BEAM.with_residual(2, DOF))).rows:
        assert row.normal_share + row.interface_share == pytest.approx(1.0)
        assert 0.0 < row.interface_share < 1.0


@pytest.mark.parametrize("factor", [1e-3, 0.9])
def test_no_basis_is_softer_than_its_body(factor):
    """A static solution in other units, or of supports, makes one warning with the worst place; 2 % are round-off."""
    loaded = loaded_beam(BEAM, BEAM.with_residual(3, DOF))
    stiff = tuple(replace(one, value=factor * one.value) for one in loaded.static)
    (warning,) = flexibility(replace(loaded, static=stiff)).warnings
    assert (warning.code, warning.count, warning.where) == ("soft_basis", 4, "flexibility.csv")
    rounded = tuple(replace(one, value=0.99 * one.value) for one in loaded.static)
    assert not flexibility(replace(loaded, static=rounded)).warnings


def test_what_a_case_lacks_is_said():
    """Without shapes no index, without a static solution no ratio; each number that is empty has its reason."""
    loaded = loaded_beam(BEAM, BEAM.normal(2))
    nothing = flexibility(replace(loaded, shapes=None, static=()))
    assert not nothing.rows
    assert len(nothing.notes) == 2
    no_static = flexibility(replace(loaded, static=()))
    assert all(np.isnan(row.ratio) and row.index > 0 and "static" in row.reason for row in no_static.rows)
    no_shapes = flexibility(replace(loaded, shapes=None))
    assert all(np.isnan(row.index) and row.static > 0 and "shapes" in row.reason for row in no_shapes.rows)
    loaded.shapes.value[2, 3] = np.nan
    holed = flexibility(loaded).rows[2]
    assert np.isnan(holed.index)
    assert holed.reason == "no shape of the modes 4"
