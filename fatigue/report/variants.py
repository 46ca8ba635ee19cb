"""The same cycles under other assumptions: what survival level, thickness rule, knee or bending ratio do to a life."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any, cast

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.life.curves import DamageLaw, Extension, SNCurve, Survival, ThicknessRule, damage_law
from fatigue.life.recorded_curve import recorded_curve
from fatigue.life.rule import cycle_damage, ratio_factor, size_factor

EXTENSIONS: dict[Extension, str] = {"none": "no knee", "haibach": "Haibach", "cutoff": "cut-off"}


@dataclass(frozen=True, slots=True, eq=False)
class Assumptions:
    """How the life of a weld was found: its curve and the choices the variants change one at a time."""

    curve: SNCurve
    survival: str
    thickness_rule: ThicknessRule
    extension: Extension
    knee_cycles: float
    mean_stress: bool = False


def assumptions_of(record: Mapping[str, Any], curve: str) -> Assumptions:
    """Assumptions behind one curve of a result, from its provenance."""
    entry, rules = record["curves"][curve], record["rules"]
    return Assumptions(
        curve=recorded_curve(curve, entry),
        survival=rules["survival"][curve],
        thickness_rule=rules["thickness_rule"],
        extension=rules["extension"],
        knee_cycles=rules["knee_cycles"],
        mean_stress=rules["mean_stress"] == "asme",
    )


def how_often(cycles: pd.DataFrame, passes_per_km: Mapping[str, float]) -> NDArray[np.float64]:
    """How often each listed cycle occurs [1/km]: its count times the passes of its event."""
    codes, events = pd.factorize(cycles["event"])
    passes = np.array([*(passes_per_km.get(event, np.nan) for event in events), np.nan])  # the last of code -1
    return np.asarray(passes[codes] * cycles["count"].to_numpy())


def damage_per_km(
    equivalent_range: NDArray[np.float64], per_km: NDArray[np.float64], assumptions: Assumptions
) -> float:
    """Miner sum per km [1/km] of cycles of these equivalent ranges, each occurring ``per_km`` times."""
    return float(np.sum(per_km * cycle_damage(equivalent_range, law_of(assumptions))))


def law_of(assumptions: Assumptions) -> DamageLaw:
    """Damage law of a curve under these assumptions."""
    survival = cast(Survival, assumptions.survival) if assumptions.curve.has_scatter else None
    return damage_law(assumptions.curve, survival, assumptions.extension, assumptions.knee_cycles)


def laws_of(assumptions: Assumptions) -> dict[str, DamageLaw]:
    """Damage law of a curve at each of its survival levels, all else as it was assumed."""
    return {level: law_of(replace(assumptions, survival=level)) for level in assumptions.curve.reference_range}


def variants(
    point: pd.Series, cycles: pd.DataFrame, passes_per_km: Mapping[str, float], used: Assumptions
) -> pd.DataFrame:
    """Damage of one point with one assumption changed at a time, from its counted cycles.

    Parameters
    ----------
    point : row of the table of nodes
    cycles : rows of the table of cycles, all events
    passes_per_km : of every event [1/km]
    used : assumptions of the assessment

    Returns
    -------
    table with ``assumption``, ``choice``, ``used`` (the choice of the assessment) and ``damage_factor``, its damage
    over the damage of the assessment (NaN where nothing damages). Where the cycles of a damaged point are not kept, the
    choices that need them are left out. Factors of mean stress, shear and weld end come from the point's own row and
    are left out where the assessment had no number for them.
    """
    per_km = how_often(cycles, passes_per_km)
    ranges = cycles["equivalent_range_dS"].to_numpy()
    assessed = damage_per_km(ranges, per_km, used)

    def factor(changed: Assumptions, scale: NDArray[np.float64] | float = 1.0) -> float:
        return damage_per_km(ranges * scale, per_km, changed) / assessed if assessed > 0.0 else np.nan

    counted = [*_curve_variants(used, factor), *_stress_variants(point, cycles, used, factor)]
    kept = len(cycles) > 0 or point["damage_per_km"] == 0.0
    rows = [*(counted if kept else ()), *_point_variants(point, used)]
    return pd.DataFrame(rows, columns=["assumption", "choice", "used", "damage_factor"])


def _curve_variants(used: Assumptions, factor: Callable[..., float]) -> Iterator[tuple[str, str, bool, float]]:
    for level in used.curve.reference_range:
        yield "survival", level, level == used.survival, factor(replace(used, survival=level))
    if not used.curve.knees_cycles:
        for extension, words in EXTENSIONS.items():
            choice = words if extension == "none" else f"{words} at {used.knee_cycles:.4g} cycles"
            yield "below the knee", choice, extension == used.extension, factor(replace(used, extension=extension))


def _stress_variants(
    point: pd.Series, cycles: pd.DataFrame, used: Assumptions, factor: Callable[..., float]
) -> Iterator[tuple[str, str, bool, float]]:
    if used.curve.applies != "dS":
        return
    thickness = np.array([point["thickness_mm"]])
    size = size_factor(thickness, used.curve, used.thickness_rule)
    rules: dict[ThicknessRule, str] = {"actual": "actual plate", "asme": "ASME, at least 16 mm"}
    for rule, words in rules.items():
        scale = float((size_factor(thickness, used.curve, rule) / size)[0])
        yield "thickness in dS", words, rule == used.thickness_rule, factor(used, scale)
    of_cycle = ratio_factor(cycles["bending_ratio"].to_numpy())
    yield "bending ratio", "of each cycle", True, factor(used)
    for ratio, words in ((0.0, "0: pure membrane"), (1.0, "1: pure bending")):
        yield "bending ratio", words, False, factor(used, of_cycle / ratio_factor(np.array(ratio)))


def _point_variants(point: pd.Series, used: Assumptions) -> Iterator[tuple[str, str, bool, float]]:
    others = (
        ("mean stress", "ASME factor for high mean stress", "damage_factor_if_mean_stress", used.mean_stress),
        ("shear", "combined as in ASME VIII-2 5.5.5.3", "damage_factor_if_shear", False),
    )
    for assumption, choice, column, is_used in others:
        if pd.notna(point[column]):
            yield assumption, choice, is_used, float(point[column])
    if point["at_end"] and np.isfinite(point["life_km"]) and point["life_km_raw_end"] > 0.0:
        yield (
            "weld end",
            "line force as solved, end not treated",
            False,
            float(point["life_km"] / point["life_km_raw_end"]),
        )
