"""One event on one block of stations: superpose, count, sum, and the frequency-domain estimate beside it."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, fields, replace

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import NumericalError, Problem
from fatigue.life.counting.chunks import count_block_long
from fatigue.life.counting.rainflow import BlockCount, count_block
from fatigue.life.counting.single.count import count_block_fast, is_fast
from fatigue.life.damage import cycle_damage, ratio_factor, shear_factor
from fatigue.life.records.history import stress_history
from fatigue.life.records.spool import Spool
from fatigue.pipeline.count.bounds import Bound
from fatigue.pipeline.count.estimate import Estimate
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.solve.modal_stress import RawEnds, Shapes, faces
from fatigue.quotient import quotient
from fatigue.spectrum.trust import VERDICTS, judge

_SAMPLES_AT_ONCE = 4_000_000  # stress samples of one component recovered before they are counted: 32 MB
_LONGEST_ROW = 250_000  # samples of a record of which 16 rows at a time are worth a matrix product


@dataclass(frozen=True, slots=True, eq=False)
class EventBlock:
    """One pass of one event at a block of stations; every array is (n, 2): top and bottom face.

    Damages are Miner sums of one pass, ``damage_raw_end`` that without the end treatment; so are ``cycles`` (sum n) and
    ``power_sum`` (sum n S^k). ``histogram`` is (n, 2, b, 2), see ``BlockCount``; ``verdict`` is an index into
    ``VERDICTS``. What needs a spectrum is NaN without one, what needs cycles is NaN where bounds stand for them.
    """

    damage: NDArray[np.float64]
    damage_same_ratio: NDArray[np.float64]
    damage_mean_stress: NDArray[np.float64]
    damage_shear: NDArray[np.float64]
    damage_raw_end: NDArray[np.float64]
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

    def at(self, rows: NDArray[np.bool_]) -> "EventBlock":
        """Take some stations."""
        return EventBlock(*(getattr(self, field.name)[rows] for field in fields(self)))


def count_event(
    shapes: Shapes, load: EventLoad, estimate: Estimate, yield_MPa: float | None, mean_stress: bool
) -> EventBlock:
    """Count one pass of an event at every station of a block; see `judged` for the verdict.

    The equivalent range of each cycle has that cycle's own bending ratio (ASME VIII-2 5.5.5).
    """
    counted, raw_end = _counted(shapes, load, estimate.one_ratio, yield_MPa, mean_stress)
    var, shear_var, covar, shear_bending_ratio = _variances(shapes, load)
    if shapes.uses_bending_ratio:
        I_s, I_t = ratio_factor(estimate.one_ratio), ratio_factor(shear_bending_ratio)
    else:
        I_s = I_t = np.ones_like(var)
    with_shear = shear_factor(var / I_s**2, shear_var / I_t**2, covar / (I_s * I_t)) ** shapes.law.slopes[0]
    return EventBlock(
        damage=counted.damage,
        damage_same_ratio=counted.damage_same_ratio,
        damage_mean_stress=counted.damage_mean_stress,
        damage_shear=np.where(counted.damage > 0.0, counted.damage * with_shear, 0.0),
        damage_raw_end=raw_end,
        damage_dirlik=estimate.dirlik,
        damage_tb=estimate.tb,
        cycles=counted.cycles,
        power_sum=counted.power_sum,
        max_range=counted.max_range,
        r_largest=counted.r_largest,
        max_equivalent_range=counted.max_equivalent_range,
        mean=estimate.mean,
        kurtosis=counted.kurtosis,
        bending_ratio=estimate.bending_ratio,
        shear_ratio=quotient(np.sqrt(shear_var), np.sqrt(var)),
        irregularity=estimate.irregularity,
        peaks_per_s=estimate.peaks_per_s,
        samples_per_peak=estimate.samples_per_peak,
        verdict=np.full(var.shape, VERDICTS.index("not_assessed"), dtype=np.int8),
        histogram=counted.histogram,
    )


def judged(event: EventBlock, shapes: Shapes, load: EventLoad, estimate: Estimate) -> EventBlock:
    """Judge by what was counted whether the estimate may be trusted at each point of a block."""
    if load.trust is None:
        return event
    law, stress = shapes.law, load.stress_factor * faces(shapes.membrane, shapes.bending)
    same_ratio, damage = event.damage_same_ratio.reshape(-1), event.damage.reshape(-1)
    found = judge(
        stress.reshape(-1, stress.shape[-1]),
        estimate.moments.reshape(len(estimate.moments), -1),
        load.trust,
        slope=float(law.slopes[0]),
        dirlik_ratio=quotient(estimate.dirlik.reshape(-1), same_ratio),
        tb_ratio=quotient(estimate.tb.reshape(-1), same_ratio),
        kurtosis=event.kurtosis.reshape(-1),
        top_cycle_share=quotient(cycle_damage(event.max_equivalent_range.reshape(-1), law), damage),
        samples_per_peak=estimate.samples_per_peak.reshape(-1),
        top_mode_hz=load.top_mode_hz,
    )
    return replace(event, verdict=found.verdict.reshape(event.damage.shape))


def bounded_event(estimate: Estimate, bound: Bound, raw_ends: RawEnds) -> EventBlock:
    """Take proven bounds for one pass of an event: damage and largest ranges are never larger; nothing was counted."""
    unknown = np.full(bound.damage.shape, np.nan)
    raw_end = bound.damage.copy()
    raw_end[raw_ends.rows] = np.nan
    return EventBlock(
        damage=bound.damage,
        damage_same_ratio=unknown,
        damage_mean_stress=unknown,
        damage_shear=unknown,
        damage_raw_end=raw_end,
        damage_dirlik=estimate.dirlik,
        damage_tb=estimate.tb,
        cycles=unknown,
        power_sum=unknown,
        max_range=bound.max_range,
        r_largest=unknown,
        max_equivalent_range=bound.max_equivalent_range,
        mean=estimate.mean,
        kurtosis=unknown,
        bending_ratio=estimate.bending_ratio,
        shear_ratio=unknown,
        irregularity=estimate.irregularity,
        peaks_per_s=estimate.peaks_per_s,
        samples_per_peak=estimate.samples_per_peak,
        verdict=np.full(unknown.shape, VERDICTS.index("not_assessed"), dtype=np.int8),
        histogram=np.zeros((*unknown.shape, 0, 2)),
    )


@contextmanager
def no_overflow(event: str, welds: str) -> Iterator[None]:
    """Turn an overflow while an event is counted at some welds into an error that names both.

    Raises
    ------
    NumericalError : stress or damage exceeds double precision
    """
    try:
        with np.errstate(over="raise"):
            yield
    except FloatingPointError:
        raise NumericalError(
            Problem(
                "overflow",
                f"event '{event}', {welds}",
                "stresses or damage exceed what double precision can hold",
                "Check the units of forces and modal coordinates, and look for a value that is far too large",
            )
        ) from None


def _counted(
    shapes: Shapes, load: EventLoad, one_ratio: NDArray[np.float64], yield_MPa: float | None, mean_stress: bool
) -> tuple[BlockCount, NDArray[np.float64]]:
    """Count a block, and beside it the ends that matter as they are without treatment: their damage is that of (n, 2).

    It is NaN at ends that do not matter without treatment, and that of the block where there is none.
    """
    n, ends = len(shapes), shapes.raw_ends
    rows = ends.rows[ends.matters]
    if rows.size:
        shapes = replace(
            shapes,
            membrane=np.concatenate([shapes.membrane, ends.membrane[ends.matters]]),
            bending=np.concatenate([shapes.bending, ends.bending[ends.matters]]),
            size=np.concatenate([shapes.size, shapes.size[rows]]),
        )
        one_ratio = np.concatenate([one_ratio, one_ratio[rows]])
    everything = _superpose_and_count(shapes, load, one_ratio, yield_MPa, mean_stress)
    counted = BlockCount(*(getattr(everything, field.name)[:n] for field in fields(BlockCount)))
    raw_end = counted.damage.copy()
    raw_end[ends.rows] = np.nan
    raw_end[rows] = everything.damage[n:]
    return counted, raw_end


def _superpose_and_count(
    shapes: Shapes, load: EventLoad, one_ratio: NDArray[np.float64], yield_MPa: float | None, mean_stress: bool
) -> BlockCount:
    """Recover membrane and bending histories, a few rows or some samples at a time, and count them."""
    S_m, S_b, size = load.stress_factor * shapes.membrane, load.stress_factor * shapes.bending, shapes.size
    if load.single is not None and is_fast(shapes.law, load.single):
        return count_block_fast(
            S_m,
            S_b,
            load.single,
            size,
            one_ratio,
            shapes.law,
            uses_bending_ratio=shapes.uses_bending_ratio,
            residue=load.residue,
            yield_MPa=yield_MPa,
            mean_stress=mean_stress,
        )
    q = load.counted.q
    if isinstance(q, Spool) or q.shape[1] > _LONGEST_ROW:
        return count_block_long(
            S_m,
            S_b,
            q,
            size,
            one_ratio,
            shapes.law,
            uses_bending_ratio=shapes.uses_bending_ratio,
            residue=load.residue,
            yield_MPa=yield_MPa,
            mean_stress=mean_stress,
        )
    rows = max(1, _SAMPLES_AT_ONCE // q.shape[1])  # depends on the record only: the bytes do not depend on the machine
    pieces = []
    for first in range(0, len(S_m), rows):
        some = slice(first, first + rows)
        piece = count_block(
            stress_history(S_m[some], q),
            stress_history(S_b[some], q),
            size[some],
            one_ratio[some],
            shapes.law,
            uses_bending_ratio=shapes.uses_bending_ratio,
            residue=load.residue,
            yield_MPa=yield_MPa,
            mean_stress=mean_stress,
        )
        pieces.append(piece)
    return BlockCount(*(np.concatenate([getattr(p, f.name) for p in pieces]) for f in fields(BlockCount)))


def _variances(shapes: Shapes, load: EventLoad) -> tuple[NDArray[np.float64], ...]:
    """Variances of stress and shear and their covariance, (n, 2), and the one bending ratio of the shear, (n, 1)."""
    f = load.stress_factor
    S_m, S_b = f * shapes.membrane, f * shapes.bending
    S_s, S_t = f * shapes.in_plane_shear, f * shapes.twist_shear
    C_m, C_b, C_s, C_t = (S @ load.covariance for S in (S_m, S_b, S_s, S_t))
    stress, shear = faces(S_m, S_b), faces(S_s, S_t)
    stress_C, shear_C = faces(C_m, C_b), faces(C_s, C_t)
    std_s, std_t = (np.sqrt(np.maximum(_along_modes(a, b), 0.0)) for a, b in ((C_s, S_s), (C_t, S_t)))
    return (
        np.maximum(_along_modes(stress_C, stress), 0.0),
        np.maximum(_along_modes(shear_C, shear), 0.0),
        _along_modes(stress_C, shear),
        np.nan_to_num(quotient(std_t, std_s + std_t))[:, None],
    )


def _along_modes(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(np.einsum("...m,...m->...", a, b))
