"""The second tier of bounds: from the range and the variation of the stress along whole welds, over time."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from fatigue.life.bounds.weld_basis import reduced_bound, weld_bases
from fatigue.pipeline.count.block import Block
from fatigue.pipeline.count.bounds import Bounds, event_bound
from fatigue.pipeline.count.estimate import Estimate

WELD_BOUNDS_AT_ONCE = 1024  # stations, or as many as one weld has: 10 kB each with 100 modes


def tighten_by_welds(block: Block, rows: NDArray[np.intp], estimates: Sequence[Estimate], bounds: Bounds) -> None:
    """Tighten the bounds of some stations of a block, event by event as long as it is needed."""
    stress, screening = block.stress, bounds.screening
    for some in _between_welds(block.weld, rows):
        bases = weld_bases(stress.membrane[some], stress.bending[some], block.weld[some], screening.extents)
        for number, left in bounds.event_by_event(some):
            record, extent = screening.records[number], screening.extents[number]
            found = reduced_bound(bases, np.searchsorted(some, left), record, extent)
            mean = estimates[number].mean[left]
            bounds.tighten(number, left, event_bound(found, stress, left, block.loads[number], mean))


def _between_welds(weld: NDArray[np.int64], rows: NDArray[np.intp]) -> list[NDArray[np.intp]]:
    """Some stations, ascending, about ``WELD_BOUNDS_AT_ONCE`` at a time; the stations of a weld stay together."""
    if not rows.size:
        return []
    first_of_weld = np.searchsorted(weld[rows], weld[rows])
    return np.split(rows, np.flatnonzero(np.diff(first_of_weld // WELD_BOUNDS_AT_ONCE)) + 1)
