"""Whether a channel is what the frequency domain assumes: stationary and Gaussian."""

from dataclasses import dataclass

from fatigue.ride.channel import ChannelRecord
from fatigue.ride.flutter import NAN
from fatigue.vibration.dispersion import FEWEST_SEGMENTS, dispersion, peakedness

REJECTED = 0.01  # probability below which a ratio is not put down to chance
MOST_KURTOSIS = 4.0
LEAST_KURTOSIS = 2.0  # a sine has 1.5
MOST_CREST = 1.3  # times the expected one


@dataclass(frozen=True, slots=True)
class StationarityRow:
    """How the mean square of a channel scatters over an event, and how far it reaches beyond its rms."""

    event: str
    channel: str
    segments: int
    segment_s: float
    bandwidth_hz: float
    dispersion_ratio: float
    p: float
    kurtosis: float
    crest: float
    expected_crest: float
    assumptions: str | None
    reason: str | None


def stationarity_row(record: ChannelRecord) -> StationarityRow:
    """Dispersion test, kurtosis and crest of a channel, and whether they violate what the frequency domain assumes."""
    scatter, reach = dispersion(record.values, record.step), peakedness(record.values)
    said = []
    if reach is None:
        said.append("the channel is silent")
    elif scatter is None:
        said.append(f"the record holds fewer than {FEWEST_SEGMENTS} segments of 2 s or of 3 over its bandwidth")
    violated = False
    if scatter is not None and scatter.p < REJECTED:
        violated = True
        said.append(f"mean squares scatter {scatter.ratio:.2g} times as much as by chance (p < {REJECTED:g})")
    if reach is not None and reach.kurtosis > MOST_KURTOSIS:
        violated = True
        said.append(f"kurtosis {reach.kurtosis:.2g} above {MOST_KURTOSIS:g}")
    if reach is not None and reach.kurtosis < LEAST_KURTOSIS:
        violated = True
        said.append(f"kurtosis {reach.kurtosis:.2g} below {LEAST_KURTOSIS:g}: more of a sine, 1.5, than of noise")
    if reach is not None and reach.crest > MOST_CREST * reach.expected_crest:
        violated = True
        said.append(
            f"crest {reach.crest:.2g} above {MOST_CREST:g} times the {reach.expected_crest:.2g} of a Gaussian record"
        )
    unknown = not violated and (scatter is None or reach is None)
    return StationarityRow(
        event=record.event,
        channel=record.name,
        segments=scatter.segments if scatter else 0,
        segment_s=scatter.segment_s if scatter else NAN,
        bandwidth_hz=scatter.bandwidth_hz if scatter else NAN,
        dispersion_ratio=scatter.ratio if scatter else NAN,
        p=scatter.p if scatter else NAN,
        kurtosis=reach.kurtosis if reach else NAN,
        crest=reach.crest if reach else NAN,
        expected_crest=reach.expected_crest if reach else NAN,
        assumptions=None if unknown else "violated" if violated else "hold",
        reason="; ".join(said) or None,
    )
