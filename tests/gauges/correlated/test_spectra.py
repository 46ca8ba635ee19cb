"""Density and coherence: those of scipy on whole records, and blind to what is cut out."""

import numpy as np
import pytest
from scipy.signal import coherence, welch

from fatigue.gauges.correlated.sides import Strain
from fatigue.gauges.correlated.spectra import coherence_band, density, frequencies, segment_samples
from fatigue.gauges.measured.alignment import Alignment

RATE = 100.0
AT_ONCE = Alignment(0.0, 0, 1.0, 0.0, at_end=False)


def whole(x):
    """A record that nothing is cut out of."""
    return Strain(x, ((0, len(x) - 1),))


@pytest.fixture(scope="module")
def noise():
    """Two signals of 40 s, the second half the first and half its own."""
    x = np.random.default_rng(1).standard_normal((2, 4000))
    return x[0], 0.7 * x[0] + 0.7 * x[1]


@pytest.mark.parametrize("length", [400, 401])
def test_density_is_that_of_welch(noise, length):
    """Periodic Hann, half overlap, mean removed, one-sided."""
    f, expected = welch(noise[0], RATE, nperseg=length, noverlap=length - length // 2)
    np.testing.assert_allclose(frequencies(RATE, length), f)
    np.testing.assert_allclose(density([whole(noise[0])], RATE, length), expected, rtol=1e-9)


def test_density_is_the_variance(noise):
    """Integrated over frequency."""
    total = density([whole(noise[0])], RATE, 400).sum() * RATE / 400
    assert total == pytest.approx(noise[0].var(), rel=0.05)


def test_what_is_cut_out_is_in_no_segment(noise):
    """Whatever stands there; where no segment is whole, all are taken."""
    x = noise[0].copy()
    x[1000:1300] = 1e6
    cut = Strain(x, ((0, 999), (1300, 3999)))
    clean = density([whole(noise[0])], RATE, 400)
    assert density([cut], RATE, 400).sum() == pytest.approx(clean.sum(), rel=0.1)
    assert density([Strain(noise[0], ((0, 99),))], RATE, 400) == pytest.approx(clean)


def test_coherence_is_that_of_scipy_weighted_with_the_measured_density(noise):
    """Of a signal with itself it is 1, of half own content about a half."""
    measured, simulated = whole(noise[1]), whole(noise[0])
    f, gamma2 = coherence(noise[1], noise[0], RATE, nperseg=400)
    power = density([measured], RATE, 400)
    inside = (f >= 1.0) & (f < 40.0)
    expected = gamma2[inside] @ power[inside] / power[inside].sum()
    assert coherence_band(measured, simulated, AT_ONCE, RATE, 400, (1.0, 40.0)) == pytest.approx(expected, rel=1e-9)
    assert 0.4 < expected < 0.65
    assert coherence_band(simulated, simulated, AT_ONCE, RATE, 400, (0.0, 50.0)) == pytest.approx(1.0)


@pytest.mark.parametrize("shift", [-7, 7])
def test_coherence_moves_the_late_record_back(noise, shift):
    """A signal and the same one later are coherent."""
    late = np.roll(noise[0], shift)
    at = Alignment(shift / RATE, shift, 1.0, 0.0, at_end=False)
    assert coherence_band(whole(late), whole(noise[0]), at, RATE, 400, (0.0, 50.0)) == pytest.approx(1.0, abs=1e-9)


def test_few_segments_say_nothing(noise):
    """Of one segment every coherence is 1."""
    few = Strain(noise[0], ((0, 700),))
    assert np.isnan(coherence_band(few, whole(noise[0]), AT_ONCE, RATE, 400, (0.0, 50.0)))
    assert np.isnan(coherence_band(whole(noise[0]), whole(np.zeros(4000)), AT_ONCE, RATE, 400, (0.0, 50.0)))


def test_a_segment_is_no_longer_than_the_shortest_record(noise):
    """As long as asked, else all of it."""
    assert segment_samples([whole(noise[0])], RATE, 4.0) == 400
    assert segment_samples([whole(noise[0]), whole(noise[0][:300])], RATE, 4.0) == 300
