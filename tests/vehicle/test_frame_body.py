"""The frame body against the numbers of another program, and what a vehicle relies on."""

import json
from pathlib import Path

import numpy as np
import pytest

from fatigue.flexbody.mass import rigid_motions
from fatigue.vehicle.definition import Car
from fatigue.vehicle.frame_body import (
    EXTERNAL,
    INTERNAL,
    OUTPUTS,
    frame_basis,
    frame_beams,
    frame_body,
    frame_structure,
    masters_of,
    mount_moment,
)

ORACLES = json.loads((Path(__file__).parents[1] / "data/vehicle/body_and_reduction.json").read_text())


@pytest.fixture(scope="module")
def structure():
    """The bare car body."""
    return frame_structure()


@pytest.fixture(scope="module")
def weak():
    """The body of the reference trailer."""
    return frame_body(Car())


def test_mass_of_the_body(weak):
    """Mass, centre and inertia are those of the other program; the floor is 1.15 m above the rail."""
    of = ORACLES["body"]
    assert len(frame_beams()[0]) == of["n_elements"]
    assert weak.mass == pytest.approx(of["mass_kg"], rel=1e-12)
    assert weak.cg == pytest.approx(np.add(of["cg_fe_frame_m"], [0.0, 0.0, 1.15]), abs=2e-6)
    about = [of["inertia_about_cg"][name] for name in ("Ixx", "Iyy", "Izz")]
    assert np.diag(weak.inertia) == pytest.approx(about, rel=1e-10)
    assert weak.inertia == pytest.approx(np.diag(np.diag(weak.inertia)), abs=1e-6)


@pytest.mark.parametrize(
    ("basis", "keep_hz", "modes"), [("weak", 25.0, 8), ("strong", 80.0, 75), ("weak", 80.0, 71), ("full", 80.0, 127)]
)
def test_bases_of_the_vehicle(basis, keep_hz, modes):
    """The bases S, R, W80 and full80 have their modes, up to their cut, with the frequencies of the other program."""
    body = frame_body(Car(basis=basis, keep_hz=keep_hz))
    known = {"weak": "external6", "strong": "all18"}
    hz = (
        ORACLES["condensation"][known[basis]]["craig_bampton_60Hz"]["elastic_hz"]
        if basis in known
        else ORACLES["body"]["elastic_hz"]
    )
    hz = [f for f in hz if f <= keep_hz]
    assert len(body.frequency_hz) == modes
    assert body.frequency_hz.max() <= keep_hz
    assert body.frequency_hz[: len(hz)] == pytest.approx(hz, rel=1e-5)
    assert (body.damping_ratio == 0.015).all()


def test_points_are_where_the_suspension_takes_hold(weak):
    """Six external, twelve internal points and five outputs, front left first, 1.15 m above the body's own frame."""
    assert set(weak.points) == {*EXTERNAL, *INTERNAL, *OUTPUTS}
    assert weak.points["bolster_front_left"].place.tolist() == [8.75, 1.45, 1.15]
    assert weak.points["converter_4"].place.tolist() == [-1.75, -1.45, 1.15]
    assert weak.points["transformer_2"].place.tolist() == [5.25, -0.7, 1.15]
    assert weak.points["roof_base"].place == pytest.approx([-3.5, 0.8, 3.75])
    assert all(point.shape.shape == (6, 8) for point in weak.points.values())


def test_shapes_are_those_of_the_basis(structure, weak):
    """The shape of a point is what the basis has at its node; other floor heights move the points alone."""
    basis = frame_basis(structure, "weak", 60.0, 25.0)
    row = 6 * (12 * (1 + 7) + 2)
    assert weak.points["converter_1"].shape == pytest.approx(basis.shapes[row : row + 6])
    higher = frame_body(Car(floor_z_m=1.25))
    assert higher.cg - weak.cg == pytest.approx([0.0, 0.0, 0.1])
    assert higher.points["roof_1"].place - weak.points["roof_1"].place == pytest.approx([0.0, 0.0, 0.1])


def test_mount_moment_is_work_of_the_beam(structure):
    """The moment is the derivative of the energy of the floor beam by the rotation of its second node."""
    rng = np.random.default_rng(5)
    shape = rng.standard_normal((1080, 1))
    first, second = 6 * (12 * 8 + 1), 6 * (12 * 8 + 2)
    # of a beam along y of length 0.75: 4 EI/L, 2 EI/L of the rotations and 6 EI/L^2 of the displacement along z
    EI, L = 70e9 * 2.4e-4, 0.75
    turned = 4 * EI / L * shape[second + 3] + 2 * EI / L * shape[first + 3]
    moved = -6 * EI / L**2 * (shape[second + 2] - shape[first + 2])
    assert mount_moment(shape) == pytest.approx(turned + moved, rel=1e-12)


def test_mount_feels_no_rigid_motion(structure):
    """A rigid motion leaves no moment in the beam."""
    R = rigid_motions(structure.xyz, structure.direction)
    assert abs(mount_moment(R)).max() < 1e-6
    assert abs(structure.K @ R).max() < 1e-5


def test_masters_are_six_degrees_of_freedom_a_node():
    """6 external nodes are 36 rows, all 18 are 108."""
    assert masters_of(EXTERNAL).sum() == 36
    assert masters_of(EXTERNAL, INTERNAL).sum() == 108


def test_unknown_basis_is_refused():
    """A basis that nobody knows is named."""
    with pytest.raises(ValueError, match="no basis 'stiff'"):
        frame_body(Car(basis="stiff"))
