"""What is kept of the cycles of a point: of each event, and of the mission as the weighted sum of its events."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.life.load_spectrum import (
    Cells,
    RangeSpectrum,
    damage_equivalent,
    from_to,
    joined_cells,
    no_spectrum,
    power_sums,
    range_mean,
    range_spectrum,
    summed,
    up_crossings,
)
from fatigue.life.mission import Plan
from fatigue.load_spectra.classes import Classes, Extent, extent_of
from fatigue.load_spectra.recounted import Counted, recounted
from fatigue.load_spectra.sequences import loop_cycles, residues_of
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.why.points import Points

Floats = NDArray[np.float64]

MISSION = "(mission)"
ALONE_HZ = 1.0  # cycles a second that the damage-equivalent load of an event is for


@dataclass(frozen=True, slots=True, eq=False)
class PointSpectra:
    """All spectra of one point under one event, or under the mission, per km of it.

    Attributes
    ----------
    event : name, in parentheses where it is none of the case
    passes_per_km : of the event [1/km]; NaN of the mission
    ranges : range spectrum (b,) [1/km]
    range_mean, from_to : cells of both matrices [1/km]; None: not known
    crossings : (l,) up-crossings of each level [1/km]; None: not known
    cycles : sum n [1/km]
    power_sum : (x,) sum n S**m for each exponent [MPa**m / km]
    del_MPa : (x,) damage-equivalent range [MPa], and in words against what
    damage : Miner sum [1/km]
    damage_ratio : the same sum with the bending ratio of each cycle [1/km]
    """

    event: str
    passes_per_km: float
    ranges: RangeSpectrum
    range_mean: Cells | None
    from_to: Cells | None
    crossings: Floats | None
    cycles: float
    power_sum: Floats
    del_MPa: Floats  # noqa: N815
    del_reference: str
    damage: float
    damage_ratio: float

    @property
    def bending_ratio(self) -> float:
        """Bending ratio of the cycles, weighted with their damage; NaN where nothing damages in all."""
        return self.damage_ratio / self.damage if self.damage > 0.0 else np.nan

    @property
    def max_range(self) -> float:
        """Largest range in any class [MPa]; NaN without a cycle."""
        return float(np.fmax.reduce(self.ranges.largest, initial=np.nan))


@dataclass(slots=True)
class _Sums:
    """Spectra of one point in one pass, piece by piece."""

    ranges: RangeSpectrum
    range_mean: list[Cells]
    from_to: list[Cells]
    crossings: Floats
    cycles: float
    power_sum: Floats
    damage: float
    ratio: float

    def add(self, counted: Counted, classes: Classes, exponents: Floats, slope: float) -> None:
        """Add some cycles."""
        cycles, levels = counted.cycles, classes.levels
        self.ranges = self.ranges + range_spectrum(cycles, classes.ranges, slope)
        self.range_mean.append(range_mean(cycles, classes.ranges, levels))
        self.from_to.append(from_to(cycles, levels))
        self.crossings = self.crossings + up_crossings(cycles, levels)
        self.cycles += float(cycles.count.sum())
        self.power_sum = self.power_sum + power_sums(cycles, exponents)
        damage = cycles.count * counted.damage
        self.damage += float(damage.sum())
        self.ratio += float(damage @ counted.bending_ratio)


def extents(points: Points, loads: Sequence[EventLoad], plan: Plan) -> Extent:
    """How far the cycles of some points reach under all events, and across them."""
    events = Extent().over(extent_of(counted.cycles) for load in loads for _, counted in recounted(points, load))
    residues = residues_of(points, loads, plan.loops)
    return events.over(
        extent_of(loop_cycles(points, i, loop, loads, residues).cycles)
        for loop in plan.loops
        for i in range(len(points))
    )


def spectra_of_points(
    points: Points, loads: Sequence[EventLoad], plan: Plan, classes: Classes, given: Floats | None
) -> Iterator[list[PointSpectra]]:
    """Spectra of each point under every event, across the events of every loop, and under the mission as the last.

    ``given`` are exponents of power sums and equivalent ranges; None: the first slope of the curve of each point.
    """
    exponents = [exponents_of(points, i, given) for i in range(len(points))]
    of_events: list[list[PointSpectra]] = [[] for _ in range(len(points))]
    for load, one_pass in zip(loads, plan.passes, strict=True):
        sums = [_nothing(classes, len(own)) for own in exponents]
        for i, counted in recounted(points, load):
            sums[i].add(counted, classes, exponents[i], first_slope(points, i))
        for i, own in enumerate(sums):
            alone = damage_equivalent(own.power_sum, exponents[i], ALONE_HZ * load.duration), f"{ALONE_HZ:g} Hz"
            of_events[i].append(_of_event(own, (load.counted.event, one_pass.passes_per_km), alone, classes))
    residues = residues_of(points, loads, plan.loops)
    for loop in plan.loops:
        for i, exponent in enumerate(exponents):
            own = _nothing(classes, len(exponent))
            own.add(loop_cycles(points, i, loop, loads, residues), classes, exponent, first_slope(points, i))
            alone = damage_equivalent(own.power_sum, exponent, 1.0), "1 per run"
            of_events[i].append(_of_event(own, (loop.name, loop.runs_per_km), alone, classes))
    for i, events in enumerate(of_events):
        yield [*events, mission_of(events, exponents[i], classes)]


def first_slope(points: Points, i: int) -> float:
    """First slope k of the curve of a point."""
    return float(points.rule[i].law.slopes[0])


def exponents_of(points: Points, i: int, given: Floats | None) -> Floats:
    """Exponents at a point: those given, else the first slope of its curve."""
    return np.array([first_slope(points, i)]) if given is None else given


def _nothing(classes: Classes, exponents: int) -> _Sums:
    of_classes, levels = no_spectrum(len(classes.ranges) - 1), np.zeros(len(classes.levels))
    return _Sums(of_classes, [], [], levels, 0.0, np.zeros(exponents), 0.0, 0.0)


def _of_event(own: _Sums, event: tuple[str, float], alone: tuple[Floats, str], classes: Classes) -> PointSpectra:
    """Spectra of an event per km of the mission, from those of one pass.

    ``event`` is its name and its passes per km, ``alone`` its damage-equivalent range and against what.
    """
    columns = len(classes.levels) - 1
    name, weight = event
    return PointSpectra(
        event=name,
        passes_per_km=weight,
        ranges=own.ranges.times(weight),
        range_mean=joined_cells(own.range_mean, columns).times(weight),
        from_to=joined_cells(own.from_to, columns).times(weight),
        crossings=weight * own.crossings,
        cycles=weight * own.cycles,
        power_sum=weight * own.power_sum,
        del_MPa=alone[0],
        del_reference=alone[1],
        damage=weight * own.damage,
        damage_ratio=weight * own.ratio,
    )


def mission_of(events: Iterable[PointSpectra], exponents: Floats, classes: Classes) -> PointSpectra:
    """Sum over all events, per km of the mission."""
    every, columns = list(events), len(classes.levels) - 1
    power_sum = np.sum([event.power_sum for event in every], axis=0)
    damage = sum(event.damage for event in every)
    return PointSpectra(
        event=MISSION,
        passes_per_km=np.nan,
        ranges=summed([event.ranges for event in every]),
        range_mean=joined_cells([e.range_mean for e in every if e.range_mean is not None], columns),
        from_to=joined_cells([e.from_to for e in every if e.from_to is not None], columns),
        crossings=np.sum([e.crossings for e in every if e.crossings is not None], axis=0),
        cycles=sum(event.cycles for event in every),
        power_sum=power_sum,
        del_MPa=damage_equivalent(power_sum, exponents, 1.0),
        del_reference="1 per km",
        damage=damage,
        damage_ratio=sum(event.damage_ratio for event in every),
    )
