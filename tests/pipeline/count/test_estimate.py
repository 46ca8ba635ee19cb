"""What the spectrum of an event says of a station: closed forms of one sine, and of a record without spectrum."""

import numpy as np
import pytest

from fatigue.life.curves import catalogue, damage_law
from fatigue.life.records.history import ModalHistory
from fatigue.life.rule import CycleRule
from fatigue.pipeline.count.estimate import estimate_event, mean_stress, member_variances
from fatigue.pipeline.mission.event_load import HowCounted, prepare_event
from fatigue.pipeline.solve.modal_stress import ModalStress
from fatigue.spectrum.moments import segment_spectra
from tests.one_event import NO_RAW_ENDS

STEP, HZ, MEAN, FACTOR = 0.01, 5.0, 7.0, 1.2
RULE = CycleRule(damage_law(catalogue()["master-steel"], "mean-2sigma", "none", 1e7), uses_bending_ratio=True)
STRESS = ModalStress(
    membrane=np.array([[30.0], [0.0]]),
    bending=np.array([[10.0], [0.0]]),
    in_plane_shear=np.zeros((2, 1)),
    twist_shear=np.zeros((2, 1)),
    size=np.full(2, 1.5),
    rule=RULE,
    **NO_RAW_ENDS,
)


def load(samples=2000, with_spectrum=True):
    """One mode that swings around 7 as a sine of 5 Hz; all stresses of the event are 1.2 times as large."""
    sine = MEAN + np.sin(2.0 * np.pi * HZ * STEP * np.arange(samples))
    history = ModalHistory("sine", np.array([1]), sine[None], STEP, 0.0)
    spectra = segment_spectra(history, 1.0, 40.0) if with_spectrum else None
    return prepare_event(history, HowCounted("repeat", FACTOR), spectra, HZ)


def estimate(event):
    """Estimate of both stations, the second of which has no stress."""
    return estimate_event(STRESS, event, member_variances(STRESS, event))


def test_variances_leave_the_stress_factor_out_and_means_have_it():
    """A sine of amplitude s has the variance s^2 / 2; at the bottom face bending counts the other way."""
    assert member_variances(STRESS, load())[0] == pytest.approx([450.0, 50.0], rel=1e-9)
    assert mean_stress(STRESS, load())[0] == pytest.approx([FACTOR * MEAN * 40.0, FACTOR * MEAN * 20.0], rel=1e-9)


def test_one_bending_ratio_of_both_faces():
    """std(b) / (std(m) + std(b)) = 10 / 40; where nothing varies there is none, and formulas take 0."""
    found = estimate(load())
    assert found.bending_ratio[0] == pytest.approx([0.25, 0.25], rel=1e-9)
    assert np.isnan(found.bending_ratio[1]).all()
    assert found.one_ratio[1].tolist() == [0.0, 0.0]


def test_moments_are_those_of_a_narrow_band():
    """Variance of the stress, peaks at the frequency of the sine, nearly no irregularity."""
    found = estimate(load())
    assert found.moments[0, 0] == pytest.approx(FACTOR**2 * np.array([800.0, 200.0]), rel=1e-6)
    assert found.peaks_per_s[0] == pytest.approx([HZ, HZ], rel=0.05)  # the window is 1.5 Hz wide
    assert found.samples_per_peak == pytest.approx(1.0 / (STEP * found.peaks_per_s), nan_ok=True)
    assert (found.irregularity[0] > 0.95).all()
    assert (found.dirlik[0] > found.dirlik[1]).all()


def test_a_pass_twice_as_long_does_twice_the_damage():
    """Dirlik and Tovo-Benasciutti are rates times the duration of the pass."""
    one, two = estimate(load(2000)), estimate(load(4000))
    assert two.dirlik[0] == pytest.approx(2.0 * one.dirlik[0], rel=1e-6)
    assert two.tb[0] == pytest.approx(2.0 * one.tb[0], rel=1e-6)


def test_without_spectrum_only_statistics_are_known():
    """Means and the bending ratio need no spectrum; all else is not a number, also at some of the stations."""
    found = estimate(load(with_spectrum=False)).at(np.array([0]))
    assert found.bending_ratio.tolist() == [pytest.approx([0.25, 0.25])]
    for name in ("moments", "dirlik", "tb", "irregularity", "peaks_per_s", "samples_per_peak"):
        assert np.isnan(getattr(found, name)).all()
