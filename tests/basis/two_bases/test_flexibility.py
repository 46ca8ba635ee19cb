"""A strong and a weak basis of the free beam: local flexibility where it is known."""

from dataclasses import replace

import numpy as np

from fatigue.basis.two_bases.flexibility import flexibilities
from tests.basis.loaded_beam import POINTS, loaded_beam
from tests.free_beam import free_beam

BEAM = free_beam()
DOF = list(POINTS.values())
ENDS = [0, 20]  # deflections of both ends: the weak interface, of which middle and rotation are no part
STRONG = loaded_beam(BEAM, BEAM.with_residual(2, DOF))
WEAK = loaded_beam(BEAM, BEAM.with_residual(2, ENDS))


def test_the_weak_basis_is_exact_at_its_interface_and_too_stiff_elsewhere():
    """The strong basis has the static flexibility at all points, the weak one at both ends only."""
    found = flexibilities(STRONG, WEAK)
    rows = {(row.point, row.direction): row for row in found.rows}
    static = dict(zip(POINTS, np.diag(BEAM.static(DOF)[DOF]), strict=True))
    for key, row in rows.items():
        np.testing.assert_allclose([row.index, row.static], static[key], rtol=1e-9)
    np.testing.assert_allclose([rows["left end", "z"].ratio, rows["right end", "z"].ratio], 1.0, rtol=1e-9)
    assert rows["left end", "ry"].ratio < 0.95
    assert rows["middle", "z"].ratio < 1.0 - 1e-6
    assert "left end ry) to 1" in found.said[0]
    assert not found.notes


def test_points_that_only_one_basis_has_are_named():
    """A direction without a shape in one of the cases has its reason; so has a case without shapes."""
    few = {key: dof for key, dof in POINTS.items() if key[0] != "middle"}
    weak = loaded_beam(BEAM, BEAM.with_residual(2, ENDS), few)
    row = next(row for row in flexibilities(STRONG, weak).rows if row.point == "middle")
    assert np.isnan(row.ratio)
    assert row.reason == "other case: the file of shapes does not have it"
    (note,) = flexibilities(STRONG, replace(WEAK, shapes=None)).notes
    assert "the other case" in note


def test_two_static_solutions_of_one_body_agree():
    """Solutions that differ are of two bodies, and that is said; digits of a file are not."""
    for factor, notes in ((1.0005, 0), (1.1, 1)):
        other = tuple(replace(one, value=factor * one.value) for one in WEAK.static)
        assert len(flexibilities(STRONG, replace(WEAK, static=other)).notes) == notes
