"""A channel from its raw samples to strain that can be compared: flagged, cut, calibrated, resampled, band-limited.

Filters see straight lines where samples were cut out; what is counted are the segments between them, nothing else.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.gauges.correlated.sides import Strain
from fatigue.gauges.measured.band import band_limited
from fatigue.gauges.measured.calibration_file import Calibration
from fatigue.gauges.measured.channel_file import Channel
from fatigue.gauges.measured.flags import Flags, flags_of
from fatigue.gauges.measured.rate import at_ratio
from fatigue.gauges.measured.record_files import Record
from fatigue.gauges.measured.segments import Cut, at_rate, cut_at

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Treatment:
    """What is done to both sides alike.

    Attributes
    ----------
    low_hz, high_hz : band
    rate_hz : of the simulation, to which records are brought
    bridge : longest gap of samples that becomes a line
    samples : of a record that replays the simulation, cut there and rid of its trend; None: all, as they are
    """

    low_hz: float
    high_hz: float
    rate_hz: float
    bridge: int
    samples: int | None

    def limited(self, x: Floats) -> Floats:
        """Samples (t,) at the rate of the simulation, in the band."""
        return band_limited(x, self.rate_hz, self.low_hz, self.high_hz)


@dataclass(frozen=True, slots=True, eq=False)
class Prepared:
    """One record of a channel.

    Attributes
    ----------
    record : where it is from
    raw : (t,) samples before anything but their calibration [ue], NaN where they are missing
    flags : of the samples, in their own unit
    cut : of the samples, in their own unit
    ue_per_raw : size of a raw unit [ue]
    strain : at the rate of the simulation, in the band
    """

    record: Record
    raw: Floats
    flags: Flags
    cut: Cut
    ue_per_raw: float
    strain: Strain


def prepared(record: Record, channel: Channel, calibration: Calibration, treatment: Treatment) -> Prepared:
    """One record of a channel, ready to be compared (measured_data 2.1 to 2.3)."""
    raw = record.read(channel)
    if treatment.samples is not None:
        raw = raw[: -(-treatment.samples * record.ratio.denominator // record.ratio.numerator)]
    gain = calibration.factor * channel.ue_per_unit
    full_scale = None if channel.full_scale_ue is None else channel.full_scale_ue / abs(gain)
    flags = flags_of(raw, record.rate_hz, full_scale)
    cut = cut_at(raw, flags.cut, treatment.bridge)
    offset = calibration.offset * channel.ue_per_unit
    x = at_ratio(gain * cut.x + offset, record.ratio)
    segments = at_rate(cut.segments, record.ratio.numerator, record.ratio.denominator)
    if treatment.samples is not None:
        x = x[: treatment.samples]
        segments = tuple((first, min(last, len(x) - 1)) for first, last in segments if first < len(x))
        x = without_trend(Strain(x, segments))
    return Prepared(record, gain * raw + offset, flags, cut, abs(gain), Strain(treatment.limited(x), segments))


def without_trend(strain: Strain) -> Floats:
    """Samples (t,) less the straight line through those that are counted."""
    x, at = strain.x, np.flatnonzero(strain.kept)
    if at.size < 2:
        return x
    line = np.polynomial.Polynomial.fit(at, x[at], 1)
    return np.asarray(x - line(np.arange(len(x))))


def km_run(records: Sequence[Prepared], km: Sequence[Floats]) -> tuple[float, float]:
    """Distance of the samples that are counted, and of all of them [km], from that of every sample of every record."""
    ways = [of_record[: len(one.raw)] for one, of_record in zip(records, km, strict=True)]
    kept = sum(of_record[one.cut.kept].sum() for one, of_record in zip(records, ways, strict=True))
    return float(kept), float(sum(of_record.sum() for of_record in ways))
