"""Synthetic modes, lightly damped, and the row that the check writes for a displacement of theirs."""

from dataclasses import dataclass

import numpy as np

from fatigue.readers.convert.displacement.record import DisplacementRecord
from fatigue.readers.convert.displacement.side_by_side import causes_of, compared
from fatigue.readers.convert.displacement.verdict import judged
from fatigue.readers.foreign.histories.foreign_history import ForeignHistory

RATE, HIGHEST_HZ = 200.0, 60.0


@dataclass(frozen=True)
class Modes:
    """Times (t,), coordinates (m, t) and the shape (m, 3) of one node."""

    time: np.ndarray
    q: np.ndarray
    shape: np.ndarray

    @property
    def weight(self):
        """Shape in z, as a copy to spoil."""
        return self.shape[:, 2].copy()

    def noise(self, share, seed=7):
        """White noise of so much of the rms of the displacement in z."""
        level = share * np.std(self.weight @ self.q)
        return level * np.random.default_rng(seed).normal(size=self.time.size)


def resonances(modes=12, samples=2000, seed=0):
    """Draw modes between 5 and 40 Hz under broad-band excitation, the higher ones smaller."""
    rng = np.random.default_rng(seed)
    f = np.fft.rfftfreq(samples, 1 / RATE)
    q = []
    for k, own in enumerate(np.linspace(5, 40, modes)):
        force = (rng.normal(size=f.size) + 1j * rng.normal(size=f.size)) * (f < HIGHEST_HZ)
        row = np.fft.irfft(force / (1 - (f / own) ** 2 + 0.04j * f / own), samples)
        q.append(row / row.std() * np.exp(-0.1 * k))
    return Modes(np.arange(samples) / RATE, np.array(q), rng.normal(size=(modes, 3)))


def row_of(modes, measured, time=None, mode=None, lacking=()):
    """The audit row of a displacement in z; ``mode`` are the numbers of the coordinates, 1 to m by default."""
    number = np.arange(1, len(modes.q) + 1) if mode is None else np.array(mode)
    names = tuple(f"q_{n}" for n in number)
    history = ForeignHistory("run/q.csv", number, np.full(len(number), np.nan), names, modes.time, modes.q)
    record = DisplacementRecord(modes.time if time is None else time, measured)
    event = compared(record, 2, np.arange(1, len(modes.shape) + 1), modes.shape, np.ones(len(modes.shape)), history)
    return judged("u.csv", event, causes_of(event, record) if event.misfit > 0.01 else (), lacking)
