"""Reversals at the vertex of the parabola through their three samples, by Lagrange's weights of these."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.verify.recount.anew.record import RecountRecord

Floats = NDArray[np.float64]
Counts = NDArray[np.int64]


@dataclass(frozen=True, slots=True, eq=False)
class Vertices:
    """Where the peaks and valleys of a stress lie that are one sample above or below both neighbours.

    Attributes
    ----------
    at : (v,) samples, ascending; none where reversals are read at their samples
    shift : (v,) distance to the vertex, between -1/2 and 1/2 [steps]
    samples : of the record
    doubt : what rounding may move a vertex by, where the larger of two samples is not sure [MPa]
    """

    at: Counts
    shift: Floats
    samples: int
    doubt: float

    def shift_of(self, samples: Counts) -> Floats:
        """Shift of some samples [steps], 0 of those that stay."""
        if not len(self.at):
            return np.zeros(len(samples))
        place = np.searchsorted(self.at, samples).clip(max=len(self.at) - 1)
        return np.where(self.at[place] == samples, self.shift[place], 0.0)

    def parts(self, modal_stress: Floats, q: Floats, samples: Counts) -> Floats:
        """Stresses (p, s) at the vertices of some samples, each on the parabola through its own three."""
        if not len(self.at):
            return np.asarray(modal_stress @ q[:, samples])
        weights = _weights(self.shift_of(samples))
        around = [(samples + k) % self.samples for k in (-1, 0, 1)]
        return np.asarray(sum(w * (modal_stress @ q[:, at]) for w, at in zip(weights, around, strict=True)))

    def moved(self, s: Floats) -> Floats:
        """The stress (t,) with its peaks and valleys at their vertices."""
        if not len(self.at):
            return s
        around = [s[(self.at + k) % self.samples] for k in (-1, 0, 1)]
        found = s.copy()
        found[self.at] = sum(w * x for w, x in zip(_weights(self.shift), around, strict=True))
        return found


def vertices(s: Floats, record: RecountRecord, rho: float) -> Vertices:
    """Vertices of a stress (t,) of a record; ``rho`` is what rounding may do to a step [MPa]."""
    if not record.vertex:
        return Vertices(np.zeros(0, dtype=np.int64), np.zeros(0), len(s), 0.0)
    down, up = s - np.roll(s, 1), s - np.roll(s, -1)
    inner = np.ones(len(s), dtype=bool)
    if not record.recurs:
        inner[[0, -1]] = False
    at = np.flatnonzero(inner & (down * up > 0.0))
    a, b = down[at], up[at]
    level = np.abs(down) <= rho
    still = np.flatnonzero(level)  # of equal coordinates both programs make equal stresses
    level[still] = (record.counted[:, still] != record.counted[:, still - 1]).any(axis=0)
    unsure = np.flatnonzero(inner & (level | np.roll(level, -1)))
    steps = np.maximum(np.abs(down[unsure]), np.abs(up[unsure]))
    return Vertices(at, (a - b) / (2.0 * (a + b)), len(s), float(steps.max(initial=0.0)) / 8.0)


def _weights(p: Floats) -> tuple[Floats, Floats, Floats]:
    """Parts of a sample's predecessor, itself and its successor at ``p`` steps from it."""
    return p * (p - 1.0) / 2.0, 1.0 - p**2, p * (p + 1.0) / 2.0
