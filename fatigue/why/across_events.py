"""What makes the damage of cycles across events: the share of every mode and unit load, as for a single event.

A cycle between an instant of one event and an instant of another has the signed range ``ds = sum_k w_k (x_k[j] -
x_k[i])``, with x_k the coordinate at each instant, its constant and the stress factor of its event included. So the
parts of ``life.attribution`` add up here, too. The cycles that the loop replaces have their parts with a negative sign.
Frequency and place on the track do not exist: the damage is in one band, and in no bin of the track.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from fatigue.life.attribution import CycleCredit, cycle_credit
from fatigue.life.mission import Loop, Plan
from fatigue.pipeline.count.joined.chains import Chain, ChainCycles, chains_of_loops, loop_cycles
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.why.attribute import EventAttribution
from fatigue.why.points import Points

Floats = NDArray[np.float64]


def attribute_loops(points: Points, loads: Sequence[EventLoad], plan: Plan) -> tuple[EventAttribution, ...]:
    """Damage that every loop of a mission adds at some points, shared out; nothing without loops."""
    if not plan.loops:
        return ()
    chains = chains_of_loops(points.membrane, points.bending, points.side, loads, plan.loops)
    coordinates = {event: _Coordinates(loads[event], of_points) for event, of_points in chains.items()}
    return tuple(_attribute(points, loads, loop, chains, coordinates) for loop in plan.loops)


def loop_damages(points: Points, scale: Floats, loads: Sequence[EventLoad], plan: Plan) -> Floats:
    """Damage per km that the loops add at one point whose coordinates are scaled in some ways (w, c): (w,)."""
    damage = np.zeros(len(scale))
    if not plan.loops:
        return damage
    side = np.full(len(scale), points.side[0])
    chains = chains_of_loops(scale * points.membrane, scale * points.bending, side, loads, plan.loops)
    for loop in plan.loops:
        for i in range(len(scale)):
            cycles = loop_cycles(_at(chains, i), loop.order, side[i], loads)
            damage[i] += loop.runs_per_km * _credit(cycles, points, 0).damage.sum()
    return damage


def _at(chains: dict[int, list[Chain]], point: int) -> dict[int, Chain]:
    return {event: of_points[point] for event, of_points in chains.items()}


class _Coordinates:
    """Coordinates of an event at the samples of some chains, with its constants and its stress factor."""

    def __init__(self, load: EventLoad, chains: Sequence[Chain]) -> None:
        self._samples = np.unique(np.concatenate([chain.sample for chain in chains]))
        q = [np.asarray(load.counted.q[:, i : i + 1], np.float64)[:, 0] for i in self._samples.tolist()]
        self._x = load.stress_factor * (np.stack(q) + load.offset)

    def at(self, sample: NDArray[np.intp]) -> Floats:
        """Coordinates (r, c) at some of the samples."""
        return np.asarray(self._x[np.searchsorted(self._samples, sample)])


def _credit(cycles: ChainCycles, points: Points, p: int) -> CycleCredit:
    membrane = np.stack([cycles.start.membrane, cycles.end.membrane])
    bending = np.stack([cycles.start.bending, cycles.end.bending])
    side, size = float(points.side[p]), float(points.size[p])
    return cycle_credit(membrane, bending, cycles.count, side, size, points.rule[p])


def _attribute(
    points: Points,
    loads: Sequence[EventLoad],
    loop: Loop,
    chains: dict[int, list[Chain]],
    coordinates: dict[int, _Coordinates],
) -> EventAttribution:
    """Damage of one loop at all points."""
    n, c = points.membrane.shape
    damage, load_slope, thickness_slope = np.zeros(n), np.zeros(n), np.zeros(n)
    mode, mode_slope = np.zeros((n, c)), np.zeros((n, c))
    for p in range(n):
        side, S_m, S_b = float(points.side[p]), points.membrane[p], points.bending[p]
        cycles = loop_cycles(_at(chains, p), loop.order, side, loads)
        of = _credit(cycles, points, p)
        start, end = (_of_chain(coordinates, chain) for chain in (cycles.start, cycles.end))
        by_start, by_end = -of.by_range, of.by_range.copy()
        by_end[of.peak_at_end] += of.by_peak[of.peak_at_end]
        by_start[~of.peak_at_end] += of.by_peak[~of.peak_at_end]
        ratio_m, ratio_b = (np.zeros_like(of.damage),) * 2 if of.by_ratio is None else of.by_ratio
        for x, by_stress, sign, chain in ((start, by_start, -1.0, cycles.start), (end, by_end, 1.0, cycles.end)):
            by_m, by_b = by_stress - sign * ratio_m, side * by_stress + sign * ratio_b
            mode[p] += (S_m + side * S_b) * ((sign * of.share) @ x)
            mode_slope[p] += S_m * (by_m @ x) + S_b * (by_b @ x)
            thickness_slope[p] -= float(by_m @ chain.membrane + 2.0 * (by_b @ chain.bending))
        damage[p], load_slope[p] = of.damage.sum(), of.slope.sum()
    per_km = loop.runs_per_km
    nothing = np.zeros((n, 0))
    return EventAttribution(
        event=loop.name,
        damage=per_km * damage,
        top_cycle_share=np.full(n, np.nan),
        load_slope=per_km * load_slope,
        thickness_slope=per_km * thickness_slope,
        rule_slope=per_km * load_slope * points.size_exponent,
        mode=per_km * mode,
        mode_slope=per_km * mode_slope,
        resonant=np.zeros((n, c)),
        band=per_km * mode.sum(axis=1, keepdims=True),
        band_slope=per_km * mode_slope.sum(axis=1, keepdims=True),
        edges_hz=np.array([0.0, np.inf]),
        place=nothing,
        place_s=np.zeros(1),
        place_km=np.full(1, np.nan),
    )


def _of_chain(coordinates: dict[int, _Coordinates], chain: Chain) -> Floats:
    """Coordinates (r, c) at the reversals of a chain over several events."""
    width = next(iter(coordinates.values())).at(np.zeros(0, np.intp)).shape[1]
    x = np.zeros((len(chain.event), width))
    for event in np.unique(chain.event).tolist():
        of_event = chain.event == event
        x[of_event] = coordinates[event].at(chain.sample[of_event])
    return x
