"""Proven bounds for the events of a block of stations in place of counting, and which stations they settle."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields
from typing import Self

import numpy as np
from numpy.typing import NDArray

from fatigue.life.bounds.screening import ModalExtent, PowerSums, damage_bound, may_need_mean_stress
from fatigue.life.bounds.vertex_bound import vertex_bound
from fatigue.life.counting.block import BlockCount
from fatigue.life.counting.record import SingleRecord
from fatigue.life.curves import DamageLaw
from fatigue.life.mission import Plan, mission_sum
from fatigue.life.rule import CycleRule
from fatigue.life.sequence import convex_damage
from fatigue.pipeline.count.joined.junctions import Junctions
from fatigue.pipeline.count.joined.loops import Joined
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.solve.modal_stress import ModalStress

ABOVE = 1.0 + 1e-6  # so that what was counted in single precision is a bound as well


@dataclass(frozen=True, slots=True, eq=False)
class Screening:
    """What settles points without counting.

    A bound below ``share`` of the damage limit is enough. With ``proves_worst`` the worst point of welds that stay
    below the share everywhere has to be proven, too. ``extents`` and ``records`` say of every event how far and how
    much its modal coordinates move, without and with a loop over time.
    """

    share: float
    proves_worst: bool
    extents: tuple[ModalExtent, ...]
    records: tuple[SingleRecord, ...]


@dataclass(frozen=True, slots=True, eq=False)
class Bound:
    """Upper bounds of damage, largest range [MPa] and largest equivalent range dS of one pass; arrays are (n, 2)."""

    damage: NDArray[np.float64]
    max_range: NDArray[np.float64]
    max_equivalent_range: NDArray[np.float64]

    def at(self, rows: NDArray[np.intp] | slice) -> Self:
        """Take some stations."""
        return type(self)(self.damage[rows], self.max_range[rows], self.max_equivalent_range[rows])

    def tightened(self, other: Self, rows: NDArray[np.intp]) -> Self:
        """The lower one of two bounds at some stations; ``other`` has these stations only, in their order."""
        arrays = []
        for name in ("damage", "max_range", "max_equivalent_range"):
            lower = getattr(self, name).copy()
            lower[rows] = np.minimum(lower[rows], getattr(other, name))
            arrays.append(lower)
        return type(self)(*arrays)

    @classmethod
    def of_count(cls, counted: BlockCount) -> Self:
        """The bound that a count is."""
        return cls(ABOVE * counted.damage, ABOVE * counted.max_range, ABOVE * counted.max_equivalent_range)

    def as_count(self) -> BlockCount:
        """A count that the bound stands for; what only cycles could tell is NaN."""
        unknown = {field.name: np.full_like(self.damage, np.nan) for field in fields(BlockCount)}
        known = {field.name: getattr(self, field.name) for field in fields(self)}
        return BlockCount(**(unknown | known | {"histogram": np.zeros((*self.damage.shape, 0, 2))}))


@dataclass(frozen=True, slots=True, eq=False)
class Bounds:
    """Upper bounds of all events at the n stations of a block, and which of the stations they settle.

    Attributes
    ----------
    of_events : the bound of every event; they are tightened one by one
    plan : how often the events occur
    toe : (n, 2) faces that carry a weld toe
    worst : (n, 1) share of the limit that a point of the weld is known to use up, 0 until one was counted
    screening : what is enough
    junctions : what bounds the cycles across events; None where no loop joins events
    """

    of_events: list[Bound]
    plan: Plan
    toe: NDArray[np.bool_]
    worst: NDArray[np.float64]
    screening: Screening
    junctions: Junctions | None = None

    def tighten(self, event: int, rows: NDArray[np.intp], found: Bound) -> None:
        """Take another bound of an event at some stations where it is lower."""
        self.of_events[event] = self.of_events[event].tightened(found, rows)

    def utilisation(self, rows: NDArray[np.intp] | slice = slice(None)) -> NDArray[np.float64]:
        """Largest share of the damage limit that the whole mission can use up at some stations, (n, 2)."""
        return utilisation(self.of_events, self.plan, rows, self.junctions)

    def joined(self, rows: NDArray[np.intp]) -> Joined:
        """Bounds of what joins the events at some stations."""
        if self.junctions is None:
            return Joined.nothing(len(rows))
        return self.junctions.at(rows).bounded(self.plan, [bound.at(rows) for bound in self.of_events])

    def unsettled(self, rows: NDArray[np.intp]) -> NDArray[np.intp]:
        """Those of some stations whose bound stays neither below the share nor below the worst point of their weld."""
        at_most = self.utilisation(rows)
        remains = at_most >= self.screening.share
        if self.screening.proves_worst:
            remains |= self.toe[rows] & (at_most > self.worst[rows])
        return rows[np.flatnonzero(remains.any(axis=1))]

    def event_by_event(self, rows: NDArray[np.intp]) -> Iterator[tuple[int, NDArray[np.intp]]]:
        """The number of each event, and the stations that are still unsettled when it is its turn.

        The events whose bounds make up most of the damage come first. The caller tightens the bound of an event before
        he asks for the next one.
        """
        for event in self._by_share(rows):
            yield event, rows
            rows = self.unsettled(rows)
            if not rows.size:
                return

    def _by_share(self, rows: NDArray[np.intp]) -> list[int]:
        """Numbers of the events; the events whose bounds make up most of the damage of some stations come first."""
        weights = np.array([p.passes_per_km for p in self.plan.passes])[:, None, None]
        damage = weights * np.stack([bound.damage[rows] for bound in self.of_events])
        with np.errstate(invalid="ignore"):  # no bound, or no damage at all
            share = np.nan_to_num(damage / damage.sum(axis=0), nan=1.0)
        return [int(event) for event in np.argsort(-share.sum(axis=(1, 2)), kind="stable")]


def utilisation(
    bounds: Sequence[Bound],
    plan: Plan,
    rows: NDArray[np.intp] | slice = slice(None),
    junctions: Junctions | None = None,
) -> NDArray[np.float64]:
    """Largest share of the damage limit that a mission can use up by the bounds of its events, (n, 2).

    ``junctions`` are of the same stations as the bounds; None where no loop joins events.
    """
    some = [bound.at(rows) for bound in bounds]
    per_km = mission_sum(np.stack([bound.damage for bound in some]), plan.passes)
    if junctions is not None and plan.loops:
        joined = junctions.at(rows).bounded(plan, some)
        per_km = per_km + sum(
            loop.runs_per_km * of.count.damage for loop, of in zip(plan.loops, joined.loops, strict=True)
        )
    return per_km * plan.target_km / plan.damage_limit


def event_bound(
    found: tuple[NDArray[np.float64], PowerSums],
    stress: ModalStress,
    rows: NDArray[np.intp] | slice,
    load: EventLoad,
    mean: NDArray[np.float64],
) -> Bound:
    """Bound of one pass at some ``rows`` of a block, from bounds of range and sum n S^q, (n, 2) each, of its record.

    ``found`` does not contain the stress factor of the event. ``mean`` (n, 2) is the time mean of the stress [MPa].
    Where the damage contains the mean-stress factor, stations that may need the factor have no bound. Bounds of the
    samples become bounds of the vertices here where reversals are read there.
    """
    stress_range, power_sums = _with_stress_factor(vertex_bound(*found) if load.vertex else found, load)
    damage, largest = damage_bound(stress_range, power_sums, stress.size[rows, None], stress.rule)
    yield_MPa = stress.rule.yield_of_damage
    if yield_MPa is not None:
        damage = np.where(may_need_mean_stress(mean, stress_range, yield_MPa), np.inf, damage)
    return Bound(damage, stress_range, largest)


def first_slope_bound(
    found: tuple[NDArray[np.float64], PowerSums], stress: ModalStress, load: EventLoad
) -> NDArray[np.float64]:
    """Bound of the damage of one pass with the slopes of a curve extended that ``convex_damage`` takes, (n, 2)."""
    law = stress.rule.law
    stress_range, power_sums = _with_stress_factor(found, load)
    damage = np.zeros_like(stress_range)
    for j in range(len(convex_damage(stress.rule).exponents)):
        straight = DamageLaw(law.slopes[j : j + 1], law.log_constants[j : j + 1], law.knees[:0], 0.0)
        rule = CycleRule(straight, stress.rule.uses_bending_ratio)
        damage += damage_bound(stress_range, power_sums, stress.size[:, None], rule)[0]
    return damage


def _with_stress_factor(
    found: tuple[NDArray[np.float64], PowerSums], load: EventLoad
) -> tuple[NDArray[np.float64], PowerSums]:
    """Bounds of range and sum n S^q with the stress factor of the event."""
    f = load.stress_factor
    return f * found[0], {q: f**q * power_sum for q, power_sum in found[1].items()}
