"""Signals of the ledger, and spectra: the same for all, drawn anew from a seed in every process."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

RATE = 250.0
SEED = 24


@dataclass(frozen=True, slots=True)
class Kind:
    """A kind of signal: what it is, how many of them, of how many samples."""

    what: str
    signals: int
    samples: int
    draw: Callable[[np.random.Generator, int], Floats]


def resonances(frequencies: Floats, rng: np.random.Generator, samples: int) -> Floats:
    """Sum of resonances with 3 % of critical damping under white noise, of standard deviation 30.

    The standard deviation of each falls with the root of its frequency.
    """
    f = np.fft.rfftfreq(samples, 1.0 / RATE)
    response = np.zeros(f.size, np.complex128)
    for f_n in frequencies:
        one = (f < 60.0) / (1.0 - (f / f_n) ** 2 + 0.06j * f / f_n)
        one *= rng.normal(size=f.size) + 1j * rng.normal(size=f.size)
        one *= f_n**-0.5 / np.linalg.norm(one)
        response += one
    x = np.fft.irfft(response, samples)
    return np.asarray(30.0 * (x - x.mean()) / x.std())


def narrow_band(rng: np.random.Generator, samples: int) -> Floats:
    """One resonance at 9 Hz."""
    return resonances(np.array([9.0]), rng, samples)


def broad_band(rng: np.random.Generator, samples: int) -> Floats:
    """Twelve resonances between 1 and 45 Hz."""
    return resonances(np.linspace(1.0, 45.0, 12), rng, samples)


def ties(rng: np.random.Generator, samples: int) -> Floats:
    """Whole numbers between -20 and 20, half of them held: plateaus, and ranges that are equal."""
    x = rng.integers(-20, 21, samples)
    held = np.maximum.accumulate(np.where(rng.random(samples) < 0.5, 0, np.arange(samples)))
    return x[held].astype(np.float64)


KINDS = {
    "narrow band": Kind("one resonance, 9 Hz at 250 Hz", 32, 20_000, narrow_band),
    "broad band": Kind("twelve resonances, 1 to 45 Hz at 250 Hz", 32, 20_000, broad_band),
    "ties": Kind("whole numbers with plateaus", 32, 20_000, ties),
    "long record": Kind("broad band of 1e7 samples", 2, 10_000_000, broad_band),
}


def signals_of(kind: str, signals: int | None = None, samples: int | None = None) -> Floats:
    """Signals (n, t) of a kind, an even number of them; fewer or shorter ones where that is asked for."""
    known = KINDS[kind]
    rng = np.random.default_rng(SEED)
    return np.array([known.draw(rng, samples or known.samples) for _ in range(signals or known.signals)])


@dataclass(frozen=True, slots=True)
class FlatBand:
    """One-sided spectrum of constant density between two frequencies, whose moments are known."""

    density: float
    low: float
    high: float

    def moment(self, order: int) -> float:
        """``integral of f^order G(f) df``."""
        return self.density * (self.high ** (order + 1) - self.low ** (order + 1)) / (order + 1)

    def sampled(self, frequencies: int) -> tuple[Floats, Floats]:
        """Frequencies (f,) from ``low`` to ``high``, and the density there."""
        f = np.linspace(self.low, self.high, frequencies)
        return f, np.full(frequencies, self.density)


BANDS = {"narrow band": FlatBand(30.0, 9.0, 11.0), "broad band": FlatBand(30.0, 1.0, 40.0)}
