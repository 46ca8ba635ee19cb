"""The unit loads of an event on the instants of its own record."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from fatigue.verify.recount.anew.interpolant import Grid, mirrored, periodic, straight
from fatigue.verify.recount.inputs.loads import RecountLoad

Floats = NDArray[np.float64]

SAME = 1e-3  # of a step: instants, periods and steps that count as equal


def factor_for(loads: Sequence[RecountLoad], step: float) -> int:
    """Smallest power of 2 that divides a time step [s] to those of loads which are finer."""
    factor, finest = 1, min((load.step for load in loads), default=np.inf)
    while step / factor > finest * (1.0 + SAME):
        factor *= 2
    return factor


def on_grid(load: RecountLoad, start: float, step: float, kept: int) -> Floats | None:
    """Samples of a load at the kept instants where they are its own ones; None: they lie between its samples.

    ``start`` [s] and ``step`` [s] are those of the ``kept`` samples of the event.
    """
    assert load.samples is not None
    if load.times is None:
        return load.samples[len(load.samples) - kept :]
    first = round((start - load.times[0]) / load.step)
    if not 0 <= first <= len(load.samples) - kept:
        return None
    own = load.times[[first, first + kept - 1]]
    is_same = np.abs(own - [start, start + (kept - 1) * step]).max() <= SAME * step
    return load.samples[first : first + kept] if is_same else None


def between(load: RecountLoad, start: float, step: float, wanted: int, period: float | None) -> Floats:
    """Load at so many instants from a start on, ``step`` apart [s], from samples at others.

    ``period`` [s] is that of an event that recurs: samples that are one of it go round, others are mirrored.
    """
    assert load.samples is not None
    assert load.times is not None
    n = len(load.samples)
    ahead = start - load.times[0]
    grid = Grid(ahead / load.step, step / load.step, wanted)
    goes_round = period is not None and max(abs(ahead), abs(n * load.step - period)) <= SAME * load.step
    if not load.is_linear:
        return (periodic if goes_round else mirrored)(load.samples, grid)
    return straight(np.append(load.samples, load.samples[0]) if goes_round else load.samples, grid)
