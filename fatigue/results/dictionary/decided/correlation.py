"""Columns of measured strain beside the simulated one, written into a folder of their own."""

from collections.abc import Sequence
from itertools import pairwise

from fatigue.results.dictionary.column import Column

_GAUGE = Column("gauge", "text", "-", "gauge, or the gauges of a bridge with their weights")
_CHANNEL = Column("channel", "text", "-", "channel of the records")
_EVENT = Column("event", "text", "-", "event of the mission")


def band_ratio(low_hz: float, high_hz: float) -> str:
    """Name of the column of the band from ``low_hz`` to ``high_hz``.

    >>> band_ratio(20.0, 37.5)
    'band_ratio_20_37.5'
    """
    return f"band_ratio_{low_hz:g}_{high_hz:g}"


def correlation_columns(edges_hz: Sequence[float]) -> tuple[Column, ...]:
    """Columns of the table ``correlation``, with those of the bands between some edges [Hz]."""
    bands = tuple(
        Column(band_ratio(low, high), "float", "-", f"measured over simulated rms from {low:g} to below {high:g} Hz")
        for low, high in pairwise(edges_hz)
    )
    return (
        _GAUGE,
        _CHANNEL,
        _EVENT,
        Column("verdict", "text", "-", "good, fair, poor; sign, data, not_alignable where no ratio can be trusted"),
        Column("km", "float", "km", "measured distance that is counted"),
        Column("lost_km", "float", "km", "measured distance of the samples that are cut out"),
        Column("kept_share", "float", "-", "share of the samples that are counted; verdict data below 0.9"),
        Column("flags", "text", "-", "flagged samples by kind; drift is of the channel and cuts nothing"),
        Column("bridged_samples", "int", "-", "flagged samples in short gaps that a straight line stands for"),
        Column("rms_measured_ue", "float", "ue", "root mean square in the band, about the mean"),
        Column("rms_simulated_ue", "float", "ue", "the same of the simulation"),
        Column("rms_ratio", "float", "-", "measured over simulated rms"),
        *bands,
        *(
            Column(f"range_ratio_{n}_per_km", "float", "-", f"measured over simulated range reached by {n} cycles a km")
            for n in (1, 10, 100)
        ),
        Column("k", "float", "-", "exponent of the pseudo-damage: 1/h or first slope of the case's curve, or as asked"),
        Column("pseudo_damage_measured_per_km", "float", "ue^k/km", "sum n range^k of the cycles of a km"),
        Column("pseudo_damage_simulated_per_km", "float", "ue^k/km", "the same of the simulation"),
        Column("damage_ratio", "float", "-", "measured over simulated pseudo-damage per km"),
        Column("equivalent_range_ratio", "float", "-", "damage_ratio^(1/k): the verdict is on it"),
        Column("lost_share", "float", "-", "share of the simulated pseudo-damage outside the band"),
        Column("lag_s", "float", "s", "by how much the measured record is late; of aligned records"),
        Column("correlation", "float", "-", "coefficient at that lag; below 0: the signs differ"),
        Column("coherence_band", "float", "-", "share of measured power that follows the simulation linearly"),
    )


CHANNEL_FLAGS = (
    _GAUGE,
    _CHANNEL,
    Column("record", "text", "-", "file of the record"),
    Column("flag", "text", "-", "missing, stuck, clipped, spike or drift"),
    Column("first_s", "float", "s", "time of the first flagged sample, as the file has it"),
    Column("last_s", "float", "s", "time of the last one"),
    Column("samples", "int", "-", "flagged samples, one behind the other; of drift all samples of the record"),
    Column("bridged", "flag", "-", "a straight line stands for them, and they are counted"),
    Column("value_ue", "float", "ue", "the flagged value of the largest size"),
    Column(
        "distance_ue", "float", "ue", "its distance from the median of five samples; of drift, range of block medians"
    ),
)

GAUGE_EXCEEDANCE = (
    _GAUGE,
    _CHANNEL,
    _EVENT,
    Column("range_ue", "float", "ue", "range"),
    Column("measured_per_km", "float", "1/km", "measured cycles of a km with at least this range"),
    Column("simulated_per_km", "float", "1/km", "simulated ones"),
)

GAUGE_SPECTRA = (
    _GAUGE,
    _CHANNEL,
    _EVENT,
    Column("frequency_hz", "float", "Hz", "frequency"),
    Column("measured_ue2_per_hz", "float", "ue^2/Hz", "one-sided power spectral density of the measured strain"),
    Column("simulated_ue2_per_hz", "float", "ue^2/Hz", "the same of the simulated strain"),
)

CORRELATED: dict[str, tuple[Column, ...]] = {
    "correlation": correlation_columns((0.0, 2.0, 5.0, 8.0, 12.0, 20.0, 60.0)),
    "channel_flags": CHANNEL_FLAGS,
    "gauge_exceedance": GAUGE_EXCEEDANCE,
    "gauge_spectra": GAUGE_SPECTRA,
}
"""Columns of every table; the last band of ``correlation`` ends where the band of the comparison does."""
