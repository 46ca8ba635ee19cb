"""Rows of the tables that say how resonances form."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from fatigue.pipeline.tables.rows import FACES
from fatigue.readers.neutral.body.modes import Modes
from fatigue.why.attribute import Attribution
from fatigue.why.formation.damping import Damping
from fatigue.why.formation.formation import Formation, Watched, WeldsOfEvent
from fatigue.why.formation.modes import ModesOfEvent
from fatigue.why.points import Points


def formation_rows(modes: Modes, attribution: Attribution, of: Formation) -> dict[str, Iterator[dict[str, Any]]]:
    """Rows of all tables by name, event by event."""
    points = attribution.points.of(of.point)
    names = [event.event for event in attribution.events]
    return {
        "resonance": (resonance_rows(modes, of.damping, event) for event in of.modes),
        "weld_resonance": (weld_rows(points, name, welds) for name, welds in zip(names, of.welds, strict=False)),
        "watch": iter([watch_rows(modes, points, attribution, of)]),
    }


def resonance_rows(modes: Modes, damping: Damping, of: ModesOfEvent) -> dict[str, Any]:
    """Rows of ``resonance.parquet`` for one event: its modes."""
    return {
        "event": np.full(len(modes.mode), of.event, dtype=object),
        "mode": modes.mode,
        "frequency_hz": modes.frequency,
        "damping_ratio": damping.ratio,
        "damping_source": damping.source,
        "class": of.mode_class,
        "rms_q": of.rms,
        "dynamic_share": of.indicators.dynamic_share,
        "amplification": np.where(np.isfinite(of.indicators.amplification), of.indicators.amplification, np.nan),
        "half_power_share": of.half_power_share,
        "response_share": of.indicators.response_share,
        "excitation_hz": of.excitation_hz,
        "response_hz": of.response_hz,
        "highest_hz": of.indicators.highest_hz,
        "reason": of.reason,
    }


def weld_rows(points: Points, event: str, of: WeldsOfEvent) -> dict[str, Any]:
    """Rows of ``weld_resonance.parquet`` for one event: the worst points of the welds."""
    return {
        **_keys(points),
        "event": np.full(len(points), event, dtype=object),
        "dominant_hz": of.dominant_hz,
        "damage_per_km": of.damage,
        "damage_per_km_quasi_static": of.quasi_static,
        "damage_per_km_dynamic": of.dynamic,
        "dynamic_share": of.dynamic_share,
        "reason": np.full(len(points), of.reason or None, dtype=object),
    }


def watch_rows(modes: Modes, points: Points, attribution: Attribution, of: Formation) -> dict[str, Any]:
    """Rows of ``watch.parquet``, the costliest swing first."""
    events = attribution.events
    swings = [one.swing for one in of.watch]
    places = [_stretch(of.watch, events[swing.event].place_km, at) for at, swing in enumerate(swings)]
    times = [_stretch(of.watch, events[swing.event].place_s, at) for at, swing in enumerate(swings)]
    mode = np.array([swing.mode for swing in swings], dtype=np.int64)
    life = np.array([one.life for one in of.watch])
    without = np.array([one.life_without for one in of.watch])
    return {
        **_keys(points.of(np.array([swing.weld for swing in swings], dtype=np.int64))),
        "rank": np.arange(1, len(swings) + 1),
        "event": np.array([events[swing.event].event for swing in swings], dtype=object),
        "mode": modes.mode[mode],
        "frequency_hz": modes.frequency[mode],
        "class": np.array([of.modes[swing.event].mode_class[swing.mode] for swing in swings], dtype=object),
        "start_km": np.array([first for first, _ in places]),
        "end_km": np.array([last for _, last in places]),
        "start_s": np.array([first for first, _ in times]),
        "end_s": np.array([last for _, last in times]),
        "damage_share": 1.0 - life / without,
        "life_km": life,
        "life_km_without": without,
        "cost_km": without - life,
        "utilisation_cost": np.array([one.utilisation for one in of.watch]),
    }


def _stretch(watch: Sequence[Watched], edges: Any, at: int) -> tuple[float, float]:
    """Both edges of the place of a swing."""
    swing = watch[at].swing
    return float(edges[swing.first]), float(edges[swing.last + 1])


def _keys(points: Points) -> dict[str, Any]:
    """Key columns of points."""
    surface = np.array(FACES, dtype=object)[points.face]
    return {"weld": points.weld, "part": points.part, "node": points.node, "order": points.order, "surface": surface}
