"""The scatter of a variance by chance, against the sum over all lags that it stands for."""

import numpy as np
import pytest

from fatigue.life.records.history import ModalHistory
from fatigue.spectrum import scatter
from fatigue.spectrum.moments import pair_densities, segment_spectra
from fatigue.spectrum.pairs import pairs, weights_of_pairs
from fatigue.spectrum.scatter import LONGEST_LAG, NEGLIGIBLE, period_taper, principal_scatter
from fatigue.spectrum.taper import hann

RATE = 64.0


def prepared(modes, upper_hz=20.0, segment_s=4.0, samples=2000):
    """Spectra of correlated noise, its pair densities, a scale for each mode and the taper of three segments."""
    rng = np.random.default_rng(modes)
    q = rng.normal(size=(modes, modes)) @ np.cumsum(rng.normal(size=(modes, samples)), axis=1)
    spectra = segment_spectra(ModalHistory("e", np.arange(modes) + 1, q, 1 / RATE, 0.0), segment_s, upper_hz)
    return spectra, pair_densities(spectra), q.std(axis=1), period_taper(len(spectra.window) // 2, 3)


def by_lags(spectra, density, taper, s):
    """``2 sum over lags of overlap(lag) R(lag)^2`` of one point, lag by lag, both signs of the lag written out."""
    first, second = pairs(len(s))
    of_stress = density @ (weights_of_pairs(len(s)) * s[first] * s[second])
    window, step = spectra.window, spectra.history.step
    stride = max(1, int(1 / (2.5 * spectra.upper_hz * step)))
    longest = min(int(LONGEST_LAG * len(window)), len(taper))
    total = 0.0
    for lag in range(-stride * ((longest - 1) // stride), longest, stride):
        n = abs(lag)
        seen = np.sum(window[n:] * window[: len(window) - n]) / np.sum(window**2)
        R = np.sum(of_stress * np.cos(2 * np.pi * n * step * spectra.frequency) * spectra.weight) / seen
        total += 2 * stride * np.sum(taper[n:] * taper[: len(taper) - n]) * R**2
    return total


def found_at(forms, scale, s):
    """Sum of the squared forms at one point."""
    first, second = pairs(len(s))
    return np.sum((forms @ ((s * scale)[first] * (s * scale)[second])) ** 2)


@pytest.mark.parametrize("modes", [1, 3, 12, 20], ids=lambda m: f"{m} modes")
@pytest.mark.parametrize(("upper_hz", "segment_s"), [(20.0, 4.0), (4.0, 8.0), (30.0, 2.0)])
def test_all_forms_together_are_the_sum_over_lags(monkeypatch, modes, upper_hz, segment_s):
    """With nothing left out: fewer pairs than bins or more, fewer lags than bins or more, every lag or each third."""
    monkeypatch.setattr(scatter, "NEGLIGIBLE", 1e-13)
    spectra, density, scale, taper = prepared(modes, upper_hz, segment_s)
    kept = density.copy()
    forms = principal_scatter(spectra, density, scale, taper)
    for s in np.random.default_rng(0).normal(size=(5, modes)):
        assert found_at(forms, scale, s) == pytest.approx(by_lags(spectra, kept, taper, s), rel=1e-6)


@pytest.mark.parametrize("negligible", [NEGLIGIBLE, 0.05, 0.2])
def test_no_more_is_left_out_than_is_negligible(monkeypatch, negligible):
    """Of six coordinates of white noise, whose forms are many: the weakest go while they hold that share of all."""
    q = np.random.default_rng(6).normal(size=(6, 2000))
    spectra = segment_spectra(ModalHistory("e", np.arange(6) + 1, q, 1 / RATE, 0.0), 4.0, 20.0)
    density, scale, taper = pair_densities(spectra), q.std(axis=1), period_taper(len(spectra.window) // 2, 3)
    monkeypatch.setattr(scatter, "NEGLIGIBLE", 1e-13)
    whole = principal_scatter(spectra, density.copy(), scale, taper)
    monkeypatch.setattr(scatter, "NEGLIGIBLE", negligible)
    some = principal_scatter(spectra, density.copy(), scale, taper)
    energy = np.sum(whole**2 / weights_of_pairs(6), axis=1)  # every number beside the diagonal stands there twice
    left_out = np.cumsum(energy) < negligible * energy.sum()
    assert len(some) == len(whole) - np.count_nonzero(left_out) < len(whole)
    np.testing.assert_allclose(np.abs(some), np.abs(whole[~left_out]), rtol=1e-6, atol=1e-9 * np.abs(whole).max())


def test_units_of_the_coordinates_do_not_matter():
    """A coordinate in other units, its scale in the same: the same forms up to their signs."""
    spectra, density, scale, taper = prepared(3)
    first, second = pairs(3)
    unit = np.array([1e-3, 1.0, 1e4])
    one = principal_scatter(spectra, density.copy(), scale, taper)
    other = principal_scatter(spectra, density * unit[first] * unit[second], scale * unit, taper)
    s = np.random.default_rng(1).normal(size=3)
    assert found_at(other, scale * unit, s / unit) == pytest.approx(found_at(one, scale, s), rel=1e-9)
    np.testing.assert_allclose(np.abs(other), np.abs(one), rtol=1e-6, atol=1e-9 * np.abs(one).max())


@pytest.mark.parametrize("length", [8, 9])
@pytest.mark.parametrize("segments", [1, 2, 4])
def test_taper_of_a_period(length, segments):
    """Squared Hann windows, each half a segment later, all together 1."""
    hop = length - length // 2
    expected = np.zeros(length + (segments - 1) * hop)
    for k in range(segments):
        expected[k * hop : k * hop + length] += hann(length) ** 2
    np.testing.assert_allclose(period_taper(length, segments), expected / expected.sum(), rtol=1e-15)
