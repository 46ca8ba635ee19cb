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
    up_crossings,
)
from fatigue.load_spectra.classes import Classes, Extent, extent_of
from fatigue.load_spectra.recounted import Counted, recounted
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
    bending_ratio : of the cycles, weighted with their damage; NaN where nothing damages
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
    bending_ratio: float

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


def extents(points: Points, loads: Sequence[EventLoad]) -> Extent:
    """How far the cycles of some points reach under all events."""
    return Extent().over(extent_of(counted.cycles) for load in loads for _, counted in recounted(points, load))


def spectra_of_points(
    points: Points, loads: Sequence[EventLoad], passes_per_km: Sequence[float], classes: Classes, given: Floats | None
) -> Iterator[list[PointSpectra]]:
    """Spectra of each point under every event, and under the mission as the last.

    ``given`` are exponents of power sums and equivalent ranges; None: the first slope of the curve of each point.
    """
    exponents = [exponents_of(points, i, given) for i in range(len(points))]
    of_events: list[list[PointSpectra]] = [[] for _ in range(len(points))]
    for load, weight in zip(loads, passes_per_km, strict=True):
        sums = [_nothing(classes, len(own)) for own in exponents]
        for i, counted in recounted(points, load):
            sums[i].add(counted, classes, exponents[i], first_slope(points, i))
        for i, own in enumerate(sums):
            cycles = ALONE_HZ * load.duration
            equivalent = damage_equivalent(own.power_sum, exponents[i], cycles)
            of_events[i].append(_of_event(own, load.counted.event, weight, equivalent, classes))
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


def _of_event(own: _Sums, event: str, weight: float, equivalent: Floats, classes: Classes) -> PointSpectra:
    """Spectra of an event per km of the mission, from those of one pass."""
    columns = len(classes.levels) - 1
    return PointSpectra(
        event=event,
        passes_per_km=weight,
        ranges=own.ranges.times(weight),
        range_mean=joined_cells(own.range_mean, columns).times(weight),
        from_to=joined_cells(own.from_to, columns).times(weight),
        crossings=weight * own.crossings,
        cycles=weight * own.cycles,
        power_sum=weight * own.power_sum,
        del_MPa=equivalent,
        del_reference=f"{ALONE_HZ:g} Hz",
        damage=weight * own.damage,
        bending_ratio=own.ratio / own.damage if own.damage > 0.0 else np.nan,
    )


def mission_of(events: Iterable[PointSpectra], exponents: Floats, classes: Classes) -> PointSpectra:
    """Sum over all events, per km of the mission."""
    every, columns = list(events), len(classes.levels) - 1
    ranges = no_spectrum(len(classes.ranges) - 1)
    for event in every:
        ranges = ranges + event.ranges
    power_sum = np.sum([event.power_sum for event in every], axis=0)
    damage = sum(event.damage for event in every)
    ratio = sum(event.damage * event.bending_ratio for event in every if event.damage != 0.0)
    return PointSpectra(
        event=MISSION,
        passes_per_km=np.nan,
        ranges=ranges,
        range_mean=joined_cells([e.range_mean for e in every if e.range_mean is not None], columns),
        from_to=joined_cells([e.from_to for e in every if e.from_to is not None], columns),
        crossings=np.sum([e.crossings for e in every if e.crossings is not None], axis=0),
        cycles=sum(event.cycles for event in every),
        power_sum=power_sum,
        del_MPa=damage_equivalent(power_sum, exponents, 1.0),
        del_reference="1 per km",
        damage=damage,
        bending_ratio=ratio / damage if damage > 0.0 else np.nan,
    )
