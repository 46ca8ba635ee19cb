"""The load of the benchmarks: resonances between 1 and 45 Hz, sampled at 250 Hz, on random weld nodes."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.life.counting.rainflow import BlockCount, count_block
from fatigue.life.counting.single.count import Record, count_block_fast, record_of
from fatigue.life.curves import DamageLaw, catalogue, damage_law

Floats = NDArray[np.float64]

CHOICES = {"uses_bending_ratio": True, "residue": "repeat", "yield_MPa": None, "mean_stress": False}
RATE = 250.0


def aluminium() -> DamageLaw:
    """Aluminium master curve at the mean minus two standard deviations."""
    return damage_law(catalogue()["master-aluminium"], "mean-2sigma", "none", 1e7)


@dataclass(frozen=True)
class Load:
    """Stress shapes of some nodes and modal coordinates of one event."""

    S_m: Floats
    S_b: Floats
    q: NDArray[np.float32]
    q_double: Floats
    record: Record

    def fast(self, first: int = 0, end: int | None = None) -> BlockCount:
        """Count nodes the fast way."""
        S_m, S_b = self.S_m[first:end], self.S_b[first:end]
        ones, ratio = np.ones(len(S_m)), np.full((len(S_m), 2), 0.3)
        return count_block_fast(S_m, S_b, self.record, ones, ratio, aluminium(), **CHOICES)

    def exact(self, first: int = 0, end: int | None = None) -> BlockCount:
        """Count nodes in double precision throughout."""
        S_m, S_b = self.S_m[first:end], self.S_b[first:end]
        ones, ratio = np.ones(len(S_m)), np.full((len(S_m), 2), 0.3)
        return count_block(S_m @ self.q_double, S_b @ self.q_double, ones, ratio, aluminium(), **CHOICES)

    def product(self) -> None:
        """Recover the same stresses in double precision and drop them, in blocks of 128 nodes."""
        out = np.empty((256, self.q.shape[1]))
        for first in range(0, len(self.S_m), 128):
            S = np.concatenate([self.S_m[first : first + 128], self.S_b[first : first + 128]])
            np.matmul(S, self.q_double, out=out[: len(S)])


def load(nodes: int, modes: int = 60, steps: int = 20_000, seed: int = 0) -> Load:
    """Draw a load of a given size."""
    rng = np.random.default_rng(seed)
    f = np.fft.rfftfreq(steps, 1.0 / RATE)
    q = np.empty((modes, steps), np.float32)
    for row, f_n in zip(q, np.linspace(1.0, 45.0, modes), strict=True):
        resonance = (f < 60.0) / (1.0 - (f / f_n) ** 2 + 0.06j * f / f_n)
        x = np.fft.irfft(resonance * (rng.normal(size=f.size) + 1j * rng.normal(size=f.size)), steps)
        row[:] = x / x.std()
    level = np.exp(rng.normal(size=(nodes, 1)))
    S_m, S_b = (level * rng.normal(size=(nodes, modes)) for _ in range(2))
    return Load(S_m, 0.5 * S_b, q, q.astype(np.float64), record_of(q))
