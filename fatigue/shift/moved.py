"""The events as they would be with a mode at another setting: its coordinate is moved, all others stay."""

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fatigue.life.records.history import cached_chunks
from fatigue.life.records.spool import Samples, Spool, SpoolWriter
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.vibration.oscillator import memory_s
from fatigue.vibration.shifted import Setting, shifted

Floats = NDArray[np.float64]

QUASI_STATIC = 0.05  # of the rms of the moved coordinate, up to which it is the old one to a factor
FEWEST_MEMORIES = 10.0  # of the moved mode, that a record has to last for its start not to matter


class Movement(NamedTuple):
    """A mode that is moved: its row in the coordinates, and its settings before and after."""

    row: int
    before: Setting
    after: Setting

    @property
    def static_factor(self) -> float:
        """Factor on what is constant or slow, (f / f')^2 at constant modal mass."""
        return (self.before.frequency_hz / self.after.frequency_hz) ** 2


class Moved(NamedTuple):
    """An event with the mode at its new setting, and what happened to its coordinate.

    Attributes
    ----------
    load : the event
    rms_ratio : rms about the mean of the moved coordinate over that before; NaN where it did not vary
    beside_static : rms of what the static factor does not explain, over the rms after; NaN where it does not vary
    memories : how many times the record is as long as the moved mode remembers
    """

    load: EventLoad
    rms_ratio: float
    beside_static: float
    memories: float


def nyquist_hz(load: EventLoad) -> float:
    """Half the sampling rate of an event as it was recorded [Hz]."""
    return 0.5 / (load.counted.step * load.upsample)


def movement(load: EventLoad, of: Movement, *, is_static: bool) -> Moved:
    """An event with a mode moved; where the record cannot hold a resonance, by its static factor only."""
    q, factor = np.asarray(load.counted.q[of.row : of.row + 1, :], dtype=np.float64)[0], of.static_factor
    after = q * factor if is_static else shifted(q, load.counted.step, of.before, of.after)
    offset = load.offset.copy()
    offset[of.row] *= factor
    mean = load.mean.copy()
    mean[of.row] *= factor
    history = replace(load.counted, q=_with_row(load.counted.q, of.row, after))
    spread, before = float(after.std()), float(q.std())
    apart = float((after - factor * q).std())
    return Moved(
        replace(load, counted=history, single=None, offset=offset, mean=mean),
        spread / before if before > 0.0 else np.nan,
        apart / spread if spread > 0.0 else np.nan,
        load.duration / memory_s(*of.after),
    )


def _with_row(q: Samples, row: int, values: Floats) -> Samples:
    """Modal coordinates with another row, in a file of its own where they are on disk."""
    if not isinstance(q, Spool):
        return np.concatenate([q[:row], values[None].astype(q.dtype), q[row + 1 :]])
    with SpoolWriter(q.path.with_name(f"{q.path.name}-moved"), q.shape[0], q.dtype) as writer:
        first = 0
        for chunk in cached_chunks(q):
            moved = np.array(chunk)
            moved[row] = values[first : first + moved.shape[1]]
            writer.append(moved)
            first += moved.shape[1]
    return writer.spool()


def moved_loads(loads: Sequence[EventLoad], of: Movement, at: Sequence[bool], is_static: Sequence[bool]) -> list[Moved]:
    """All events, those of ``at`` with the mode moved; nothing moves where the settings are the same."""
    same = of.before == of.after
    return [
        Moved(load, 1.0, 0.0, load.duration / memory_s(*of.after))
        if same or not here
        else movement(load, of, is_static=static)
        for load, here, static in zip(loads, at, is_static, strict=True)
    ]
