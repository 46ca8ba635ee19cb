"""Decisions from a result of a million points: beside the bare sums of stored damages that they cannot do without."""

import tempfile
from pathlib import Path

import numpy as np
import pandas as pd

from benchmarks.long_records import measured
from benchmarks.timing import Row, best_times
from fatigue.decide.whatif.change import Change, Mission
from fatigue.decide.whatif.curves import Curves, OneCurve
from fatigue.decide.whatif.forward import forward
from fatigue.decide.whatif.stored import Kind, Stored, StoredRanges
from fatigue.life.curves import catalogue, damage_law
from fatigue.life.rule import CycleRule
from fatigue.pipeline.solve.rated.rated_curves import RatedCurve
from fatigue.synth import Size, synthesize

POINTS, EVENTS, WELDS = 1_000_000, 13, 20_000
FEW, MANY = 500, 50_000  # weld nodes of results; each has two points
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


def what_if_command() -> list[Row]:
    """The whole command, beside the same on a small result: what start-up takes, and what a point more takes."""
    cpu = {}
    with tempfile.TemporaryDirectory() as folder:
        for nodes in (FEW, MANY):
            case = synthesize(Path(folder) / f"case {nodes}", Size(nodes, 2, EVENTS, 4.0, 50.0))
            case.write_text(case.read_text().replace("[curve]", "[counting]\nupsample = 1\n[curve]"))
            result = str(Path(folder) / f"result {nodes}")
            _run(["assess", str(case), "-o", result, "--exact", "--no-report", "--exit-zero"])
            words = ["whatif", result, "--set", "load=1.1", "--exit-zero"]
            cpu[nodes] = min(_run(words) for _ in range(5))
    million = 1e6 * (cpu[MANY] - cpu[FEW]) / (2 * (MANY - FEW))
    what = f"fatigue whatif --set load=1.1, {EVENTS} events, processor time"
    return [
        (f"{what}, {2 * FEW:,} points: start-up", f"{cpu[FEW]:.2f} s"),
        (f"{what}, {2 * MANY:,} points", f"{cpu[MANY]:.2f} s"),
        (f"{what}, each million points more", f"{million:.1f} s"),
    ]


def _run(words: list[str]) -> float:
    """Processor time [s] of a command."""
    code, cpu, _, _ = measured(words)
    if code:
        raise SystemExit(f"fatigue {words[0]} ended with {code}")
    return cpu


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
