"""Rows of the result tables for a block of stations."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.life.mission import Plan
from fatigue.pipeline.event_block import EventBlock
from fatigue.pipeline.mission_block import MissionBlock
from fatigue.pipeline.stations import Stations
from fatigue.spectrum.diagnosis import VERDICTS

FACES = ("top", "bottom")


def point_columns(stations: Stations, rows: NDArray[np.int64], welds: Sequence[str], repeat: int = 1) -> dict[str, Any]:
    """Key columns of the points of some stations, top before bottom, each ``repeat`` times."""
    station = np.repeat(rows, 2 * repeat)
    return {
        "weld": np.array(welds, dtype=object)[stations.weld[station]],
        "part": stations.part[station],
        "node": stations.node[station],
        "order": stations.order[station],
        "surface": np.tile(np.repeat(np.array(FACES, dtype=object), repeat), len(rows)),
    }


def node_rows(
    stations: Stations,
    rows: NDArray[np.int64],
    block: MissionBlock,
    life_km_raw_end: NDArray[np.float64],
    toe: NDArray[np.bool_],
    plan: Plan,
    welds: Sequence[str],
) -> dict[str, Any]:
    """Rows of ``nodes.parquet`` for a block of stations; ``toe`` is (n, 2)."""
    station = np.repeat(rows, 2)
    events = np.array([p.event for p in plan.passes] + [None], dtype=object)
    return {
        **point_columns(stations, rows, welds),
        "toe": toe.ravel(),
        "arc_length_mm": stations.arc_length[station],
        "x_mm": stations.xyz[station, 0],
        "y_mm": stations.xyz[station, 1],
        "z_mm": stations.xyz[station, 2],
        "thickness_mm": stations.thickness[station],
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
        "dirlik_verdict": np.array(VERDICTS, dtype=object)[block.verdict.ravel()],
        "max_range_MPa": block.max_range.ravel(),
        "equivalent_range_2e6_MPa": block.equivalent_range.ravel(),
        "mean_stress_MPa": block.mean_stress.ravel(),
        "R_largest_cycle": block.r_largest.ravel(),
        "damage_factor_if_mean_stress": block.factor_if_mean_stress.ravel(),
        "shear_ratio": block.shear_ratio.ravel(),
        "damage_factor_if_shear": block.factor_if_shear.ravel(),
        "governing_event": events[block.governing.ravel()],
        "bending_ratio": block.bending_ratio.ravel(),
        "life_km_raw_end": life_km_raw_end.ravel(),
        "at_end": stations.at_end[station],
        "at_corner": stations.at_corner[station],
        "screened": np.full(len(station), "", dtype=object),
    }


def damage_rows(
    stations: Stations, rows: NDArray[np.int64], parts: Sequence[EventBlock], plan: Plan, welds: Sequence[str]
) -> dict[str, Any]:
    """Rows of ``damage.parquet`` for a block of stations: every event of every point, unweighted."""
    length = np.array([np.nan if p.length is None else p.length for p in plan.passes])

    def per_pass(name: str) -> NDArray[np.float64]:
        return np.stack([getattr(p, name) for p in parts], axis=-1).ravel()

    def per_km(name: str) -> NDArray[np.float64]:
        return np.asarray((np.stack([getattr(p, name) for p in parts], axis=-1) / length).ravel())

    points = 2 * len(rows)
    return {
        **point_columns(stations, rows, welds, repeat=len(parts)),
        "event": np.tile(np.array([p.event for p in plan.passes], dtype=object), points),
        "damage_per_km": per_km("damage"),
        "damage_per_pass": per_pass("damage"),
        "damage_dirlik_per_km": per_km("damage_dirlik"),
        "damage_tb_per_km": per_km("damage_tb"),
        "damage_same_ratio_per_km": per_km("damage_same_ratio"),
        "damage_dirlik_per_pass": per_pass("damage_dirlik"),
        "damage_tb_per_pass": per_pass("damage_tb"),
        "damage_same_ratio_per_pass": per_pass("damage_same_ratio"),
        "cycles_per_km": per_km("cycles"),
        "cycles_per_pass": per_pass("cycles"),
        "max_range_MPa": per_pass("max_range"),
        "max_equivalent_range_dS": per_pass("max_equivalent_range"),
        "bending_ratio": per_pass("bending_ratio"),
        "mean_stress_MPa": per_pass("mean"),
        "kurtosis": per_pass("kurtosis"),
        "irregularity": per_pass("irregularity"),
        "peaks_per_s": per_pass("peaks_per_s"),
        "samples_per_peak": per_pass("samples_per_peak"),
        "verdict": np.array(VERDICTS, dtype=object)[np.stack([p.verdict for p in parts], axis=-1).ravel()],
    }


def stress_rows(
    stations: Stations, rows: NDArray[np.int64], modes: NDArray[np.int64], welds: Sequence[str]
) -> Mapping[str, Any]:
    """Rows of ``structural_stress.parquet`` for a block of stations: the five components of every mode."""
    station = np.repeat(rows, len(modes))
    columns: dict[str, Any] = {
        "weld": np.array(welds, dtype=object)[stations.weld[station]],
        "part": stations.part[station],
        "order": stations.order[station],
        "node": stations.node[station],
        "mode": np.tile(modes, len(rows)),
    }
    for component in ("membrane", "bending", "in_plane_shear", "twist_shear", "transverse_shear"):
        columns[f"{component}_MPa"] = getattr(stations.treated, component)[rows].ravel()
        columns[f"{component}_raw_MPa"] = getattr(stations.raw, component)[rows].ravel()
    return columns
