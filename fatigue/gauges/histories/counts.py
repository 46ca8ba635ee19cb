"""Cycles of the strain that gauges read: range spectra, pseudo-damage, equivalent ranges; by event and for the mission.

Ranges are counted at the instants an assessment counts, with the residue of the event, and exact, never in classes.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fatigue.gauges.instrument import Floats
from fatigue.gauges.simulated import Reading
from fatigue.life.counting.rainflow import rainflow
from fatigue.life.counting.vertex import vertex_history
from fatigue.life.load_spectrum import (
    LoadCycles,
    RangeSpectrum,
    damage_equivalent,
    power_sums,
    range_spectrum,
    summed,
    uniform_edges,
)

CLASSES = 64
ALONE_HZ = 1.0  # cycles a second that the equivalent range of an event is for


@dataclass(frozen=True, slots=True, eq=False)
class Counted:
    """Cycles of g gauges in one event.

    Attributes
    ----------
    cycles : of one pass, for each gauge
    duration : of a pass [s]
    passes_per_km : of the mission [1/km]
    """

    event: str
    cycles: tuple[LoadCycles, ...]
    duration: float
    passes_per_km: float


@dataclass(frozen=True, slots=True, eq=False)
class GaugeSpectra:
    """Range spectra of one gauge; arrays are (e,) over the events.

    Attributes
    ----------
    edges : (b + 1,) of the classes, common to all events [ue]
    ranges : of each event per km of the mission [1/km]
    cycles : sum n of a pass
    largest : largest range [ue]
    power_sum : sum n r^k of a pass
    equivalent : range that does the same at one cycle a second [ue]
    weight : passes per km of the mission [1/km]
    """

    edges: Floats
    ranges: tuple[RangeSpectrum, ...]
    cycles: Floats
    largest: Floats
    power_sum: Floats
    equivalent: Floats
    weight: Floats

    @property
    def mission(self) -> RangeSpectrum:
        """Range spectrum of the mission [1/km]."""
        return summed(self.ranges)


def counted_cycles(reading: Reading, *, vertex: bool) -> tuple[LoadCycles, ...]:
    """Cycles of each gauge in one pass of an event, in ranges of strain; ``vertex``: see ``[counting] reversals``."""
    found = []
    for strain in reading.strain:
        signal = strain
        if vertex:
            recurs = reading.residue == "repeat"
            signal = vertex_history(signal, np.zeros_like(signal), 1.0, recurs=recurs).membrane
        cycles = rainflow(signal, reading.residue)
        found.append(LoadCycles(signal[cycles.start], signal[cycles.end], cycles.range, cycles.count))
    return tuple(found)


def gauge_spectra(events: Sequence[Counted], gauge: int, exponent: float) -> GaugeSpectra:
    """Range spectra of one gauge in some events, in classes of equal width up to its largest range."""
    k = np.array([exponent])
    own = [one.cycles[gauge] for one in events]
    largest = np.array([cycles.range.max(initial=0.0) for cycles in own])
    edges = uniform_edges(0.0, float(largest.max(initial=0.0)), CLASSES)
    weight = np.array([one.passes_per_km for one in events])
    sums = np.array([power_sums(cycles, k)[0] for cycles in own])
    alone = np.array([ALONE_HZ * one.duration for one in events])
    return GaugeSpectra(
        edges=edges,
        ranges=tuple(range_spectrum(c, edges, exponent).times(w) for c, w in zip(own, weight.tolist(), strict=True)),
        cycles=np.array([cycles.count.sum() for cycles in own]),
        largest=largest,
        power_sum=sums,
        equivalent=np.array([damage_equivalent(s, k, n)[0] for s, n in zip(sums[:, None], alone, strict=True)]),
        weight=weight,
    )
