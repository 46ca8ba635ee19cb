"""Every place where samples are flagged, and the samples around it: a spike may be the largest real cycle."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.gauges.correlated.prepared import Prepared
from fatigue.gauges.measured.flags import runs

Floats = NDArray[np.float64]

DRIFT = "drift"
FLAGS = ("missing", "stuck", "clipped", "spike", DRIFT)
AROUND_S = 0.1  # of a spike that is shown
FEWEST_AROUND = 6  # samples on each side


@dataclass(frozen=True, slots=True)
class FlagRow:
    """A row of the table ``channel_flags``: neighbouring samples with one flag, or a record that drifts."""

    gauge: str
    channel: str
    record: str
    flag: str
    first_s: float
    last_s: float
    samples: int
    bridged: bool
    value_ue: float
    distance_ue: float


@dataclass(frozen=True, slots=True, eq=False)
class SpikeShown:
    """A spike with the samples around it: their times in the record (n,) [s], strain (n,) [ue], which are the spike."""

    record: str
    time: Floats
    strain: Floats
    marked: NDArray[np.bool_]
    distance: float


def flag_rows(gauge: str, channel: str, records: Sequence[Prepared]) -> Iterator[FlagRow]:
    """Rows of one channel, record after record, flag after flag."""
    for one in records:
        start, step, name = one.record.start, one.record.step, one.record.name
        kept = one.cut.kept
        for flag, mask in one.flags.masks.items():
            for first, last in runs(mask):
                value = one.raw[first : last + 1]
                yield FlagRow(
                    gauge=gauge,
                    channel=channel,
                    record=name,
                    flag=flag,
                    first_s=start + first * step,
                    last_s=start + last * step,
                    samples=last - first + 1,
                    bridged=bool(kept[first : last + 1].all()),
                    value_ue=_largest(value),
                    distance_ue=one.ue_per_raw * _largest(one.flags.distance[first : last + 1]),
                )
        if one.flags.drift.is_flagged:
            samples, drift = len(one.raw), one.ue_per_raw * one.flags.drift.range
            end = start + (samples - 1) * step
            yield FlagRow(gauge, channel, name, DRIFT, start, end, samples, False, np.nan, drift)


def flag_counts(rows: Sequence[FlagRow]) -> dict[str, int]:
    """Flagged samples of each kind, in the order in which they are looked for; of drift the records that have it."""
    counts: dict[str, int] = {}
    for row in rows:
        counts[row.flag] = counts.get(row.flag, 0) + (row.samples if row.flag != DRIFT else 1)
    return {flag: counts[flag] for flag in FLAGS if flag in counts}


def flags_in_words(rows: Sequence[FlagRow]) -> str:
    """Flagged samples of each kind, as "missing 3, drift"; "" of none."""
    return ", ".join(flag if flag == DRIFT else f"{flag} {n}" for flag, n in flag_counts(rows).items())


def spikes_shown(records: Sequence[Prepared], most: int) -> tuple[SpikeShown, ...]:
    """The largest spikes of a channel with the raw samples around them."""
    found = []
    for one in records:
        around = max(FEWEST_AROUND, round(AROUND_S * one.record.rate_hz))
        for first, last in runs(one.flags.spike):
            at = np.arange(max(0, first - around), min(len(one.raw), last + 1 + around))
            distance = one.ue_per_raw * _largest(one.flags.distance[first : last + 1])
            time = np.asarray(one.record.start + one.record.step * at, dtype=np.float64)
            found.append(SpikeShown(one.record.name, time, one.raw[at], (at >= first) & (at <= last), distance))
    return tuple(sorted(found, key=lambda spike: -spike.distance)[:most])


def _largest(values: Floats) -> float:
    """Value of the largest size, NaN of none."""
    finite = values[np.isfinite(values)]
    return float(finite[np.abs(finite).argmax()]) if finite.size else np.nan
