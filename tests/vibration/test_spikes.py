"""Spikes are single samples that no vibration makes; what vibrates has none."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatigue.vibration.spikes import spikes


def noise(seed: int, samples: int = 4000) -> np.ndarray:
    """White noise of rms 1."""
    return np.random.default_rng(seed).standard_normal(samples)


@given(seed=st.integers(0, 999), at=st.integers(2, 3997), sign=st.sampled_from((-1.0, 1.0)), lift=st.floats(-1e3, 1e3))
def test_a_spike_is_found_wherever_it_is(seed, at, sign, lift):
    """On noise, on a constant, upwards and downwards, whatever the unit."""
    record = noise(seed)
    assert spikes(record).size == 0
    record[at] += 200.0 * sign
    assert spikes(lift + 1e-3 * record).tolist() == [at]


def test_several_spikes_on_a_drift():
    """In their order."""
    record = noise(1) + 0.01 * np.arange(4000.0)
    record[[70, 2000, 3500]] += [150.0, -90.0, 400.0]
    assert spikes(record).tolist() == [70, 2000, 3500]


@pytest.mark.parametrize(
    "record",
    [
        np.zeros(2000),
        np.sin(0.05 * np.arange(2000.0)),
        np.sin(3.0 * np.arange(2000.0)),
        np.repeat([0.0, 100.0], 1000),
        noise(2, 999) ** 9,
        np.cumsum(noise(3)),
    ],
    ids=["zeros", "slow sine", "fast sine", "step", "short", "drift"],
)
def test_what_is_no_spike(record):
    """Silence, tones close to half the sampling rate, a step, a short record, a random walk."""
    assert spikes(record).size == 0


def test_an_impact_that_rings_is_none():
    """Its neighbours move as well."""
    t = np.arange(4000.0)
    ringing = np.where(t >= 2000.0, 300.0 * np.exp(-0.05 * (t - 2000.0)) * np.cos(2.0 * (t - 2000.0)), 0.0)
    assert spikes(noise(4) + ringing).size == 0
