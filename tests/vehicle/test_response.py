"""Response to a rough track against a second program, a direct solution, and what symmetry asks."""

from dataclasses import replace

import numpy as np
import pytest

from fatigue.errors import CaseError
from fatigue.vehicle.assembly import assembled
from fatigue.vehicle.definition import Suspension, Track, Vehicle
from fatigue.vehicle.response import GRID_HZ, modal_split, peak_hz, response, rms, transfer, wz
from tests.vehicle_bodies import bending_body, elastic_body
from tests.vehicle_oracles import body, oracles

CASES = oracles("response")["frequency_domain"]
SIGNALS = {"lateral": 0, "vertical": 1, "roll": 2}


def at(setting="hard", fe=9.2, basis="S", V=350.0, lam=0.1):
    """The trailer of a case of the verification numbers."""
    vehicle = Vehicle(suspension=Suspension(setting=setting))
    vehicle = replace(vehicle, converter=replace(vehicle.converter, fe_hz=fe))
    return assembled(vehicle, body(basis), V, lam)


@pytest.fixture(scope="module")
def sound():
    """Response of the sound reference: hard, 350 km/h, conicity 0.10, 9.2 Hz."""
    return response(at(), Track())


@pytest.mark.parametrize("case", CASES, ids=lambda c: f"{c['setting']}-{c['V']}-{c['lam']}-{c['fe']}-{c['basis']}")
def test_response_is_that_of_the_second_program(case):
    """Rms and peak of accelerations, Wz, and rms of the mount moment, within 5e-4; measured 4.5e-5."""
    found = response(at(case["setting"], case["fe"], case["basis"], case["V"], case["lam"]), Track())
    f = found.frequency_hz
    for name, expected in case["outputs"].items():
        if name == "mount_mx_Nm":
            assert rms(f, found.recovered["mount_mx"]) == pytest.approx(expected["rms"], rel=5e-4)
            above = rms(f, found.recovered["mount_mx"], above_hz=20.0)
            assert above == pytest.approx(expected["rms_above_20Hz"], rel=5e-4)
        else:
            assert rms(f, found.acceleration[name]) == pytest.approx(expected["acc_rms"], rel=5e-4)
            assert wz(found, name) == pytest.approx(expected["wz"], rel=5e-4)
            assert peak_hz(f, found.acceleration[name]) == pytest.approx(expected["peak_hz"], abs=1e-9)


def test_modal_split_is_that_of_the_second_program(sound):
    """Excitation, static and dynamic share of the eight modes, within 5e-4."""
    split, expected = modal_split(sound, body()), oracles("response")["modal_split"]["fe_9p2"]
    assert split.mode_hz == pytest.approx(np.array(expected["mode_hz"]), rel=5e-5)
    assert split.rms_q == pytest.approx(np.array(expected["rms_q"]), rel=5e-4)
    assert split.rms_excitation == pytest.approx(np.array(expected["rms_effective_excitation"]), rel=5e-4)
    assert split.static_share == pytest.approx(np.array(expected["rms_q_quasistatic_over_q"]), rel=5e-4)
    assert split.dynamic_share == pytest.approx(np.array(expected["rms_q_dynamic_over_q"]), rel=5e-4)


def test_excitation_of_modes_balances_their_equations(sound):
    """``f`` of a mode is what springs and dampers pull at it with, computed from the equations of motion."""
    of, k = at(), 700
    w = 2.0 * np.pi * sound.frequency_hz[k]
    q = sound.transfer[0, k]
    own, z = 2.0 * np.pi * body().frequency_hz, body().damping_ratio
    modes = sound.modes
    D = dynamic_stiffness(of, w)[modes]
    D[:, modes] -= np.diag(own**2 - w**2 + 2j * z * own * w)
    excitation = (own**2 - w**2 + 2j * z * own * w) * q[modes]
    assert np.abs(D @ q + excitation).max() < 1e-7 * np.abs(excitation).max()


def dynamic_stiffness(of, w):
    """``-w^2 M + i w C + K + sum of r'r i w c k/(k + i w c)``: the equations with the yaw dampers eliminated."""
    D = -(w**2) * of.M + 1j * w * of.C + of.K
    for damper in of.maxwell:
        k, c = damper.stiffness, damper.damping
        D = D + 1j * w * c * k / (k + 1j * w * c) * np.outer(damper.row, damper.row)
    return D


@pytest.mark.parametrize("modes_hz", [[], [9.0, 14.0], [12.0, 1.4e3, 8.0e3, 1.0e3, 3.0e4]])
def test_transfer_solves_the_dynamic_stiffness(modes_hz):
    """Axle by axle with its lag, at low and high frequencies; modes far above the band and critically damped too."""
    of = assembled(Vehicle(), elastic_body(modes_hz, seed=4), 300.0, 0.2)
    hz = np.array([0.5, 1.84, 9.3, 59.0, 400.0])
    H = transfer(of, hz)
    for k, w in enumerate(2.0 * np.pi * hz):
        for signal in SIGNALS.values():
            force = sum(
                (of.B_value + 1j * w * of.B_rate)[:, 4 * signal + axle]
                * np.exp(-1j * w * (of.axle_x_m[0] - of.axle_x_m[axle]) / of.speed_m_s)
                for axle in range(4)
            )
            expected = np.linalg.solve(dynamic_stiffness(of, w), force)
            assert np.abs(H[signal, k] - expected).max() < 1e-7 * np.abs(expected).max()


def test_left_and_right_are_alike():
    """Lateral and roll signals move a mirror symmetric vehicle sideways alone, the vertical one up and down alone."""
    of = assembled(Vehicle(), bending_body())
    H = transfer(of, np.array([1.0, 8.0, 20.0]))
    sideways = np.array([name.rpartition(".")[2] in {"y", "rx", "rz", "2"} for name in of.coordinates.names])
    for name, signal in SIGNALS.items():
        still = ~sideways if name in ("lateral", "roll") else sideways
        assert np.abs(H[signal][:, still]).max() < 1e-9 * np.abs(H[signal]).max()


def test_a_slow_vehicle_follows_the_track():
    """Waves far longer than the vehicle lift and shift it as they are, with the lag of its middle; roll turns it."""
    of = assembled(Vehicle(), bending_body(), 100.0, 0.1)
    H = transfer(of, np.array([1e-3]))[:, 0]
    for body_name in ("car", "conv", "bogie_front", "bogie_rear"):
        assert H[1, of.coordinates.column(body_name, "z")] == pytest.approx(1.0, abs=5e-3)
        assert H[0, of.coordinates.column(body_name, "y")] == pytest.approx(1.0, abs=2e-2)
    assert H[2, of.coordinates.column("bogie_front", "rx")] == pytest.approx(1.0, abs=0.05)


def test_rougher_track_scales_the_response(sound):
    """All signals times c: accelerations times c. ``high`` has 2.89 and 2.68 times the spectra of ``low``."""
    rough = response(at(), Track(quality="high"))
    f = sound.frequency_hz
    ratio = {n: (rms(f, rough.acceleration[n]) / rms(f, sound.acceleration[n])) ** 2 for n in sound.acceleration}
    assert ratio["floor_mid_z"] == pytest.approx(1.080e-6 / 4.032e-7, rel=1e-6)
    assert all(value * (1 + 1e-9) >= 1.080e-6 / 4.032e-7 for value in ratio.values())
    assert all(value <= 6.125e-7 / 2.119e-7 * (1 + 1e-9) for value in ratio.values())


def test_an_unstable_vehicle_has_no_response():
    """One clear line with the root that grows: what moves, frequency, damping, share of energy."""
    with pytest.raises(CaseError) as caught:
        response(at(lam=0.05), Track())
    (problem,) = caught.value.problems
    assert problem.code == "unstable"
    assert problem.where == "350 km/h, conicity 0.05"
    assert problem.what.startswith("the vehicle is unstable, so that it has no linear response: car body upper sway")
    assert "Hz, damping -" in problem.what
    assert "% of the energy" in problem.what


def test_the_grid_is_that_of_the_definition():
    """0.50, 0.52, ... 60.00 Hz."""
    assert GRID_HZ[[0, 1, -1]].tolist() == [0.5, 0.52, 60.0]
    assert GRID_HZ.size == 2976
