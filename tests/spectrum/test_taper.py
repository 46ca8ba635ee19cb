"""The Hann window on samples and on their transform."""

import numpy as np
import pytest
from scipy.signal.windows import hann as scipy_hann

from fatigue.spectrum.taper import hann, tapered


@pytest.mark.parametrize("samples", [4, 5, 64, 65])
def test_window_on_the_transform_is_the_window_on_the_samples(samples):
    """Every bin, the first and the last included, and any run of them; even and odd lengths."""
    np.testing.assert_allclose(hann(samples), scipy_hann(samples, sym=False), atol=1e-15)
    x = np.random.default_rng(samples).normal(size=(3, samples)) + 2.0
    expected = np.fft.rfft(x * hann(samples))
    bins = expected.shape[1]
    for begin in range(min(bins, 3)):
        for end in range(begin, bins + 1):
            found = tapered(np.fft.rfft(x), samples, slice(begin, end))
            np.testing.assert_allclose(found, expected[:, begin:end], atol=1e-13)
