"""Interface modes per loaded point: which points follow every direction, and which lose local force."""

from dataclasses import replace

import numpy as np
import pytest

from fatigue.basis.loaded.interface import ALL, interface
from tests.basis.loaded_beam import POINTS, loaded_beam
from tests.free_beam import free_beam

BEAM = free_beam()
DOF = list(POINTS.values())


def rows_of(loaded):
    """Rows by the name of their point."""
    return {row.point: row for row in interface(loaded).rows}


def test_attachment_modes_of_all_directions_are_complete():
    """A residual mode for each direction: every point alone and all of them together."""
    found = interface(loaded_beam(BEAM, BEAM.with_residual(3, DOF)))
    assert [(row.point, row.directions, row.independent, row.complete) for row in found.rows] == [
        ("left end", 2, 2, True), ("middle", 1, 1, True), ("right end", 1, 1, True), (ALL, 4, 4, True)
    ]  # fmt: skip
    assert not any("lose" in line for line in found.said)


def test_modes_that_are_too_few_lose_a_direction():
    """One residual mode moves both directions of the left end, but never independently of each other."""
    found = interface(loaded_beam(BEAM, BEAM.with_residual(3, [0])))
    row = {one.point: one for one in found.rows}["left end"]
    assert (row.interface_modes, row.independent, row.complete) == (1, 1, False)
    assert row.lost == "z with ry"
    assert any("lose local force: left end (1 of 2, not z with ry)" in line for line in found.said)


def test_points_share_modes():
    """Two interface modes reach every point with one direction, and all of them together only twice."""
    points = {key: dof for key, dof in POINTS.items() if key[1] == "z"}
    points |= {(f"extra {i}", "z"): dof for i, dof in enumerate((2, 4, 6, 8, 12, 14))}
    found = interface(loaded_beam(BEAM, BEAM.with_residual(3, [0, 20]), points))
    rows = {row.point: row for row in found.rows}
    assert all(row.complete for point, row in rows.items() if point != ALL)
    assert (rows[ALL].independent, rows[ALL].directions, rows[ALL].complete) == (2, 9, False)
    assert any("share modes" in line for line in found.said)


def test_rigid_motions_of_the_interface_may_be_carried_apart():
    """All but up to six directions together are not called incomplete: constraint modes hold rigid motions."""
    row = rows_of(loaded_beam(BEAM, BEAM.with_residual(3, [0, 10])))[ALL]
    assert (row.independent, row.complete) == (2, None)
    assert "rigid motions" in row.reason


def test_a_direction_that_nothing_moves_and_a_basis_without_interface_modes():
    """Each is said for what it is."""
    loaded = loaded_beam(BEAM, BEAM.with_residual(3, DOF))
    loaded.shapes.value[1] = 0.0
    row = rows_of(loaded)["left end"]
    assert (row.independent, row.complete, row.lost) == (1, False, "ry")
    found = interface(loaded_beam(BEAM, BEAM.normal(4)))
    assert "no interface modes" in found.said[0]
    assert all((row.interface_modes, row.independent, row.complete) == (0, 0, False) for row in found.rows)


@pytest.mark.parametrize("scale", [1e-3, 1e3])
def test_units_and_normalisation_say_nothing(scale):
    """Rotations in other units and modes of another size give the same numbers."""
    loaded = loaded_beam(BEAM, BEAM.with_residual(3, [0, 20]))
    before = interface(loaded).rows
    value = loaded.shapes.value * np.geomspace(1.0, scale, loaded.shapes.value.shape[1])
    value[1] *= scale
    mass = np.geomspace(1.0, scale, len(loaded.modes.mode)) ** 2
    other = replace(loaded, shapes=replace(loaded.shapes, value=value), modes=replace(loaded.modes, modal_mass=mass))
    assert interface(other).rows == before


def test_without_shapes_and_with_a_hole():
    """No file: a note; a missing shape: no rank, and why."""
    loaded = loaded_beam(BEAM, BEAM.with_residual(3, DOF))
    assert "no shapes" in interface(replace(loaded, shapes=None)).notes[0]
    loaded.shapes.value[2, -1] = np.nan
    row = rows_of(loaded)["middle"]
    assert (row.independent, row.complete) == (None, None)
    assert "no shape of the modes" in row.reason
