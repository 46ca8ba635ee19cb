"""Decisions from a result of a million points: beside the bare sums of stored damages that they cannot do without."""

from pathlib import Path

import numpy as np
import pandas as pd

from benchmarks.timing import Row, best_times
from fatigue.decide.whatif.change import Change, Mission
from fatigue.decide.whatif.curves import Curves, OneCurve
from fatigue.decide.whatif.forward import forward
from fatigue.decide.whatif.stored import Kind, Stored, StoredRanges
from fatigue.life.curves import catalogue, damage_law
from fatigue.life.rule import CycleRule
from fatigue.pipeline.solve.rated.rated_curves import RatedCurve

POINTS, EVENTS, WELDS = 1_000_000, 13, 20_000
RULES = {"screening": {"share_of_limit": 0.0}}


def what_if() -> list[Row]:
    """Other shares, and another load on a straight curve, of a million points and 13 events."""
    stored, weights = _stored(), np.full(EVENTS, 0.1)
    curve = catalogue()["master-aluminium"]
    rated = RatedCurve(curve, "mean-2sigma", CycleRule(damage_law(curve, "mean-2sigma", "none", 1e7), True), "actual")
    curves = Curves((OneCurve(rated, rated, 1.0, 1.0),), dict.fromkeys(stored.welds, 0))
    before = Mission(weights, 1e7, 5e5, 1.0)
    after = Mission(np.linspace(0.05, 0.15, EVENTS), 1.2e7, 5e5, 1.0)
    shares = Change(stored.names, (), before, after, np.ones(EVENTS), ())
    load = Change(stored.names, (), before, before, np.full(EVENTS, 1.1), ())
    best = best_times(
        {
            "sums": lambda: stored.per_pass @ weights,
            "shares": lambda: forward(stored, shares, curves, _none),
            "load": lambda: forward(stored, load, curves, _none),
        }
    )
    return [
        (
            f"what-if, {name}: {POINTS:,} points, {EVENTS} events",
            f"{best[name]:.2f} s, {best[name] / best['sums']:.0f} x",
        )
        for name in ("shares", "load")
    ]


def _stored() -> Stored:
    """A result in memory, all of it counted, as it is read."""
    rng = np.random.default_rng(0)
    weld = np.sort(rng.integers(0, WELDS, POINTS)).astype(np.int32)
    per_pass = 1e-9 * rng.random((POINTS, EVENTS))
    return Stored(
        folder=Path(),
        record={"rules": RULES},
        names=tuple(f"event {i}" for i in range(EVENTS)),
        welds=tuple(f"W{i}" for i in range(WELDS)),
        weld=weld,
        toe=np.ones(POINTS, dtype=np.bool_),
        counted=np.ones(POINTS, dtype=np.bool_),
        damage_per_km=per_pass @ np.full(EVENTS, 0.1),
        per_pass=per_pass,
        thickness=np.full(POINTS, 8.0),
        attachment=np.full(POINTS, np.inf),
        of_welds=pd.DataFrame(),
    )


def _none(kind: Kind) -> StoredRanges:
    """Ranges that nothing asks for."""
    raise AssertionError(kind)
