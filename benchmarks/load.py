"""The load of the benchmarks: resonances between 1 and 45 Hz, sampled at 250 Hz, on random weld nodes."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.life.counting.block import BlockCount, BlockStress
from fatigue.life.counting.count import count
from fatigue.life.counting.record import CountedRecord
from fatigue.life.counting.rows import count_rows
from fatigue.life.counting.single.prepare import single_record
from fatigue.life.curves import DamageLaw, catalogue, damage_law
from fatigue.life.rule import CycleRule

Floats = NDArray[np.float64]

RATE = 250.0


def aluminium() -> DamageLaw:
    """Aluminium master curve at the mean minus two standard deviations."""
    return damage_law(catalogue()["master-aluminium"], "mean-2sigma", "none", 1e7)


@dataclass(frozen=True)
class Load:
    """Modal stress of some nodes and modal coordinates of one event, the latter for either counter."""

    S_m: Floats
    S_b: Floats
    q: NDArray[np.float32]
    q_double: Floats
    single: CountedRecord
    double: CountedRecord

    def stress(self, first: int = 0, end: int | None = None) -> BlockStress:
        """Stress of some nodes."""
        S_m, S_b = self.S_m[first:end], self.S_b[first:end]
        return BlockStress(S_m, S_b, np.ones(len(S_m)), np.full((len(S_m), 2), 0.3))

    def count_single(self, first: int = 0, end: int | None = None) -> BlockCount:
        """Count of some nodes in single precision."""
        return count(self.stress(first, end), self.single, CycleRule(aluminium(), uses_bending_ratio=True))

    def count_double(self, first: int = 0, end: int | None = None) -> BlockCount:
        """Count of some nodes in double precision."""
        return count_rows(self.stress(first, end), self.double, CycleRule(aluminium(), uses_bending_ratio=True))

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
    single = CountedRecord(q, "repeat", single_record(q))
    q_double = q.astype(np.float64)
    return Load(S_m, 0.5 * S_b, q, q_double, single, CountedRecord(q_double, "repeat"))
