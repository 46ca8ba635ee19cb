"""Flags of measured channels: those of the oracle, their rules at the edges, drift."""

import numpy as np
import pytest

from fatigue.gauges.measured.flags import Drift, drift_of, flags_of, median_distance, runs, spikes, stuck_samples
from fatigue.gauges.measured.segments import cut_at
from fatigue.life.counting.rainflow import rainflow
from tests.gauges.measured.tones import flagged_tones, tones


@pytest.fixture(scope="module")
def flagged():
    """Flags of the oracle's channel."""
    return flags_of(flagged_tones(), 250.0, 500.0)


def test_the_flags_of_the_oracle(flagged):
    """measured_oracles.json, flags.flagged: 3 missing, 20 stuck, 4 clipped, 2 spikes, no drift."""
    counts = {name: int(mask.sum()) for name, mask in flagged.masks.items()}
    assert counts == {"missing": 3, "stuck": 20, "clipped": 4, "spike": 2}
    assert list(counts) == ["missing", "stuck", "clipped", "spike"]
    assert flagged.drift.range == pytest.approx(0.24564595, rel=1e-7)
    assert flagged.drift.span == pytest.approx(134.59813, rel=1e-7)
    assert not flagged.drift.is_flagged


def test_places_are_those_that_were_injected(flagged):
    """Every flag is where it was put; a run of 6 equal samples is shorter than the 12 of 0.05 s."""
    assert runs(flagged.missing) == [(5000, 5002)]
    assert runs(flagged.stuck) == [(7000, 7019)]
    assert runs(flagged.clipped) == [(12000, 12003)]
    assert runs(flagged.spike) == [(3000, 3000), (3500, 3500)]


def test_cut_damage_is_near_the_truth_and_ignored_flags_are_not(flagged):
    """flags.pseudo_damage_*: cut 0.976 of the truth, ignored 4.0 times as much."""
    x = flagged_tones()

    def damage(signal):
        cycles = rainflow(signal, "half")
        return float(cycles.count @ cycles.range**3.6)

    cut = cut_at(x, flagged.cut)
    assert cut.segments == ((0, 2999), (3001, 3499), (3501, 4999), (5003, 6999), (7020, 11999), (12004, 14999))
    of_segments = sum(damage(cut.x[first : last + 1]) for first, last in cut.segments)
    clean = damage(tones(np.arange(15000) / 250.0))
    assert clean == pytest.approx(4394786200.0, rel=1e-7)
    assert of_segments == pytest.approx(4290057400.0, rel=1e-7)
    assert damage(x[np.isfinite(x)]) == pytest.approx(17447342000.0, rel=1e-7)


def test_a_clean_channel_has_no_flag():
    """No false spike on smooth tones, at any of some rates."""
    for rate in (100.0, 250.0, 1000.0):
        assert not flags_of(tones(np.arange(int(20 * rate)) / rate), rate).cut.any()


def test_the_shortest_stuck_run_follows_the_rate():
    """max(5, round(0.05 fs)) samples: 5 up to 100 Hz, 12 at 250 Hz, 50 at 1 kHz."""
    for rate, shortest in ((20.0, 5), (100.0, 5), (250.0, 12), (1000.0, 50)):
        for length in (shortest - 1, shortest):
            x = tones(np.arange(400) / rate)
            x[100 : 100 + length] = x[100]
            assert flags_of(x, rate).stuck.sum() == (length if length == shortest else 0)


def test_missing_samples_are_not_stuck():
    """A run of NaN is missing, and nothing else."""
    x = tones(np.arange(500) / 250.0)
    x[50:100] = np.nan
    x[120] = np.inf
    flags = flags_of(x, 250.0, 100.0)
    assert flags.missing.sum() == 51
    assert not flags.stuck.any()
    assert not flags.clipped.any()


def test_a_channel_of_one_value_is_stuck_as_a_whole():
    """A dead channel: nothing is left, and there is no spike in it."""
    flags = flags_of(np.full(300, 7.0), 250.0)
    assert flags.stuck.all()
    assert not flags.spike.any()
    assert not flags.drift.is_flagged


def test_clipping_is_at_999_per_mille_of_full_scale_on_both_sides():
    """Both ends of the range; without a full scale nothing is clipped."""
    x = np.array([0.0, 99.8, 99.9, -99.95, 50.0])
    assert flags_of(x, 250.0, 100.0).clipped.tolist() == [False, False, True, True, False]
    assert not flags_of(np.array([np.nan, 0.1, 0.2]), 250.0, 0.5).clipped.any()
    assert not flags_of(x, 250.0).clipped.any()


def test_a_step_is_no_spike():
    """The median of five follows a step: the distance is that of the signal, not of the step."""
    x = tones(np.arange(1000) / 250.0)
    x[500:] += 300.0
    assert not flags_of(x, 250.0).spike.any()


def test_distances_at_the_ends_and_beside_gaps_are_not_known():
    """Two samples at each end, and two on each side of a missing one, have no full window."""
    x = np.arange(12.0) ** 2
    x[6] = np.nan
    assert np.flatnonzero(np.isnan(median_distance(x))).tolist() == [0, 1, 4, 5, 6, 7, 8, 10, 11]
    assert np.isnan(median_distance(np.arange(4.0))).all()
    assert median_distance(np.array([0.0, 1, 7, 2, 1]))[2] == 6.0


def test_distances_are_those_of_sorted_windows():
    """Against the median of every window by itself."""
    x = np.random.default_rng(3).standard_normal(200)
    slow = [abs(x[i] - np.median(x[i - 2 : i + 3])) for i in range(2, 198)]
    np.testing.assert_allclose(median_distance(x)[2:-2], slow, rtol=0, atol=1e-15)


def test_a_spike_is_beyond_fifteen_robust_scales():
    """The limit is 15 x 1.4826 x the median of the positive distances."""
    distance = np.array([0.0, 1.0, 1.0, 1.0, 15 * 1.4826 - 1e-9, 15 * 1.4826 + 1e-9, np.nan])
    assert spikes(distance).tolist() == [False] * 5 + [True, False]


def test_drift_is_flagged_from_a_quarter_of_the_span():
    """A ramp over 60 s on tones: its block medians go five sixths of the way."""
    t = np.arange(15000) / 250.0
    span = drift_of(tones(t), 250.0).span
    for rise in (0.2, 0.4):
        found = drift_of(tones(t) + rise * span * t / 60.0, 250.0)
        assert found.range == pytest.approx(rise * span * 50.0 / 60.0, rel=0.05)
        assert found.is_flagged == (rise > 0.3)


def test_drift_is_beyond_a_quarter():
    """Exactly a quarter of the span is none."""
    assert not Drift(0.25, 1.0).is_flagged
    assert Drift(0.251, 1.0).is_flagged


def test_drift_wants_two_blocks_of_ten_seconds():
    """A short channel has none, and a block without a sample is passed over."""
    t = np.arange(15000) / 250.0
    assert drift_of(100.0 * t[:4999], 250.0).range == 0.0
    x = tones(t) + 100.0 * t
    x[2500:5000] = np.nan
    assert drift_of(x, 250.0).range == pytest.approx(5000.0, rel=0.01)


def test_runs_of_equal_samples():
    """First and last of a run at both ends of the signal."""
    assert stuck_samples(np.array([1.0, 1, 1, 2, 3, 3, 3]), 3).tolist() == [True] * 3 + [False] + [True] * 3
    assert not stuck_samples(np.array([1.0, 1, 2, 2]), 3).any()
