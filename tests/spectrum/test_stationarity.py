"""Variance over time: the scatter expected by chance, the modulation index, damage period by period."""

from functools import partial

import numpy as np
import pytest
from scipy.stats import chi2

from fatigue.life.counting.rainflow import rainflow
from fatigue.life.records.history import ModalHistory
from fatigue.spectrum.methods import dirlik_damage_rate
from fatigue.spectrum.moments import moment_matrices, point_moments, segment_spectra
from fatigue.spectrum.pairs import pair_forms
from fatigue.spectrum.stationarity import (
    MOST_PERIODS,
    _chi_square_over_freedom,
    damage_rate_by_period,
    modulation_factor,
    moments_and_variances,
    moments_by_period,
    period_matrices,
    stationarity,
)
from fatigue.spectrum.taper import hann
from tests.naive_spectrum import modal_spectrum, narrow_spectrum, straight_law, two_band_spectrum
from tests.synthetic_records import RATE, gaussian, speed_steps, stationary

STEP = 1 / RATE


def prepared(records, segment_s=4.0, upper_hz=80.0):
    """Take each record for a mode of its own: history, spectra, period matrices."""
    q = np.atleast_2d(records)
    history = ModalHistory("event", np.arange(len(q)) + 1, q, STEP, 0.0)
    spectra = segment_spectra(history, segment_s, upper_hz)
    return history, spectra, period_matrices(history, spectra, moments_and_variances(spectra)[1])


def ensemble(spectrum, records, samples, seed):
    """Draw independent records."""
    rng = np.random.default_rng(seed)
    return np.stack([gaussian(rng, spectrum, samples) for _ in range(records)])


def test_expected_scatter_is_the_sum_over_lags():
    """A few principal spectra reproduce the sum of squared autocovariances of each point, lag by lag, to 4 %."""
    rng = np.random.default_rng(0)
    q = rng.normal(size=(4, 4)) @ ensemble(modal_spectrum(), 4, 29 * 512, 1)
    history, _, periods = prepared(q)
    modal_stress = rng.normal(size=(20, 4))

    long = segment_spectra(history, 8.0, 80.0)
    length = round(4.0 * RATE)
    weight = hann(length) ** 2 / np.sum(hann(length) ** 2)
    window = hann(2 * length)
    for of_point, found in zip(modal_stress, stationarity(modal_stress, periods).expected_cov, strict=True):
        density = np.mean(
            [np.sum((of_point @ parts).reshape(-1, 2) ** 2, axis=1) for parts in long.transforms()], axis=0
        )
        variance = 0.0
        for lag in range(0, int(0.4 * len(window)), 2):
            if lag >= length:
                break
            seen = np.sum(window[: len(window) - lag] * window[lag:]) / np.sum(window**2)
            r = np.sum(density * np.cos(2 * np.pi * long.frequency * lag * STEP) * long.weight) / seen
            overlap = np.sum(weight[: length - lag] * weight[lag:])
            variance += 2 * 2 * (1 if lag == 0 else 2) * overlap * r**2
        mean = np.sum(density * long.weight)
        by_lags = np.sqrt(variance / (1 + periods.period_s / history.duration)) / mean
        assert 0.96 * by_lags < found < 1.001 * by_lags  # what is left out is only ever missing


@pytest.mark.parametrize(
    ("spectrum", "bandwidth_hz"), [(narrow_spectrum, 4.0), (two_band_spectrum, 2.26), (modal_spectrum, 2.36)]
)
def test_statistical_bandwidth(spectrum, bandwidth_hz):
    """B_s = m0^2 / integral of G^2 of the spectrum, as far as segments resolve it, in the mean of many records."""
    _, _, periods = prepared(ensemble(spectrum(), 20, 205 * 512, 2))
    found = stationarity(np.eye(20), periods).bandwidth_hz
    assert np.median(found) == pytest.approx(bandwidth_hz, rel=0.12)


@pytest.mark.parametrize("spectrum", [narrow_spectrum, two_band_spectrum, modal_spectrum])
@pytest.mark.parametrize("seconds", [29, 60])
def test_gaussian_records_stay_inside_the_bounds(spectrum, seconds):
    """Modulation index of stationary Gaussian records: 1 in the mean square, and inside its bounds 9 times in 10."""
    _, _, periods = prepared(ensemble(spectrum(), 30, seconds * 512, 3))
    found = stationarity(np.eye(30), periods)
    assert np.sqrt(np.mean(found.modulation_index**2)) == pytest.approx(1.0, abs=0.1)
    inside = (found.lower < found.modulation_index) & (found.modulation_index < found.upper)
    assert np.mean(inside) >= 0.9


@pytest.mark.parametrize(("modes", "samples"), [(2, 29 * 512), (3, 300 * 512)])
def test_moments_and_variances_are_those_of_the_segments(modes, samples):
    """One pass over the segments gives the moments of all of them, and the variance of each whole period."""
    _, spectra, _ = prepared(ensemble(modal_spectrum(), modes, samples, 10))
    moments, variances = moments_and_variances(spectra)
    np.testing.assert_allclose(moments.matrix, moment_matrices(spectra).matrix, rtol=1e-12)
    assert moments.segments == len(spectra.starts)
    of_periods = [m.matrix[0] for m in moments_by_period(spectra, (0,))]
    np.testing.assert_allclose(variances, of_periods, rtol=1e-12)


def test_many_modes_or_few_make_the_same_scatter():
    """More pairs of modes than bins, or fewer: the same scatter at a point that sees the same modes."""
    q = ensemble(modal_spectrum(), 3, 29 * 512, 11)
    modal_stress = np.random.default_rng(12).normal(size=(10, 3))
    few = stationarity(modal_stress, prepared(q)[2])
    still = np.zeros((50, q.shape[1]))
    many = stationarity(np.hstack([modal_stress, np.ones((10, 50))]), prepared(np.vstack([q, still]))[2])
    np.testing.assert_allclose(many.expected_cov, few.expected_cov, rtol=1e-5)


def test_modulation_shows():
    """Amplitude steps of 0.5 to 1.5 are seen at once and their factor on the damage is that of the steps."""
    _, _, periods = prepared(speed_steps(np.random.default_rng(4), 205 * 512))
    found = stationarity(np.ones((1, 1)), periods)
    assert found.modulation_index[0] > 2 * found.upper[0]
    steps = np.array([0.5, 1.0, 1.5, 0.75])
    expected = np.mean(steps**3.6) / np.mean(steps**2) ** 1.8
    assert modulation_factor(found, 3.6)[0] == pytest.approx(expected, rel=0.08)


def test_dirlik_by_period_follows_the_modulation():
    """Where one spectrum for all misses a quarter of the damage, the sum over periods comes close to rainflow."""
    law, modal_stress = straight_law(3.6), np.ones((1, 1))
    at_once, by_period = [], []
    for seed in range(4):
        record = speed_steps(np.random.default_rng(seed), 205 * 512)
        history, spectra, _ = prepared(record)
        cycles = rainflow(record, "repeat")
        counted = np.sum(cycles.count * cycles.range**3.6) / history.duration
        at_once.append(dirlik_damage_rate(point_moments(modal_stress, moment_matrices(spectra)), law)[0] / counted)
        by_period.append(
            damage_rate_by_period(modal_stress, spectra, partial(dirlik_damage_rate, law=law))[0] / counted
        )
    assert np.mean(at_once) == pytest.approx(0.79, abs=0.06)
    assert np.mean(by_period) == pytest.approx(1.1, abs=0.06)  # Dirlik is 7 % high here, short periods scatter


def test_units_and_factors_do_not_matter():
    """Scaled modal coordinates, scaled modal_stress: the same numbers; they are ratios."""
    q = ensemble(modal_spectrum(), 3, 29 * 512, 6)
    modal_stress = np.random.default_rng(7).normal(size=(10, 3))
    plain = stationarity(modal_stress, prepared(q)[2])
    scale = np.array([1e-9, 1.0, 1e6])
    scaled = stationarity(1e3 * modal_stress / scale, prepared(q * scale[:, None])[2])
    for name in ("modulation_index", "bandwidth_hz", "expected_cov"):
        np.testing.assert_allclose(getattr(scaled, name), getattr(plain, name), rtol=1e-3)


def test_a_long_record_is_cut_into_few_periods():
    """Segments are pooled so that there are at most `MOST_PERIODS`, and the variance in the mean stays that of all."""
    _, spectra, periods = prepared(ensemble(modal_spectrum(), 2, 300 * 512, 8))
    assert len(spectra.starts) == 149
    assert periods.periods == 29 <= MOST_PERIODS
    assert periods.segments == 5
    assert periods.period_s == pytest.approx(4.0 * 0.514 + 4 * 2.0, rel=0.1)
    variance = pair_forms(np.eye(2), periods.forms)[:29]
    np.testing.assert_allclose(variance.mean(axis=0), 1.0, rtol=0.1)


def test_a_short_record_has_no_periods():
    """Fewer than eight segments say nothing about scatter."""
    assert prepared(np.random.default_rng(0).normal(size=17 * 512))[2] is None
    assert prepared(np.random.default_rng(0).normal(size=18 * 512))[2] is not None


def test_modes_and_points_that_do_not_move():
    """A mode that is never excited costs nothing; a point without stress has no numbers."""
    moving = stationary(np.random.default_rng(9), 29 * 512)
    _, _, periods = prepared(np.stack([moving, np.zeros_like(moving)]))
    found = stationarity(np.array([[1.0, 0.0], [1.0, 5.0], [0.0, 0.0], [0.0, 1.0]]), periods)
    assert found.modulation_index[0] == pytest.approx(found.modulation_index[1], rel=1e-6)
    assert np.all(np.isnan(found.modulation_index[2:]))


def test_chi_square_quantiles():
    """The closed form of Wilson and Hilferty is good to a few per cent where it is used."""
    freedom = np.array([7.0, 12.0, 31.0])
    for normal, probability in ((2.326, 0.99), (-2.576, 0.005)):
        exact = chi2.ppf(probability, freedom) / freedom
        np.testing.assert_allclose(_chi_square_over_freedom(normal, freedom), exact, rtol=0.07)


@pytest.mark.parametrize("exponent", [10, 60, 300])
def test_stresses_whose_squares_single_precision_cannot_hold(exponent):
    """A stress of any size is judged alike: a damaged value of 1e30 breaks nothing."""
    periods = prepared(ensemble(modal_spectrum(), 2, 29 * 512, 6))[2]
    modal_stress = np.random.default_rng(7).normal(size=(5, 2))
    usual, huge = (stationarity(modal_stress * factor, periods) for factor in (1.0, 2.0**exponent))
    assert np.isfinite(usual.modulation_index).all()
    assert usual.modulation_index.tolist() == huge.modulation_index.tolist()


@pytest.mark.parametrize("cancels", [1e2, 1e5, 1e8, 1e12])
def test_points_whose_modes_cancel(cancels):
    """What two opposite modes leave of a large common motion is judged as if it came alone, as far as it is known."""
    common, *own = ensemble(modal_spectrum(), 3, 29 * 512, 11)
    opposite = prepared(np.stack([cancels * common + own[0], cancels * common + own[1]]))[2]
    found = stationarity(np.array([[1.0, -1.0]]), opposite)
    expected = stationarity(np.ones((1, 1)), prepared((own[0] - own[1])[None])[2])
    assert (found.relative_variance >= 0.0).all()
    if cancels <= 1e5:  # variances are 1e10 times what is left of them: six of their digits
        np.testing.assert_allclose(found.relative_variance, expected.relative_variance, rtol=1e-4)
