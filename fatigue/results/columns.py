"""The data dictionary: every column of every result table with its type, unit and meaning."""

from fatigue.results.dictionary.bench import BENCHED
from fatigue.results.dictionary.checks import CHECKED
from fatigue.results.dictionary.column import POINT as _POINT
from fatigue.results.dictionary.column import Column
from fatigue.results.dictionary.decided.band import BAND
from fatigue.results.dictionary.load_spectra import LOAD_SPECTRA
from fatigue.results.dictionary.nodes import NODES
from fatigue.results.dictionary.resonance import FORMED
from fatigue.results.dictionary.ride import RIDDEN
from fatigue.results.dictionary.sensitivity import SENSITIVITY
from fatigue.results.dictionary.shift import SHIFTED
from fatigue.results.dictionary.welds import WELDS

DAMAGE = (
    *_POINT,
    Column(
        "event",
        "text",
        "-",
        "event of the mission; (sequence 1) and so on: what one run of that order of events adds to their passes",
    ),
    Column(
        "damage_per_km",
        "float",
        "1/km",
        "Miner sum per km of this event; empty for an event counted by number and for a sequence",
    ),
    Column(
        "damage_per_pass",
        "float",
        "-",
        "Miner sum of one pass of the simulated record; of one run of a sequence, less what its events have already: "
        "may be negative",
    ),
    Column("damage_dirlik_per_km", "float", "1/km", "Dirlik's estimate with the one bending ratio"),
    Column("damage_tb_per_km", "float", "1/km", "Tovo-Benasciutti 2005 with the one bending ratio"),
    Column("damage_tb_whole_per_km", "float", "1/km", "Tovo-Benasciutti of the spectrum up to half the sampling rate"),
    Column("damage_same_ratio_per_km", "float", "1/km", "rainflow with the one bending ratio"),
    Column("damage_dirlik_per_pass", "float", "-", "Dirlik's estimate of one pass; empty without a spectrum"),
    Column("damage_tb_per_pass", "float", "-", "Tovo-Benasciutti 2005 of one pass; empty without a spectrum"),
    Column(
        "damage_tb_whole_per_pass",
        "float",
        "-",
        "Tovo-Benasciutti of the spectrum up to half the sampling rate: what it has more comes from above upper_hz",
    ),
    Column("damage_same_ratio_per_pass", "float", "-", "rainflow with the one bending ratio of one pass"),
    Column("cycles_per_km", "float", "1/km", "counted cycles per km"),
    Column("cycles_per_pass", "float", "-", "counted cycles of one pass; of a sequence the difference it makes"),
    Column("max_range_MPa", "float", "MPa", "largest structural stress range"),
    Column(
        "max_equivalent_range_dS",
        "float",
        "MPa mm^-0.222",
        "largest equivalent range (MPa on curves in structural stress)",
    ),
    Column("bending_ratio", "float", "-", "std(sigma_b) / (std(sigma_m) + std(sigma_b)) over the kept samples"),
    Column("mean_stress_MPa", "float", "MPa", "time mean of the structural stress, constants included"),
    Column("kurtosis", "float", "-", "Pearson kurtosis of the structural stress, 3 for a Gaussian record"),
    Column("irregularity", "float", "-", "alpha_2 = zero up-crossings / peaks, from the spectral moments"),
    Column("outside_share", "float", "-", "share of the variance of the spectrum that lies above upper_hz"),
    Column(
        "peaks_per_s",
        "float",
        "1/s",
        "nu_p = sqrt(m4 / m2) of the spectrum up to half the sampling rate; an outside_share below 1e-4 is left out",
    ),
    Column("samples_per_peak", "float", "-", "sampling rate of the counted record / nu_p"),
    Column(
        "verdict",
        "text",
        "-",
        "may the frequency domain be trusted in this event: see dirlik_verdict of the nodes table",
    ),
)

CYCLES = (
    *_POINT,
    Column("event", "text", "-", "event of the mission, or the sequence of which it is a cycle across events"),
    Column("start_event", "text", "-", "event of the first reversal of a cycle of a sequence; else empty"),
    Column("end_event", "text", "-", "event of the second reversal of a cycle of a sequence; else empty"),
    Column("start_s", "float", "s", "file time of the first reversal"),
    Column("end_s", "float", "s", "file time of the second reversal; before start_s: the cycle wraps past the end"),
    Column("range_MPa", "float", "MPa", "structural stress range"),
    Column("mean_MPa", "float", "MPa", "mean of the two reversals, constants included"),
    Column(
        "count",
        "float",
        "-",
        "1: cycle, 0.5: half cycle; negative: a cycle of a single event that the sequence replaces",
    ),
    Column("membrane_range_MPa", "float", "MPa", "membrane stress range between the same two instants"),
    Column("bending_range_MPa", "float", "MPa", "bending stress range between the same two instants"),
    Column("bending_ratio", "float", "-", "bending / (membrane + bending) range"),
    Column("equivalent_range_dS", "float", "MPa mm^-0.222", "equivalent range (MPa on curves in structural stress)"),
    Column("damage", "float", "-", "count / cycles to failure at this range"),
)

_COMPONENTS = (
    ("membrane_MPa", "membrane stress"),
    ("bending_MPa", "bending stress of the top face"),
    ("in_plane_shear_MPa", "in-plane shear stress, mean"),
    ("twist_shear_MPa", "in-plane shear stress of the top face from the twisting moment"),
    ("transverse_shear_MPa", "transverse shear stress, mean"),
)

STRUCTURAL_STRESS = (
    Column("weld", "text", "-", "weld line"),
    Column("part", "int", "-", "straight part of a weld split at its kinks, from 1"),
    Column("order", "int", "-", "position along the weld line, as given"),
    Column("node", "int", "-", "FE node id"),
    Column("mode", "int", "-", "mode id, empty of a unit load"),
    Column("unit_load", "text", "-", "name of the unit load, empty of a mode"),
    *(
        Column(name, "float", "MPa", f"{meaning}, per unit of the coordinate, ends treated")
        for name, meaning in _COMPONENTS
    ),
    *(
        Column(name.replace("_MPa", "_raw_MPa"), "float", "MPa", f"{meaning}, per unit of the coordinate, as solved")
        for name, meaning in _COMPONENTS
    ),
)

HISTOGRAM = (
    *_POINT,
    Column("event", "text", "-", "event of the mission, or (sequence 1): cycles across events, those replaced below 0"),
    Column("kind", "text", "-", "of which range: S, structural stress; dS, equivalent range, the one of the damage"),
    Column(
        "bin",
        "int",
        "-",
        "class b of ranges from 10^(b/64 - 3) to 10^((b+1)/64 - 3) [MPa, or MPa mm^-0.222 for dS]; the first begins at "
        "0, the last, 511, has no end; only classes with cycles",
    ),
    Column("count_per_pass", "float", "-", "sum n: cycles of one pass in this class"),
    Column(
        "power_sum_per_pass",
        "float",
        "MPa^k",
        "sum n x^k of their ranges x, k the first slope of the curve; in double precision",
    ),
)

_CHOSEN = Column(
    "chosen",
    "text",
    "-",
    "why the point is in this table: all points are, or it is the worst of its weld, or above a share of the limit",
)

ATTRIBUTION = (
    *_POINT,
    _CHOSEN,
    Column("event", "text", "-", "event of the mission; every column of numbers adds up over the events"),
    Column(
        "kind",
        "text",
        "-",
        "event: the whole event; sequence: what a sequence adds to its events; mode with unit_load, and band: its "
        "parts, each set adds up to it; load: all stresses; thickness: the plate through its stress, at constant line "
        "force and moment; thickness_rule: the plate through the rule",
    ),
    Column("mode", "int", "-", "mode id, for kind mode"),
    Column("unit_load", "text", "-", "name of the unit load, for kind unit_load"),
    Column("low_hz", "float", "Hz", "lower edge, for kind band"),
    Column("high_hz", "float", "Hz", "upper edge, for kind band; empty: no upper edge"),
    Column(
        "damage_per_km",
        "float",
        "1/km",
        "damage owed to it per km of the mission, below 0 where it relieves; empty for load and thickness",
    ),
    Column("share", "float", "-", "the same over the damage of the point in all events"),
    Column(
        "resonant_share",
        "float",
        "-",
        "part of share in resonance, within f (1 +- 2 zeta) of the mode; empty without damping ratio",
    ),
    Column(
        "life_exponent",
        "float",
        "-",
        "d ln(life) / d ln of the amplitude, the number of passes of the event, the load or the thickness",
    ),
)

TRACK = (
    *_POINT,
    _CHOSEN,
    Column("event", "text", "-", "event of the mission"),
    Column("start_km", "float", "km", "from the first kept sample; empty for an event counted by number"),
    Column("end_km", "float", "km", "end of the bin; empty for an event counted by number"),
    Column("start_s", "float", "s", "file time at the start of the bin"),
    Column("end_s", "float", "s", "file time at the end of the bin"),
    Column("damage_per_km", "float", "1/km", "damage of the bin per km of the mission; half a cycle at either instant"),
    Column("share", "float", "-", "the same over the damage of the point in this event"),
    Column("intensity", "float", "-", "share over the part of the event that the bin is long; 1: as the average"),
)

DIAGNOSIS = (
    *_POINT,
    _CHOSEN,
    Column("event", "text", "-", "event of the mission"),
    Column(
        "verdict",
        "text",
        "-",
        "may the frequency domain be trusted in this event: not_assessed, valid, or why not, first hit (outside_band, "
        "sampling, quasi_static, single_event, non_stationary, harmonic, non_gaussian, bandwidth)",
    ),
    Column("reason", "text", "-", "the verdict in words, with its numbers"),
    Column("record_too_short", "flag", "-", "the damage scatters by more than 25 % from record to record, or unknown"),
    Column(
        "damage_cov", "float", "-", "coefficient of variation of the damage from one record of this length to the next"
    ),
    Column("dirlik_ratio", "float", "-", "D_dirlik / D_rainflow of the event, one bending ratio in both"),
    Column("tb_ratio", "float", "-", "D_tovo_benasciutti / D_rainflow"),
    Column("ratio_low", "float", "-", "from here on the ratio means agreement"),
    Column("ratio_high", "float", "-", "up to here the ratio means agreement"),
    Column(
        "segmentwise_ratio", "float", "-", "Dirlik summed over periods / D_rainflow, where the event is not stationary"
    ),
    Column(
        "formula_error", "float", "-", "A of the ratio A B: Dirlik / rainflow of Gaussian surrogates; governing points"
    ),
    Column("process_error", "float", "-", "B of the ratio A B: rainflow of the surrogates / of the record"),
    Column("split_standard_error", "float", "-", "of ln A and of ln B"),
    Column("explained_share", "float", "-", "share of ln B that the modulation and the tones found explain"),
    Column("alpha2", "float", "-", "irregularity m2 / sqrt(m0 m4)"),
    Column("outside_share", "float", "-", "of the variance of the spectrum, above upper_hz"),
    Column("missed_damage", "float", "-", "of the damage by Tovo-Benasciutti of the whole spectrum, above upper_hz"),
    Column("missed_limit", "float", "-", "share of the damage that may be missed"),
    Column("samples_per_peak", "float", "-", "sampling rate of the counted record over the rate of peaks"),
    Column("peaks_over_top_mode", "float", "-", "rate of peaks over the highest frequency of a normal mode"),
    Column("slow_share", "float", "-", "of the variance, slower than the record can hold ten cycles of"),
    Column("top_cycle_share", "float", "-", "of the damage, in the one most damaging cycle"),
    Column("top_cycle_limit", "float", "-", "share that chance allows"),
    Column("modulation_index", "float", "-", "scatter of the variance over time / scatter by chance"),
    Column("modulation_low", "float", "-", "below, the stress is steadier than chance"),
    Column("modulation_high", "float", "-", "above, the stress is not stationary"),
    Column("modulation_factor", "float", "-", "damage that the modulation found adds"),
    Column("line_share", "float", "-", "of the variance, in tones"),
    Column("line_factor", "float", "-", "damage of tones plus noise / of noise of the same variance"),
    Column("kurtosis", "float", "-", "Pearson kurtosis of the stress, 3 for a Gaussian record"),
    Column("expected_kurtosis", "float", "-", "of a Gaussian record with the modulation found"),
    Column("kurtosis_tolerance", "float", "-", "difference that chance allows"),
    Column("bandwidth_hz", "float", "Hz", "statistical bandwidth: the variance over T scatters by 1 / sqrt(T B)"),
    Column("relative_bandwidth", "float", "-", "the same over the rate of zero crossings"),
)

LEVERS = (
    *_POINT,
    _CHOSEN,
    Column("rank", "int", "-", "1: buys most"),
    Column("mode", "int", "-", "mode id, empty of a unit load"),
    Column("unit_load", "text", "-", "name of the unit load, empty of a mode"),
    Column("frequency_hz", "float", "Hz", "natural frequency of the mode, empty of a unit load"),
    Column("kind", "text", "-", "normal, interface, rigid or unit_load"),
    Column("share", "float", "-", "share of the damage owed to it"),
    Column("life_exponent", "float", "-", "d ln(life) / d ln(its amplitude in all events)"),
    Column("life_km", "float", "km", "life as it is"),
    Column("life_km_estimated", "float", "km", "life with it 10 % smaller, by the exponent"),
    Column("life_km_counted", "float", "km", "the same with all cycles counted again"),
    Column("gain_km", "float", "km", "life_km_counted - life_km"),
)


ASSESSED: dict[str, tuple[Column, ...]] = {
    "nodes": NODES,
    "damage": DAMAGE,
    "cycles": CYCLES,
    "structural_stress": STRUCTURAL_STRESS,
    "welds": WELDS,
}
DIAGNOSED: dict[str, tuple[Column, ...]] = {
    "attribution": ATTRIBUTION,
    "track": TRACK,
    "diagnosis": DIAGNOSIS,
    "levers": LEVERS,
}
OPTIONAL: dict[str, tuple[Column, ...]] = {"histogram": HISTOGRAM, "band": BAND, "sensitivity": SENSITIVITY, **CHECKED}
"""Tables of an assessment that older versions do not write, or only one that asks for them does."""
TABLES = ASSESSED | OPTIONAL | DIAGNOSED | FORMED | LOAD_SPECTRA | BENCHED | RIDDEN | SHIFTED

_SHEAR = ("shear_required", "multiaxial_status", "multiaxial_bound", "multiaxial_verdict")
_SUMS = ("utilisation_path_range", "utilisation_path_length", "utilisation_path_mlp", "utilisation_asme")
_PATH = ("path_factor_largest", "path_moment_largest")
_CURVE = ("curve_status", "edition", "attachment_mm", "damage_limit")
_CHECKS = ("worst_check", "worst_check_utilisation")
_QUALITY = ("joint_type", "performance_class", "inspection_class", "stress_utilisation", "stress_category")
_UNIT_LOAD: dict[str, int | None] = {"unit_load": None}
NOT_IN_OLDER: dict[str, dict[str, int | None]] = {
    "nodes": dict.fromkeys(("curve_status", *_SHEAR, *_SUMS, *_PATH)),
    "welds": dict.fromkeys((*_CURVE, *_CHECKS, *_QUALITY)) | {"checks_not_assessed": 0},
    "attribution": _UNIT_LOAD,
    "track": _UNIT_LOAD,
    "levers": _UNIT_LOAD,
}
"""Columns that tables of older versions lack, and what is read in their place: nothing, or the number of none."""
