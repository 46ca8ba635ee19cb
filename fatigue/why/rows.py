"""Rows of the tables that say what makes the damage and whether the frequency domain may be trusted."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from fatigue.life.mission import life_km
from fatigue.pipeline.tables.rows import FACES
from fatigue.readers.neutral.body.coordinates import Coordinates
from fatigue.why.attribute import Attribution, EventAttribution
from fatigue.why.evidence import Evidence, ids
from fatigue.why.formation.rows import formation_rows
from fatigue.why.points import Points
from fatigue.why.verdicts import EventVerdicts

POINTS_AT_ONCE = 1000  # whose rows are made at a time


def rows_of_tables(evidence: Evidence) -> dict[str, Iterator[dict[str, Any]]]:
    """Rows of all tables by name, event by event, within an event block by block of points."""
    attribution, coordinates = evidence.attribution, evidence.body.coordinates
    events = range(len(evidence.plan.passes))
    firsts = range(0, len(attribution.points), POINTS_AT_ONCE)
    some = [slice(first, first + POINTS_AT_ONCE) for first in firsts]
    blocks = [(attribution.of(few), [verdict.of(few) for verdict in evidence.verdicts]) for few in some]
    and_loops = range(len(attribution.events))
    return {
        "attribution": (attribution_rows(coordinates, part, part.events[e]) for e in and_loops for part, _ in blocks),
        "track": (track_rows(block.points, block.events[e]) for e in events for block, _ in blocks),
        "diagnosis": (diagnosis_rows(block.points, judged[e]) for e in events for block, judged in blocks),
        "levers": iter([lever_rows(evidence)]),
        **formation_rows(evidence.body.modes, attribution, evidence.formation),
    }


def attribution_rows(coordinates: Coordinates, attribution: Attribution, event: EventAttribution) -> dict[str, Any]:
    """Rows of ``attribution.parquet`` for one event: per point the event, its parts, load and thickness.

    The parts are modes, unit loads and frequency bands.
    """
    points, bands = len(attribution.points), event.band.shape[1]
    of_mode = slice(1, 1 + len(coordinates))
    of_band = slice(of_mode.stop, of_mode.stop + bands)
    parts = np.where(coordinates.is_mode, "mode", "unit_load")
    whole = "sequence" if event.is_sequence else "event"
    kind = np.array([whole, *parts, *["band"] * bands, "load", "thickness", "thickness_rule"])
    mode, unit_load = np.full((2, len(kind)), None)
    mode[of_mode], unit_load[of_mode] = ids(coordinates)
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
    if not event.is_sequence:
        resonant[:, of_mode] = attribution.share(event.resonant)
    return {
        **point_columns(attribution.points, len(kind)),
        "event": np.full(damage.size, event.event, dtype=object),
        "kind": np.tile(kind.astype(object), points),
        "mode": np.tile(mode, points),
        "unit_load": np.tile(unit_load, points),
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


def lever_rows(evidence: Evidence) -> dict[str, Any]:
    """Rows of ``levers.parquet``: modes and unit loads whose reduction buys most, at the worst point of every weld."""
    coordinates, attribution, levers = evidence.body.coordinates, evidence.attribution, evidence.levers
    number, unit_load = ids(coordinates)
    frequency = np.concatenate([coordinates.modes.frequency, np.full(len(coordinates.unit_loads), np.nan)])
    ranks = levers.mode.shape[1]
    mode = levers.mode.ravel()
    life = np.repeat(life_km(attribution.damage[levers.point], attribution.points.damage_limit[levers.point]), ranks)
    return {
        **point_columns(attribution.points.of(levers.point), ranks),
        "rank": np.tile(np.arange(1, ranks + 1), len(levers.point)),
        "mode": number[mode],
        "unit_load": unit_load[mode],
        "frequency_hz": frequency[mode],
        "kind": np.array(coordinates.kind, dtype=object)[mode],
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
