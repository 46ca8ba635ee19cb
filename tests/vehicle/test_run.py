"""Rides: what is linear adds up, what is at rest stays, and time and frequency agree."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import signal

from fatigue.errors import CaseError, NumericalError
from fatigue.vehicle.assembly import assembled
from fatigue.vehicle.definition import Car, Contact, Run, Suspension, Track, Vehicle
from fatigue.vehicle.elastic import ElasticBody, Point
from fatigue.vehicle.frame_body import frame_body
from fatigue.vehicle.in_time.contact import contact_of
from fatigue.vehicle.in_time.recorded import moved
from fatigue.vehicle.in_time.stepping import AxleRows, Met, exact_step, states
from fatigue.vehicle.in_time.thinned import thinned
from fatigue.vehicle.response import response, rms
from fatigue.vehicle.run import ride
from fatigue.vehicle.track import realised, under_axles

STEPS = 1500
LINEAR = Contact(state="sound", flange_N_m=0.0)
SHORT = Track(distance_m=600.0)


@pytest.fixture(scope="module")
def body():
    """The body of the reference trailer."""
    return frame_body(Car())


@pytest.fixture(scope="module")
def of(body):
    """The reference trailer at 350 km/h."""
    return assembled(Vehicle(), body)


def motion(of, contact, inputs, worn, start=None):
    """Motion over given inputs (steps, 24), as one row for each thing kept."""
    met = Met(inputs, inputs[:, :4], np.full((len(inputs), 4), worn))
    found = moved(of, contact, met, np.zeros(len(of.A)) if start is None else start, 1e-3)
    return np.concatenate([found.q, found.over_track, np.stack(list(found.velocity.values()))])


def rough(seed):
    """Irregularities of some tenths of a millimetre, drawn at random."""
    return 2e-4 * np.random.default_rng(seed).normal(size=(STEPS, 24))


def close(found, expected):
    """Agree to 1e-9 of the largest value of each row."""
    assert (np.abs(found - expected) <= 1e-9 * np.abs(expected).max(axis=1, keepdims=True)).all()


def test_a_linear_ride_is_the_sum_of_its_parts(of):
    """Lateral, vertical and roll apart; without worn tread, flange and saturation nothing else is there."""
    contact, whole = contact_of(Vehicle(contact=LINEAR), of.speed_m_s), rough(1)
    columns = np.arange(24) // 4 % 3
    parts = [motion(of, contact, whole * (columns == part), 0.0) for part in range(3)]
    close(sum(parts), motion(of, contact, whole, 0.0))


def test_a_linear_ride_scales_and_a_worn_one_does_not(of):
    """Twice the track, twice the motion; the hollow of a tread has a size of its own."""
    contact, track = contact_of(Vehicle(contact=LINEAR), of.speed_m_s), rough(2)
    once, twice = motion(of, contact, track, 0.0), motion(of, contact, 2 * track, 0.0)
    close(twice, 2 * once)
    hollow = contact_of(Vehicle(), of.speed_m_s)
    once, twice = motion(of, hollow, track, 1.0), motion(of, hollow, 2 * track, 1.0)
    assert np.abs(twice - 2 * once).max() > 0.01 * np.abs(twice).max()


def test_no_track_no_motion(of):
    """At rest is at rest, on worn treads too."""
    for worn in (0.0, 1.0):
        assert not motion(of, contact_of(Vehicle(), of.speed_m_s), np.zeros((STEPS, 24)), worn).any()


def test_the_other_way_round(of):
    """Treads, flanges and saturation are odd: the reverse of a push and a track is the reverse of their motion."""
    contact = contact_of(Vehicle(contact=Contact(saturation_mu=0.35)), of.speed_m_s)
    start = 1e-3 * np.random.default_rng(3).normal(size=len(of.A))
    there, back = (motion(of, contact, sign * rough(4), 1.0, sign * start) for sign in (1, -1))
    close(-back, there)


def test_what_a_ride_leaves(body):
    """Samples from the end of its start on, accelerations of all outputs, wear of each axle where it is."""
    sections = ((200.0, 400.0),)
    vehicle = Vehicle(
        contact=Contact(state="worn", worn_sections_m=sections), track=SHORT, run=Run(dropped_s=1.0, seed=2)
    )
    found = ride(vehicle, body)
    assert found.step_s == 1e-3
    assert found.time_s[0] == pytest.approx(1.0)
    n = int(600 / (350 / 3.6) / 1e-3) - 1000
    assert found.q.shape == (8, n)
    assert {values.shape for values in (*found.channels.values(), *found.recovered.values())} == {(n,)}
    assert {"floor_mid_z", "conv_y", "bog_y", "roof_mid_y"} <= found.channels.keys()
    assert found.recovered.keys() == {"mount_mx"}
    np.testing.assert_allclose(found.recovered["mount_mx"], body.recover[0] @ found.q, rtol=1e-12)
    first = found.time_s[np.argmax(found.worn == 1.0, axis=1)] * found.speed_m_s
    np.testing.assert_allclose(first, 220.0 - np.array([10.0, 7.5, -7.5, -10.0]), atol=0.1)
    sound = ride(replace(vehicle, contact=replace(vehicle.contact, state="sound")), body)
    assert not sound.worn.any()
    np.testing.assert_allclose(sound.q[:, :800], found.q[:, :800], rtol=1e-9, atol=1e-12)  # not there yet
    worn = slice(2000, 3000)
    assert found.channels["bog_y"][worn].std() > 2 * sound.channels["bog_y"][worn].std()


def test_the_same_ride_twice_and_another_track(body):
    """A seed is a track, bit for bit."""
    vehicle = Vehicle(contact=Contact(state="worn"), track=SHORT)
    one, again = ride(vehicle, body), ride(vehicle, body)
    np.testing.assert_array_equal(one.q, again.q)
    np.testing.assert_array_equal(one.channels["bog_y"], again.channels["bog_y"])
    other = ride(replace(vehicle, run=Run(seed=2)), body)
    assert np.std(other.q - one.q) > 0.5 * np.std(one.q)


def test_accelerations_are_those_of_the_coordinates(body):
    """The converter hangs on the modes: what is read off velocities is the second derivative of what is read off q."""
    vehicle = Vehicle(contact=LINEAR, track=SHORT, run=Run(dropped_s=1.0))
    of, found = assembled(vehicle, body), ride(vehicle, body)
    slow = of.outputs["roof_mid_y"].copy()
    slow[of.coordinates.flex] = 0.0
    assert np.abs(slow).max() > 0.0  # the car moves as a rigid body too, so q alone is not the whole of it
    sos = signal.butter(4, [8.0, 30.0], "bandpass", fs=1000.0, output="sos")
    bent = np.gradient(np.gradient(of.outputs["roof_mid_y"][of.coordinates.flex] @ found.q, 1e-3), 1e-3)
    whole, flexible = (signal.sosfiltfilt(sos, values) for values in (found.channels["roof_mid_y"], bent))
    assert np.corrcoef(whole, flexible)[0, 1] > 0.6


def test_time_and_frequency_agree_without_flange(body):
    """Root mean squares over two tracks against those of the response to their spectra, within the scatter."""
    vehicle = Vehicle(contact=LINEAR, suspension=Suspension(setting="soft"))
    rides = [ride(replace(vehicle, run=Run(seed=seed)), body) for seed in (1, 2)]
    answer = response(assembled(vehicle, body), vehicle.track, np.arange(0.5, 60.0, 0.05))
    for names, scatter in ((("floor_mid_z", "floor_bog_z", "conv_z"), 0.03), (("conv_y", "bog_y", "roof_mid_y"), 0.1)):
        for name in names:
            in_time = np.sqrt(np.mean([of.channels[name].var() for of in rides]))
            assert in_time == pytest.approx(rms(answer.frequency_hz, answer.acceleration[name]), rel=scatter), name
    moment = np.sqrt(np.mean([of.recovered["mount_mx"].var() for of in rides]))
    assert moment == pytest.approx(rms(answer.frequency_hz, answer.recovered["mount_mx"]), rel=0.05)


def with_a_fast_mode(body, hz):
    """The body with a mode far above all others that bends where the first mount of the converter is."""
    points = {
        name: Point(point.place, np.hstack([point.shape, 0.02 * np.eye(6)[:, [1]] * (name == "converter_1")]))
        for name, point in body.points.items()
    }
    frequency, damping = np.append(body.frequency_hz, hz), np.append(body.damping_ratio, 1.0)
    return ElasticBody(body.mass, body.cg, body.inertia, frequency, damping, points)


def test_a_mode_far_above_the_sampling_rate_follows_its_load(body):
    """20 kHz in steps of 1 ms: its coordinate is the force of the mount over its stiffness, and 250 Hz hold it."""
    hz = 20e3
    vehicle, fast = Vehicle(track=SHORT, run=Run(dropped_s=1.0)), with_a_fast_mode(body, hz)
    of, time = assembled(vehicle, fast), 1e-3 * np.arange(3000)
    rails = under_axles(realised(SHORT, 1), of.axle_x_m, of.speed_m_s * time, of.speed_m_s)
    met = Met(np.concatenate([rails.value, rails.rate]).reshape(24, -1).T, rails.value[0].T, np.ones((3000, 4)))
    n, y, psi = len(of.M), of.coordinates.wheelset_y, of.coordinates.wheelset_yaw
    step = exact_step(of.A, np.hstack([of.B, of.G]), 1e-3)
    rows = AxleRows(y, psi, n + y, n + psi)
    (found,) = states(step, np.zeros(len(of.A)), met, rows, contact_of(vehicle, of.speed_m_s))
    mode = of.coordinates.flex.stop - 1
    others = np.delete(np.arange(n), mode)
    load = -found[:, others] @ of.K[mode, others] - found[:, n + others] @ of.C[mode, others]
    assert of.K[mode, mode] == pytest.approx((2 * np.pi * hz) ** 2, rel=1e-3)
    force = found[:, mode] * of.K[mode, mode]
    np.testing.assert_allclose(force[100:], load[100:], atol=1e-3 * np.abs(load).max())
    ridden = ride(vehicle, fast)
    slow = thinned(ridden, 250.0)
    np.testing.assert_allclose(slow.q[-1][10:-10], ridden.q[-1][::4][10:-10], atol=0.01 * np.abs(ridden.q[-1]).max())


@pytest.mark.parametrize(
    ("run", "track", "said"),
    [
        (Run(step_s=0.0), SHORT, r"\[run\] step_s: 0.0 s is no step"),
        (Run(dropped_s=9.0), SHORT, r"\[run\] dropped_s: 9.0 s of the start are dropped of a ride that lasts 6.17 s"),
        (
            Run(step_s=1e-8),
            SHORT,
            r"\[run\] step_s: a ride of 6.17 s in steps of 1e-08 s takes more than 1e\+07 of them",
        ),
        (Run(seed=-3), SHORT, r"\[run\] seed: -3 is no seed"),
        (Run(), Track(distance_m=-5.0), r"\[track\] distance_m: -5.0 m is no such length"),
        (Run(speed_km_h=0.0), SHORT, r"\[run\] speed_km_h: .* Give a speed above 0"),
    ],
)
def test_what_is_no_ride_is_refused(run, track, said, body):
    """One line that names key, value and remedy."""
    with pytest.raises(CaseError, match=said):
        ride(Vehicle(run=run, track=track), body)


def test_a_vehicle_that_leaves_the_track_is_told_when_where_and_what_grew(body):
    """Unstable at conicity 0.02 and 420 km/h, and no flange in its way; a flange too stiff for the step."""
    unstable = Vehicle(contact=Contact(conicity=0.02, flange_N_m=0.0), run=Run(speed_km_h=420.0))
    with pytest.raises(NumericalError) as refused:
        ride(unstable, body)
    said = str(refused.value)
    assert said.startswith("ride at 420 km/h: wheelset ")
    assert " m beside the track after " in said
    assert "m from the start; car." in said
    assert "Look at the roots of this vehicle" in said
    with pytest.raises(NumericalError, match=r"after .* s, .* m from the start; wheelset_\d\.y moves most"):
        ride(Vehicle(contact=Contact(flange_N_m=1e11)), body)
