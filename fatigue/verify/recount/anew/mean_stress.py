"""``f_M`` of ASME VIII-2 5.5.5.2 once more: what the mean stress of a cycle does to its range."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.verify.recount.anew.curve import RecountCurve

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class MeanStress:
    """Yield stress [MPa], None where none is given, and whether the mean stress counts."""

    yield_MPa: float | None  # noqa: N815 - the unit keeps its spelling
    counts: bool

    def factor(self, a: Floats, b: Floats) -> Floats:
        """``f_M`` of cycles between two stresses, (c,) each."""
        low, high = np.minimum(a, b), np.maximum(a, b)
        factor = np.ones(len(a))
        if self.yield_MPa is not None:
            tension = ((low + high) / 2 >= self.yield_MPa / 2) & (low > 0) & (high - low <= 2 * self.yield_MPa)
            tension &= low < high  # where rounding takes the range of a cycle about a high mean there is none
            factor[tension] = (1 - low[tension] / high[tension]) ** (1 / 3.6)
        return factor

    def least_factor(self, ranges: Floats, highest: float) -> Floats:
        """``f_M`` of ranges that reach up to the highest stress of all; no cycle of such a range has a smaller one."""
        if self.yield_MPa is None or highest < self.yield_MPa / 2:
            return np.ones(len(ranges))
        return np.minimum(ranges / highest, 1.0) ** (1 / 3.6)

    def is_known(self, curve: RecountCurve) -> bool:
        """Whether there is something to say of mean stress: a yield stress, and a curve in dS."""
        return self.yield_MPa is not None and curve.on_equivalent


def stress_ratio(a: float, b: float) -> float:
    """Smaller over larger of two stresses."""
    return min(a, b) / max(a, b) if max(a, b) != 0 else np.nan


def stress_ratios(a: Floats, b: Floats) -> Floats:
    """Smaller over larger of two stresses, (c,) each."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(np.minimum(a, b) / np.maximum(a, b))
