"""Which stations of a block need counting, and proven bounds for the others.

A station may go without counting when no event, and no choice of bending ratios, can take its damage to a stated share
of the limit, and when it cannot be the worst point of its weld: its bound is below the damage that was counted at
another toe point of the weld. So the point that the spectrum says is worst is counted first, weld by weld. Bounds come
in tiers, each sharper and dearer than the one before; a station leaves as soon as one of them settles it, even while
its events are counted, as soon as those that were counted and the bounds of the others do. Where it is enough to know
the likely worst point of welds that stay below the share everywhere, the second condition is dropped, as a point below
the share is not the worst one of the other welds: it takes most of the time.

Raw ends are counted beside the points that are counted, unless the first of the bounds proves that they stay below the
share as well.
"""

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from fatigue.life.mission import mission_sum
from fatigue.pipeline.count.block import TIERS, Block, Settled
from fatigue.pipeline.count.bounds import Bounds, Screening
from fatigue.pipeline.count.estimate import Estimate
from fatigue.pipeline.count.modal_bound import estimated_and_bounded, without_small_raw_ends
from fatigue.pipeline.count.weld_bound import tighten_by_welds

BOUNDED_AT_ONCE = 1024  # stations whose bounds are laid out as events at a time: 4 kB each with 12 events


def settle(block: Block, screening: Screening) -> Iterator[Settled]:
    """Every station of a block, settled by bounds or counted.

    Raises
    ------
    NumericalError : stress or damage exceeds double precision
    """
    estimates, bounds = estimated_and_bounded(block, screening)
    block = without_small_raw_ends(block, screening)

    tier = np.ones(len(block), dtype=np.int8)
    likely_worst = _likely_worst(block, estimates, bounds)
    tier[likely_worst] = 0
    for settled in block.counted(likely_worst, estimates):
        yield settled
        at_worst = np.where(block.toe[settled.rows], settled.mission.utilisation, 0.0).max(axis=1)
        welds = block.weld[settled.rows]
        of_these = np.isin(block.weld, welds)
        bounds.worst[of_these, 0] = at_worst[np.searchsorted(welds, block.weld[of_these])]

    rest = bounds.unsettled(np.flatnonzero(tier))
    tier[rest] = 2
    tighten_by_welds(block, rest, estimates, bounds)
    for settled in block.counted_while_unsettled(bounds.unsettled(rest), estimates, bounds):
        yield settled
        tier[settled.rows] = 0
    for number in range(1, len(TIERS)):
        rows = np.flatnonzero(tier == number)
        for first in range(0, len(rows), BOUNDED_AT_ONCE):
            yield block.bounded(rows[first : first + BOUNDED_AT_ONCE], estimates, bounds, number)


def _likely_worst(block: Block, estimates: Sequence[Estimate], bounds: Bounds) -> NDArray[np.intp]:
    """Station of every weld with the largest estimated damage at a toe; without a spectrum, with the largest bound."""
    of_events = zip(estimates, bounds.of_events, strict=True)
    slope = float(block.stress.rule.law.slopes[0])
    guess = np.stack([np.where(np.isnan(e.dirlik), b.damage, e.likely_damage(slope)) for e, b in of_events])
    damage = np.where(block.toe, mission_sum(guess, block.plan.passes), -1.0).max(axis=1)
    first = np.flatnonzero(np.diff(block.weld, prepend=block.weld[0] - 1))
    of_welds = zip(first, np.split(damage, first[1:]), strict=True)
    return np.array([start + int(of_weld.argmax()) for start, of_weld in of_welds])
