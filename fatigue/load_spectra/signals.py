"""Range spectra of the coordinates themselves: every modal coordinate and unit load by itself, in its own unit."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.life.load_spectrum import (
    RangeSpectrum,
    damage_equivalent,
    no_spectrum,
    power_sums,
    range_spectrum,
    summed,
    uniform_edges,
)
from fatigue.life.mission import Plan
from fatigue.load_spectra.gathered import ALONE_HZ, MISSION
from fatigue.load_spectra.recounted import signal_cycles
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.solve.body import Body

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Signal:
    """A coordinate of the body: its column in histories, mode id (-1: none), unit load ("": none) and unit."""

    column: str
    mode: int
    unit_load: str
    unit: str


@dataclass(frozen=True, slots=True, eq=False)
class SignalSpectra:
    """Range spectra of one coordinate per km of the mission, of every event and of the mission as the last.

    Attributes
    ----------
    signal : the coordinate
    edges : (b + 1,) of the classes, common to all events [unit]
    event : names
    ranges : one for each name, the power sums with the first exponent
    cycles : sum n of each [1/km]
    power_sum : (event, x) sum n S**m for each exponent [unit**m / km]
    equivalent : (event, x) damage-equivalent range, of an event at 1 Hz, of the mission at one cycle a km [unit]
    """

    signal: Signal
    edges: Floats
    event: tuple[str, ...]
    ranges: tuple[RangeSpectrum, ...]
    cycles: Floats
    power_sum: Floats
    equivalent: Floats


def signals_of(body: Body) -> list[Signal]:
    """Coordinates of a body, in their order."""
    of = body.coordinates
    units = {load.name: load.unit for load in body.case.body.unit_load}
    numbered = zip(of.column, of.number.tolist(), of.is_mode.tolist(), of.unit_load, strict=True)
    return [
        Signal(column, mode if is_mode else -1, load, "unit of the mode" if is_mode else units[load])
        for column, mode, is_mode, load in numbered
    ]


def signal_spectra(
    signal: Signal,
    coordinate: int,
    loads: Sequence[EventLoad],
    plan: Plan,
    classes: int,
    exponents: Floats,
) -> SignalSpectra:
    """Range spectra of one coordinate, given by its place among all."""
    largest = max(float(piece.range.max(initial=0.0)) for load in loads for piece in signal_cycles(load, coordinate))
    edges = uniform_edges(0.0, largest, classes)
    ranges = [no_spectrum(classes) for _ in loads]
    cycles, power_sum = np.zeros(len(loads)), np.zeros((len(loads), len(exponents)))
    for e, load in enumerate(loads):
        for piece in signal_cycles(load, coordinate):
            ranges[e] = ranges[e] + range_spectrum(piece, edges, float(exponents[0]))
            cycles[e] += piece.count.sum()
            power_sum[e] += power_sums(piece, exponents)
    weights = np.array([one.passes_per_km for one in plan.passes])
    weighted = [of.times(weight) for of, weight in zip(ranges, weights.tolist(), strict=True)]
    alone = np.array([ALONE_HZ * load.duration for load in loads])
    equivalent = np.stack([damage_equivalent(sums, exponents, n) for sums, n in zip(power_sum, alone, strict=True)])
    total = weights @ power_sum
    return SignalSpectra(
        signal=signal,
        edges=edges,
        event=(*(load.counted.event for load in loads), MISSION),
        ranges=(*weighted, summed(weighted)),
        cycles=np.append(weights * cycles, weights @ cycles),
        power_sum=np.vstack([weights[:, None] * power_sum, total]),
        equivalent=np.vstack([equivalent, damage_equivalent(total, exponents, 1.0)]),
    )


def all_signal_spectra(
    body: Body, loads: Sequence[EventLoad], plan: Plan, classes: int, exponents: Floats
) -> Iterator[SignalSpectra]:
    """Range spectra of every coordinate, one after the other."""
    for coordinate, signal in enumerate(signals_of(body)):
        yield signal_spectra(signal, coordinate, loads, plan, classes, exponents)
