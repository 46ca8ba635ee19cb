"""From event results of a block to the rows of the result tables."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.life.curves import DamageLaw
from fatigue.life.mission import Plan, equivalent_range, life_km, load_factor, mission_sum, straight_load_factor
from fatigue.pipeline.event_block import EventBlock
from fatigue.pipeline.stations import Stations
from fatigue.quotient import quotient
from fatigue.spectrum.diagnosis import VERDICTS

FACES = ("top", "bottom")


@dataclass(frozen=True, slots=True, eq=False)
class MissionBlock:
    """Results of the whole mission at a block of stations; every array is (n, 2): top and bottom face.

    ``governing`` is the index of the event with the largest share of the damage, -1 where nothing damages; ``verdict``
    that of the event with the largest share of the damage among those that have a spectrum.
    """

    damage_per_km: NDArray[np.float64]
    life_km: NDArray[np.float64]
    utilisation: NDArray[np.float64]
    load_factor: NDArray[np.float64]
    life_km_dirlik: NDArray[np.float64]
    life_km_tb: NDArray[np.float64]
    life_km_same_ratio: NDArray[np.float64]
    dirlik_ratio: NDArray[np.float64]
    max_range: NDArray[np.float64]
    equivalent_range: NDArray[np.float64]
    mean_stress: NDArray[np.float64]
    r_largest: NDArray[np.float64]
    factor_if_mean_stress: NDArray[np.float64]
    shear_ratio: NDArray[np.float64]
    factor_if_shear: NDArray[np.float64]
    governing: NDArray[np.int64]
    bending_ratio: NDArray[np.float64]
    verdict: NDArray[np.int8]


def mission_block(parts: Sequence[EventBlock], plan: Plan, law: DamageLaw) -> MissionBlock:
    """Weight the passes of every event with the mission: damage per km, life, load factor and what goes with them."""
    k = float(law.slopes[0])
    damage = mission_sum(np.stack([p.damage for p in parts]), plan.passes)
    utilisation = damage * plan.target_km / plan.damage_limit

    weights = np.array([p.passes_per_km for p in plan.passes])[:, None, None]
    share = weights * np.stack([p.damage for p in parts])
    governing = np.where(damage > 0.0, share.argmax(axis=0), -1)
    largest = np.stack([p.max_range for p in parts]).argmax(axis=0)

    in_spectrum = [i for i, p in enumerate(parts) if not np.isnan(p.damage_dirlik).all()]
    dirlik = _sum_over("damage_dirlik", parts, plan, in_spectrum)
    tb = _sum_over("damage_tb", parts, plan, in_spectrum)
    same_ratio = _sum_over("damage_same_ratio", parts, plan, in_spectrum)
    return MissionBlock(
        damage_per_km=damage,
        life_km=life_km(damage, plan.damage_limit),
        utilisation=utilisation,
        load_factor=_load_factor(parts, utilisation, plan, law),
        life_km_dirlik=_life(dirlik, plan),
        life_km_tb=_life(tb, plan),
        life_km_same_ratio=_life(same_ratio, plan),
        dirlik_ratio=quotient(dirlik, same_ratio),
        max_range=np.stack([p.max_range for p in parts]).max(axis=0),
        equivalent_range=equivalent_range(
            mission_sum(np.stack([p.power_sum for p in parts]), plan.passes), k, plan.target_km
        ),
        mean_stress=_of_event("mean", parts, governing),
        r_largest=_of_event("r_largest", parts, largest),
        factor_if_mean_stress=quotient(_sum_over("damage_mean_stress", parts, plan), damage),
        shear_ratio=_of_event("shear_ratio", parts, governing),
        factor_if_shear=quotient(_sum_over("damage_shear", parts, plan), damage),
        governing=governing,
        bending_ratio=_of_event("bending_ratio", parts, governing),
        verdict=_verdict(parts, weights),
    )


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


def _verdict(parts: Sequence[EventBlock], weights: NDArray[np.float64]) -> NDArray[np.int8]:
    """Pick the verdict of the event that does most of the damage and was assessed in the frequency domain."""
    verdicts = np.stack([p.verdict for p in parts])
    share = np.where(verdicts > 0, weights * np.stack([p.damage_same_ratio for p in parts]), -1.0)
    return np.asarray(np.take_along_axis(verdicts, share.argmax(axis=0)[None], axis=0)[0])


def _load_factor(
    parts: Sequence[EventBlock], utilisation: NDArray[np.float64], plan: Plan, law: DamageLaw
) -> NDArray[np.float64]:
    """Exact on a straight curve; from the stored spectrum on a curve with a knee."""
    if law.is_straight:
        return straight_load_factor(utilisation, float(law.slopes[0]))
    spectrum = mission_sum(np.stack([p.histogram for p in parts]), plan.passes).reshape(utilisation.size, -1, 2)
    factor = load_factor(spectrum[..., 0], spectrum[..., 1], law, plan.target_km, plan.damage_limit)
    return factor.reshape(utilisation.shape)


def _sum_over(
    name: str, parts: Sequence[EventBlock], plan: Plan, events: Sequence[int] | None = None
) -> NDArray[np.float64]:
    """Mission sum of a quantity per pass over some events, all by default; NaN over no event."""
    chosen = range(len(parts)) if events is None else events
    if not chosen:
        return np.full_like(parts[0].damage, np.nan)
    return mission_sum(np.stack([getattr(parts[i], name) for i in chosen]), [plan.passes[i] for i in chosen])


def _life(damage_per_km: NDArray[np.float64], plan: Plan) -> NDArray[np.float64]:
    """Life where there is an estimate, NaN where there is none."""
    return np.where(np.isnan(damage_per_km), np.nan, life_km(damage_per_km, plan.damage_limit))


def _of_event(name: str, parts: Sequence[EventBlock], event: NDArray[np.int64]) -> NDArray[np.float64]:
    """Pick a quantity of the given event at every point; NaN for event -1."""
    stacked = np.stack([getattr(p, name) for p in parts])
    picked = np.take_along_axis(stacked, np.maximum(event, 0)[None], axis=0)[0]
    return np.where(event >= 0, picked, np.nan)
