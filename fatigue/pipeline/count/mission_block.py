"""The events of a block of stations weighted with the mission: damage per km, life, and what goes with them."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.life.counting.block import BlockCount
from fatigue.life.curves import DamageLaw
from fatigue.life.mission import Pass, Plan, life_km, load_factor, mission_sum, range_at_2e6, straight_load_factor
from fatigue.life.sequence import LoopCount
from fatigue.pipeline.count.event_block import EventBlock
from fatigue.pipeline.count.joined.loops import Joined
from fatigue.quotient import quotient
from fatigue.spectrum.outside import missed_damage
from fatigue.spectrum.trust import NO_LIFE, VERDICTS, missed_limit


@dataclass(frozen=True, slots=True, eq=False)
class MissionBlock:
    """Results of the whole mission at a block of stations; every array is (n, 2): top and bottom face.

    ``life_km_raw_end`` is the life without the end treatment, NaN where it was not counted. ``governing`` is the index
    of the event, or of the loop behind all events, with the largest share of the damage, -1 where nothing damages.
    ``damage_with_shear`` is that of the passes alone, per km, with the ASME factor for shear.
    ``transitions`` is what the loops add per km, NaN without loops, and ``transitions_bound`` what no order of the
    events exceeds, NaN unless their stints are given. ``verdict`` is the verdict of the
    event with the largest share of the damage among the events that have a spectrum, or ``outside_band`` where the
    bands of all events together miss too much of it; where they miss nearly all, there is no ``life_km_dirlik`` and
    ``life_km_tb`` (NaN).
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
    damage_with_shear: NDArray[np.float64]
    governing: NDArray[np.int64]
    bending_ratio: NDArray[np.float64]
    verdict: NDArray[np.int8]
    transitions: NDArray[np.float64]
    transitions_bound: NDArray[np.float64]


def mission_block(
    events: Sequence[EventBlock], plan: Plan, law: DamageLaw, joined: Joined | None = None
) -> MissionBlock:
    """Damage per km, life, load factor and what goes with them: the passes of every event weighted with the mission.

    ``joined`` is what joins the events, by default nothing: loops add to damage and ranges, not to what is compared
    with the frequency domain; how much shear would add to the cycles across events is not known. Where bounds stand for
    counting (the number of cycles is NaN), damage, life and load factor are on the safe side, and nothing is said of
    what depends on the event that governs.
    """
    joined = Joined.nothing(len(events[0].verdict)) if joined is None else joined
    loops = [loop.count for loop in joined.loops]
    counts, estimates = [event.count for event in events], [event.estimate for event in events]
    weights = plan.weights[:, None, None]
    counted = not np.isnan(counts[0].cycles).any()

    damages = np.stack([*(c.damage for c in counts), *(loop.damage for loop in loops)])
    transitions = _of_loops([loop.damage for loop in loops], plan, counts[0].damage)
    damage = mission_sum(damages[: len(counts)], plan.passes) + transitions
    utilisation = damage * plan.target_km / plan.damage_limit
    governing = np.where(counted & (damage > 0.0), (weights * damages).argmax(axis=0), -1)
    ranges = np.stack([*(c.max_range for c in counts), *(loop.max_range for loop in loops)])
    largest = ranges.argmax(axis=0)

    in_spectrum = [i for i, estimate in enumerate(estimates) if not np.isnan(estimate.dirlik).all()]
    passes = [plan.passes[i] for i in in_spectrum]
    dirlik = _sum([estimates[i].dirlik for i in in_spectrum], passes, damage)
    tb = _sum([estimates[i].tb for i in in_spectrum], passes, damage)
    tb_whole = _sum([estimates[i].tb_whole for i in in_spectrum], passes, damage)
    missed = missed_damage(tb, tb_whole)
    outside = missed > missed_limit(float(law.slopes[0]))
    same_ratio = _sum([counts[i].damage_same_ratio for i in in_spectrum], passes, damage)
    power_sum = _sum([c.power_sum for c in counts], plan.passes, damage)
    power_sum = np.maximum(power_sum + _of_loops([loop.power_sum for loop in loops], plan, damage), 0.0)
    mean_stress = _sum([c.damage_mean_stress for c in counts], plan.passes, damage)
    mean_stress = mean_stress + _of_loops([loop.damage_mean_stress for loop in loops], plan, damage)
    raw_end = _sum([event.damage_raw_end for event in events], plan.passes, damage)
    raw_end = raw_end + _of_loops([loop.damage_raw_end for loop in joined.loops], plan, damage)
    with_shear = _sum([event.damage_shear for event in events], plan.passes, damage)
    return MissionBlock(
        damage_per_km=damage,
        life_km=life_km(damage, plan.damage_limit),
        life_km_raw_end=_life(raw_end, plan),
        utilisation=utilisation,
        load_factor=_load_factor(counts, loops, utilisation, plan, law, counted),
        life_km_dirlik=np.where(missed > NO_LIFE, np.nan, _life(dirlik, plan)),
        life_km_tb=np.where(missed > NO_LIFE, np.nan, _life(tb, plan)),
        life_km_same_ratio=_life(same_ratio, plan),
        dirlik_ratio=quotient(dirlik, same_ratio),
        max_range=ranges.max(axis=0),
        equivalent_range=range_at_2e6(power_sum, float(law.slopes[0]), plan.target_km),
        mean_stress=_of_event([estimate.mean for estimate in estimates], governing),
        r_largest=_of_event([*(c.r_largest for c in counts), *(loop.r_largest for loop in loops)], largest),
        factor_if_mean_stress=quotient(mean_stress, damage),
        shear_ratio=_of_event([event.shear_ratio for event in events], governing),
        factor_if_shear=np.full_like(damage, np.nan) if loops else quotient(with_shear, damage),
        damage_with_shear=with_shear,
        governing=governing,
        bending_ratio=_of_event([estimate.bending_ratio for estimate in estimates], governing),
        verdict=_verdict(events, weights[: len(counts)], outside),
        transitions=transitions if loops else np.full_like(damage, np.nan),
        transitions_bound=joined.bound,
    )


def _of_loops(per_run: Sequence[NDArray[np.float64]], plan: Plan, like: NDArray[np.float64]) -> NDArray[np.float64]:
    """Sum of a quantity of one run of every loop over the mission [1/km]; 0 without loops."""
    total = np.zeros_like(like)
    for loop, value in zip(plan.loops, per_run, strict=True):
        total += loop.runs_per_km * value
    return total


def _verdict(
    events: Sequence[EventBlock], weights: NDArray[np.float64], outside: NDArray[np.bool_]
) -> NDArray[np.int8]:
    """Verdict of the event that does most of the damage, of the events assessed in the frequency domain.

    Where too much is ``outside`` the bands of all events, (n, 2), that is the verdict.
    """
    verdicts = np.stack([event.verdict for event in events])
    same_ratio = np.stack([event.count.damage_same_ratio for event in events])
    share = np.where(verdicts > 0, weights * same_ratio, -1.0)
    largest = np.take_along_axis(verdicts, share.argmax(axis=0)[None], axis=0)[0]
    return np.where(outside & (largest > 0), np.int8(VERDICTS.index("outside_band")), largest)


def _load_factor(
    counts: Sequence[BlockCount],
    loops: Sequence[LoopCount],
    utilisation: NDArray[np.float64],
    plan: Plan,
    law: DamageLaw,
    counted: bool,
) -> NDArray[np.float64]:
    """Scale on all stresses that meets the target: exact on a straight curve, from the spectrum on one with a knee.

    Only counting gives a spectrum; without one the factor is NaN.
    """
    if law.is_straight:
        return straight_load_factor(utilisation, float(law.slopes[0]))
    if not counted:
        return np.full_like(utilisation, np.nan)
    histogram = mission_sum(np.stack([c.histogram for c in counts]), plan.passes)
    if loops:  # what they replace leaves rounding errors behind
        rounding = 1e-12 * histogram
        histogram = histogram + _of_loops([loop.histogram for loop in loops], plan, histogram)
        histogram = np.where(histogram > rounding, histogram, 0.0)
    spectrum = histogram.reshape(utilisation.size, -1, 2)
    factor = load_factor(spectrum[..., 0], spectrum[..., 1], law, plan.target_km, plan.damage_limit)
    return factor.reshape(utilisation.shape)


def _sum(
    per_pass: Sequence[NDArray[np.float64]], passes: Sequence[Pass], like: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Sum of a quantity of some events over the mission; NaN of the form of ``like`` over no event."""
    return mission_sum(np.stack(per_pass), passes) if per_pass else np.full_like(like, np.nan)


def _life(damage_per_km: NDArray[np.float64], plan: Plan) -> NDArray[np.float64]:
    """Life where there is an estimate, NaN where there is none."""
    return np.where(np.isnan(damage_per_km), np.nan, life_km(damage_per_km, plan.damage_limit))


def _of_event(per_event: Sequence[NDArray[np.float64]], event: NDArray[np.int64]) -> NDArray[np.float64]:
    """A quantity of the given event at every point; NaN for event -1 and for a loop."""
    known = (event >= 0) & (event < len(per_event))
    picked = np.take_along_axis(np.stack(per_event), np.where(known, event, 0)[None], axis=0)[0]
    return np.where(known, picked, np.nan)
