"""Rows of the tables that say what makes the damage and may the frequency domain be trusted, with their columns."""

from typing import Any

import numpy as np

from fatigue.attribute import Attribution, EventAttribution
from fatigue.levers import Levers
from fatigue.life.mission import Plan, life_km
from fatigue.points import Points
from fatigue.readers.body import Modes
from fatigue.results import Column
from fatigue.tables import FACES
from fatigue.verdicts import EventVerdicts

_POINT = (
    Column("weld", "text", "-", "weld line"),
    Column("part", "int", "-", "straight part of a weld split at its kinks, from 1"),
    Column("node", "int", "-", "FE node id"),
    Column("order", "int", "-", "position along the weld line, as given"),
    Column("surface", "text", "-", "top (side of the plate normal) or bottom face of the assessed plate"),
    Column(
        "chosen",
        "text",
        "-",
        "why the point is in this table: all points are, or it is the worst of its weld, or above a share of the limit",
    ),
)

ATTRIBUTION = (
    *_POINT,
    Column("event", "text", "-", "event of the mission; every column of numbers adds up over the events"),
    Column(
        "kind",
        "text",
        "-",
        "event: the whole event; mode, band: its parts, each set adds up to the event; load: all stresses; thickness: "
        "the plate through its stress, at constant line force and moment; thickness_rule: the plate through the rule",
    ),
    Column("mode", "int", "-", "mode id, for kind mode"),
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
    Column("event", "text", "-", "event of the mission"),
    Column(
        "verdict",
        "text",
        "-",
        "may the frequency domain be trusted in this event: not_assessed, valid, or why not, first hit (sampling, "
        "quasi_static, single_event, non_stationary, harmonic, non_gaussian, bandwidth)",
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
    Column("rank", "int", "-", "1: buys most"),
    Column("mode", "int", "-", "mode id"),
    Column("frequency_hz", "float", "Hz", "natural frequency of the mode"),
    Column("kind", "text", "-", "normal, interface or rigid"),
    Column("share", "float", "-", "share of the damage owed to the mode"),
    Column("life_exponent", "float", "-", "d ln(life) / d ln(amplitude of the mode in all events)"),
    Column("life_km", "float", "km", "life as it is"),
    Column("life_km_estimated", "float", "km", "life with the mode 10 % smaller, by the exponent"),
    Column("life_km_counted", "float", "km", "the same with all cycles counted again"),
    Column("gain_km", "float", "km", "life_km_counted - life_km"),
)


def attribution_rows(modes: Modes, attribution: Attribution, event: EventAttribution) -> dict[str, Any]:
    """Rows of ``attribution.parquet`` for one event: per point the event, its modes, its bands, load and thickness."""
    points, bands = len(attribution.points), event.band.shape[1]
    of_mode = slice(1, 1 + len(modes.mode))
    of_band = slice(of_mode.stop, of_mode.stop + bands)
    kind = np.array(["event", *["mode"] * len(modes.mode), *["band"] * bands, "load", "thickness", "thickness_rule"])
    mode = np.full(len(kind), None)
    mode[of_mode] = modes.mode
    low, high = np.full((2, len(kind)), np.nan)
    low[of_band], high[of_band] = (
        event.edges_hz[:-1],
        np.where(np.isinf(event.edges_hz[1:]), np.nan, event.edges_hz[1:]),
    )

    damage = np.column_stack([event.damage, event.mode, event.band, np.full((points, 3), np.nan)])
    slope = np.column_stack(
        [event.damage, event.mode_slope, event.band_slope, event.load_slope, event.thickness_slope, event.rule_slope]
    )
    resonant = np.full(damage.shape, np.nan)
    resonant[:, of_mode] = attribution.share(event.resonant)
    return {
        **point_columns(attribution.points, len(kind)),
        "event": np.full(damage.size, event.event, dtype=object),
        "kind": np.tile(kind.astype(object), points),
        "mode": np.tile(mode, points),
        "low_hz": np.tile(low, points),
        "high_hz": np.tile(high, points),
        "damage_per_km": damage.ravel(),
        "share": attribution.share(damage).ravel(),
        "resonant_share": resonant.ravel(),
        "life_exponent": -attribution.share(slope).ravel(),
    }


def track_rows(points: Points, event: EventAttribution) -> dict[str, Any]:
    """Rows of ``track.parquet`` for one event: per point the bins of the track."""
    bins = event.place.shape[1]
    damage = event.damage[:, None]
    share = np.divide(event.place, damage, out=np.zeros_like(event.place), where=damage > 0.0)
    return {
        **point_columns(points, bins),
        "event": np.full(share.size, event.event, dtype=object),
        "start_km": np.tile(event.place_km[:-1], len(points)),
        "end_km": np.tile(event.place_km[1:], len(points)),
        "start_s": np.tile(event.place_s[:-1], len(points)),
        "end_s": np.tile(event.place_s[1:], len(points)),
        "damage_per_km": event.place.ravel(),
        "share": share.ravel(),
        "intensity": (share / event.place_length).ravel(),
    }


def diagnosis_rows(points: Points, of: EventVerdicts) -> dict[str, Any]:
    """Rows of ``diagnosis.parquet`` for one event."""
    return {
        **point_columns(points, 1),
        **of.measured,
        "event": np.full(len(points), of.event, dtype=object),
        "verdict": of.verdict,
        "reason": of.reason,
        "record_too_short": of.measured["record_too_short"] != 0.0,
        "segmentwise_ratio": of.segmentwise_ratio,
        "formula_error": of.formula,
        "process_error": of.process,
        "split_standard_error": of.standard_error,
        "explained_share": of.explained,
    }


def lever_rows(modes: Modes, plan: Plan, attribution: Attribution, levers: Levers) -> dict[str, Any]:
    """Rows of ``levers.parquet``: the modes whose reduction buys most, at the worst point of every weld."""
    ranks = levers.mode.shape[1]
    mode = levers.mode.ravel()
    life = np.repeat(life_km(attribution.damage[levers.point], plan.damage_limit), ranks)
    return {
        **point_columns(attribution.points.of(levers.point), ranks),
        "rank": np.tile(np.arange(1, ranks + 1), len(levers.point)),
        "mode": modes.mode[mode],
        "frequency_hz": modes.frequency[mode],
        "kind": np.array(modes.kind, dtype=object)[mode],
        "share": attribution.mode_share[np.repeat(levers.point, ranks), mode],
        "life_exponent": levers.exponent.ravel(),
        "life_km": life,
        "life_km_estimated": levers.life_estimated.ravel(),
        "life_km_counted": levers.life_counted.ravel(),
        "gain_km": levers.life_counted.ravel() - life,
    }


def point_columns(points: Points, repeat: int) -> dict[str, Any]:
    """Key columns of points, each ``repeat`` times."""
    surface = np.array(FACES, dtype=object)[points.face]
    key = {"weld": points.weld, "part": points.part, "node": points.node, "order": points.order, "surface": surface}
    return {name: np.repeat(column, repeat) for name, column in {**key, "chosen": points.chosen}.items()}
