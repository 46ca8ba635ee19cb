"""Proven bounds for one pass of an event at a block of stations, in place of counting."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.life.bounds.screening import PowerSums, damage_bound, may_need_mean_stress
from fatigue.life.mission import Plan
from fatigue.pipeline.solve.modal_stress import Shapes

Unsettled = Callable[[NDArray[np.intp]], NDArray[np.intp]]  # those of some stations that are not settled


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
    found: tuple[NDArray[np.float64], PowerSums],
    stress_factor: float,
    shapes: Shapes,
    rows: NDArray[np.intp] | slice,
    mean: NDArray[np.float64],
) -> Bound:
    """Bound one pass at some ``rows`` of a block from bounds of range and sum n S^q, (n, 2) each, of the record.

    They are those before the event's ``stress_factor``. ``mean`` (n, 2) is the time mean of the stress [MPa]. Where
    the damage contains the mean-stress factor, stations that may need it have no bound.
    """
    stress_range = stress_factor * found[0]
    power_sums = {q: stress_factor**q * power_sum for q, power_sum in found[1].items()}
    size = shapes.size[rows, None]
    damage, largest = damage_bound(stress_range, power_sums, size, shapes.rule)
    yield_MPa = shapes.rule.yield_of_damage
    if yield_MPa is not None:
        damage = np.where(may_need_mean_stress(mean, stress_range, yield_MPa), np.inf, damage)
    return Bound(damage, stress_range, largest)


def event_by_event(
    rows: NDArray[np.intp], bounds: Sequence[Bound], plan: Plan, unsettled: Unsettled
) -> Iterator[tuple[int, NDArray[np.intp]]]:
    """Give the number of each event and those of some stations that are still unsettled when it is its turn.

    The events whose bounds make up most of the damage come first; whoever asks tightens the ``bounds`` of an event, by
    which stations are settled, before he asks for the next one.
    """
    for number in _by_share(bounds, rows, plan):
        yield number, rows
        rows = unsettled(rows)
        if not rows.size:
            return


def _by_share(bounds: Sequence[Bound], rows: NDArray[np.intp], plan: Plan) -> list[int]:
    """Numbers of the events, those first whose bounds make up most of the damage of some stations."""
    weights = np.array([p.passes_per_km for p in plan.passes])[:, None, None]
    damage = weights * np.stack([bound.damage[rows] for bound in bounds])
    with np.errstate(invalid="ignore"):  # no bound, or no damage at all
        share = np.nan_to_num(damage / damage.sum(axis=0), nan=1.0)
    return [int(number) for number in np.argsort(-share.sum(axis=(1, 2)), kind="stable")]
