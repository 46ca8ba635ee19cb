"""Which resonance to watch: what each mode's swing costs a weld, in which event, and where on the track.

The damage of a point is ``sum_k w_k (q_k @ g)`` (``fatigue.life.attribution``), so it is also shared out to the
quasi-static and the dynamic part of every mode. What the dynamic parts have chooses the candidates, and says where on
the track the swing does its damage. What a swing costs is counted: all cycles of the event once more, with that mode
following its load instead of swinging, ``q_k`` replaced by ``q_qs,k``; cycles across events with it.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from fatigue.life.mission import Plan
from fatigue.life.records.spool import Samples, Spool, create_spool, time_slices
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.why.across_events import loop_damages
from fatigue.why.attribute import EventAttribution
from fatigue.why.formation.modes import FOLLOWING, EventParts
from fatigue.why.formation.point_stress import Laid, PointStress
from fatigue.why.points import Points

Floats = NDArray[np.float64]

CANDIDATES = 3  # swings counted again at each weld: of each event at most
WORTH_COUNTING = 0.01  # of the damage of the point, owed to the dynamic part of a mode
HALF = 0.5  # of the damage of a swing, that its place holds


@dataclass(frozen=True, slots=True)
class Swing:
    """One mode in one event at the worst point of a weld, and what it costs.

    Attributes
    ----------
    weld : which of the points
    event, mode : numbers of the event, and of the mode among the coordinates
    first, last : bins of the track: the shortest stretch that holds half of what the dynamic part of the mode owes
    damage_without : of the point per km of the mission, with the mode following its load in this event [1/km]
    """

    weld: int
    event: int
    mode: int
    first: int
    last: int
    damage_without: float


def swings_of(
    at: PointStress,
    parts: EventParts,
    weld: int,
    event: int,
    damage: float,
    placed: EventAttribution,
    loads: Sequence[EventLoad],
    plan: Plan,
) -> list[Swing]:
    """Swings in one event that are worth counting at one point, which has ``damage`` per km in all events.

    Raises
    ------
    DataError : the disk is full
    """
    one_pass = plan.passes[event]
    everything = np.ones(len(parts.is_split))
    laid = at.laid(at.history(everything, 0.0 * everything))
    owed = one_pass.passes_per_km * _owed(at, laid)
    of_class = parts.of_modes.mode_class
    answers = np.isin(of_class, ("quasi_static", "resonant"))  # an inertial mode moves less than its load would move it
    owed[: len(of_class)][~answers] = 0.0
    owed[~parts.is_split] = 0.0
    largest = np.argsort(-owed, kind="stable")[:CANDIDATES]
    found = []
    for mode in largest[owed[largest] >= WORTH_COUNTING * damage].tolist():
        only = np.arange(len(owed)) == mode
        without = at.damage(at.history(everything - only, 1.0 * only), at.load.offset)
        change = one_pass.passes_per_km * (without - laid.damage)
        change += _across_events(at.point, parts, event, mode, loads, plan) if plan.loops else 0.0
        first, last = shortest_half(_places(at, laid, mode, placed.place_s))
        found.append(Swing(weld, event, mode, first, last, damage + change))
    return found


def _owed(at: PointStress, laid: Laid) -> Floats:
    """Damage owed to the dynamic part of each coordinate in one pass, (c,)."""
    found = np.zeros(at.q.shape[0])
    for part in _slices(at.q):
        found += (at.q[:, part] - at.quasi_static[:, part]) @ laid.share[0:1, part][0]
    return np.asarray(at.surface * found)


def _places(at: PointStress, laid: Laid, mode: int, place_s: Floats) -> Floats:
    """Damage owed to the dynamic part of one mode, per bin of the track."""
    found = np.zeros(len(place_s) - 1)
    one = slice(mode, mode + 1)
    for part in _slices(at.q):
        dynamic = (at.q[one, part] - at.quasi_static[one, part])[0]
        time = at.load.counted.start + at.load.counted.step * np.arange(part.start, part.stop)
        bins = np.clip(np.searchsorted(place_s, time, side="right") - 1, 0, len(found) - 1)
        found += np.bincount(bins, at.surface[mode] * dynamic * laid.share[0:1, part][0], len(found))
    return found


def shortest_half(owed: Floats) -> tuple[int, int]:
    """First and last of the fewest neighbouring bins (x,) that hold half of what is above 0; the fullest of these.

    >>> shortest_half(np.array([1.0, -2.0, 3.0, 4.0, 1.0]))
    (2, 3)
    """
    below = np.append(0.0, np.cumsum(np.maximum(owed, 0.0)))
    for width in range(1, len(owed) + 1):
        held = below[width:] - below[:-width]
        if held.max() >= HALF * below[-1]:
            first = int(held.argmax())
            return first, first + width - 1
    return 0, len(owed) - 1


def _across_events(
    point: Points, parts: EventParts, event: int, mode: int, loads: Sequence[EventLoad], plan: Plan
) -> float:
    """What cycles across events make less or more of a point per km, with one mode following its load in one event."""
    load = loads[event]
    others = [replace(load, counted=replace(load.counted, q=_following(load.counted.q, parts, mode)))]
    changed = [*loads[:event], *others, *loads[event + 1 :]]
    as_it_is = np.ones((1, len(parts.is_split)))
    with_it, without = (loop_damages(point, as_it_is, given, plan)[0] for given in (loads, changed))
    return float(without - with_it)


def _following(q: Samples, parts: EventParts, mode: int) -> Samples:
    """Coordinates with one of them replaced by its quasi-static part."""
    one = slice(mode, mode + 1)
    if not isinstance(parts.quasi_static, Spool):
        found = np.array(q, dtype=np.float64)
        found[one] = parts.quasi_static[one, :]
        return found
    fine = create_spool(parts.quasi_static.path.with_name(FOLLOWING), q.shape, np.dtype(np.float64))
    for part in time_slices(q.shape):
        some = np.array(q[:, part], dtype=np.float64)
        some[one] = parts.quasi_static[one, part]
        fine[:, part] = some
    return fine


def _slices(q: Samples) -> list[slice]:
    """All samples of coordinates in memory at once, some after the other of those on disk."""
    return list(time_slices(q.shape)) if isinstance(q, Spool) else [slice(0, q.shape[1])]
