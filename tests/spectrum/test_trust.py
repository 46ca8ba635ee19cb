"""The verdict: every defect gets its own, sound records get none."""

from dataclasses import replace
from math import gamma

import numpy as np
import pytest

from fatigue.life.counting.rainflow import rainflow
from fatigue.life.records.history import ModalHistory
from fatigue.spectrum.methods import dirlik_damage_rate, spectral_shape, tovo_benasciutti_damage_rate
from fatigue.spectrum.moments import moment_matrices, point_moments, segment_spectra
from fatigue.spectrum.reasons import reason
from fatigue.spectrum.trust import (
    VERDICTS,
    judge,
    sampling_loss,
    tone_damage_factor,
    trust_matrices,
)
from tests.naive_spectrum import modal_spectrum, narrow_spectrum, straight_law, two_band_spectrum
from tests.synthetic_records import (
    RATE,
    bimodal,
    curves,
    gaussian,
    hermite,
    hunting_bursts,
    impacts,
    saturation,
    sine,
    slow_modulation,
    speed_steps,
    spike,
    stationary,
)

K = 3.6
LONG = int(205 * RATE)
SHORT = int(29 * RATE)


def judged(records, k=K, step=1 / RATE, **changes):
    """Judge records (n, t), each the stress of one point, from end to end."""
    q = np.atleast_2d(records)
    history = ModalHistory("event", np.arange(len(q)) + 1, q, step, 0.0)
    spectra = segment_spectra(history, 4.0, min(80.0, 0.4 / step))
    modal_stress, law = np.eye(len(q)), straight_law(k)
    moments = point_moments(modal_stress, moment_matrices(spectra))
    damage = []
    for cycles in (rainflow(x, "repeat") for x in q):
        damage.append(cycles.count * cycles.range**k)
    counted = np.array([d.sum() for d in damage]) / history.duration
    deviation = q - q.mean(axis=1, keepdims=True)
    known = {
        "slope": k,
        "dirlik_ratio": dirlik_damage_rate(moments, law) / counted,
        "tb_ratio": tovo_benasciutti_damage_rate(moments, law) / counted,
        "kurtosis": np.mean(deviation**4, axis=1) / np.mean(deviation**2, axis=1) ** 2,
        "top_cycle_share": np.array([d.max() / d.sum() for d in damage]),
        "samples_per_peak": 1 / step / spectral_shape(moments).peaks,
        "top_mode_hz": 36.0,
    }
    return judge(modal_stress, moments, trust_matrices(history, spectra), **(known | changes))


def verdicts(judgement):
    """Names of the verdicts."""
    return [VERDICTS[code] for code in judgement.verdict]


def ensemble(kind, samples, count=3):
    """Draw records of one kind."""
    return np.stack([kind(np.random.default_rng(seed), samples) for seed in range(count)])


@pytest.mark.parametrize(
    ("kind", "verdict"),
    [
        (stationary, "valid"),
        (bimodal, "valid"),
        (speed_steps, "non_stationary"),
        (hunting_bursts, "non_stationary"),
        (hermite, "non_gaussian"),
        (impacts, "non_gaussian"),
        (saturation, "non_gaussian"),
        (sine(0.5), "harmonic"),
        (sine(0.9), "harmonic"),
        (sine(0.99), "harmonic"),
        (curves, "quasi_static"),
        (spike, "single_event"),
    ],
)
def test_every_defect_gets_its_own_verdict(kind, verdict):
    """Records of 205 s with one defect each, three of each kind."""
    assert verdicts(judged(ensemble(kind, LONG))) == [verdict] * 3


def test_slow_modulation():
    """A log-normal amplitude makes the record non-stationary, unless by chance one crest of it governs alone."""
    found = verdicts(judged(ensemble(slow_modulation, LONG, 6)))
    assert set(found) <= {"non_stationary", "single_event"}
    assert found.count("non_stationary") >= 5


@pytest.mark.parametrize(
    ("kind", "verdict"),
    [
        (stationary, "valid"),
        (bimodal, "valid"),
        (slow_modulation, "non_stationary"),
        (sine(0.9), "harmonic"),
        (curves, "quasi_static"),
        (spike, "single_event"),
    ],
)
def test_a_simulation_of_half_a_minute_suffices(kind, verdict):
    """29 s show what is gross; limits widen with what chance does in so short a record."""
    assert verdicts(judged(ensemble(kind, SHORT))) == [verdict] * 3


@pytest.mark.parametrize("spectrum", [narrow_spectrum, two_band_spectrum, modal_spectrum])
def test_stationary_gaussian_records_are_not_accused(spectrum):
    """Of 40 sound records of 29 s, no more than one in ten gets a verdict other than valid."""
    rng = np.random.default_rng(1)
    records = np.stack([gaussian(rng, spectrum(), SHORT) for _ in range(40)])
    assert verdicts(judged(records)).count("valid") >= 36


def test_points_mix_modes():
    """Two coordinates, one stationary, one a limit cycle: each point is judged by its own mixture."""
    rng = np.random.default_rng(2)
    q = np.stack([stationary(rng, LONG), sine(0.99)(rng, LONG)])
    history = ModalHistory("event", np.array([1, 2]), q, 1 / RATE, 0.0)
    spectra = segment_spectra(history, 4.0, 80.0)
    modal_stress = np.array([[1.0, 0.0], [1.0, 1e-3], [0.0, 1.0], [0.1, 1.0], [0.0, 0.0]])
    moments = point_moments(modal_stress, moment_matrices(spectra))
    good = np.ones(5)
    found = judge(
        modal_stress,
        moments,
        trust_matrices(history, spectra),
        slope=K,
        dirlik_ratio=np.where(moments[0] > 0, 1.0, np.nan),
        tb_ratio=good,
        kurtosis=3 * good,
        top_cycle_share=0 * good,
        samples_per_peak=20 * good,
        top_mode_hz=None,
    )
    assert verdicts(found) == ["valid", "valid", "harmonic", "harmonic", "not_assessed"]
    assert np.all(np.isnan(found.peaks_over_top_mode))


def test_a_coarse_record_is_accused_of_its_sampling():
    """Every tenth sample: fewer than six per peak, whatever else may be wrong."""
    found = judged(ensemble(speed_steps, LONG, 2)[:, ::10], step=10 / RATE)
    assert verdicts(found) == ["sampling", "sampling"]
    assert "samples per peak" in reason(found, 0)


def test_more_peaks_than_modes_can_make():
    """A rate of peaks above three times the highest mode is noise."""
    found = judged(stationary(np.random.default_rng(3), SHORT), top_mode_hz=2.0)
    assert verdicts(found) == ["sampling"]
    assert "upper_hz" in reason(found, 0)


def test_what_remains_is_the_formula():
    """A ratio that is off although nothing is wrong with the record: the formula at this bandwidth."""
    record = stationary(np.random.default_rng(4), LONG)
    for ratio in (0.5, 1.6):
        found = judged(record, dirlik_ratio=np.array([ratio]), tb_ratio=np.array([0.97]))
        assert verdicts(found) == ["bandwidth"]
        assert "0.97" in reason(found, 0)


def test_first_finding_wins():
    """The order is that of the rule: what makes the later findings meaningless comes first."""
    record = speed_steps(np.random.default_rng(5), LONG)
    nothing = np.array([np.nan])
    many, few = np.array([0.9]), np.array([4.0])
    assert verdicts(judged(record)) == ["non_stationary"]
    assert verdicts(judged(record, top_cycle_share=many)) == ["single_event"]
    assert verdicts(judged(record, top_cycle_share=many, samples_per_peak=few)) == ["sampling"]
    assert verdicts(judged(record, samples_per_peak=few, dirlik_ratio=nothing)) == ["not_assessed"]


def test_a_modulation_without_consequence_is_no_finding():
    """A slow change of a tenth in amplitude is seen in a long record, but Dirlik remains right: valid, and said."""
    samples = int(600 * RATE)
    record = gaussian(np.random.default_rng(6), narrow_spectrum(), samples)
    found = judged(record * (1 + 0.25 * np.sin(2 * np.pi * np.arange(samples) / samples)))
    assert found.modulation_index[0] > found.modulation_high[0]
    assert verdicts(found) == ["valid"]
    assert "modulated over time" in reason(found, 0)


def test_steep_curves_have_a_wider_band():
    """Formulas differ more at steep slopes: 0.80 to 1.25 up to k = 4, 0.65 to 1.35 from k = 5."""
    record = stationary(np.random.default_rng(7), LONG)
    bands = [judged(record, k=k) for k in (3.0, 4.0, 4.5, 5.0, 9.0)]
    chance = [np.exp(1.645 * 0.5 * d.damage_cov[0]) for d in bands]
    np.testing.assert_allclose(
        [d.ratio_low[0] * c for d, c in zip(bands, chance, strict=True)], [0.8, 0.8, 0.725, 0.65, 0.65]
    )
    np.testing.assert_allclose(
        [d.ratio_high[0] / c for d, c in zip(bands, chance, strict=True)], [1.25, 1.25, 1.3, 1.35, 1.35]
    )


def test_confidence_of_the_damage():
    """CoV = k/2 / sqrt(T B_s): a record of 51 s of these modes knows its damage to 16 %, one of 205 s to 8 %."""
    short = judged(ensemble(stationary, int(51.2 * RATE)))
    long = judged(ensemble(stationary, LONG))
    assert np.mean(short.damage_cov) == pytest.approx(0.165, abs=0.02)
    assert np.mean(long.damage_cov) == pytest.approx(0.08, abs=0.01)
    assert not short.record_too_short.any()
    steep = judged(ensemble(stationary, SHORT), k=9.0)
    assert steep.record_too_short.all()
    assert "The record is short" in reason(steep, 0)


def test_too_short_for_its_scatter():
    """Ten seconds: what cannot be had is NaN and said in words, and nobody is accused for want of it."""
    found = judged(stationary(np.random.default_rng(8), int(10 * RATE)))
    assert verdicts(found) == ["valid"]
    assert found.record_too_short[0]
    for name in ("modulation_index", "modulation_factor", "bandwidth_hz", "damage_cov", "expected_kurtosis"):
        assert np.isnan(getattr(found, name)[0])
    assert np.isfinite(found.top_cycle_limit[0])
    assert "unknown (4 spectral segments, 8 are needed)" in reason(found, 0)


def test_factors_of_the_known_effects():
    """Speed steps x 0.5 to 1.5 add 35 % of damage, a tone with 90 % of the variance takes a third away."""
    steps = judged(ensemble(speed_steps, LONG))
    assert np.mean(steps.modulation_factor) == pytest.approx(1.35, abs=0.06)
    tone = judged(ensemble(sine(0.9), LONG))
    assert np.mean(tone.line_factor) == pytest.approx(0.677, abs=0.05)
    assert np.all(tone.line_share > 0.8)


def test_sampling_loss():
    """3.4 % at 12.7 samples per peak and 15 % at 6.3, k = 3.6; never more than everything."""
    assert sampling_loss(np.array([12.7, 6.3, 0.5]), 3.6) == pytest.approx([0.0367, 0.149, 1.0], abs=1e-3)


@pytest.mark.parametrize("k", [3.0, 3.6, 5.0])
def test_tone_factor_from_noise_to_pure_tone(k):
    """1 without a tone, 1 / Gamma(1 + k/2) for nothing but a tone, falling in between."""
    factor = tone_damage_factor(np.linspace(0, 1, 30), k)
    assert factor[0] == pytest.approx(1.0)
    assert factor[-1] == pytest.approx(1 / gamma(1 + k / 2), rel=5e-3)
    assert np.all(np.diff(factor) <= 1e-12)


def test_codes_and_rider_are_what_they_say():
    """The verdict is an index into the list of names, which the results store."""
    found = judged(stationary(np.random.default_rng(9), SHORT))
    assert VERDICTS[0] == "not_assessed"
    assert found.verdict.dtype == np.int8
    assert replace(found, verdict=np.array([1], dtype=np.int8)).verdict[0] == VERDICTS.index("valid")


def test_a_record_in_which_nothing_moves():
    """A constant record is not assessed, without a warning."""
    history = ModalHistory("event", np.array([1, 2]), np.full((2, SHORT), 7.0), 1 / RATE, 0.0)
    spectra = segment_spectra(history, 4.0, 80.0)
    modal_stress = np.ones((1, 2))
    nothing = np.array([np.nan])
    found = judge(
        modal_stress,
        point_moments(modal_stress, moment_matrices(spectra)),
        trust_matrices(history, spectra),
        slope=K,
        dirlik_ratio=nothing,
        tb_ratio=nothing,
        kurtosis=nothing,
        top_cycle_share=nothing,
        samples_per_peak=nothing,
        top_mode_hz=36.0,
    )
    assert verdicts(found) == ["not_assessed"]
    assert reason(found, 0).startswith("Nothing to compare")
