"""The chirp transform against the sum written out, also where phases turn many millions of times."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.life.records.chirp import fourier_sum


def written_out(lines, first, apart, samples):
    """The sum line by line."""
    n = np.arange(samples)
    return sum(line * np.exp(2j * np.pi * k * (first + apart * n)) for k, line in enumerate(lines))


@settings(deadline=None, max_examples=60)
@given(
    lines=st.integers(1, 40),
    samples=st.integers(1, 60),
    first=st.floats(-2.0, 2.0),
    apart=st.floats(-1.0, 1.0),
    seed=st.integers(0, 99),
)
def test_it_is_the_sum(lines, samples, first, apart, seed):
    """Any number of lines and of places, of any distance."""
    rng = np.random.default_rng(seed)
    given_lines = rng.normal(size=lines) + 1j * rng.normal(size=lines)
    expected = written_out(given_lines, first, apart, samples)
    np.testing.assert_allclose(fourier_sum(given_lines, first, apart, samples), expected, atol=1e-11 * lines)


def test_phases_keep_their_digits():
    """One line at the end of 200 000 has turned 3e9 times half-way: its phase is exact in whole numbers."""
    p, q = 7, 400_009  # the distance p / q is no binary fraction, but its turns are whole numbers over q
    lines = np.zeros(200_000, dtype=np.complex128)
    lines[-1] = 1.0
    found = fourier_sum(lines, 0.0, p / q, 30_000)
    turns = (199_999 * p * np.arange(30_000)) % q / q
    assert np.abs(found - np.exp(2j * np.pi * turns)).max() < 3e-9  # p / q itself is rounded to 1e-16 relative


@pytest.mark.parametrize("samples", [1, 2, 3, 4, 5])
def test_one_line_is_a_constant(samples):
    """The mean alone."""
    np.testing.assert_allclose(fourier_sum(np.array([2.5 + 0j]), 0.3, 0.1, samples), 2.5)
