"""The records and moments of the recount against those of scipy."""

import numpy as np
import pytest
from scipy.signal import resample, welch

from fatigue.verify.recount.anew.record import SpectrumRules, finer, welch_moments


@pytest.mark.parametrize("samples", [64, 65])
@pytest.mark.parametrize("factor", [2, 4])
def test_finer_records_pass_through_the_samples(samples, factor):
    """The periodic interpolation is that of scipy; the mirrored one is even about both ends."""
    q = np.random.default_rng(3).standard_normal((2, samples))
    np.testing.assert_allclose(finer(q, factor, recurs=True), resample(q, samples * factor, axis=1), atol=1e-12)
    single = finer(q, factor, recurs=False)
    assert single.shape == (2, (samples - 1) * factor + 1)
    np.testing.assert_allclose(single[:, ::factor], q, atol=1e-12)
    mirrored = finer(q[:, ::-1], factor, recurs=False)
    np.testing.assert_allclose(single, mirrored[:, ::-1], atol=1e-12)


@pytest.mark.parametrize("segment", [100, 101])
def test_moments_are_those_of_welch(segment):
    """Density of scipy.signal.welch, integrated by the trapezoid rule."""
    stress = np.random.default_rng(5).standard_normal(1000) + 40.0
    f, density = welch(stress, fs=50.0, window="hann", nperseg=segment, noverlap=segment // 2, detrend="constant")
    used = f <= 20.0 + 1e-9
    expected = [np.trapezoid(f[used] ** p * density[used], f[used]) for p in (0, 1, 2, 4)]
    found, _ = welch_moments(stress, 0.02, SpectrumRules(segment / 50, 20.0))
    np.testing.assert_allclose(found, expected, rtol=1e-12)


def test_a_record_below_one_segment_has_no_moments():
    """Neither a short record nor a segment of fewer than four samples gives a spectrum."""
    assert welch_moments(np.arange(10.0), 0.1, SpectrumRules(1.1, 5.0)) is None
    assert welch_moments(np.arange(10.0), 0.5, SpectrumRules(1.0, 1.0)) is None
