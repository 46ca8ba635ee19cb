"""Half cycles of a path of normal and shear stress: what comes in, what goes out."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fatigue.errors import DataError, NumericalError, Problem
from fatigue.life.counting.signal import not_finite, recurs, samples_of
from fatigue.life.path.walk import half_cycles
from fatigue.life.records.history import Residue

Floats = NDArray[np.float64]

COUNT = 0.5  # of every cycle: the counter finds half cycles only


@dataclass(frozen=True, slots=True, eq=False)
class PathCycles:
    """The half cycles of a path, in the order of their beginnings; each counts 0.5.

    Attributes
    ----------
    start, end : (h,) sample index and fraction of the two ends; ``end < start``: across the end of a recurring block
    range : (h,) distance of the ends
    length : (h,) length of the path between them that takes the point farther from the first end than ever before
    moment : (h,) area moment of that path about the first end, over that of a half circle on the range
    """

    start: Floats
    end: Floats
    range: Floats
    length: Floats
    moment: Floats

    @property
    def factor(self) -> Floats:
        """(h,) Length over range, at least 1."""
        return np.maximum(self.length / self.range, 1.0)


def count_path(normal: ArrayLike, shear: ArrayLike, beta: float, residue: Residue) -> PathCycles:
    """Count the half cycles of normal and shear stress (t,) in the plane of ``(normal, sqrt(beta) shear)``.

    ``half`` takes the record as it is, ``repeat`` as a block that recurs for ever, from the first point of its most
    distant pair to the next time it occurs. A path that never moves has no half cycles.

    Raises
    ------
    CaseError : another residue
    DataError : not one-dimensional, not of one length, or no numbers
    NumericalError : a sample is not finite, or their range overflows

    Examples
    --------
    >>> turn = np.linspace(0.0, 2.0 * np.pi, 3600, endpoint=False)
    >>> circle = count_path(np.cos(turn), np.sin(turn), 1.0, "repeat")
    >>> circle.range.round(6), circle.factor.round(5), circle.moment.round(5)
    (array([2., 2.]), array([1.5708, 1.5708]), array([1., 1.]))
    """
    s, tau = samples_of(normal), samples_of(shear)
    if s.size != tau.size:
        raise DataError(
            Problem(
                "path",
                "path of normal and shear stress",
                f"normal stress has {s.size} samples, shear stress {tau.size}",
                "Give both at the same instants",
            )
        )
    return count_path_in_space(np.stack([s, np.sqrt(beta) * tau], axis=1), residue)


def count_path_in_space(points: ArrayLike, residue: Residue) -> PathCycles:
    """Count the half cycles of a path of points (t, dimensions), see ``count_path``; quick in a plane only.

    Raises
    ------
    CaseError : another residue
    NumericalError : a coordinate is not finite, or their range overflows
    """
    block = recurs(residue)
    z = np.array(points, dtype=np.float64, order="C", ndmin=2)
    if not np.isfinite(z).all():
        raise not_finite("the path of stresses")
    z, unit = _scaled(z)
    samples = len(z)
    if samples < 2:
        z = np.zeros((2, z.shape[1]))
    half, first = half_cycles(np.concatenate([z, np.zeros((2, z.shape[1]))]), block)
    half = half[np.lexsort((-half[:, 2], half[:, 0]))]
    start, end, largest, length, moment = half.T
    if block and samples:
        start, end = (start + first) % samples, (end + first) % samples
    return PathCycles(start, end, largest * unit, length * unit, moment)


def _scaled(z: Floats) -> tuple[Floats, float]:
    """A path over a unit, a power of two, in which squares of its distances neither overflow nor vanish."""
    with np.errstate(over="ignore"):
        extent = float(np.ptp(z, axis=0).max()) if z.size else 0.0
    if not np.isfinite(extent):
        raise NumericalError(
            Problem(
                "overflow",
                "path of stresses",
                "their range exceeds what double precision can hold",
                "Look for such values in the input",
            )
        )
    if extent == 0.0:
        return z, 1.0
    unit = 2.0 ** float(np.floor(np.log2(extent)))
    return z / unit, unit
