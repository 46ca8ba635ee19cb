"""Columns of the load spectra: ranges, means, reversals, levels and equivalent ranges of chosen points."""

from fatigue.results.dictionary.column import POINT, Column

_EVENT = Column(
    "event",
    "text",
    "-",
    "event of the mission; (sequence 1): cycles across events, those replaced below 0; (mission): all of these; "
    "(measured): the spectrum given for comparison",
)
_PER_KM = "cycles per km of the mission: passes_per_km of the event times those of one pass"
_REACHED = "cycles of this range and more in 1e6 km of the mission"

SPECTRUM = (
    *POINT,
    _EVENT,
    Column("lower_MPa", "float", "MPa", "smallest structural stress range of the class"),
    Column("upper_MPa", "float", "MPa", "end of the class, which belongs to the next one, or to the last"),
    Column("count_per_km", "float", "1/km", _PER_KM),
    Column("power_sum_per_km", "float", "MPa^k/km", "sum n S^k of the ranges themselves, k the curve's first slope"),
    Column("max_MPa", "float", "MPa", "largest range in the class; empty where there is none"),
    Column("exceedance_per_1e6_km", "float", "-", f"{_REACHED}: S >= lower_MPa"),
)

RANGE_MEAN = (
    *POINT,
    _EVENT,
    Column("range_lower_MPa", "float", "MPa", "class of the structural stress range: from"),
    Column("range_upper_MPa", "float", "MPa", "class of the structural stress range: to"),
    Column("mean_lower_MPa", "float", "MPa", "class of the mean of the two reversals, constants included: from"),
    Column("mean_upper_MPa", "float", "MPa", "class of the mean of the two reversals, constants included: to"),
    Column("count_per_km", "float", "1/km", f"{_PER_KM}; cells without cycles have no row"),
)

FROM_TO = (
    *POINT,
    _EVENT,
    Column("from_lower_MPa", "float", "MPa", "class of the first reversal in time, constants included: from"),
    Column("from_upper_MPa", "float", "MPa", "class of the first reversal in time, constants included: to"),
    Column("to_lower_MPa", "float", "MPa", "class of the second reversal in time, constants included: from"),
    Column("to_upper_MPa", "float", "MPa", "class of the second reversal in time, constants included: to"),
    Column("count_per_km", "float", "1/km", f"{_PER_KM}; cells without cycles have no row"),
)

LEVEL_CROSSINGS = (
    *POINT,
    _EVENT,
    Column("level_MPa", "float", "MPa", "level u of the structural stress, constants included"),
    Column(
        "up_crossings_per_km",
        "float",
        "1/km",
        "crossings upwards per km of the mission; of an event counted half, half of the crossings in both directions",
    ),
)

EQUIVALENT = (
    *POINT,
    _EVENT,
    Column("exponent", "float", "-", "m: the curve's first slope unless given"),
    Column(
        "equivalent_range_2e6_MPa",
        "float",
        "MPa",
        "(target_km x sum n S^m / 2e6)^(1/m); empty where a sequence takes away more than it adds",
    ),
    Column("equivalent_amplitude_2e6_MPa", "float", "MPa", "half of equivalent_range_2e6_MPa"),
    Column("del_MPa", "float", "MPa", "damage-equivalent range (sum n S^m / N_eq)^(1/m), N_eq as del_reference says"),
    Column(
        "del_reference",
        "text",
        "-",
        "1 Hz: N_eq is the duration of one pass times 1 Hz, for its cycles; 1 per run: one cycle, for those of a run "
        "of the sequence; 1 per km: one cycle, for those of a km",
    ),
    Column("power_sum_per_km", "float", "MPa^m/km", "sum n S^m per km of the mission"),
    Column("cycles_per_km", "float", "1/km", "cycles per km of the mission"),
    Column("passes_per_km", "float", "1/km", "of the event, or runs of the sequence; empty for the rest"),
    Column("max_range_MPa", "float", "MPa", "largest structural stress range; empty where nothing varies"),
    Column("damage_per_km", "float", "1/km", "Miner sum per km of the mission, on the curve of the point"),
    Column(
        "bending_ratio",
        "float",
        "-",
        "of the damage: the ratios of the cycles weighted with their damage; of (measured): the one its damage is with",
    ),
)

SIGNALS = (
    Column("signal", "text", "-", "coordinate: q_<mode> or u_<unit load>"),
    Column("mode", "int", "-", "mode id; empty for a unit load"),
    Column("unit_load", "text", "-", "unit load; empty for a mode"),
    Column("unit", "text", "-", "of the ranges of this signal"),
    Column("event", "text", "-", "event of the mission; (mission): all of them, without cycles across events"),
    Column("lower", "float", "as unit", "smallest range of the class; one set of classes for each signal"),
    Column("upper", "float", "as unit", "end of the class, which belongs to the next one, or to the last"),
    Column("count_per_km", "float", "1/km", _PER_KM),
    Column("exponent", "float", "-", "m of the power sum: the first given, else the first slope of the case's curve"),
    Column("power_sum_per_km", "float", "unit^m/km", "sum n S^m of the ranges themselves"),
    Column("largest", "float", "as unit", "largest range in the class; empty where there is none"),
    Column("exceedance_per_1e6_km", "float", "-", f"{_REACHED}: S >= lower"),
)

LOAD_SPECTRA: dict[str, tuple[Column, ...]] = {
    "spectrum": SPECTRUM,
    "range_mean": RANGE_MEAN,
    "from_to": FROM_TO,
    "level_crossings": LEVEL_CROSSINGS,
    "equivalent": EQUIVALENT,
    "signals": SIGNALS,
}
