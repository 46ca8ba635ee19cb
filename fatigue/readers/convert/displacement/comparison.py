"""A displacement beside the modes that should make it: every set of weights on the modes has its misfit."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

SHARE = 0.03
"""Of the rms of the displacement: a mode that contributes less is not blamed."""

_COLOURED = 5.0  # standard errors take samples as independent; the samples of a vibration are not


@dataclass(frozen=True, eq=False)
class Comparison:
    """A displacement and the modes that should make it, at the same instants.

    Attributes
    ----------
    direction : 0, 1, 2 for x, y, z
    mode : (m,) modes that have shape and coordinate
    number : (m,) their positions among the modes of the FE run
    shape : (M, 3) displacement of the node in every mode of the FE run [mm per unit modal coordinate], basic frame
    time : (t,) [s]
    q : (m, t) modal coordinates
    measured : (t,) displacement [mm]
    """

    direction: int
    mode: NDArray[np.int64]
    number: NDArray[np.int64]
    shape: Floats
    time: Floats
    q: Floats
    measured: Floats

    @cached_property
    def weight(self) -> Floats:
        """(m,) Weights of the modal coordinates in the displacement, as the files have them."""
        return np.asarray(self.shape[self.number, self.direction])

    @cached_property
    def centred(self) -> tuple[Floats, Floats]:
        """The coordinates (m, t) and the displacement (t,) without their means."""
        return self.q - self.q.mean(axis=1, keepdims=True), self.measured - self.measured.mean()

    @cached_property
    def products(self) -> tuple[Floats, Floats, float]:
        """Mean products of the records without their means: q q' (m, m), q y (m,), y y."""
        q, y = self.centred
        t = y.size
        return q @ q.T / t, q @ y / t, float(y @ y) / t

    @cached_property
    def rms(self) -> float:
        """Rms of the displacement about its mean [mm]."""
        return float(np.sqrt(self.products[2]))

    @cached_property
    def summed_rms(self) -> float:
        """Rms of the sum about its mean [mm]."""
        return float(np.sqrt(max(0.0, float(self.weight @ self.products[0] @ self.weight))))

    @cached_property
    def largest_rms(self) -> float:
        """Rms of the sum about its mean in the direction in which the node moves most [mm]."""
        weights = self.shape[self.number].T
        return float(np.sqrt(np.einsum("ai,ij,aj->a", weights, self.products[0], weights).max(initial=0.0)))

    @cached_property
    def rest(self) -> tuple[float, Floats]:
        """Mean square of what the sum misses, and its mean products with q (m,)."""
        qq, qy, yy = self.products
        left = qy - qq @ self.weight
        return float(yy - self.weight @ qy - self.weight @ left), left

    def misfit(self, weights: Floats) -> Floats:
        """Rms of measured - weights @ q over the rms of the displacement, means left out; (..., m) -> (...)."""
        qq, qy, yy = self.products
        square = yy - 2 * weights @ qy + np.einsum("...i,ij,...j->...", weights, qq, weights, optimize=True)
        return self.relative(square)

    def relative(self, mean_square: Any) -> Floats:
        """Root of mean squares (...) over the rms of the displacement."""
        return np.asarray(np.sqrt(np.maximum(mean_square, 0.0)) / self.rms)

    @cached_property
    def parts(self) -> Floats:
        """(m, m) Mean products of what the modes contribute."""
        return np.asarray(self.weight[:, None] * self.products[0] * self.weight)

    @cached_property
    def flipped(self) -> Floats:
        """(m,) Misfit with the sign of one mode changed."""
        square, left = self.rest
        return self.relative(square + 4 * self.weight * left + 4 * np.diagonal(self.parts))


def best_fit(comparison: Comparison) -> tuple[float, Floats]:
    """Least misfit that any weights of these modes leave, and what is left over time (t,)."""
    qq, qy, _ = comparison.products
    size = np.sqrt(np.diagonal(qq))
    size[size == 0] = 1.0
    weight = np.linalg.lstsq(qq / np.outer(size, size), qy / size, rcond=1e-12)[0] / size
    q, y = comparison.centred
    rest = y - weight @ q
    return float(np.sqrt(np.mean(rest**2)) / comparison.rms), rest


def fitted_factors(c: Comparison) -> list[tuple[int, float]]:
    """Position and fitted factor of the modes that contribute enough and whose factor is surely not 1."""
    samples, modes = c.measured.size, c.mode.size
    each = np.diagonal(c.parts)
    taking_part = np.flatnonzero(each > 1e-12 * each.max(initial=0.0))
    if samples < 10 * modes or not taking_part.size:
        return []
    parts = c.parts[np.ix_(taking_part, taking_part)]
    size = np.sqrt(np.diagonal(parts))
    value, vector = np.linalg.eigh(parts / np.outer(size, size))
    value = np.maximum(value, 1e-12)
    right = (c.weight * c.products[1])[taking_part] / size
    factor = vector @ (vector.T @ right / value) / size
    left_over = max(0.0, c.products[2] - factor @ (c.weight * c.products[1])[taking_part])
    error = np.sqrt(left_over / samples * (vector**2 / value).sum(axis=1)) / size
    sure = np.abs(factor - 1) > np.maximum(0.1, 3 * _COLOURED * error)
    seen = np.maximum(1.0, np.abs(factor)) * size > SHARE * c.rms
    return [(int(taking_part[k]), float(factor[k])) for k in np.flatnonzero(sure & seen)]
