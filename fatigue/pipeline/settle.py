"""Which stations of a group of welds need counting, and proven bounds for the others.

A station may go without counting when no event, and no choice of bending ratios, can take its damage to a stated share
of the limit, and when it cannot be the worst point of its weld: its bound is below the damage that was counted at
another toe point of the weld. So the point that the spectrum says is worst is counted first, weld by weld. Bounds come
in tiers, each sharper and dearer than the one before; a station leaves as soon as one of them settles it. Where it is
enough to know the likely worst point of welds that stay below the share everywhere, the second condition is dropped for
them: it takes most of the time.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.life.mission import Plan, mission_sum
from fatigue.life.rainflow_fast import Record
from fatigue.life.screening import ModalExtent, extent_bound
from fatigue.life.weld_basis import reduced_bound, weld_bases
from fatigue.pipeline.bounds import Bound, event_bound
from fatigue.pipeline.estimate import Estimate, estimate_event
from fatigue.pipeline.event_block import EventBlock, count_event, no_overflow
from fatigue.pipeline.event_load import EventLoad
from fatigue.pipeline.shapes import Shapes

TIERS = ("", "modal bound", "weld bound")  # of the column `screened`: counted, or the bound that settled the point


@dataclass(frozen=True, slots=True, eq=False)
class Screening:
    """What settles points without counting.

    ``share`` of the damage limit below which a bound is enough; ``proves_worst``: also the worst point of welds that
    are below it everywhere has to be proven; ``extents`` and ``records`` say of every event how far and how much its
    modal coordinates move, without and with a loop over time.
    """

    share: float
    proves_worst: bool
    extents: tuple[ModalExtent, ...]
    records: tuple[Record, ...]


@dataclass(frozen=True, slots=True, eq=False)
class Settled:
    """What became of the stations of a group.

    ``tier`` (n,) is an index into `TIERS`; ``counted`` are the rows that were counted and their events, piece by
    piece; ``bounds`` and ``estimates`` are those of every event at all stations.
    """

    tier: NDArray[np.int8]
    counted: tuple[tuple[NDArray[np.intp], tuple[EventBlock, ...]], ...]
    bounds: tuple[Bound, ...]
    estimates: tuple[Estimate, ...]


def settle(
    shapes: Shapes,
    weld: NDArray[np.int64],
    toe: NDArray[np.bool_],
    loads: Sequence[EventLoad],
    plan: Plan,
    screening: Screening,
    yield_MPa: float | None,
    mean_stress: bool,
    where: str,
) -> Settled:
    """Settle or count every station of some whole welds.

    Parameters
    ----------
    shapes : of the stations
    weld : (n,) which weld a station belongs to, ascending
    toe : (n, 2) faces that carry a weld toe
    loads, plan : the events
    screening : up to which share of the limit a bound is enough
    yield_MPa, mean_stress : as in `count_event`
    where : the welds, for messages

    Raises
    ------
    NumericalError : stress or damage exceeds double precision
    """
    needs_yield = yield_MPa if mean_stress else None
    estimates: tuple[Estimate, ...] = ()
    bounds: tuple[Bound, ...] = ()
    for load, extent in zip(loads, screening.extents, strict=True):
        with no_overflow(load.counted.event, where):
            estimates += (estimate_event(shapes, load),)
            bounds += (_modal_bound(shapes, estimates[-1], load, extent, needs_yield),)
    tier = np.ones(len(shapes), dtype=np.int8)

    def count(rows: NDArray[np.intp]) -> tuple[EventBlock, ...]:
        tier[rows] = 0
        some, events = shapes.at(rows), []
        for load, estimate in zip(loads, estimates, strict=True):
            with no_overflow(load.counted.event, where):
                events.append(count_event(some, load, estimate.at(rows), yield_MPa, mean_stress))
        return tuple(events)

    likely_worst = _likely_worst(weld, toe, estimates, bounds, plan)
    counted = [(likely_worst, count(likely_worst))]
    at_worst = np.where(toe[likely_worst], _utilisation(counted[0][1], plan), 0.0).max(axis=1)
    worst = at_worst[np.searchsorted(weld[likely_worst], weld), None]

    def unsettled() -> NDArray[np.intp]:
        """Stations whose bound neither stays below the share nor below the worst point of their weld."""
        at_most = _utilisation(bounds, plan)
        matters = (at_most >= screening.share).any(axis=1)
        may_be_worst = (toe & (at_most > worst)).any(axis=1)
        if not screening.proves_worst:
            may_be_worst &= np.isin(weld, weld[matters])
        return np.flatnonzero((matters | may_be_worst) & (tier > 0))

    rest = unsettled()
    if rest.size:
        tier[rest] = 2
        bounds = _weld_bounds(shapes, weld, rest, bounds, estimates, loads, screening, needs_yield)
        rest = unsettled()
    if rest.size:
        counted.append((rest, count(rest)))
    return Settled(tier, tuple(counted), bounds, estimates)


def _utilisation(blocks: Sequence[EventBlock] | Sequence[Bound], plan: Plan) -> NDArray[np.float64]:
    """Share of the damage limit that the whole mission uses up, (n, 2)."""
    per_km = mission_sum(np.stack([block.damage for block in blocks]), plan.passes)
    return per_km * plan.target_km / plan.damage_limit


def _modal_bound(
    shapes: Shapes, estimate: Estimate, load: EventLoad, extent: ModalExtent, yield_MPa: float | None
) -> Bound:
    """Bound an event from how its modal coordinates move, without a loop over time."""
    f = load.stress_factor
    stress_range, sums = extent_bound(f * shapes.membrane, f * shapes.bending, extent)
    return event_bound(stress_range, sums, shapes, estimate, yield_MPa)


def _weld_bounds(
    shapes: Shapes,
    weld: NDArray[np.int64],
    rows: NDArray[np.intp],
    bounds: Sequence[Bound],
    estimates: Sequence[Estimate],
    loads: Sequence[EventLoad],
    screening: Screening,
    yield_MPa: float | None,
) -> tuple[Bound, ...]:
    """Tighten the bounds of some stations by the range and the variation of their stress, weld by weld."""
    bases = weld_bases(shapes.membrane, shapes.bending, weld, screening.extents)
    some = shapes.at(rows)
    tighter = []
    for load, extent, record, bound, estimate in zip(
        loads, screening.extents, screening.records, bounds, estimates, strict=True
    ):
        f = load.stress_factor
        stress_range, sums = reduced_bound(bases, rows, record, extent)
        powers = f ** np.arange(1, len(sums) + 1)[:, None, None]
        found = event_bound(f * stress_range, powers * sums, some, estimate.at(rows), yield_MPa)
        tighter.append(bound.tightened(found, rows))
    return tuple(tighter)


def _likely_worst(
    weld: NDArray[np.int64],
    toe: NDArray[np.bool_],
    estimates: Sequence[Estimate],
    bounds: Sequence[Bound],
    plan: Plan,
) -> NDArray[np.intp]:
    """Find the station of every weld with the largest estimated damage at a toe; without spectrum, by the bound."""
    guess = np.stack([np.where(np.isnan(e.dirlik), b.damage, e.dirlik) for e, b in zip(estimates, bounds, strict=True)])
    damage = np.where(toe, mission_sum(guess, plan.passes), -1.0).max(axis=1)
    first = np.flatnonzero(np.diff(weld, prepend=weld[0] - 1))
    return np.array(
        [start + int(part.argmax()) for start, part in zip(first, np.split(damage, first[1:]), strict=True)]
    )
