"""One event on one block of stations: superpose, count, sum, and the frequency-domain estimate beside it."""

from dataclasses import dataclass, fields
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fatigue.life.curves import DamageLaw
from fatigue.life.damage import cycle_damage, ratio_factor, shear_factor
from fatigue.life.rainflow import BlockCount, count_block
from fatigue.life.rainflow_fast import count_block_fast, is_fast
from fatigue.pipeline.event_load import EventLoad
from fatigue.quotient import quotient
from fatigue.spectrum.diagnosis import diagnose
from fatigue.spectrum.methods import dirlik_damage_rate, tovo_benasciutti_damage_rate
from fatigue.spectrum.moments import point_moments

_SAMPLES_AT_ONCE = 4_000_000  # stress samples of one component recovered before they are counted: 32 MB


@dataclass(frozen=True, slots=True, eq=False)
class Shapes:
    """Structural stress shapes of a block of stations that share one S-N curve.

    ``membrane``, ``bending``, ``in_plane_shear``, ``twist_shear`` are (n, m) [MPa per unit modal coordinate], bending
    and twist those of the top face; ``size`` (n,) turns a structural stress range over ``I(r)^(1/m)`` into the
    equivalent range of the law; ``uses_bending_ratio`` is False for curves in plain structural stress, where I is 1.
    """

    membrane: NDArray[np.float64]
    bending: NDArray[np.float64]
    in_plane_shear: NDArray[np.float64]
    twist_shear: NDArray[np.float64]
    size: NDArray[np.float64]
    law: DamageLaw
    uses_bending_ratio: bool


@dataclass(frozen=True, slots=True, eq=False)
class EventBlock:
    """One pass of one event at a block of stations; every array is (n, 2): top and bottom face.

    Damages are Miner sums of one pass; so are ``cycles`` (sum n) and ``power_sum`` (sum n S^k). ``histogram`` is
    (n, 2, b, 2), see ``BlockCount``; ``verdict`` is an index into ``VERDICTS``. What needs a spectrum is NaN without
    one.
    """

    damage: NDArray[np.float64]
    damage_same_ratio: NDArray[np.float64]
    damage_mean_stress: NDArray[np.float64]
    damage_shear: NDArray[np.float64]
    damage_dirlik: NDArray[np.float64]
    damage_tb: NDArray[np.float64]
    cycles: NDArray[np.float64]
    power_sum: NDArray[np.float64]
    max_range: NDArray[np.float64]
    r_largest: NDArray[np.float64]
    max_equivalent_range: NDArray[np.float64]
    mean: NDArray[np.float64]
    kurtosis: NDArray[np.float64]
    bending_ratio: NDArray[np.float64]
    shear_ratio: NDArray[np.float64]
    irregularity: NDArray[np.float64]
    peaks_per_s: NDArray[np.float64]
    samples_per_peak: NDArray[np.float64]
    verdict: NDArray[np.int8]
    histogram: NDArray[np.float64]


def assess_event_block(shapes: Shapes, load: EventLoad, yield_MPa: float | None, mean_stress: bool) -> EventBlock:
    """Damage of one pass of an event at every station of a block, in the time and in the frequency domain.

    Time domain: the equivalent range of each cycle has that cycle's own bending ratio (ASME VIII-2 5.5.5). The
    comparison of both domains uses one ratio per station, ``std(sigma_b) / (std(sigma_m) + std(sigma_b))``.
    """
    f, C = load.stress_factor, load.covariance
    S_m, S_b = f * shapes.membrane, f * shapes.bending
    stress = _faces(S_m, S_b)
    shear = _faces(f * shapes.in_plane_shear, f * shapes.twist_shear)

    std_m, std_b = np.sqrt(_quadratic(S_m, C, S_m)), np.sqrt(_quadratic(S_b, C, S_b))
    bending_ratio = np.repeat(quotient(std_b, std_m + std_b)[:, None], 2, axis=1)
    one_ratio = np.nan_to_num(bending_ratio)  # where nothing varies there is nothing to count either
    counted = _superpose_and_count(S_m, S_b, one_ratio, shapes, load, yield_MPa, mean_stress)

    shear_ratio = _shear_bending_ratio(shapes, C)
    I_s, I_t = (ratio_factor(r) if shapes.uses_bending_ratio else np.ones_like(r) for r in (one_ratio, shear_ratio))
    to_equivalent = shapes.size[:, None] / I_s
    spectral = _frequency_domain(stress, to_equivalent, counted, shapes.law, load)

    var, shear_var, covar = _quadratic(stress, C, stress), _quadratic(shear, C, shear), _quadratic(stress, C, shear)
    with_shear = shear_factor(var / I_s**2, shear_var / I_t**2, covar / (I_s * I_t)) ** shapes.law.slopes[0]
    return EventBlock(
        damage=counted.damage,
        damage_same_ratio=counted.damage_same_ratio,
        damage_mean_stress=counted.damage_mean_stress,
        damage_shear=np.where(counted.damage > 0.0, counted.damage * with_shear, 0.0),
        damage_dirlik=spectral.dirlik,
        damage_tb=spectral.tb,
        cycles=counted.cycles,
        power_sum=counted.power_sum,
        max_range=counted.max_range,
        r_largest=counted.r_largest,
        max_equivalent_range=counted.max_equivalent_range,
        mean=stress @ load.mean,
        kurtosis=counted.kurtosis,
        bending_ratio=bending_ratio,
        shear_ratio=quotient(np.sqrt(shear_var), np.sqrt(var)),
        irregularity=spectral.irregularity,
        peaks_per_s=spectral.peaks_per_s,
        samples_per_peak=spectral.samples_per_peak,
        verdict=spectral.verdict,
        histogram=counted.histogram,
    )


def _superpose_and_count(
    S_m: NDArray[np.float64],
    S_b: NDArray[np.float64],
    one_ratio: NDArray[np.float64],
    shapes: Shapes,
    load: EventLoad,
    yield_MPa: float | None,
    mean_stress: bool,
) -> BlockCount:
    """Recover membrane and bending histories a few rows at a time and count them; histories are never kept."""
    if load.single is not None and is_fast(shapes.law, load.single):
        return count_block_fast(
            S_m,
            S_b,
            load.single,
            shapes.size,
            one_ratio,
            shapes.law,
            uses_bending_ratio=shapes.uses_bending_ratio,
            residue=load.residue,
            yield_MPa=yield_MPa,
            mean_stress=mean_stress,
        )
    q = load.counted.q.astype(np.float64, copy=False)
    rows = max(1, _SAMPLES_AT_ONCE // q.shape[1])  # depends on the record only: the bytes do not depend on the machine
    pieces = []
    for first in range(0, len(S_m), rows):
        some = slice(first, first + rows)
        piece = count_block(
            S_m[some] @ q,
            S_b[some] @ q,
            shapes.size[some],
            one_ratio[some],
            shapes.law,
            uses_bending_ratio=shapes.uses_bending_ratio,
            residue=load.residue,
            yield_MPa=yield_MPa,
            mean_stress=mean_stress,
        )
        pieces.append(piece)
    return BlockCount(*(np.concatenate([getattr(p, f.name) for p in pieces]) for f in fields(BlockCount)))


class _FrequencyDomain(NamedTuple):
    """Dirlik and Tovo-Benasciutti damage of one pass, shape of the spectrum and verdict, each (n, 2)."""

    dirlik: NDArray[np.float64]
    tb: NDArray[np.float64]
    irregularity: NDArray[np.float64]
    peaks_per_s: NDArray[np.float64]
    samples_per_peak: NDArray[np.float64]
    verdict: NDArray[np.int8]


def _frequency_domain(
    stress: NDArray[np.float64],
    to_equivalent: NDArray[np.float64],
    counted: BlockCount,
    law: DamageLaw,
    load: EventLoad,
) -> _FrequencyDomain:
    """Estimate the damage from the spectrum, and judge whether that may be done."""
    shape = stress.shape[:2]
    if load.moments is None or load.diagnosis is None:
        nothing = np.full(shape, np.nan)
        return _FrequencyDomain(nothing, nothing, nothing, nothing, nothing, np.zeros(shape, dtype=np.int8))
    points = stress.reshape(-1, stress.shape[-1])
    moments = point_moments(points, load.moments)
    equivalent = moments * to_equivalent.reshape(-1) ** 2
    dirlik = load.duration * dirlik_damage_rate(equivalent, law)
    tb = load.duration * tovo_benasciutti_damage_rate(equivalent, law)
    m0, _, m2, m4 = moments
    peaks_per_s = np.sqrt(quotient(m4, m2))
    samples_per_peak = quotient(np.full_like(m0, 1.0 / load.counted.step), peaks_per_s)

    same_ratio, damage = counted.damage_same_ratio.reshape(-1), counted.damage.reshape(-1)
    judged = diagnose(
        points,
        moments,
        load.diagnosis,
        slope=float(law.slopes[0]),
        dirlik_ratio=quotient(dirlik, same_ratio),
        tb_ratio=quotient(tb, same_ratio),
        kurtosis=counted.kurtosis.reshape(-1),
        top_cycle_share=quotient(cycle_damage(counted.max_equivalent_range.reshape(-1), law), damage),
        samples_per_peak=samples_per_peak,
        top_mode_hz=load.top_mode_hz,
    )
    return _FrequencyDomain(
        dirlik=dirlik.reshape(shape),
        tb=tb.reshape(shape),
        irregularity=quotient(m2, np.sqrt(m0 * m4)).reshape(shape),
        peaks_per_s=peaks_per_s.reshape(shape),
        samples_per_peak=samples_per_peak.reshape(shape),
        verdict=judged.verdict.reshape(shape),
    )


def _faces(mean: NDArray[np.float64], gradient: NDArray[np.float64]) -> NDArray[np.float64]:
    """Shapes at both faces, (n, 2, m): top = mean + gradient part, bottom = mean - gradient part."""
    return np.stack([mean + gradient, mean - gradient], axis=1)


def _shear_bending_ratio(shapes: Shapes, C: NDArray[np.float64]) -> NDArray[np.float64]:
    """Compute the one bending ratio of the shear stress from its rms values, (n, 1)."""
    std_m = np.sqrt(_quadratic(shapes.in_plane_shear, C, shapes.in_plane_shear))
    std_b = np.sqrt(_quadratic(shapes.twist_shear, C, shapes.twist_shear))
    return np.nan_to_num(quotient(std_b, std_m + std_b))[:, None]


def _quadratic(a: NDArray[np.float64], C: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    """Evaluate ``a' C b`` along the last axis; a variance, so never below 0, where a is b."""
    form = np.asarray(((a @ C) * b).sum(axis=-1))
    return np.maximum(form, 0.0) if a is b else form
