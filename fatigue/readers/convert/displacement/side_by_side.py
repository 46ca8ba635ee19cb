"""A displacement of the simulation beside the modal coordinates of one event, at common instants."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from fatigue.readers.convert.displacement.causes import EXPLAINED, Cause, explain
from fatigue.readers.convert.displacement.comparison import Comparison
from fatigue.readers.convert.displacement.record import DisplacementRecord
from fatigue.readers.convert.displacement.timing import derived, shifted
from fatigue.readers.foreign.histories.foreign_history import ForeignHistory

Floats = NDArray[np.float64]

_MOST_INSTANTS = 100_000
_FEW_INSTANTS = 8


@dataclass(frozen=True, slots=True, eq=False)
class EventComparison:
    """What one event says of a displacement: the records side by side, and their misfit.

    Attributes
    ----------
    comparison : at the instants in common; None where these are too few
    misfit : rms error over rms of the displacement; infinite where there is nothing to compare
    span : the instants in common, in words
    time, summed : the event's own times [s], and the sum of its modes [mm]
    """

    comparison: Comparison | None
    misfit: float
    span: str
    time: Floats
    summed: Floats


def compared(
    record: DisplacementRecord,
    direction: int,
    mode: NDArray[np.int64],
    shape: Floats,
    factor: Floats,
    history: ForeignHistory,
) -> EventComparison:
    """A displacement and one event side by side, at the instants of the coarser of the two.

    Parameters
    ----------
    direction : 0, 1, 2 for x, y, z
    mode, shape : (M,) modes of the FE run, and (M, 3) displacement of the node in them [mm per unit coordinate]
    factor : (M,) on the coordinate of each mode in the history, for its unit
    history : of the event, on uniform times
    """
    event = Path(history.source).name
    position = {number: k for k, number in enumerate(mode.tolist())}
    shared = [k for k, number in enumerate(history.mode.tolist()) if number in position]
    at = np.array([position[int(number)] for number in history.mode[shared]], np.int64)
    summed = (shape[at, direction] * factor[at]) @ history.q[shared]
    if not shared:
        return EventComparison(None, np.inf, f"{event} has no mode of the force file", history.time, summed)
    first, last = max(history.time[0], record.time[0]), min(history.time[-1], record.time[-1])
    slack = 1e-6 * float(np.median(np.diff(record.time)))
    ours, theirs = (t[(t >= first - slack) & (t <= last + slack)] for t in (history.time, record.time))
    time = np.clip(min(ours, theirs, key=len)[:_MOST_INSTANTS], first, last)
    if time.size < _FEW_INSTANTS:
        span = (
            f"its times {record.time[0]:.6g} to {record.time[-1]:.6g} s and those of {event}, {history.time[0]:.6g} to "
            f"{history.time[-1]:.6g} s, have {time.size} instants in common"
        )
        return EventComparison(None, np.inf, span, history.time, summed)
    q = np.stack([f * _at(time, history.time, row) for f, row in zip(factor[at], history.q[shared], strict=True)])
    measured = _at(time, record.time, record.value)
    comparison = Comparison(direction, history.mode[shared], at, shape, time, q, measured)
    moves = comparison.rms > 1e-9 * float(np.abs(measured).max())
    misfit = float(comparison.misfit(comparison.weight)) if moves else np.inf
    span = f"{time.size} instants from {time[0]:.6g} to {time[-1]:.6g} s of {event}"
    return EventComparison(comparison, misfit, span, history.time, summed)


def _at(time: Floats, own: Floats, values: NDArray[np.floating]) -> Floats:
    """Values at other times, by cubic splines; where the times are the same, the values themselves."""
    near = np.clip(np.searchsorted(own, time - 1e-9 * (own[-1] - own[0])), 0, own.size - 1)
    if np.allclose(own[near], time, rtol=0, atol=1e-6 * (own[-1] - own[0]) / own.size):
        return np.asarray(values[near], np.float64)
    return np.asarray(CubicSpline(own, values)(time))


def causes_of(event: EventComparison, record: DisplacementRecord) -> tuple[Cause, ...]:
    """Causes that explain the misfit of one event alike."""
    if event.comparison is not None and not np.isfinite(event.misfit):
        return ()
    records = (event.time, event.summed, record.time, record.value)
    shifts = shifted(*records)
    if event.comparison is None:
        return tuple(shift for shift in shifts if shift.misfit <= EXPLAINED)
    return explain(event.comparison, [*shifts, *derived(*records)], event.misfit)
