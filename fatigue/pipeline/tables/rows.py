"""Rows of the result tables for the stations of a group of welds."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from fatigue.life.mission import Plan
from fatigue.pipeline.count.block import TIERS
from fatigue.pipeline.count.result import OF_EVENT, OF_LOOP, GroupResult
from fatigue.pipeline.multiaxial.found import MODELS, NULL, STATUSES, nothing_found
from fatigue.pipeline.multiaxial.found import VERDICTS as SHEAR_VERDICTS
from fatigue.pipeline.solve.stations import Stations
from fatigue.readers.neutral.body.coordinates import Coordinates
from fatigue.results import coded
from fatigue.spectrum.trust import VERDICTS

FACES = ("top", "bottom")


def coordinate_columns(coordinates: Coordinates, repeat: int) -> dict[str, Any]:
    """Key columns of all coordinates in turn, so many times: ``mode``, or ``unit_load`` where it is one."""
    modes, loads = len(coordinates.modes.mode), coordinates.unit_loads
    mode = pa.array(np.tile(coordinates.number, repeat), mask=np.tile(~coordinates.is_mode, repeat))
    code = np.concatenate([np.full(modes, -1), np.arange(len(loads))])
    return {"mode": mode, "unit_load": coded(np.tile(code, repeat), loads)}


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


def node_rows(stations: Stations, result: GroupResult, plan: Plan, status_of_weld: Sequence[str]) -> dict[str, Any]:
    """Rows of ``nodes.parquet``: the whole mission at every point; ``status_of_weld`` is that of the curve of each."""
    block, statuses = result.mission, sorted(set(status_of_weld))
    status = np.array([statuses.index(one) for one in status_of_weld])[stations.weld]
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
        "governing_event": coded(block.governing.ravel(), plan.names),
        "bending_ratio": block.bending_ratio.ravel(),
        "damage_per_km_transitions": block.transitions.ravel(),
        "damage_per_km_transitions_bound": block.transitions_bound.ravel(),
        "life_km_raw_end": block.life_km_raw_end.ravel(),
        **shear_columns(result, 2 * len(stations)),
        "at_end": np.repeat(stations.at_end, 2),
        "at_corner": np.repeat(stations.at_corner, 2),
        "summed_corner": np.repeat(stations.summed_corner, 2),
        "curve_status": coded(np.repeat(status, 2), statuses),
        "screened": coded(np.repeat(result.tier, 2), TIERS),
    }


def shear_columns(result: GroupResult, points: int) -> dict[str, Any]:
    """Columns of ``nodes.parquet`` about shear; empty where the case wants none of it."""
    found = result.multiaxial if result.multiaxial.size else nothing_found((points,))
    found = found.ravel()
    required = found["shear_required"]
    return {
        "shear_required": pa.array(required == 1, mask=required == NULL),
        "multiaxial_status": coded(found["status"], STATUSES),
        "multiaxial_bound": found["bound"].copy(),
        **{f"utilisation_path_{model}": found[model].copy() for model in MODELS},
        "utilisation_asme": found["asme"].copy(),
        "path_factor_largest": found["path_factor"].copy(),
        "path_moment_largest": found["path_moment"].copy(),
        "multiaxial_verdict": coded(found["verdict"], SHEAR_VERDICTS),
    }


def damage_rows(stations: Stations, result: GroupResult, plan: Plan, some: slice) -> dict[str, Any]:
    """Rows of ``damage.parquet`` of some stations: every event of every point, unweighted, and every loop of events."""
    rows = len(plan.names)
    lengths = [np.nan if p.length is None else p.length for p in plan.passes]
    length = np.array([*lengths, *(np.nan for _ in plan.loops)])
    columns = {name: _with_loops(name, result, some) for name in OF_EVENT}
    per_km = {name.replace("_per_pass", "_per_km"): columns[name] / length for name in columns if "_per_pass" in name}
    verdicts = [*result.verdicts[:, some], *(np.zeros_like(v) for v in result.verdicts[:1, some] for _ in plan.loops)]
    verdict = np.stack(verdicts, axis=-1)
    return {
        **point_columns(stations, repeat=rows, some=some),
        "event": coded(np.tile(np.arange(rows), verdict.size // rows), plan.names),
        **{name: values.ravel() for name, values in (columns | per_km).items()},
        "verdict": coded(verdict.ravel(), VERDICTS),
    }


def _with_loops(name: str, result: GroupResult, some: slice) -> NDArray[np.float64]:
    """A column of every event and every loop of some stations, (n, 2, e + l); NaN where a loop has none."""
    of_events = result.of_events(name)[:, some]
    loops = result.loop_columns[:, :, some]
    of_loops = loops[:, list(OF_LOOP).index(name)] if name in OF_LOOP else np.full_like(loops[:, 0], np.nan)
    return np.stack([*of_events, *of_loops], axis=-1)


def stress_rows(stations: Stations, coordinates: Coordinates, some: slice) -> Mapping[str, Any]:
    """Rows of ``structural_stress.parquet`` of some stations: the five components of every mode and unit load."""
    count = len(coordinates)
    rows, ends = np.arange(len(stations))[some], stations.raw_ends
    changed, of_changed = np.isin(rows, ends.rows), np.isin(ends.rows, rows)
    columns: dict[str, Any] = {
        "weld": coded(np.repeat(stations.weld[some], count), stations.names),
        "part": np.repeat(stations.part[some], count),
        "order": np.repeat(stations.order[some], count),
        "node": np.repeat(stations.node[some], count),
        **coordinate_columns(coordinates, changed.size),
    }
    for component in ("membrane", "bending", "in_plane_shear", "twist_shear", "transverse_shear"):
        treated = getattr(stations.treated, component)[some]
        raw = treated.copy()
        raw[changed] = getattr(ends.stress, component)[of_changed]
        columns[f"{component}_MPa"], columns[f"{component}_raw_MPa"] = treated.ravel(), raw.ravel()
    return columns
