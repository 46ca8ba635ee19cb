"""Small cases in four curves, with and without a sequence; what a change makes of them when all is assessed again."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd

from fatigue.assess import assess
from tests.small_case import SmallCase, small_case

CURVES: dict[str, dict[str, object]] = {
    "straight": {"name": "master-aluminium"},
    "haibach": {"name": "master-aluminium", "extension": "haibach"},
    "cutoff": {"name": "master-aluminium", "extension": "cutoff"},
    "structural": {"name": "own"},
}
OWN = """
[curves.own]
slopes = [3.0, 5.0]
knees_cycles = [1e7]
range_at_2e6_MPa = 60.0
log10_scatter = 0.2
applies = "structural"
source = "test"
"""
SEQUENCE = """
[[mission.sequence]]
order = ["sine", "noise", "sine"]
per_1000_km = 20.0
"""
Mutation = Callable[[SmallCase], SmallCase]


def base_case(curve: str, *, sequence: bool = False) -> SmallCase:
    """The small case with a plate of 5 mm, an offset between its events, and static parts of the load."""
    case = small_case(seconds=4.0)
    case.histories["sine"] = case.histories["sine"].assign(q_1=lambda t: t.q_1 + 25.0)
    case.curve = dict(CURVES[curve])
    case.extra = OWN + (SEQUENCE if sequence else "")
    case.mission = {"target_km": 2e3, "km_per_year": 1e3, "damage_limit": 1.0}
    return case


def changed(case: SmallCase, mutate: Mutation) -> SmallCase:
    """A copy of a case, changed."""
    events = [dict(event) for event in case.events]
    copied = replace(case, curve=dict(case.curve), mission=dict(case.mission), events=events)
    return mutate(copied)


def run(case: SmallCase, folder: Path, **how: object) -> Path:
    """Result folder of a case, written and assessed."""
    path = case.write(folder / "case")
    how = {"histogram": "all"} | how
    assess(path, folder / "result", report=False, threads=1, verification=tuple, **how)
    return folder / "result"


def nodes_of(result: Path) -> pd.DataFrame:
    """Points of a result."""
    return pd.read_parquet(result / "nodes.parquet")


def event(name: str, **keys: object) -> Mutation:
    """Keys of an event, None: left out."""

    def mutate(case: SmallCase) -> SmallCase:
        for one in case.events:
            if one["name"] == name:
                one.update(keys)
                for key in [key for key, value in keys.items() if value is None]:
                    del one[key]
        return case

    return mutate


def both(*mutations: Mutation) -> Mutation:
    """Some changes one after the other."""

    def mutate(case: SmallCase) -> SmallCase:
        for one in mutations:
            case = one(case)
        return case

    return mutate


def shares(sine: float) -> Mutation:
    """Shares of the two events of the mileage."""
    return both(event("sine", share=sine), event("noise", share=1.0 - sine))


def load(factor: float, only: Sequence[str] = ("sine", "noise", "load and unload")) -> Mutation:
    """All stresses, or those of some events, times a factor."""
    return both(*(event(name, stress_factor=factor) for name in only))


def curve(**keys: object) -> Mutation:
    """Keys of the table of the curve."""

    def mutate(case: SmallCase) -> SmallCase:
        case.curve.update(keys)
        return case

    return mutate


def mission(**keys: object) -> Mutation:
    """Keys of the mission."""

    def mutate(case: SmallCase) -> SmallCase:
        case.mission.update(keys)
        return case

    return mutate


def dropped(name: str, **keys: object) -> Mutation:
    """An event left out; ``keys`` of the sine, whose share makes up for it."""

    def mutate(case: SmallCase) -> SmallCase:
        case.events = [one for one in case.events if one["name"] != name]
        return event("sine", **keys)(case) if keys else case

    return mutate


def extra(old: str, new: str) -> Mutation:
    """Other words in what stands behind the mission."""

    def mutate(case: SmallCase) -> SmallCase:
        assert old in case.extra
        return replace(case, extra=case.extra.replace(old, new))

    return mutate


def inside(low: np.ndarray, truth: np.ndarray, high: np.ndarray, room: float = 1e-11) -> bool:
    """Whether the truth lies between two bounds, rounding left aside."""
    space = room * np.abs(truth) + 1e-300
    return bool(((low - space <= truth) & (truth <= high + space)).all())
