"""Roots of the trailer against a second program, their names, and what the least stable one is."""

import numpy as np
import pytest

from fatigue.vehicle.assembly import assembled
from fatigue.vehicle.definition import Vehicle
from fatigue.vehicle.roots import is_stable, largest_real_part, least_stable, roots
from tests.vehicle_bodies import bending_body, elastic_body
from tests.vehicle_oracles import oracles, trailer

SETTINGS = ["hard", "soft", "long_wheelbase"]


@pytest.mark.parametrize("setting", SETTINGS)
def test_roots_are_those_of_the_second_program(setting):
    """All 105 settings: frequency within 5e-5, damping within 5e-5, the same group with the same share of energy."""
    checked = 0
    for case in oracles("stability")["eigenvalues"]["settings"][setting]:
        found = roots(trailer(setting).at(case["V"], case["lam"]))
        assert len(found) == len(case["modes"])
        for root, (hz, damping, group, share) in zip(found, case["modes"], strict=True):
            assert root.frequency_hz == pytest.approx(hz, rel=5e-5)
            assert root.damping == pytest.approx(damping, abs=5e-5)
            assert root.of.group == group
            assert root.of.shares[group] == pytest.approx(share, abs=6e-4)
            checked += 1
    assert checked > 1000


def test_every_root_solves_the_equations():
    """``A x = s x`` read back from the shape: the dynamic stiffness with the yaw dampers at s takes no force."""
    of = trailer().at(350.0, 0.3)
    for root in roots(of):
        s, q = root.s, root.shape
        force = (s**2 * of.M + s * of.C + of.K) @ q
        for damper in of.maxwell:
            k, c = damper.stiffness, damper.damping
            force = force + damper.row * (s * c * k / (k + s * c)) * (damper.row @ q)
        assert np.abs(force).max() < 1e-6 * np.abs(of.K).max() * np.abs(q).max()
        assert np.real(q.conj() @ of.M @ q) == pytest.approx(1.0)
        assert sum(root.of.shares.values()) == pytest.approx(1.0)


def test_names_tell_what_moves():
    """The roots of the sound reference at 350 km/h, in order of frequency."""
    names = [root.of.name for root in roots(trailer().at(350.0, 0.1))]
    assert names[:13] == [
        "car body lower sway",
        "car body bounce",
        "car body yaw",
        "car body upper sway",
        "car body pitch",
        "car body yaw with hunting",
        "bogie hunting (front)",
        "bogie bounce (opposed)",
        "bogie bounce (in phase)",
        "converter bounce",
        "converter lateral",
        "transformer bounce",
        "bogie roll (opposed)",
    ]
    assert names.count("body mode 1 (11.7 Hz)") == 1
    assert names.count("transformer lateral") == 1
    assert "wheelset creep (in phase)" in names


@pytest.mark.parametrize(("setting", "conicity"), [("hard", 0.75), ("soft", 0.6), ("long_wheelbase", 0.3)])
def test_what_loses_stability_at_high_conicity_hunts(setting, conicity):
    """The unstable root is called bogie hunting, whatever the suspension."""
    worst = least_stable(trailer(setting).at(350.0, conicity))
    assert worst.damping < 0.0
    assert worst.of.name.startswith("bogie hunting")
    assert str(worst).startswith(f"{worst.of.name}, {worst.frequency_hz:.2f} Hz, damping -")


def test_least_stable_root_decides():
    """Its real part is the largest of all; stability is its sign."""
    for conicity, stable in ((0.05, False), (0.1, True), (0.7, True), (0.72, False)):
        of = trailer().at(350.0, conicity)
        assert least_stable(of).s.real == pytest.approx(largest_real_part(of.A), rel=1e-9)
        assert is_stable(of) == stable == (largest_real_part(of.A) < 0.0)


def test_a_body_mode_is_named_by_its_own_frequency():
    """A root that is a mode of the car body says which, and at what frequency that mode lies by itself."""
    found = [r for r in roots(assembled(Vehicle(), bending_body(17.0)), 40.0) if r.of.group == "flex"]
    assert [r.of.body_mode for r in found] == [0, 1]
    assert [r.of.name for r in found] == ["body mode 1 (17.0 Hz)", "body mode 2 (19.5 Hz)"]
    assert all(0.5 < r.of.body_mode_share <= r.of.shares["flex"] for r in found)


def test_modes_far_above_the_band_are_kept_and_harmless():
    """Modes of 1 to 50 kHz with 100 % damping: the vehicle stays stable, its slow roots move by their flexibility."""
    stiff = assembled(Vehicle(), elastic_body([12.0], seed=2))
    more = assembled(Vehicle(), elastic_body([12.0, 1.2e3, 9.1e3, 5.0e4], seed=2))
    assert more.A.shape == (78, 78)
    assert is_stable(more)
    assert len(roots(more)) == len(roots(stiff))
