"""Irregularities: their spectra, one realisation of them, and what axles meet."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.errors import CaseError
from fatigue.vehicle.definition import Track
from fatigue.vehicle.track import (
    BEFORE_M,
    GRID_M,
    LATERAL,
    LEVELS,
    ROLL,
    SIGNALS,
    VERTICAL,
    realised,
    spectra,
    spectra_per_hz,
    under_axles,
)

STANDARD_DEVIATION = [1.695e-3, 2.339e-3, 1.192e-3]  # m, m, rad: of the definition of the reference vehicle
WHOLE = Track(longest_m=1e9, weakened_below_m=0.0)  # the spectra as they are printed


@pytest.mark.parametrize(
    ("quality", "lateral", "vertical"), [("low", 1.440846e-7, 2.741619e-7), ("high", 4.164787e-7, 7.343623e-7)]
)
def test_the_spectra_are_those_of_an_open_simulator(quality, lateral, vertical):
    """It has numerators A W_c^2 and one denominator 0.00028855 + 0.6803895 W^2 + W^4."""
    W = np.geomspace(0.01, 20.0, 200)
    denominator = 0.00028855 + 0.6803895 * W**2 + W**4
    S = spectra(W, replace(WHOLE, quality=quality))
    np.testing.assert_allclose(S[LATERAL], lateral / denominator, rtol=2e-5)
    np.testing.assert_allclose(S[VERTICAL], vertical / denominator, rtol=2e-5)
    np.testing.assert_allclose(S[ROLL], vertical / 0.75**2 * W**2 / (denominator * (W**2 + 0.438**2)), rtol=2e-5)


def test_their_integral_is_the_variance():
    """One-sided: from wavenumber 0 on, no factor of 2 and none of pi."""
    W = np.linspace(2 * np.pi / 100, 200.0, 2_000_001)
    deviation = np.sqrt(np.trapezoid(spectra(W, Track()), W, axis=1))
    np.testing.assert_allclose(deviation, STANDARD_DEVIATION, rtol=5e-4)


def test_long_waves_are_left_out_and_short_ones_weakened():
    """100 m is the longest wave that is there; at 1.5 m a quarter of the spectrum is left, at 3 m all of it."""
    W = 2 * np.pi / np.array([100.1, 99.9, 3.01, 2.99, 1.5])
    share = spectra(W, Track()) / spectra(W, WHOLE)
    np.testing.assert_allclose(share, np.broadcast_to([0.0, 1.0, 1.0, (2.99 / 3) ** 2, 0.25], (3, 5)), rtol=1e-12)
    np.testing.assert_allclose(spectra(W, Track(weakened_below_m=0.0))[:, 1:], spectra(W, WHOLE)[:, 1:])


@given(st.floats(5.0, 200.0))
def test_a_spectrum_over_frequency_holds_the_same_variance_at_any_speed(speed):
    """S_f df = S dW with W = 2 pi f / V."""
    W = np.geomspace(0.05, 50.0, 300)
    per_hz = spectra_per_hz(W * speed / (2 * np.pi), speed, Track())
    np.testing.assert_allclose(per_hz * speed / (2 * np.pi), spectra(W, Track()), rtol=1e-12)


@pytest.mark.parametrize("seed", [1, 2])
def test_a_realisation_has_the_variance_of_its_spectrum(seed):
    """Parseval: the mean square of each signal is the sum of S W_1 over its lines, whatever the phases."""
    track = realised(Track(), seed)
    n = track.value.shape[1]
    assert n * GRID_M == 6553.6
    first = 2 * np.pi / (n * GRID_M)
    W = first * np.arange(1, n // 2)
    S = spectra(W, Track())
    np.testing.assert_allclose((track.value**2).mean(axis=1), S.sum(axis=1) * first, rtol=1e-12)
    np.testing.assert_allclose((track.slope**2).mean(axis=1), (W**2 * S).sum(axis=1) * first, rtol=1e-12)
    np.testing.assert_allclose(track.value.std(axis=1), STANDARD_DEVIATION, rtol=1e-3)
    np.testing.assert_allclose(track.value.mean(axis=1), 0.0, atol=1e-17)


def test_a_realisation_is_that_of_the_recipe():
    """A sum of cosines with the phases drawn one signal after the other, at a few points."""
    short = Track(distance_m=300.0)
    track, n = realised(short, 7), 16_384
    assert track.value.shape == (3, n)
    rng = np.random.default_rng(7)
    first = 2 * np.pi / (n * GRID_M)
    W = first * np.arange(1, n // 2)
    x = GRID_M * np.array([0, 1, 777, 16_000])
    for k, _ in enumerate(SIGNALS):
        phase = 2 * np.pi * rng.random(n // 2 + 1)[1:-1]
        size = np.sqrt(2 * spectra(W, short)[k] * first)
        angle = W[:, None] * x + phase[:, None]
        np.testing.assert_allclose(track.value[k, [0, 1, 777, 16_000]], size @ np.cos(angle), rtol=1e-9)
        np.testing.assert_allclose(track.slope[k, [0, 1, 777, 16_000]], -(W * size) @ np.sin(angle), rtol=1e-9)


def test_signals_and_seeds_are_independent():
    """Correlations of a 6.5 km track are those of chance."""
    signals = np.concatenate([realised(Track(), seed).value for seed in (1, 2)])
    assert np.abs(np.corrcoef(signals) - np.eye(6)).max() < 0.2


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 20), st.floats(0.0, 250.0), st.floats(10.0, 120.0))
def test_an_axle_meets_what_another_met_before_it(seed, at, speed):
    """The rear axle of two, 20 m apart, sees beyond the rise what the front axle saw 20 m earlier."""
    track = realised(Track(distance_m=300.0), seed)
    axles = np.array([10.0, -10.0])
    front = under_axles(track, axles, np.array([50.0 + at]), speed)
    rear = under_axles(track, axles, np.array([70.0 + at]), speed)
    np.testing.assert_allclose(rear.value[:, 1], front.value[:, 0], atol=1e-15)
    np.testing.assert_allclose(rear.rate[:, 1], front.rate[:, 0], atol=1e-12)


def test_irregularities_rise_over_fifty_metres_and_the_rate_is_that_of_travel():
    """Nothing at the begin, half after 25 m, all after 50 m; d/dt of what an axle meets is V du/dx."""
    track, distance, speed = realised(Track(distance_m=300.0), 3), GRID_M * np.arange(6000), 80.0
    met = under_axles(track, np.array([0.0]), distance, speed)
    assert not met.value[..., 0].any()
    assert not met.rate[..., 0].any()
    place = np.arange(track.value.shape[1]) * GRID_M
    half = np.interp(BEFORE_M + 25.0, place, track.value[0])
    assert met.value[0, 0, 500] == pytest.approx(0.5 * half, rel=1e-9)
    value, rate = met.value[:, 0, 1000:], met.rate[:, 0, 1000:]
    between = 0.5 * (rate[:, 1:] + rate[:, :-1])
    error = np.diff(value, axis=1) * speed / GRID_M - between
    assert (error.std(axis=1) < 5e-3 * rate.std(axis=1)).all()


def test_a_ride_beyond_the_end_of_the_track_is_refused():
    """The realisation ends; nothing is made up behind it."""
    with pytest.raises(ValueError, match="longer than the track"):
        under_axles(realised(Track(distance_m=300.0), 1), np.zeros(1), np.array([900.0]), 80.0)


def test_what_is_no_track_is_refused_all_at_once():
    """Each mistake names its key, its value and what to give."""
    with pytest.raises(CaseError) as refused:
        realised(Track(quality="good", longest_m=0.0, weakened_below_m=-1.0, distance_m=float("nan")), 1)
    text = str(refused.value)
    assert "[track] quality: 'good' is no known quality. Choose one of low, high." in text
    assert "[track] longest_m: 0.0 m is no such length" in text
    assert "[track] weakened_below_m: -1.0 m is no wavelength" in text
    assert "[track] distance_m: nan m is no such length. Give a length above 0, 1e+06 m at most." in text
    assert set(LEVELS) == {"low", "high"}
