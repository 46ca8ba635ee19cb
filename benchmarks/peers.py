"""Counting against `rainflow` and pyyeti on the same signals, Dirlik against FLife on the same spectra."""

import importlib
from typing import Any

import numpy as np

from benchmarks.load import RATE, aluminium, load
from benchmarks.timing import Row, best_times
from fatigue.files.extras import install_command
from fatigue.life.counting.block import BlockStress
from fatigue.life.counting.count import count
from fatigue.life.counting.record import CountedRecord
from fatigue.life.counting.rows import count_histories
from fatigue.life.counting.single.prepare import single_record
from fatigue.life.rule import CycleRule
from fatigue.spectrum.methods import dirlik_damage_rate


def counting() -> list[Row]:
    """Signal to Miner sum of 64 signals of 20 000 samples, in one call or in one call each."""
    rainflow, cyclecount = (_peer(name) for name in ("rainflow", "pyyeti.cyclecount"))
    case = load(32)
    signals = (case.S_m + case.S_b) @ case.q.astype(np.float64)
    ones, ratio, law = np.ones(32), np.zeros((32, 2)), aluminium()
    k, A = float(law.slopes[0]), float(np.exp(law.log_constants[0]))

    def pyyeti_sum() -> float:
        total = 0.0
        for s in signals:
            cycles = cyclecount.rainflow(s[cyclecount.findap(s)], use_pandas=False)
            total += float((cycles[:, 2] * (2.0 * cycles[:, 0]) ** k).sum()) / A
        return total

    def rainflow_sum() -> float:
        return sum(n * S**k for S, _, n, _, _ in rainflow.extract_cycles(signals[0].tolist())) / A

    rule = CycleRule(law, uses_bending_ratio=False)
    stress = BlockStress(np.eye(32), np.zeros((32, 32)), ones, ratio)
    q = np.ascontiguousarray(signals)
    record = CountedRecord(q, "half", single_record(q))
    # 32 points have 64 surfaces: what one surface costs is half of what a point costs
    functions = {
        "single": lambda: count(stress, record, rule),
        "double": lambda: count_histories(signals, 0.0 * signals, ones, ratio, "half", rule),
        "pyyeti": pyyeti_sum,
        "rainflow": rainflow_sum,
    }
    best = best_times(functions, 3)
    double = best["double"] / 64
    return [
        ("pyyeti / double precision counter, per signal", f"{best['pyyeti'] / 32 / double:.1f}"),
        ("rainflow / double precision counter, per signal", f"{best['rainflow'] / double:.0f}"),
        (
            "pyyeti / single precision counter, per signal (32 signals as modes)",
            f"{best['pyyeti'] / 32 / (best['single'] / 64):.1f}",
        ),
        ("rainflow / single precision counter, per signal", f"{best['rainflow'] / (best['single'] / 64):.0f}"),
    ]


def dirlik() -> list[Row]:
    """Damage of 4096 nodes from their spectral moments, against FLife on one given spectrum."""
    flife = _peer("FLife")
    f = np.linspace(0.0, RATE / 2, 4097)
    density = 30.0 * ((f > 10.0) & (f < 40.0))
    moments = np.array([np.trapezoid(f**i * density, f) for i in (0, 1, 2, 4)])
    many = moments[:, None] * np.exp(np.random.default_rng(0).normal(size=4096))
    data = flife.SpectralData(input={"PSD": density, "f": f})
    law = aluminium()
    best = best_times(
        {
            "ours": lambda: dirlik_damage_rate(many, law),
            "FLife": lambda: flife.Dirlik(data).get_life(C=1e12, k=3.6),
        },
        5,
    )
    return [
        ("Dirlik, FLife / ours, per node", f"{best['FLife'] / (best['ours'] / 4096):.0f}"),
        ("Dirlik of a million nodes from their moments", f"{1e6 * best['ours'] / 4096:.2f} s"),
    ]


def _peer(name: str) -> Any:
    """Import a package of the ``bench`` extra of the project."""
    try:
        return importlib.import_module(name)
    except ImportError as error:
        package = name.split(".", maxsplit=1)[0]
        raise SystemExit(f"{package} is missing: {install_command(package)}") from error
