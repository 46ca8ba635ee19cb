"""Proven bounds for one pass of an event at a block of stations, in place of counting."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.life.curves import DamageLaw
from fatigue.life.mission import Plan
from fatigue.life.screening import PowerSums, damage_bound, may_need_mean_stress


@dataclass(frozen=True, slots=True, eq=False)
class Bound:
    """Upper bounds of damage, largest range [MPa] and largest equivalent range dS of one pass; arrays are (n, 2)."""

    damage: NDArray[np.float64]
    max_range: NDArray[np.float64]
    max_equivalent_range: NDArray[np.float64]

    def at(self, rows: NDArray[np.intp]) -> "Bound":
        """Take some stations."""
        return Bound(self.damage[rows], self.max_range[rows], self.max_equivalent_range[rows])

    def tightened(self, other: "Bound", rows: NDArray[np.intp]) -> "Bound":
        """Take the lower one of two bounds at some stations, those of ``other`` in their order."""
        arrays = []
        for mine, theirs in (
            (self.damage, other.damage),
            (self.max_range, other.max_range),
            (self.max_equivalent_range, other.max_equivalent_range),
        ):
            lower = mine.copy()
            lower[rows] = np.minimum(mine[rows], theirs)
            arrays.append(lower)
        return Bound(*arrays)


def event_bound(
    stress_range: NDArray[np.float64],
    power_sums: PowerSums,
    size: NDArray[np.float64],
    mean: NDArray[np.float64],
    law: DamageLaw,
    yield_MPa: float | None,
    *,
    uses_bending_ratio: bool,
) -> Bound:
    """Bound one pass from a bound of range (n, 2) and of sum n S^q, (n, 2) each [MPa^q].

    ``mean`` (n, 2) is the time mean of the stress [MPa]; ``yield_MPa`` is given where damage contains the mean-stress
    factor: stations that may need it have no bound then.
    """
    damage, largest = damage_bound(stress_range, power_sums, size[:, None], law, uses_bending_ratio=uses_bending_ratio)
    if yield_MPa is not None:
        damage = np.where(may_need_mean_stress(mean, stress_range, yield_MPa), np.inf, damage)
    return Bound(damage, stress_range, largest)


def by_share(bounds: Sequence[Bound], rows: NDArray[np.intp], plan: Plan) -> list[int]:
    """Numbers of the events, those first whose bounds make up most of the damage of some stations."""
    weights = np.array([p.passes_per_km for p in plan.passes])[:, None, None]
    damage = weights * np.stack([bound.damage[rows] for bound in bounds])
    with np.errstate(invalid="ignore"):  # no bound, or no damage at all
        share = np.nan_to_num(damage / damage.sum(axis=0), nan=1.0)
    return [int(number) for number in np.argsort(-share.sum(axis=(1, 2)), kind="stable")]
