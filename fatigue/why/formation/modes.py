"""What every mode does in one event: its excitation, what it answers, and its quasi-static part, sample by sample.

A record that is upsampled is split on the samples of its file, and its quasi-static part is upsampled as the record
was: interpolation rings where a record does not close, and the second derivative would find nothing else there. A long
record is split in blocks of some minutes that overlap, as the excitation at an instant is of its surroundings only.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from fatigue.life.records.history import upsampled
from fatigue.life.records.spool import Samples, Spool, create_spool
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.readers.neutral.body.modes import LOWEST_HZ, Modes
from fatigue.vibration.dominant import Spectrum, dominant_hz, share_between, spectrum
from fatigue.vibration.excitation import CUT, SHORTEST, is_differentiated, quasi_static
from fatigue.vibration.resonance import HIGHEST, OFF_RESONANCE, Indicators, is_boundary, mode_classes
from fatigue.why.formation.damping import Damping
from fatigue.why.long_record import is_long

Floats = NDArray[np.float64]

FEWEST_PERIODS = 4.0  # of a mode in a record, below which neither its swing nor its load can be told
BLOCK, OVERLAP = 1 << 16, 1 << 10  # samples of a long record that are split at a time, and of its surroundings
NUMBERS_AT_ONCE = 1 << 19  # of modes that are split at a time: 4 MB, some times over

GIVEN, FINE = "quasi-static", "quasi-static-upsampled"  # files beside a long record: its quasi-static parts
MIXED, LAID, FOLLOWING = "mixed", "laid-on-mixed", "following"  # stress of a point, its damage, coordinates for a loop

STATIC = "a static load case has no time, so nothing swings in it"
NO_FREQUENCY = "a rigid mode has no natural frequency"
AT_REST = "the coordinate does not move in this event"
NO_DAMPING = "no damping ratio is known, so there is no half-power band"


@dataclass(frozen=True, slots=True, eq=False)
class ModesOfEvent:
    """What the modes do in one event; arrays are (m,), NaN where a number could not be had.

    Attributes
    ----------
    event : name
    mode_class : one of ``fatigue.vibration.resonance.CLASSES``
    rms : rms of the coordinate about its mean
    indicators : what the class follows from
    half_power_share : variance of the excitation within f (1 +- 2 zeta) over all of it
    excitation_hz, response_hz : dominant frequencies of the excitation and of the coordinate
    reason : why a number is not there, or why the class is what it is; nothing where all is there
    """

    event: str
    mode_class: NDArray[np.object_]
    rms: Floats
    indicators: Indicators
    half_power_share: Floats
    excitation_hz: Floats
    response_hz: Floats
    reason: NDArray[np.object_]


@dataclass(frozen=True, slots=True, eq=False)
class EventParts:
    """One event in its quasi-static and its dynamic part.

    Attributes
    ----------
    of_modes : what the modes do
    q : (c, t) coordinates as they are counted, in memory in double precision or long and on disk
    quasi_static : (c, t) quasi-static part of the coordinates as they are counted; unit loads are their own
    is_split : (c,) whether a coordinate has a dynamic part
    reason : why nothing could be split; empty where something was
    """

    of_modes: ModesOfEvent
    q: Samples
    quasi_static: Samples
    is_split: NDArray[np.bool_]
    reason: str

    def forget(self) -> None:
        """Remove the files of a long record that was split."""
        if isinstance(self.quasi_static, Spool) and self.quasi_static is not self.q:
            for name in (GIVEN, FINE, MIXED, LAID, FOLLOWING):
                self.quasi_static.path.with_name(name).unlink(missing_ok=True)


def event_parts(load: EventLoad, modes: Modes, damping: Damping, *, is_static: bool) -> EventParts:
    """One event in its two parts, and what the modes do in it; ``is_static``: a static load case.

    Raises
    ------
    DataError : the disk is full
    """
    counted, factor = load.counted, load.upsample
    q = counted.q if is_long(counted.q) else np.asarray(counted.q, np.float64)
    samples = -(-counted.q.shape[1] // factor)
    step = counted.step * factor
    m = len(modes.mode)
    vibrates = modes.frequency > LOWEST_HZ
    enough = samples * step * modes.frequency >= FEWEST_PERIODS
    short = is_static or samples < SHORTEST
    assessed = vibrates & enough if not short else np.zeros(m, dtype=np.bool_)
    split = assessed & is_differentiated(modes.frequency, step)
    record = _Record(q, factor, samples, step, load.mean)
    found = _statistics(record, modes, damping, assessed, split)
    reason = _reasons(modes, damping, found, assessed, split, record)
    reason[~enough & vibrates] = f"the record of {samples * step:.3g} s holds fewer than {FEWEST_PERIODS:g} periods"
    reason[~vibrates] = NO_FREQUENCY
    whole = ""
    if short:
        whole = STATIC if is_static else f"the record of {samples} samples is too short to be differentiated"
        reason[:] = whole
    of_modes = ModesOfEvent(
        event=counted.event,
        mode_class=mode_classes(found.indicators),
        rms=found.rms,
        indicators=found.indicators,
        half_power_share=found.half_power_share,
        excitation_hz=found.excitation_hz,
        response_hz=found.response_hz,
        reason=reason,
    )
    is_split = np.zeros(counted.q.shape[0], dtype=np.bool_)
    is_split[:m] = split
    if not split.any():
        return EventParts(of_modes, q, q, is_split, whole or "no mode is within the band of the record")
    return EventParts(of_modes, q, _as_counted(load, record, found.quasi_static), is_split, "")


@dataclass(frozen=True, slots=True, eq=False)
class _Record:
    """Coordinates at the samples of their file, every ``factor``-th that is counted; ``mean`` (c,) is their mean."""

    q: Samples
    factor: int
    samples: int
    step: float
    mean: Floats

    def part(self, modes: slice, first: int, end: int) -> Floats:
        """Some modes between two samples."""
        found = self.q[modes, first * self.factor : (end - 1) * self.factor + 1]
        return np.asarray(found[:, :: self.factor], np.float64)

    def blocks(self) -> list[tuple[int, int]]:
        """First and last sample of blocks; all at once of a record in memory."""
        count = max(1, self.samples // BLOCK) if is_long(self.q) else 1
        return list(pairwise(self.samples * i // count for i in range(count + 1)))

    def some_modes(self) -> Iterator[slice]:
        """Some modes after the other, that are in memory together."""
        longest = max(end - first for first, end in self.blocks())
        width = max(1, NUMBERS_AT_ONCE // longest)
        return (slice(first, first + width) for first in range(0, self.q.shape[0], width))


@dataclass(frozen=True, slots=True, eq=False)
class _Statistics:
    rms: Floats
    indicators: Indicators
    half_power_share: Floats
    excitation_hz: Floats
    response_hz: Floats
    quasi_static: Samples


def _statistics(
    record: _Record, modes: Modes, damping: Damping, assessed: NDArray[np.bool_], split: NDArray[np.bool_]
) -> _Statistics:
    """Numbers of all modes; the quasi-static parts go to a file beside a record that is in one."""
    m = len(modes.mode)
    parts = _place_for_parts(record)
    rms, dynamic, follows = (np.full(m, np.nan) for _ in range(3))
    highest, response_hz, excitation_hz, response_share, half_power = (np.full(m, np.nan) for _ in range(5))
    low, high = (modes.frequency * (1.0 + sign * 2.0 * damping.ratio) for sign in (-1.0, 1.0))
    for some in record.some_modes():
        own = slice(some.start, min(some.stop, m))
        of_q, of_qs, sums = _split_blocks(record, some, modes, damping, split, parts)
        if own.stop <= own.start:
            continue
        here = np.flatnonzero(assessed[own])
        n = own.stop - own.start
        rms[own], follows[own], dynamic[own] = (np.sqrt(values[:n]) for values in sums)
        if not len(here):
            continue
        at = own.start + here
        response, excited = (Spectrum(of.hz, of.variance[here]) for of in (of_q, of_qs))
        response_hz[at], excitation_hz[at] = dominant_hz(response), dominant_hz(excited)
        highest[at] = np.where(rms[at] > 0.0, _highest(response), np.nan)
        response_share[at] = share_between(response, low[at], high[at])
        half_power[at] = share_between(excited, low[at], high[at])
    lines = 2.0 / (record.samples * record.step)
    unresolved = ~(high - low > lines)  # no damping, too
    half_power[unresolved] = response_share[unresolved] = np.nan
    half_power[~split] = excitation_hz[~split] = np.nan
    in_resonance = np.abs(response_hz / modes.frequency - 1.0, where=modes.frequency > 0.0, out=np.full(m, np.inf))
    excitation_hz[np.isnan(damping.ratio) & (in_resonance < OFF_RESONANCE)] = np.nan
    moves = (rms > 0.0) & split
    indicators = Indicators(
        frequency_hz=modes.frequency,
        highest_hz=highest,
        dynamic_share=np.divide(dynamic, rms, out=np.full(m, np.nan), where=moves),
        amplification=np.divide(rms, follows, out=np.full(m, np.inf), where=follows > 0.0),
        response_share=response_share,
    )
    return _Statistics(rms, indicators, half_power, excitation_hz, response_hz, parts)


def _place_for_parts(record: _Record) -> Samples:
    """Where quasi-static parts go: into a file beside a record that is long and in one."""
    shape = record.q.shape[0], record.samples
    if isinstance(record.q, Spool) and is_long(record.q):
        return create_spool(record.q.path.with_name(GIVEN), shape, np.dtype(np.float64))
    return np.empty(shape)


def _split_blocks(
    record: _Record, some: slice, modes: Modes, damping: Damping, split: NDArray[np.bool_], parts: Samples
) -> tuple[Spectrum, Spectrum, list[Floats]]:
    """Split some modes block by block: spectra of coordinates and quasi-static parts, variances of all parts."""
    m = len(modes.mode)
    blocks = record.blocks()
    shortest = min(end - first for first, end in blocks)
    hz, variance, sums = np.zeros(0), np.zeros((2, 1, 0)), np.zeros((3, 2, 1))
    for first, end in blocks:
        begin, stop = max(0, first - OVERLAP), min(record.samples, end + OVERLAP)
        q = record.part(some, begin, stop)
        follows = q.copy()
        own = np.flatnonzero(split[some.start : min(some.stop, m)])
        if len(own):
            at = some.start + own
            follows[own] = quasi_static(q[own], record.step, modes.frequency[at], damping.used[at])
        q, follows = (x[:, first - begin : end - begin] for x in (q, follows))
        parts[some, first:end] = follows
        if shortest > 1:
            of = [spectrum(x[:, :shortest], record.step) for x in (q, follows)]
            hz = of[0].hz
            variance = np.stack([one.variance for one in of]) / len(blocks) + (variance if variance.size else 0.0)
        mean = record.mean[some, None]
        three = q - mean, follows - mean, q - follows
        sums = sums + np.stack([np.stack([x.sum(axis=1), np.vecdot(x, x)]) for x in three])
    variances = [np.maximum(0.0, square - mean**2) for mean, square in sums / record.samples]
    return Spectrum(hz, variance[0]), Spectrum(hz, variance[1]), variances


def _highest(of: Spectrum) -> Floats:
    """Frequency below which almost all of the variance of records lies, (n,)."""
    below = np.cumsum(of.variance, axis=-1)
    return np.asarray(of.hz[np.minimum((below < HIGHEST * below[:, -1:]).sum(axis=-1), len(of.hz) - 1)])


def _reasons(
    modes: Modes,
    damping: Damping,
    found: _Statistics,
    assessed: NDArray[np.bool_],
    split: NDArray[np.bool_],
    record: _Record,
) -> NDArray[np.object_]:
    """Why a number of a mode is not there; None where all are."""
    reason = np.full(len(modes.mode), None, dtype=object)
    reason[np.isnan(found.half_power_share)] = (
        f"the record of {record.samples * record.step:.3g} s does not resolve the half-power band"
    )
    undamped = np.isnan(damping.ratio)
    reason[undamped] = NO_DAMPING
    reason[undamped & np.isnan(found.excitation_hz)] = (
        f"{NO_DAMPING}; the mode moves within {OFF_RESONANCE:.0%} of its frequency, where its excitation depends on it"
    )
    cut = f"it is above {CUT:g} of the sampling rate, {CUT / record.step:.4g} Hz, so nothing is differentiated"
    boundary = is_boundary(found.indicators)
    reason[assessed & ~split] = f"{cut}; the motion comes near its frequency"
    reason[assessed & ~split & boundary] = f"a boundary mode: {cut}, and twice the highest frequency of its motion"
    reason[assessed & (found.rms == 0.0)] = AT_REST
    return reason


def _as_counted(load: EventLoad, record: _Record, parts: Samples) -> Samples:
    """Quasi-static parts at the samples that are counted."""
    if record.factor == 1:
        return parts
    given = replace(load.counted, q=parts, step=record.step)
    scratch = parts.path.with_name(FINE) if isinstance(parts, Spool) else None
    return upsampled(given, record.factor, load.residue, scratch).q
