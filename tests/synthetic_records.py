"""Stress records whose nature is known, to try the judgement on: one defect each."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from tests.naive_spectrum import Spectrum, modal_spectrum, two_band_spectrum

RATE = 512.0  # [Hz]
Record = NDArray[np.float64]
Generator = np.random.Generator


def gaussian(rng: Generator, spectrum: Spectrum, samples: int) -> Record:
    """Cut a stationary Gaussian record out of a periodic one twice as long."""
    n = 2 * samples
    f = np.fft.rfftfreq(n, 1 / RATE)
    density = np.interp(f, *spectrum, left=0, right=0)
    lines = np.sqrt(density * RATE * n) / 2 * (rng.normal(size=f.size) + 1j * rng.normal(size=f.size))
    return np.fft.irfft(lines, n)[:samples]


def seconds(samples: int) -> Record:
    """Instants of the samples."""
    return np.arange(samples) / RATE


def stationary(rng: Generator, samples: int) -> Record:
    """Three modes, Gaussian."""
    return gaussian(rng, modal_spectrum(), samples)


def bimodal(rng: Generator, samples: int) -> Record:
    """Two bands, Gaussian: Dirlik is 11 % low at k = 3.6 and 21 % at k = 5."""
    return gaussian(rng, two_band_spectrum(), samples)


def speed_steps(rng: Generator, samples: int) -> Record:
    """Four speeds: amplitude x 0.5, 1, 1.5, 0.75."""
    return stationary(rng, samples) * np.repeat([0.5, 1.0, 1.5, 0.75], -(-samples // 4))[:samples]


def slow_modulation(rng: Generator, samples: int) -> Record:
    """Log-normal amplitude that wanders below 0.1 Hz."""
    wander = gaussian(rng, (np.array([0.005, 0.1]), np.array([1.0, 1.0])), samples)
    return stationary(rng, samples) * np.exp(0.5 * wander / wander.std())


def hermite(rng: Generator, samples: int) -> Record:
    """Stationary with high peaks: cubic transformation to kurtosis 5 (Winterstein, 1988)."""
    h = (np.sqrt(1 + 1.5 * (5 - 3)) - 1) / 18
    x = stationary(rng, samples)
    u = x / x.std()
    return x.std() * (u + h * (u**3 - 3 * u)) / np.sqrt(1 + 6 * h**2)


def saturation(rng: Generator, samples: int) -> Record:
    """Bump stop: peaks clipped softly at one standard deviation."""
    x = stationary(rng, samples)
    return x.std() * np.tanh(x / x.std() * 1.5)


def sine(share: float) -> Callable[[Generator, int], Record]:
    """Hunting limit cycle: a 9.3 Hz tone that holds ``share`` of the variance."""

    def record(rng: Generator, samples: int) -> Record:
        noise = stationary(rng, samples)
        amplitude = np.sqrt(2 * share / (1 - share)) * noise.std()
        return noise + amplitude * np.sin(2 * np.pi * 9.3 * seconds(samples) + rng.uniform(0, 2 * np.pi))

    return record


def hunting_bursts(rng: Generator, samples: int) -> Record:
    """Hunting that comes and goes, a fifth of the time, up to three times the noise."""
    t = seconds(samples)
    noise = stationary(rng, samples)
    period = t[-1] / 4
    burst = np.clip(1 - np.abs((t % period) / period - 0.5) / 0.1, 0, 1) ** 0.5
    return noise + 3 * np.sqrt(2) * noise.std() * burst * np.sin(2 * np.pi * 9.3 * t)


def curves(rng: Generator, samples: int) -> Record:
    """Four curves of 8 s, 120 MPa of quasi-static stress each."""
    t = seconds(samples)
    record = stationary(rng, samples)
    for start in (0.1, 0.35, 0.6, 0.85):
        record += 120 * np.clip(4 * (1 - np.abs(t - start * t[-1] - 4) / 4), 0, 1)
    return record


def impacts(rng: Generator, samples: int) -> Record:
    """A dozen impacts that ring at 36 Hz."""
    t = seconds(samples)
    record = stationary(rng, samples)
    for start in rng.uniform(0, t[-1], 12):
        since = np.maximum(t - start, 0)
        record += 300 * np.exp(-2 * np.pi * 36 * 0.015 * since) * np.sin(2 * np.pi * 36 * since)
    return record


def spike(rng: Generator, samples: int) -> Record:
    """One peak of 350 MPa, 0.1 s long."""
    record = stationary(rng, samples)
    length = int(0.1 * RATE)
    middle = samples // 3
    record[middle : middle + length] += 350 * np.hanning(length)
    return record
