"""Nodal forces prove in which axes stresses stand, on files of three solvers; another rule, face or run is told."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fatigue.readers.convert.stresses.axes import element_axes, into_frame
from fatigue.readers.convert.stresses.proof import CHECK, stress_row
from fatigue.readers.foreign.read import read_forces, read_model, read_stresses

STRIP = Path("tests/data/nastran/mystran")
NASTRAN, OWN = Path("data/nastran"), Path("tests/data/nastran")


def read(results, mesh):
    """Forces, model, and the stress blocks of every mode."""
    forces, model = read_forces(results, None), read_model(mesh)
    stresses = read_stresses(results, model.mesh.element)
    by_mode = [[b for b in stresses.blocks if (b.mode or b.subcase) == m] for m in forces.mode.tolist()]
    return forces, model, by_mode


@pytest.mark.parametrize(
    ("results", "mesh", "sign", "precision"),
    [
        (NASTRAN / "wingbox_stitched_together-000.op2", NASTRAN / "wingbox_stitched_together-000.bdf", -1, 1e-4),  # NX
        (OWN / "mode_solid_shell_bar.op2", OWN / "mode_solid_shell_bar.bdf", -1, 1e-4),  # MSC, modes
        (STRIP / "strip_static.op2", STRIP / "strip_static.dat", 1, 1e-6),  # MYSTRAN, distorted
        (STRIP / "strip_modes.op2", STRIP / "strip_modes.dat", 1, 1e-5),
    ],
)
def test_stresses_do_the_work_of_the_forces(results, mesh, sign, precision):
    """Genuine files: membrane and bending stress agree to the precision of the file, with the bisector of diagonals."""
    row = stress_row(*read(results, mesh), sign)
    assert (row.check, row.light) == (CHECK, "green")
    assert row.value < precision


def test_a_parabolic_quadrangle_is_told_by_its_centre():
    """The zoo has one CQUAD8, whose centre is not its mean: 5 % off, all other shells 1e-7; HDF5 says the same."""
    pytest.importorskip("h5py")
    for suffix in ("op2", "h5"):
        forces, model, by_mode = read(NASTRAN / f"modes_elements.{suffix}", NASTRAN / "modes_elements.bdf")
        forces = replace(forces, frequency=np.full(3, 10.0))  # the zoo has rigid modes only; round-off counts here
        row = stress_row(forces, model, by_mode, -1.0)
        assert row.light == "green"
        assert 0.01 < row.value < 0.06
        rest = [[b for b in own if b.kind != "QUAD8"] for own in by_mode]
        assert stress_row(forces, model, rest, -1.0).value < 1e-6


def turned(block, model):
    """A block whose solver lays x along the first side of quadrangles."""
    mesh = model.mesh
    bisected = element_axes(mesh)
    stress = block.stress.copy()
    for k, element in enumerate(block.element.tolist()):
        i = int(np.searchsorted(mesh.element, element))
        side = mesh.xyz[mesh.corner[i, 1]] - mesh.xyz[mesh.corner[i, 0]]
        stress[k] = stress[k] @ into_frame(bisected[i], side / np.linalg.norm(side), bisected[i, 2]).T
    return replace(block, stress=stress)


def test_other_axes_are_red():
    """The axis x along the first side, as some post-processors have it, and material axes of 30 degrees."""
    forces, model, by_mode = read(STRIP / "strip_static.op2", STRIP / "strip_static.dat")
    side = [[turned(b, model) if b.kind == "QUAD4" else b for b in own] for own in by_mode]
    c = into_frame(np.eye(3), np.array([np.cos(0.5), np.sin(0.5), 0.0]), np.array([0.0, 0.0, 1.0]))
    material = [[replace(b, stress=b.stress @ c.T) for b in own] for own in by_mode]
    for wrong in (side, material):
        row = stress_row(forces, model, wrong, 1.0)
        assert (row.light, row.value > 0.05) == ("red", True)
        assert "OMID" in row.remedy


def test_other_faces_signs_and_runs_are_red():
    """Faces swapped, forces of the other sign, half the stress, the case of another load."""
    forces, model, by_mode = read(STRIP / "strip_static.op2", STRIP / "strip_static.dat")
    swapped = [[replace(b, stress=b.stress[:, :, ::-1]) for b in own] for own in by_mode]
    half = [[replace(b, stress=b.stress / 2) for b in own] for own in by_mode]
    for blocks, sign in ((swapped, 1.0), (half, 1.0), (by_mode, -1.0), (by_mode[::-1], 1.0)):
        assert stress_row(forces, model, blocks, sign).light == "red"


def test_without_common_elements_nothing_is_proven():
    """Forces of other elements than those with stresses: amber, and what is assumed is said."""
    forces, model, by_mode = read(STRIP / "strip_static.op2", STRIP / "strip_static.dat")
    few = [[replace(b, element=b.element[:1], node=b.node[:1], fibre=b.fibre[:1], stress=b.stress[:1]) for b in own[:1]]
           for own in by_mode]  # fmt: skip
    keep = forces.element != few[0][0].element[0]
    less = replace(forces, node=forces.node[keep], element=forces.element[keep], kind=forces.kind[keep],
                   force=forces.force[:, keep])  # fmt: skip
    row = stress_row(less, model, few, 1.0)
    assert (row.light, row.value) == ("amber", None)
    assert "taken to be in the axes of the elements" in row.finding


def test_offsets_move_the_moments_and_not_the_proof():
    """Forces about grids that lie 2 mm below the mid-surface: the same stresses, the same proof."""
    forces, model, by_mode = read(STRIP / "strip_static.op2", STRIP / "strip_static.dat")
    offset = np.full(model.mesh.element.size, 2.0)
    at = np.minimum(np.searchsorted(model.mesh.element, forces.element), offset.size - 1)
    normal = element_axes(model.mesh)[at, 2]
    moved = forces.force.astype(float).copy()
    moved[..., 3:] += np.cross(2.0 * normal, moved[..., :3]) * forces.of_element[:, None]
    shifted = replace(model, mesh=replace(model.mesh, offset=offset))
    assert stress_row(replace(forces, force=moved), shifted, by_mode, 1.0).value < 1e-6
    assert stress_row(forces, shifted, by_mode, 1.0).light == "red"
