"""The equations of motion of the vehicle: mass, energy, symmetry, what rolls freely, and what is refused."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.errors import CaseError, DataError
from fatigue.vehicle.assembly import assembled, suspended
from fatigue.vehicle.definition import Contact, Suspension, Vehicle
from fatigue.vehicle.equations.coordinates import BOGIES, MOTIONS
from fatigue.vehicle.equations.creep import klingel_hz
from tests.vehicle_bodies import bending_body, elastic_body, rigid_body

FREE_OF_CREEP = Contact(f11_N=0.0, f22_N=0.0, f23_Nm=0.0, load_N=0.0)
UNDAMPED = Suspension(
    primary_x_Ns_m=0.0,
    primary_y_Ns_m=0.0,
    primary_z_Ns_m=0.0,
    secondary_y_Ns_m=0.0,
    secondary_z_Ns_m=0.0,
    yaw_damper_N_m=0.0,
)


def undamped(modes_hz):
    """A vehicle in which nothing dissipates, with invented modes of its car body."""
    vehicle = Vehicle(suspension=UNDAMPED, contact=FREE_OF_CREEP)
    converter, transformer = (replace(e, damping_ratio=0.0) for e in (vehicle.converter, vehicle.transformer))
    body = elastic_body(modes_hz, damping_ratio=0.0)
    return suspended(replace(vehicle, converter=converter, transformer=transformer), body)


def moved(coordinates, **motions):
    """Coordinates (n,) with the same motions of every body that has them."""
    q = np.zeros(coordinates.size)
    for column, name in enumerate(coordinates.names):
        body, _, motion = name.partition(".")
        if body != "flex":
            q[column] = motions.get(motion, 0.0)
    return q


def test_the_whole_vehicle_weighs_51_8_t():
    """Along y all bodies move; along z wheels stay on the rail."""
    of = suspended(Vehicle(), rigid_body())
    y, z = moved(of.coordinates, y=1.0), moved(of.coordinates, z=1.0)
    assert y @ of.M @ y == pytest.approx(51_800.0, rel=1e-12)
    assert z @ of.M @ z == pytest.approx(51_800.0 - 4 * 1900.0, rel=1e-12)


def test_number_of_coordinates_and_states():
    """Eight modes: 41 coordinates, 86 states, as the reference says; none: 33 and 70."""
    assert suspended(Vehicle(), elastic_body(np.linspace(8, 30, 8))).A_0.shape == (86, 86)
    assert suspended(Vehicle(), rigid_body()).A_0.shape == (70, 70)
    assert assembled(Vehicle(), rigid_body()).coordinates.size == 33


@pytest.mark.parametrize(("dampers", "hz"), [({"primary_x_Ns_m": 0.0, "primary_y_Ns_m": 0.0}, 0.4294), ({}, 0.4252)])
def test_a_free_wheelset_rolls_as_klingel_says(dampers, hz):
    """Guided by 100 N/m, without spin and gravity it swings at 0.4294 Hz at 5 m/s; dampers left in make it 0.4252."""
    vehicle = Vehicle(
        suspension=Suspension(primary_x_N_m=100.0, primary_y_N_m=100.0, **dampers),
        contact=Contact(f23_Nm=0.0, contact_angle_rate=0.0, load_N=0.0),
    )
    s = np.linalg.eigvals(assembled(vehicle, rigid_body(), speed_km_h=18.0, conicity=0.1).A)
    rolling = np.abs(s[(s.imag > 2.0) & (s.imag < 4.0)]) / (2 * np.pi)
    assert len(rolling) == 4
    assert rolling.max() == pytest.approx(hz, abs=5e-5)
    assert klingel_hz(5.0, 0.1, vehicle.wheelset) == pytest.approx(0.4294, abs=5e-5)


@given(st.lists(st.floats(5.0, 3000.0), max_size=5))
@settings(deadline=None, max_examples=20)
def test_nothing_that_dissipates_gives_roots_without_damping(modes_hz):
    """All roots are imaginary, K is symmetric and not negative; four wheelsets that no rail guides stay free."""
    of = undamped(modes_hz)
    np.testing.assert_allclose(of.K, of.K.T, rtol=0, atol=1e-6)
    assert np.linalg.eigvalsh(of.K).min() > -1e-12 * np.abs(of.K).max()
    s = np.linalg.eigvals(of.at(200.0, 0.1).A)
    assert np.abs(s.real).max() < 1e-6 * np.abs(s).max()


def test_rigid_motions_of_an_unguided_vehicle():
    """Without creep and gravity two motions are free: the vehicle as a whole along y, and its yaw."""
    of = undamped([9.0])
    stiffness = np.linalg.eigvalsh(of.K)
    assert (np.abs(stiffness) < 1e-3).sum() == 2
    y = moved(of.coordinates, y=1.0)
    assert np.abs(of.K @ y).max() < 1e-4


def test_a_rail_that_rises_lifts_the_whole_vehicle():
    """Raised rails and a vehicle raised with them: no force; a lateral shift of track and vehicle: no force."""
    of = assembled(Vehicle(), bending_body())
    signal = np.zeros((3, 4))
    for row, motion in ((1, "z"), (0, "y")):
        signal[:] = 0.0
        signal[row] = 1.0
        force = of.K @ moved(of.coordinates, **{motion: 1.0}) - of.B_value @ signal.ravel()
        assert np.abs(force).max() < 1e-4


def mirrored(coordinates, lateral_modes=()):
    """Signs (n,) of coordinates in a mirror that turns left into right: y, rx and rz change sign."""
    of_motion = {"y": -1.0, "z": 1.0, "rx": -1.0, "ry": 1.0, "rz": -1.0}
    return np.array(
        [
            of_motion[motion] if body != "flex" else (-1.0 if motion in lateral_modes else 1.0)
            for body, _, motion in (name.partition(".") for name in coordinates.names)
        ]
    )


@given(st.floats(50.0, 600.0), st.floats(0.0, 1.2))
@settings(deadline=None, max_examples=20)
def test_left_and_right_are_alike(speed, conicity):
    """The mirror image of a motion of a mirror symmetric vehicle is a motion: matrices commute with the mirror."""
    of = assembled(Vehicle(), bending_body(), speed, conicity)
    mirror = mirrored(of.coordinates, lateral_modes=("2",))
    for matrix in (of.M, of.C, of.K):
        np.testing.assert_allclose(mirror[:, None] * matrix * mirror, matrix, rtol=0, atol=1e-9 * np.abs(matrix).max())
    of_signal = np.repeat([-1.0, 1.0, -1.0], 4)
    np.testing.assert_allclose(mirror[:, None] * of.B_value * of_signal, of.B_value, atol=1e-6)
    np.testing.assert_allclose(mirror[:, None] * of.B_rate * of_signal, of.B_rate, atol=1e-6)


def test_parts_add_up_to_the_equations():
    """A is that of M, C, K and the yaw dampers at any speed and conicity, B that of the track."""
    of = suspended(Vehicle(), elastic_body([8.0, 1500.0])).at(287.0, 0.23)
    n = of.coordinates.size
    rng = np.random.default_rng(3)
    q, v, d = rng.normal(size=n), rng.normal(size=n), rng.normal(size=4)
    w = rng.normal(size=(2, 12))
    force = of.B_value @ w[0] + of.B_rate @ w[1] - of.C @ v - of.K @ q
    rate = []
    for damper, at in zip(of.maxwell, d, strict=True):
        pull = damper.stiffness * (damper.row @ q - at)
        force = force - damper.row * pull
        rate.append(pull / damper.damping)
    expected = np.r_[v, np.linalg.solve(of.M, force), rate]
    found = of.A @ np.r_[q, v, d] + of.B @ w.ravel()
    np.testing.assert_allclose(found, expected, rtol=1e-8, atol=1e-8 * np.abs(expected).max())


def test_forces_on_wheelsets():
    """A force along y accelerates a wheelset by 1/m, a moment about z by 1/I."""
    of = assembled(Vehicle(), rigid_body())
    n = of.coordinates.size
    push = of.G @ np.r_[0.0, 1900.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1029.0]
    assert push[n + of.coordinates.column("wheelset_2", "y")] == pytest.approx(1.0)
    assert push[n + of.coordinates.column("wheelset_4", "rz")] == pytest.approx(1.0)
    assert np.count_nonzero(push) == 2


@pytest.mark.parametrize("speed", [0.0, -10.0, np.nan, np.inf])
def test_a_vehicle_at_rest_has_no_creep(speed):
    """One clear line for a speed at which the law of conicity says nothing."""
    with pytest.raises(CaseError, match=r"\[run\] speed_km_h: wheels that do not roll have neither creep nor conicity"):
        assembled(Vehicle(), rigid_body(), speed_km_h=speed)


@pytest.mark.parametrize("conicity", [-0.1, np.nan])
def test_a_conicity_that_no_wheel_has(conicity):
    """One clear line, beside that of the speed."""
    with pytest.raises(CaseError, match="is no equivalent conicity") as caught:
        assembled(Vehicle(), rigid_body(), 0.0, conicity)
    assert len(caught.value.problems) == 2


def test_a_car_body_without_the_points_it_hangs_by():
    """All points that are missing or not known are named at once."""
    body = rigid_body()
    points = {name: point for name, point in body.points.items() if name not in ("converter_2", "bolster_rear_left")}
    with pytest.raises(DataError, match="lacks the points bolster_rear_left, converter_2"):
        assembled(Vehicle(), replace(body, points=points))
    elastic = elastic_body([9.0])
    elastic.points["transformer_3"].shape[1, 0] = np.nan
    with pytest.raises(DataError, match="does not say how its modes move transformer_3"):
        assembled(Vehicle(), elastic)
    names = {"bolster_front_left": "bolster_front_right", "bolster_front_right": "bolster_front_left"}
    with pytest.raises(DataError, match="bolster_front_left at y = -1.45 m is not".replace(".", r"\.")):
        assembled(Vehicle(), replace(body, points={names.get(n, n): p for n, p in body.points.items()}))


def test_no_yaw_damper_has_no_state():
    """A yaw damper of stiffness or damping 0 is none: no state that never moves, which would read as a root at 0."""
    for key in ("yaw_damper_N_m", "yaw_damper_Ns_m"):
        of = assembled(Vehicle(suspension=Suspension(**{key: 0.0})), elastic_body([9.0]))
        assert of.A.shape == (68, 68)
        assert of.maxwell == ()


def test_outputs_are_those_of_the_bodies():
    """A vehicle shifted along y shows it at all lateral outputs; one that yaws about its middle, at the bogie by x."""
    of = assembled(Vehicle(), elastic_body([9.0]))
    assert set(of.outputs) == {
        f"{name}_{way}"
        for name in ("floor_mid", "floor_bog", "floor_rear", "roof_mid", "conv", "trafo", "bog", "bog_rear")
        for way in "yz"
    }
    y = moved(of.coordinates, y=1.0)
    assert all(row @ y == pytest.approx(float(name.endswith("_y"))) for name, row in of.outputs.items())
    turned = np.zeros(of.coordinates.size)
    turned[of.coordinates.column(BOGIES[0], "rz")] = 1.0
    assert of.outputs["bog_y"] @ turned == pytest.approx(1.25)
    assert list(of.recovered) == ["moment"]
    assert of.recovered["moment"][: len(MOTIONS)] == pytest.approx(0.0)
