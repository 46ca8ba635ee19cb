"""The same cycles under other assumptions: what survival level, thickness rule, knee or bending ratio make of a life."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.life.curves import Extension, SNCurve, Survival, damage_law
from fatigue.life.damage import ThicknessRule, cycle_damage, ratio_factor, size_factor

EXTENSIONS: dict[Extension, str] = {"none": "no knee", "haibach": "Haibach", "cutoff": "cut-off"}


@dataclass(frozen=True, slots=True, eq=False)
class Assumptions:
    """How the life of a weld was found: its curve and the choices the variants change one at a time."""

    curve: SNCurve
    survival: str
    thickness_rule: ThicknessRule
    extension: Extension
    knee_cycles: float


def assumptions_of(record: Mapping[str, Any], curve: str) -> Assumptions:
    """Read the assumptions behind one curve of a result from its provenance."""
    entry, rules = record["curves"][curve], record["rules"]
    return Assumptions(
        curve=SNCurve(
            name=curve,
            applies=entry["applies"],
            slopes=tuple(entry["slopes"]),
            knees_cycles=tuple(entry["knees_cycles"]),
            reference_cycles=entry["reference_cycles"],
            reference_range=entry["reference_range"],
            source=entry["source"],
            thickness_reference=entry["thickness_reference_mm"],
            thickness_exponent=entry["thickness_exponent"],
        ),
        survival=rules["survival"][curve],
        thickness_rule=rules["thickness_rule"],
        extension=rules["extension"],
        knee_cycles=rules["knee_cycles"],
    )


def damage_per_km(
    cycles: pd.DataFrame,
    passes_per_km: Mapping[str, float],
    assumptions: Assumptions,
    scale: NDArray[np.float64] | float = 1.0,
) -> float:
    """Miner sum per km [1/km] of the cycles of one point, their equivalent ranges times ``scale``."""
    per_km = cycles["event"].map(passes_per_km).to_numpy(dtype=np.float64) * cycles["count"].to_numpy()
    survival: Survival | None = assumptions.survival if assumptions.curve.has_scatter else None  # type: ignore[assignment]
    law = damage_law(assumptions.curve, survival, assumptions.extension, assumptions.knee_cycles)
    return float(np.sum(per_km * cycle_damage(cycles["equivalent_range_dS"].to_numpy() * scale, law)))


def variants(
    point: pd.Series, cycles: pd.DataFrame, passes_per_km: Mapping[str, float], assumptions: Assumptions
) -> pd.DataFrame:
    """Damage per km of one point with one assumption changed at a time, from its counted cycles.

    Parameters
    ----------
    point : row of the table of nodes
    cycles : rows of the table of cycles, all events
    passes_per_km : of every event [1/km]
    assumptions : of the assessment

    Returns
    -------
    table with ``assumption``, ``choice``, ``used`` (the choice of the assessment) and ``damage_factor``, its damage over
    that of the assessment (NaN where nothing damages). Factors of mean stress, shear and weld end come from the point's
    own row and are left out where the assessment had no number for them.
    """
    assessed = damage_per_km(cycles, passes_per_km, assumptions)

    def factor(changed: Assumptions, scale: NDArray[np.float64] | float = 1.0) -> float:
        return damage_per_km(cycles, passes_per_km, changed, scale) / assessed if assessed > 0.0 else np.nan

    rows = [
        *_curve_variants(assumptions, factor),
        *_stress_variants(point, cycles, assumptions, factor),
        *_point_variants(point),
    ]
    return pd.DataFrame(rows, columns=["assumption", "choice", "used", "damage_factor"])


def _curve_variants(used: Assumptions, factor: Any) -> Iterator[tuple[str, str, bool, float]]:
    for level in used.curve.reference_range:
        yield "survival", level, level == used.survival, factor(_replaced(used, survival=level))
    if not used.curve.knees_cycles:
        for extension, words in EXTENSIONS.items():
            choice = words if extension == "none" else f"{words} at {used.knee_cycles:.4g} cycles"
            yield "below the knee", choice, extension == used.extension, factor(_replaced(used, extension=extension))


def _stress_variants(
    point: pd.Series, cycles: pd.DataFrame, used: Assumptions, factor: Any
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


def _point_variants(point: pd.Series) -> Iterator[tuple[str, str, bool, float]]:
    others = (
        ("mean stress", "ASME factor for high mean stress", "damage_factor_if_mean_stress"),
        ("shear", "combined as in ASME VIII-2 5.5.5.3", "damage_factor_if_shear"),
    )
    for assumption, choice, column in others:
        if pd.notna(point[column]):
            yield assumption, choice, False, float(point[column])
    if point["at_end"] and np.isfinite(point["life_km"]) and point["life_km_raw_end"] > 0.0:
        yield (
            "weld end",
            "line force as solved, end not treated",
            False,
            float(point["life_km"] / point["life_km_raw_end"]),
        )


def _replaced(assumptions: Assumptions, survival: str | None = None, extension: Extension | None = None) -> Assumptions:
    return Assumptions(
        curve=assumptions.curve,
        survival=survival or assumptions.survival,
        thickness_rule=assumptions.thickness_rule,
        extension=extension or assumptions.extension,
        knee_cycles=assumptions.knee_cycles,
    )
