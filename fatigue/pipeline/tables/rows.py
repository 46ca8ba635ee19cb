"""Rows of the result tables for some stations, those of a group of welds."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.life.mission import Plan
from fatigue.pipeline.count.event_block import EventBlock
from fatigue.pipeline.count.mission_block import MissionBlock
from fatigue.pipeline.count.piece import TIERS
from fatigue.pipeline.solve.stations import Stations
from fatigue.results import coded
from fatigue.spectrum.trust import VERDICTS

FACES = ("top", "bottom")


def point_columns(stations: Stations, repeat: int = 1, some: slice = slice(None)) -> dict[str, Any]:
    """Key columns of the points of some stations, top before bottom, each ``repeat`` times."""
    weld = stations.weld[some]
    return {
        "weld": coded(np.repeat(weld, 2 * repeat), stations.names),
        "part": np.repeat(stations.part[some], 2 * repeat),
        "node": np.repeat(stations.node[some], 2 * repeat),
        "order": np.repeat(stations.order[some], 2 * repeat),
        "surface": coded(np.tile(np.repeat(np.arange(2), repeat), weld.size), FACES),
    }


def node_rows(stations: Stations, block: MissionBlock, tier: NDArray[np.integer], plan: Plan) -> dict[str, Any]:
    """Rows of ``nodes.parquet``; ``tier`` (n,) is an index into `TIERS`."""
    return {
        **point_columns(stations),
        "toe": stations.toe.ravel(),
        "arc_length_mm": np.repeat(stations.arc_length, 2),
        "x_mm": np.repeat(stations.xyz[:, 0], 2),
        "y_mm": np.repeat(stations.xyz[:, 1], 2),
        "z_mm": np.repeat(stations.xyz[:, 2], 2),
        "thickness_mm": np.repeat(stations.thickness, 2),
        "damage_per_km": block.damage_per_km.ravel(),
        "life_km": block.life_km.ravel(),
        "life_years": block.life_km.ravel() / plan.km_per_year,
        "utilisation": block.utilisation.ravel(),
        "fulfilled": block.utilisation.ravel() <= 1.0,
        "load_factor": block.load_factor.ravel(),
        "life_km_dirlik": block.life_km_dirlik.ravel(),
        "life_km_tb": block.life_km_tb.ravel(),
        "life_km_same_ratio": block.life_km_same_ratio.ravel(),
        "dirlik_ratio": block.dirlik_ratio.ravel(),
        "dirlik_verdict": coded(block.verdict.ravel(), VERDICTS),
        "max_range_MPa": block.max_range.ravel(),
        "equivalent_range_2e6_MPa": block.equivalent_range.ravel(),
        "mean_stress_MPa": block.mean_stress.ravel(),
        "R_largest_cycle": block.r_largest.ravel(),
        "damage_factor_if_mean_stress": block.factor_if_mean_stress.ravel(),
        "shear_ratio": block.shear_ratio.ravel(),
        "damage_factor_if_shear": block.factor_if_shear.ravel(),
        "governing_event": coded(block.governing.ravel(), [p.event for p in plan.passes]),
        "bending_ratio": block.bending_ratio.ravel(),
        "life_km_raw_end": block.life_km_raw_end.ravel(),
        "at_end": np.repeat(stations.at_end, 2),
        "at_corner": np.repeat(stations.at_corner, 2),
        "screened": coded(np.repeat(tier, 2), TIERS),
    }


def damage_rows(stations: Stations, parts: Sequence[EventBlock], plan: Plan, some: slice) -> dict[str, Any]:
    """Rows of ``damage.parquet`` of some stations: every event of every point, unweighted."""
    length = np.array([np.nan if p.length is None else p.length for p in plan.passes])

    def per_pass(name: str) -> NDArray[Any]:
        return np.stack([getattr(p, name)[some] for p in parts], axis=-1)

    damage, same_ratio = per_pass("damage"), per_pass("damage_same_ratio")
    dirlik, tb, cycles = per_pass("damage_dirlik"), per_pass("damage_tb"), per_pass("cycles")
    return {
        **point_columns(stations, repeat=len(parts), some=some),
        "event": coded(np.tile(np.arange(len(parts)), damage.size // len(parts)), [p.event for p in plan.passes]),
        "damage_per_km": (damage / length).ravel(),
        "damage_per_pass": damage.ravel(),
        "damage_dirlik_per_km": (dirlik / length).ravel(),
        "damage_tb_per_km": (tb / length).ravel(),
        "damage_same_ratio_per_km": (same_ratio / length).ravel(),
        "damage_dirlik_per_pass": dirlik.ravel(),
        "damage_tb_per_pass": tb.ravel(),
        "damage_same_ratio_per_pass": same_ratio.ravel(),
        "cycles_per_km": (cycles / length).ravel(),
        "cycles_per_pass": cycles.ravel(),
        "max_range_MPa": per_pass("max_range").ravel(),
        "max_equivalent_range_dS": per_pass("max_equivalent_range").ravel(),
        "bending_ratio": per_pass("bending_ratio").ravel(),
        "mean_stress_MPa": per_pass("mean").ravel(),
        "kurtosis": per_pass("kurtosis").ravel(),
        "irregularity": per_pass("irregularity").ravel(),
        "peaks_per_s": per_pass("peaks_per_s").ravel(),
        "samples_per_peak": per_pass("samples_per_peak").ravel(),
        "verdict": coded(per_pass("verdict").ravel(), VERDICTS),
    }


def stress_rows(stations: Stations, modes: NDArray[np.int64], some: slice) -> Mapping[str, Any]:
    """Rows of ``structural_stress.parquet`` of some stations: the five components of every mode."""
    changed = np.isin(np.arange(len(stations))[some], stations.raw_rows)
    of_changed = np.isin(stations.raw_rows, np.arange(len(stations))[some])
    columns: dict[str, Any] = {
        "weld": coded(np.repeat(stations.weld[some], len(modes)), stations.names),
        "part": np.repeat(stations.part[some], len(modes)),
        "order": np.repeat(stations.order[some], len(modes)),
        "node": np.repeat(stations.node[some], len(modes)),
        "mode": np.tile(modes, changed.size),
    }
    for component in ("membrane", "bending", "in_plane_shear", "twist_shear", "transverse_shear"):
        treated = getattr(stations.treated, component)[some]
        raw = treated.copy()
        raw[changed] = getattr(stations.raw, component)[of_changed]
        columns[f"{component}_MPa"], columns[f"{component}_raw_MPa"] = treated.ravel(), raw.ravel()
    return columns
