"""A record goes on beyond its ends as it did before them, and never grows there."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatigue.vibration.continuation import LARGEST, LEARNT_FROM, ORDER, burg, continued
from tests.vibration.oscillator import band_limited_noise


def test_a_record_stays_as_it_is_between_its_continuations():
    """Nothing of the record itself is tapered; the continuation ends near zero."""
    x = np.random.default_rng(1).standard_normal((3, 1000))
    found = continued(x)
    assert np.array_equal(found.x[:, found.kept], x)
    assert found.x.shape == (3, 1000 + 2 * 50)
    assert np.abs(found.x[:, [0, -1]]).max() < 0.01


@pytest.mark.parametrize("hz", [1.3, 9.2, 31.0])
def test_a_sine_goes_on_as_a_sine(hz):
    """The samples next to either end are those of the sine, to the taper."""
    t = 0.01 * np.arange(-60, 1560)
    x = np.sin(2.0 * np.pi * hz * t + 0.4)
    found = continued(x[60:-60])
    ahead = found.kept.start
    taper = 0.5 + 0.5 * np.cos(np.pi * np.arange(1, ahead + 1) / (ahead + 1))
    assert found.x[found.kept.stop :][:20] == pytest.approx(x[-60:-40] * taper[:20], abs=2e-3)
    assert found.x[: found.kept.start][::-1][:20] == pytest.approx(x[40:60][::-1] * taper[:20], abs=2e-3)


def test_rows_do_not_know_each_other():
    """Records continued together are those continued alone; one of zeros stays zero."""
    x = np.stack([band_limited_noise(700, 0.01, 20.0), np.zeros(700), np.sin(np.arange(700))])
    together = continued(x).x
    for row, alone in zip(together, x, strict=True):
        assert row == pytest.approx(continued(alone).x, abs=1e-12)
    assert not together[1].any()


@given(st.integers(0, 10_000), st.integers(64, 2000), st.sampled_from(["noise", "walk", "burst", "step"]))
def test_a_continuation_never_grows(seed, samples, kind):
    """Whatever the record: no continuation exceeds twice the largest value next to its end."""
    x = np.random.default_rng(seed).standard_normal(samples)
    if kind == "walk":
        x = x.cumsum()
    if kind == "burst":
        x *= np.exp(np.linspace(-8.0, 8.0, samples))
    if kind == "step":
        x = np.sign(x).cumsum()
    found = continued(x)
    assert np.isfinite(found.x).all()
    assert np.abs(found.x[found.kept.stop :]).max() <= LARGEST * np.abs(x[-LEARNT_FROM:]).max() + 1e-12


def test_coefficients_of_a_known_process():
    """x[n] = 1.5 x[n-1] - 0.8 x[n-2] + noise: the first two coefficients are found, the others are about zero."""
    rng = np.random.default_rng(3)
    x = np.zeros(20_000)
    for n, e in enumerate(rng.standard_normal(len(x))):
        x[n] = 1.5 * x[n - 1] - 0.8 * x[n - 2] + e if n > 1 else e
    a = burg(x[None], ORDER)[0]
    assert a[:2] == pytest.approx([-1.5, 0.8], abs=0.02)
    assert np.abs(a[2:]).max() < 0.03
