"""The numbers of one gauge: measured over simulated strain in one event (measured_data 2.4)."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from fatigue.gauges.correlated.sides import Counted, Strain, counted, rms
from fatigue.gauges.measured.band import band_edges, in_bands
from fatigue.life.records.history import Residue

Floats = NDArray[np.float64]
EMPTY = 1e-4  # of the root mean square of the whole: a band that holds no more is empty
PER_KM = (1, 10, 100)  # how often the ranges are reached that are compared


@dataclass(frozen=True, slots=True, eq=False)
class Side:
    """Strain of one side in the band, its cycles, and the distance that they were counted over [km]."""

    records: tuple[Strain, ...]
    cycles: Counted
    km: float

    def pseudo_damage(self, k: float) -> float:
        """``sum n range^k`` per km [ue^k/km]; NaN where nothing is counted."""
        return self.cycles.pseudo_damage(k) if any(record.segments for record in self.records) else np.nan


@dataclass(frozen=True, slots=True)
class Numbers:
    """Measured over simulated; NaN where one of them has none.

    Attributes
    ----------
    rms_measured, rms_simulated : root mean square [ue]
    band_ratios : of the root mean square in bands, by their edges [Hz]
    range_ratios : of the ranges reached so often in a km
    damage_measured, damage_simulated : pseudo-damage ``sum n range^k`` per km [ue^k/km]
    k : its exponent
    """

    rms_measured: float
    rms_simulated: float
    band_ratios: dict[tuple[float, float], float]
    range_ratios: dict[int, float]
    damage_measured: float
    damage_simulated: float
    k: float

    @property
    def rms_ratio(self) -> float:
        """Measured over simulated root mean square."""
        return ratio(self.rms_measured, self.rms_simulated)

    @property
    def damage_ratio(self) -> float:
        """Measured over simulated pseudo-damage per km."""
        return ratio(self.damage_measured, self.damage_simulated)

    @property
    def equivalent_range_ratio(self) -> float:
        """Constant range that does the measured over that which does the simulated damage."""
        return float(self.damage_ratio ** (1.0 / self.k))


def side(records: Sequence[Strain], residue: Residue, km: float) -> Side:
    """One side with its cycles counted."""
    return Side(tuple(records), counted(tuple(records), residue, km), km)


def compared(measured: Side, simulated: Side, rate_hz: float, band_hz: tuple[float, float], k: float) -> Numbers:
    """Numbers of two sides at one sampling rate, in one band."""
    edges = band_edges(*band_hz)
    rms_of_bands = [band_rms(one.records, rate_hz, edges) for one in (measured, simulated)]
    bands = {band: ratio(*both) for band, *both in zip(pairwise(edges), *rms_of_bands, strict=True)}
    ranges = {n: ratio(measured.cycles.range_exceeded(n), simulated.cycles.range_exceeded(n)) for n in PER_KM}
    return Numbers(
        rms_measured=rms(measured.records),
        rms_simulated=rms(simulated.records),
        band_ratios=bands,
        range_ratios=ranges,
        damage_measured=measured.pseudo_damage(k),
        damage_simulated=simulated.pseudo_damage(k),
        k=k,
    )


def lost_share(simulated: Strain, limited: Side, residue: Residue, k: float) -> float:
    """Share of the simulated pseudo-damage that the band leaves out: ``1 - D(B(sim)) / D(sim)`` (measured_data 2.2)."""
    whole = counted((simulated,), residue, limited.km).pseudo_damage(k)
    return 1.0 - ratio(limited.cycles.pseudo_damage(k), whole)


def ratio(measured: float, simulated: float) -> float:
    """Measured over simulated; infinite over nothing, NaN of nothing over nothing.

    >>> ratio(1.0, 2.0), ratio(1.0, 0.0), ratio(0.0, 0.0)
    (0.5, inf, nan)
    """
    if simulated == 0.0:
        return np.inf if measured > 0.0 else np.nan
    return measured / simulated


def band_rms(records: Sequence[Strain], rate_hz: float, edges_hz: Sequence[float]) -> list[float]:
    """Root mean square of what is counted in every band between neighbouring edges [ue]; 0 of an empty one."""
    signals = [in_bands(one.x, rate_hz, edges_hz) for one in records]
    parts = zip(*signals, strict=True)
    found = [rms(tuple(Strain(x, one.segments) for x, one in zip(part, records, strict=True))) for part in parts]
    least = EMPTY * rms(tuple(records))
    return [0.0 if value < least else value for value in found]
