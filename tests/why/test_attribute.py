"""Damage shared out at one point under a sine, where every share and slope is known."""

import numpy as np
import pytest

from fatigue.life.rule import cycle_damage
from fatigue.why.attribute import Attribution, Bins, attribute_event, numbers_of_point
from tests.why.one_point import CYCLES, LENGTH, MODES, PLAN, RULE, SLOPE, point, sine_load

BINS = Bins(np.array([3.0, 8.0]), length_km=0.5)
FACTOR = 1.2


@pytest.fixture(scope="module")
def found():
    """The damage of a point with 60 MPa of the first mode, and -20 MPa of the second, which relieves."""
    return attribute_event(point(60.0, -20.0), sine_load(FACTOR), PLAN.passes[0], MODES, BINS)


def test_damage_is_that_of_its_cycles(found):
    """100 cycles of one range in 2 km."""
    largest = 2.0 * FACTOR * 1.5 * 40.0 * np.sin(2.0 * np.pi * np.array([0.2625]))  # the samples miss the crest
    damage = CYCLES * cycle_damage(largest, RULE.law) / LENGTH
    assert found.damage == pytest.approx(damage, rel=1e-9)
    assert found.top_cycle_share == pytest.approx(1.0 / CYCLES, rel=1e-9)


def test_modes_owe_as_their_parts_of_the_stress(found):
    """60 - 20 = 40: one and a half times the damage, and half of it taken off; slopes are k times as large."""
    assert found.mode[0] / found.damage == pytest.approx([1.5, -0.5], rel=1e-9)
    assert found.mode_slope[0] / found.damage == pytest.approx([1.5 * SLOPE, -0.5 * SLOPE], rel=1e-9)
    assert found.load_slope == pytest.approx(SLOPE * found.damage, rel=1e-9)


def test_thickness_acts_through_membrane_stress_and_through_the_rule(found):
    """Membrane stress falls with 1/t; the rule has its own exponent."""
    assert found.thickness_slope == pytest.approx(-SLOPE * found.damage, rel=1e-9)
    assert found.rule_slope == pytest.approx(-0.25 * SLOPE * found.damage, rel=1e-9)


def test_the_band_of_the_sine_owns_the_damage_and_the_mode_in_it_resonates(found):
    """5 Hz lies in the second of three bands; the second mode has no damping to say how wide its resonance is."""
    assert found.band[0] / found.damage == pytest.approx([0.0, 1.0, 0.0], abs=1e-9)
    assert found.resonant[0, 0] == pytest.approx(found.mode[0, 0], rel=1e-9)
    assert np.isnan(found.resonant[0, 1])


def test_every_bin_of_the_track_has_its_part(found):
    """Four bins of half a kilometre; a sine damages everywhere alike, but for the cycle that a bin cuts."""
    assert found.place_km.tolist() == [0.0, 0.5, 1.0, 1.5, 2.0]
    assert found.place[0].sum() == pytest.approx(found.damage[0], rel=1e-12)
    assert found.place[0] / found.damage == pytest.approx(np.full(4, 0.25), abs=1.0 / CYCLES)


def test_shares_of_all_events_are_of_the_damage_of_the_point(found):
    """The same event twice: each has half, the modes keep their shares, life falls with their exponents."""
    both = Attribution(point(60.0, -20.0), (found, found))
    assert both.event_share.tolist() == [[0.5, 0.5]]
    assert both.mode_share[0] == pytest.approx([1.5, -0.5], rel=1e-9)
    assert both.mode_exponent[0] == pytest.approx([-1.5 * SLOPE, 0.5 * SLOPE], rel=1e-9)
    assert both.band_share[0] == pytest.approx([0.0, 1.0, 0.0, 0.0], abs=1e-9)


def test_numbers_of_a_point_grow_with_its_bins():
    """Half as long bins of a 2 km event: four more; one band more: two more."""
    few = numbers_of_point(PLAN, len(MODES.mode), BINS)
    assert numbers_of_point(PLAN, len(MODES.mode), Bins(BINS.edges_hz, 0.25)) == few + 4
    assert numbers_of_point(PLAN, len(MODES.mode), Bins(np.array([3.0, 8.0, 9.0]), 0.5)) == few + 2
