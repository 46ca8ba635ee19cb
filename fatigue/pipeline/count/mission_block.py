"""The events of a block of stations weighted with the mission: damage per km, life, and what goes with them."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.life.curves import DamageLaw
from fatigue.life.mission import Plan, life_km, load_factor, mission_sum, range_at_2e6, straight_load_factor
from fatigue.pipeline.count.event_block import EventBlock
from fatigue.quotient import quotient


@dataclass(frozen=True, slots=True, eq=False)
class MissionBlock:
    """Results of the whole mission at a block of stations; every array is (n, 2): top and bottom face.

    ``life_km_raw_end`` is the life without the end treatment, NaN where that was not counted. ``governing`` is the
    index of the event with the largest share of the damage, -1 where nothing damages; ``verdict`` that of the event
    with the largest share of the damage among those that have a spectrum.
    """

    damage_per_km: NDArray[np.float64]
    life_km: NDArray[np.float64]
    life_km_raw_end: NDArray[np.float64]
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
    """Weight the passes of every event with the mission: damage per km, life, load factor and what goes with them.

    Where bounds stand for counting (``cycles`` is NaN), damage, life and load factor are on the safe side, and nothing
    is said of what depends on the event that governs.
    """
    k = float(law.slopes[0])
    counted = not np.isnan(parts[0].cycles).any()
    damage = mission_sum(np.stack([p.damage for p in parts]), plan.passes)
    utilisation = damage * plan.target_km / plan.damage_limit

    weights = np.array([p.passes_per_km for p in plan.passes])[:, None, None]
    share = weights * np.stack([p.damage for p in parts])
    governing = np.where(counted & (damage > 0.0), share.argmax(axis=0), -1)
    largest = np.stack([p.max_range for p in parts]).argmax(axis=0)

    in_spectrum = [i for i, p in enumerate(parts) if not np.isnan(p.damage_dirlik).all()]
    dirlik = _sum_over("damage_dirlik", parts, plan, in_spectrum)
    tb = _sum_over("damage_tb", parts, plan, in_spectrum)
    same_ratio = _sum_over("damage_same_ratio", parts, plan, in_spectrum)
    return MissionBlock(
        damage_per_km=damage,
        life_km=life_km(damage, plan.damage_limit),
        life_km_raw_end=_life(_sum_over("damage_raw_end", parts, plan), plan),
        utilisation=utilisation,
        load_factor=_load_factor(parts, utilisation, plan, law, counted),
        life_km_dirlik=_life(dirlik, plan),
        life_km_tb=_life(tb, plan),
        life_km_same_ratio=_life(same_ratio, plan),
        dirlik_ratio=quotient(dirlik, same_ratio),
        max_range=np.stack([p.max_range for p in parts]).max(axis=0),
        equivalent_range=range_at_2e6(
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


def _verdict(parts: Sequence[EventBlock], weights: NDArray[np.float64]) -> NDArray[np.int8]:
    """Pick the verdict of the event that does most of the damage and was assessed in the frequency domain."""
    verdicts = np.stack([p.verdict for p in parts])
    share = np.where(verdicts > 0, weights * np.stack([p.damage_same_ratio for p in parts]), -1.0)
    return np.asarray(np.take_along_axis(verdicts, share.argmax(axis=0)[None], axis=0)[0])


def _load_factor(
    parts: Sequence[EventBlock], utilisation: NDArray[np.float64], plan: Plan, law: DamageLaw, counted: bool
) -> NDArray[np.float64]:
    """Exact on a straight curve; from the stored spectrum on a curve with a knee, which only counting gives."""
    if law.is_straight:
        return straight_load_factor(utilisation, float(law.slopes[0]))
    if not counted:
        return np.full_like(utilisation, np.nan)
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
