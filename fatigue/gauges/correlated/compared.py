"""One channel beside its gauge: prepared, aligned if it replays the simulation, numbers, verdict, what is drawn."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.gauges.correlated.excerpts import Excerpt, aligned_excerpt, largest_excerpt
from fatigue.gauges.correlated.flag_rows import FlagRow, SpikeShown, flag_rows, flags_in_words, spikes_shown
from fatigue.gauges.correlated.numbers import Numbers, Side, compared, lost_share, side
from fatigue.gauges.correlated.prepared import Prepared, Treatment, km_run, prepared
from fatigue.gauges.correlated.sides import Strain
from fatigue.gauges.correlated.spectra import coherence_band, density, frequencies, segment_samples
from fatigue.gauges.correlated.verdict import verdict
from fatigue.gauges.measured.alignment import Alignment, aligned
from fatigue.gauges.measured.calibration_file import Calibration
from fatigue.gauges.measured.channel_file import Channel
from fatigue.gauges.measured.record_files import Distances, Record
from fatigue.life.records.history import Residue

Floats = NDArray[np.float64]

LEVELS = 100  # of range, from 0 to the largest of both sides
MOST_SPIKES = 8  # of a channel that are drawn; the table has all


@dataclass(frozen=True, slots=True)
class How:
    """How all channels are compared.

    Attributes
    ----------
    event, residue, km : of the simulation: its name, how its cycles close, distance of a pass [km]
    treatment : of both sides
    max_lag_s : within which the lag of a replayed record is looked for; None: the records are not aligned
    k, k_source : exponent of the pseudo-damage, and where it is from
    segment_s : of the spectra
    """

    event: str
    residue: Residue
    km: float
    treatment: Treatment
    max_lag_s: float | None
    k: float
    k_source: str
    segment_s: float

    @property
    def band_hz(self) -> tuple[float, float]:
        """The band of both sides."""
        return self.treatment.low_hz, self.treatment.high_hz


@dataclass(frozen=True, slots=True, eq=False)
class Drawn:
    """What figures and tables show of one channel.

    Attributes
    ----------
    frequency : (f,) [Hz]
    measured_density, simulated_density : (f,) [ue^2/Hz]
    level : (n,) ranges [ue]
    measured_reached, simulated_reached : (n,) cycles per km that reach them
    excerpts : histories around the largest cycles
    spikes : samples around the largest spikes
    """

    frequency: Floats
    measured_density: Floats
    simulated_density: Floats
    level: Floats
    measured_reached: Floats
    simulated_reached: Floats
    excerpts: tuple[Excerpt, ...]
    spikes: tuple[SpikeShown, ...]


@dataclass(frozen=True, slots=True, eq=False)
class Comparison:
    """One channel beside its gauge in one event.

    Attributes
    ----------
    channel : of the records
    numbers : measured over simulated
    km, km_lost : of the records, counted and not
    kept_share : of the samples
    bridged : samples that a line stands for, and that are counted
    lost_share : of the simulated pseudo-damage, outside the band
    alignment : of a record that replays the simulation
    coherence : share of its power that follows the simulation linearly
    verdict : word
    flags : places that are flagged
    drawn : what is shown
    """

    channel: Channel
    numbers: Numbers
    km: float
    km_lost: float
    kept_share: float
    bridged: int
    lost_share: float
    alignment: Alignment | None
    coherence: float
    verdict: str
    flags: tuple[FlagRow, ...]
    drawn: Drawn

    @property
    def said_flags(self) -> str:
        """Flagged samples by kind."""
        return flags_in_words(self.flags)


def comparison(
    channel: Channel,
    calibration: Calibration,
    records: Sequence[Record],
    distances: Distances,
    simulated: Floats,
    how: How,
) -> Comparison:
    """A channel of some records beside what its gauge reads, ``simulated`` (t,) [ue] at the rate of the simulation."""
    found = [prepared(record, channel, calibration, how.treatment) for record in records]
    km, km_all = km_run(found, distances.km)
    kept_share = sum(one.cut.kept.sum() for one in found) / sum(len(one.raw) for one in found)
    measured = side([one.strain for one in found], how.residue, km)
    x = simulated[: how.treatment.samples]
    whole = Strain(x, ((0, len(x) - 1),))
    reference = side([Strain(how.treatment.limited(x), whole.segments)], how.residue, how.km * len(x) / len(simulated))
    numbers = compared(measured, reference, how.treatment.rate_hz, how.band_hz, how.k)
    alignment, coherence = _alignment(measured, reference, how)
    correlation = None if alignment is None else alignment.correlation
    return Comparison(
        channel=channel,
        numbers=numbers,
        km=km,
        km_lost=km_all - km,
        kept_share=float(kept_share),
        bridged=sum(one.cut.bridged for one in found),
        lost_share=lost_share(whole, reference, how.residue, how.k),
        alignment=alignment,
        coherence=coherence,
        verdict=verdict(numbers.equivalent_range_ratio, float(kept_share), correlation),
        flags=tuple(flag_rows(channel.gauge, channel.name, found)),
        drawn=_drawn(found, measured, reference, alignment, how),
    )


def _alignment(measured: Side, simulated: Side, how: How) -> tuple[Alignment | None, float]:
    """How the one record that replays the simulation lies on it, and its coherence with it."""
    if how.max_lag_s is None:
        return None, np.nan
    rate_hz, (one,), (other,) = how.treatment.rate_hz, measured.records, simulated.records
    found = aligned(one.x, other.x, rate_hz, how.max_lag_s, one.kept)
    length = segment_samples([one, other], rate_hz, how.segment_s)
    return found, coherence_band(one, other, found, rate_hz, length, how.band_hz)


def _drawn(found: Sequence[Prepared], measured: Side, simulated: Side, alignment: Alignment | None, how: How) -> Drawn:
    rate_hz = how.treatment.rate_hz
    length = segment_samples([*measured.records, *simulated.records], rate_hz, how.segment_s)
    frequency = frequencies(rate_hz, length)
    of_measured, of_simulated = (density(one.records, rate_hz, length) for one in (measured, simulated))
    inside = (frequency >= how.band_hz[0]) & (frequency < how.band_hz[1])
    tops = [one.cycles.range[0] for one in (measured, simulated) if one.cycles.range.size]
    level = np.linspace(0.0, max(tops, default=1.0), LEVELS + 1)[1:]
    if alignment is None:
        both = [largest_excerpt(one, rate_hz) for one in (measured, simulated)]
        excerpts = tuple(Excerpt(name, *one) for name, one in zip(("measured", "simulated"), both, strict=True) if one)
    else:
        excerpts = aligned_excerpt(measured, simulated, alignment, rate_hz)
    return Drawn(
        frequency=frequency[inside],
        measured_density=of_measured[inside],
        simulated_density=of_simulated[inside],
        level=level,
        measured_reached=measured.cycles.reached(level),
        simulated_reached=simulated.cycles.reached(level),
        excerpts=excerpts,
        spikes=spikes_shown(found, MOST_SPIKES),
    )
