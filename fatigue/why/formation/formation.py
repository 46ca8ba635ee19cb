"""How the resonance that damages forms, event by event: modes in two parts, welds under each of them, what to watch."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.life.mission import Plan, life_km
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.solve.body import Body
from fatigue.vibration.resonance import AMPLIFIED, DYNAMIC, FAR_ABOVE, HALF_POWER
from fatigue.why.attribute import Attribution
from fatigue.why.formation.damping import Damping, damping_of
from fatigue.why.formation.modes import EventParts, ModesOfEvent, event_parts
from fatigue.why.formation.point_stress import PointStress
from fatigue.why.formation.watch import CANDIDATES, WORTH_COUNTING, Swing, swings_of
from fatigue.why.points import Points

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class WeldsOfEvent:
    """What the two parts of one event do at the worst point of w welds; arrays (w,), NaN where it could not be had.

    Attributes
    ----------
    damage, quasi_static, dynamic : per km of the mission, of the whole stress and of either part alone [1/km]
    dominant_hz : dominant frequency of the stress
    dynamic_share : rms of the dynamic part of the stress over that of the stress
    reason : why a number is empty; empty where all are there
    """

    damage: Floats
    quasi_static: Floats
    dynamic: Floats
    dominant_hz: Floats
    dynamic_share: Floats
    reason: str


@dataclass(frozen=True, slots=True, eq=False)
class Watched:
    """Swings that cost something, the costliest first.

    Attributes
    ----------
    swing : which mode where, and the damage without it
    life, life_without : of the point [km]
    utilisation : what the swing adds to the utilisation of the point
    """

    swing: Swing
    life: float
    life_without: float
    utilisation: float


@dataclass(frozen=True, slots=True, eq=False)
class Formation:
    """How resonances form.

    Attributes
    ----------
    damping : of the modes
    point : (w,) the worst points of the welds that are damaged, index into the points of the attribution
    modes, welds : event by event
    watch : the ranking over all welds, modes and events
    """

    damping: Damping
    point: NDArray[np.int64]
    modes: tuple[ModesOfEvent, ...]
    welds: tuple[WeldsOfEvent, ...]
    watch: tuple[Watched, ...]

    def on_record(self) -> dict[str, Any]:
        """What the provenance of a result says of it."""
        return {
            "assumed_damping_ratio": self.damping.assumed,
            "modes_without_damping_ratio": int(np.isnan(self.damping.ratio).sum()),
            "swing_counted_from_damage_share": WORTH_COUNTING,
            "class_thresholds": {
                "dynamic_share": DYNAMIC,
                "amplification": AMPLIFIED,
                "response_share": HALF_POWER,
                "boundary_mode_above_highest_hz": FAR_ABOVE,
            },
        }

    def of_weld(self, weld: int) -> list[Watched]:
        """Swings at one of the points, the costliest first."""
        return [one for one in self.watch if one.swing.weld == weld]


def formation(
    body: Body,
    attribution: Attribution,
    loads: Sequence[EventLoad],
    plan: Plan,
    point: NDArray[np.int64],
    assumed_damping: float | None,
) -> Formation:
    """How resonances form at some points that have damage; ``assumed_damping`` is of modes without damping ratio.

    Raises
    ------
    DataError : the disk is full
    """
    damping = damping_of(body.modes, assumed_damping)
    static = {event.name for event in body.case.mission.event if event.history is None}
    points, damage = attribution.points.of(point), attribution.damage[point]
    modes: list[ModesOfEvent] = []
    welds: list[WeldsOfEvent] = []
    swings: list[Swing] = []
    for number, load in enumerate(loads):
        event = attribution.events[number]
        parts = event_parts(load, body.modes, damping, is_static=event.event in static)
        modes.append(parts.of_modes)
        at = [_at(points, w, load, parts) for w in range(len(point))]
        per_km = plan.passes[number].passes_per_km
        welds.append(_welds(at, parts, per_km, event.damage[point], event.event in static))
        if parts.is_split.any():
            for w, one in enumerate(at):
                if event.damage[point[w]] > 0.0:
                    swings += swings_of(one, parts, w, number, float(damage[w]), event, loads, plan)
        parts.forget()
    watch = _ranked(swings, damage, points.damage_limit, plan.target_km)
    return Formation(damping, point, tuple(modes), tuple(welds), tuple(watch))


def _at(points: Points, w: int, load: EventLoad, parts: EventParts) -> PointStress:
    return PointStress(points.of(slice(w, w + 1)), load, parts.q, parts.quasi_static)


def _welds(
    at: Sequence[PointStress], parts: EventParts, per_km: float, damage: Floats, is_static: bool
) -> WeldsOfEvent:
    """Both parts of one event at all points."""
    n = len(at)
    quasi_static, dynamic, hz, share = (np.full(n, np.nan) for _ in range(4))
    swings = parts.is_split.astype(np.float64)
    if is_static:
        quasi_static, dynamic = damage.copy(), np.zeros(n)
    for w, one in enumerate(at if not is_static else ()):
        whole, hz[w] = one.moves(one.history(np.ones_like(swings), 0.0 * swings))
        if parts.reason:
            continue
        of_follows = one.history(1.0 - swings, swings)
        quasi_static[w] = per_km * one.damage(of_follows, one.load.offset)
        of_swings = one.history(swings, -swings)
        dynamic[w] = per_km * one.damage(of_swings, one.load.level)
        moved, _ = one.moves(of_swings)
        share[w] = moved / whole if whole > 0.0 else np.nan
    return WeldsOfEvent(damage, quasi_static, dynamic, hz, share, parts.reason)


def _ranked(swings: Sequence[Swing], damage: Floats, limit: Floats, target_km: float) -> list[Watched]:
    """The costliest swings of every point, ranked by what they add to its utilisation."""
    found: list[Watched] = []
    for w in range(len(damage)):
        own = sorted((one for one in swings if one.weld == w), key=lambda one: one.damage_without)[:CANDIDATES]
        life = float(life_km(damage[w : w + 1], limit[w : w + 1])[0])
        for one in own:
            without = float(life_km(np.array([max(0.0, one.damage_without)]), limit[w : w + 1])[0])
            cost = target_km * (damage[w] - one.damage_without) / limit[w]
            found.append(Watched(one, life, without, float(cost)))
    return sorted(found, key=lambda one: -one.utilisation)
