"""Superposition, rainflow counting and damage of a block of points in one pass over time, in single precision.

The stress histories come out of a matrix product, some thousand samples at a time, and are used up before the next
product. Three steps follow per point and surface:

1. ``write_reversals`` appends the turning points, z = stress at a peak and minus the stress at a valley, so that every
   z[i] + z[i + 1] is a range. The membrane stress carries the same sign.
2. ``close_pass`` takes out every range that is smaller than the one before it and not larger than the one after it, all
   of them at once: two neighbours never both qualify, and taking one never disqualifies another, so these are the
   cycles of the stack machine in ``reversals``, in another order. What is left after a few passes, some tens of points,
   waits for the next samples; at the end of the record the stack finishes it.
3. ``raise_to_slope`` has S^k of all cycles from polynomials for log2 and exp2, and I(r)^(-k/m) from a polynomial in r.

Where single precision cannot tell which of two neighbouring samples is the extreme, or which of two ranges is the
larger one, double precision does in that chunk, see ``kernels.doubt``. The few surfaces of which that is not enough are
counted again in the same way in double precision, all of a call together. Points in high mean tension, those whose
modes cancel so far that powers of what is left leave the exponents of single precision, laws with knees, and short
records go to ``count_chunks``. ``kernels.over_time`` loops over time, ``kernels.loops`` and ``kernels.power``
over samples; ``kernels.simd`` has steps 1 and 2 in vector instructions, and without that file the plain loops do the
same, bit for bit.

Modal coordinates are only read in slices of some thousand samples, so they may be on disk.
"""

import math
from dataclasses import fields, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fatigue.life.counting.block import BlockCount, BlockStress
from fatigue.life.counting.chunks import count_chunks, count_chunks_and_residue
from fatigue.life.counting.record import CountedRecord, SingleRecord
from fatigue.life.counting.residue import BlockResidue
from fatigue.life.counting.signal import not_finite
from fatigue.life.counting.single.kernels.doubt import Exact
from fatigue.life.counting.single.kernels.over_time import Workspace, count_in_memory, count_record
from fatigue.life.counting.single.kernels.power import PowerLaw, power_law
from fatigue.life.counting.single.kernels.product import block_for, is_in_panels, prepared_rows, space_for_samples
from fatigue.life.counting.single.kernels.state import PAD, State, fresh_state, room_for
from fatigue.life.counting.single.prepare import CHUNK
from fatigue.life.rule import CycleRule

Floats = NDArray[np.float64]

POINTS = 48  # counted at a time, twice as many fill whole tiles; the stress of more would not stay in the cache
RESIDUE = 512  # reversals of a point that may wait for the next chunk
KEPT = 128  # reversals of the residue of a pass, some ten as a rule

SHORTEST = 512  # samples of a record; a few cycles do not average rounding errors out
STEEPEST = 12.0  # slope up to which S^k stays within single precision
CANCELLATION = 8.0  # modal stresses over their sum from which on single precision is not enough
SMALLEST = -64.0  # exponent of S^k of the largest range, over the modal stress; what ``kernels.power`` has ends at -126
FLAT = 4e-8  # doubt about a difference of stresses of rms 1, per root of the number of modes: 3 standard deviations


class _Normalised(NamedTuple):
    """Modal stress of a block over ``scale`` [MPa], and the mean of its stress [MPa].

    ``membrane`` and ``bending`` (n, m); ``scale`` (n, 1); ``mean`` (n, 2) of top and bottom, ``mean_parts`` (n, 2) of
    membrane and bending; ``trusted`` (n, 2): single precision is enough.
    """

    membrane: Floats
    bending: Floats
    scale: Floats
    mean: Floats
    mean_parts: Floats
    trusted: NDArray[np.bool_]


def is_single(record: CountedRecord, rule: CycleRule) -> bool:
    """Whether this counter serves: a law of one slope, not too steep, and a record prepared for it, not too short.

    Reversals at vertices are not for it: whether ranges close is then no question of two samples, which is what its
    doubts are about. Nor are the allowances of a curve for bending or for the stress ratio of a cycle.
    """
    straight = rule.law.is_straight and float(rule.law.slopes[0]) <= STEEPEST
    known = straight and rule.is_of_range_alone
    return record.single is not None and not record.vertex and known and record.q.shape[1] >= SHORTEST


def count_single(stress: BlockStress, record: CountedRecord, rule: CycleRule) -> BlockCount:
    """Count a block as ``count`` does, where ``is_single`` says so.

    Raises
    ------
    NumericalError : a stress is not finite
    """
    count, _ = _counted(stress, record, rule, 0)
    return count


def count_single_and_residue(
    stress: BlockStress, record: CountedRecord, rule: CycleRule
) -> tuple[BlockCount, BlockResidue]:
    """Count a block as ``count_single`` does, and keep the residue of every point."""
    return _counted(stress, record, rule, KEPT)


def _counted(stress: BlockStress, record: CountedRecord, rule: CycleRule, kept: int) -> tuple[BlockCount, BlockResidue]:
    """Count a block, with residues of ``kept`` reversals at most, or counted in double precision; 0: no residues."""
    single = record.single
    assert single is not None
    finite = np.isfinite(stress.membrane).all(axis=1) & np.isfinite(stress.bending).all(axis=1)
    if not finite.all():
        raise not_finite(f"row {np.flatnonzero(~finite)[0]} of the block")
    block = _normalised(stress, single)
    law = power_law(float(rule.law.slopes[0]), rule.uses_bending_ratio)
    everywhere = np.ones((len(stress), 2), np.bool_)
    state = _count(block, everywhere, record, single, law, np.float32, kept)
    found, residue = state.sides, _residue_of(state, block, block.mean_parts)
    doubtful = found["doubtful"] & ~found["crowded"]
    rows = np.flatnonzero(doubtful.any(axis=1))
    if rows.size:
        wanted = doubtful[rows]
        some = _Normalised._make(a[rows] for a in block)
        state = _count(some, wanted, record, single, law, np.float64, kept)
        again = state.sides
        for name in ("maximum", "minimum"):
            again[name] -= again["mean"]
        found[doubtful] = again[wanted]
        residue = residue.replaced(doubtful, _residue_of(state, some, np.zeros_like(some.mean_parts)), wanted)
    count = _evaluated(found, block, stress, record.q.shape[1], rule)
    unsuited, tense = found["crowded"] | _vanishes(found, law), np.zeros((len(stress), 2), np.bool_)
    if rule.yield_MPa is not None:  # f_M is 1 where no cycle reaches this tension
        count = replace(count, damage_mean_stress=count.damage.copy())
        highest = block.mean + block.scale * found["maximum"]
        unsuited |= 2.0 * highest >= (1.0 - 1e-6) * rule.yield_MPa
        tense = 2.0 * (highest + stress.level) >= (1.0 - 1e-6) * rule.yield_MPa
        unsuited |= tense & rule.mean_stress
    rows = np.flatnonzero(unsuited.any(axis=1))
    if rows.size:
        if kept:
            exact, others = count_chunks_and_residue(stress.at(rows), record, rule)
            whole = np.zeros(unsuited.shape, np.bool_)
            whole[rows] = True
            residue = residue.replaced(whole, others, whole[rows])
        else:
            exact = count_chunks(stress.at(rows), record, rule)
        for field in fields(BlockCount):
            getattr(count, field.name)[rows] = getattr(exact, field.name)
    tense[rows] = False
    rows = np.flatnonzero(tense.any(axis=1))
    if rows.size:  # in tension by the offset, on which nothing else may depend
        exact = count_chunks(stress.at(rows), record, rule)
        counted = exact.damage > 0.0
        factor = np.divide(exact.damage_mean_stress, exact.damage, out=np.ones_like(exact.damage), where=counted)
        count.damage_mean_stress[rows] *= factor
    return count, residue


def _vanishes(found: NDArray[np.void], law: PowerLaw) -> NDArray[np.bool_]:
    """Whether modes cancel so far that S^k of the largest range (n, 2) is near the smallest number of ``power``."""
    largest = found["maximum"] - found["minimum"]
    return np.asarray((largest > 0.0) & (law.slope * np.log2(np.where(largest > 0.0, largest, 1.0)) < SMALLEST))


def _residue_of(state: State, block: _Normalised, mean: Floats) -> BlockResidue:
    """Residues of a block from its normalised stress, over a ``mean`` (n, 2) of membrane and bending stress [MPa]."""
    s, m = (state.residue[:, :, i].astype(np.float64) for i in range(2))
    b = (s - m) * np.array([1.0, -1.0])[:, None]  # the surfaces are m + b and m - b
    scale, length = block.scale[:, None], np.minimum(state.sides["kept"], state.residue.shape[3])
    return BlockResidue.of_padded(scale * m + mean[:, 0, None, None], scale * b + mean[:, 1, None, None], length)


def _surfaces(membrane: Floats, bending: Floats) -> Floats:
    """Stress of top and bottom surface side by side."""
    return np.stack([membrane + bending, membrane - bending], axis=1)


def _normalised(stress: BlockStress, single: SingleRecord) -> _Normalised:
    """Divide the stress of each point by a power of 2 so that its modal stresses have an rms of about 1."""
    S_m, S_b = stress.membrane, stress.bending
    of_membrane, of_bending = S_m @ single.covariance, S_b @ single.covariance
    pairs = (of_membrane, S_m), (of_bending, S_b), (of_membrane, S_b)
    membrane, bending, both = (np.einsum("nm,nm->n", a, b) for a, b in pairs)
    variance = np.maximum(_surfaces(membrane + bending, 2.0 * both), 0.0)
    modal = (S_m**2 + S_b**2) @ np.diagonal(single.covariance)
    scale = np.ldexp(1.0, np.frexp(np.sqrt(modal))[1])[:, None]
    return _Normalised(
        membrane=S_m * single.scale / scale,
        bending=S_b * single.scale / scale,
        scale=scale,
        mean=_surfaces(S_m @ single.mean, S_b @ single.mean),
        mean_parts=np.stack([S_m @ single.mean, S_b @ single.mean], axis=1),
        trusted=variance * CANCELLATION**2 >= modal[:, None],
    )


def _count(
    block: _Normalised,
    wanted: NDArray[np.bool_],
    record: CountedRecord,
    single: SingleRecord,
    law: PowerLaw,
    precision: type[np.floating],
    kept: int,
) -> State:
    """Count normalised stress, some samples and some points at a time; returns the state behind the last sample."""
    is_first = precision is np.float32
    modes, t = record.q.shape
    flat = np.float32(FLAT * math.sqrt(modes) if is_first else -1.0)
    state = fresh_state(len(wanted), RESIDUE, precision, kept)
    state.sides["wanted"] = wanted
    if is_first:
        state.sides["doubtful"] = ~block.trusted
    else:
        state.sides["mean"] = block.mean / block.scale
    exact = Exact(block.membrane / single.scale, block.bending / single.scale, record.q)
    parts = (block.membrane, block.bending) if is_first else (exact.membrane, exact.bending)
    of_points = (slice(first, first + POINTS) for first in range(0, len(wanted), POINTS))
    modal_stress = np.concatenate([part[some] for some in of_points for part in parts])
    rows, width = 2 * min(len(wanted), POINTS), 1 + min(t, CHUNK) + 1 + PAD
    work = Workspace(
        modal_stress=prepared_rows(modal_stress.astype(precision)),
        stress=block_for(rows, width, precision),
        space=space_for_samples(modes, min(t, CHUNK), precision),
        room=room_for(width, RESIDUE, precision),
        recurs=record.recurs,
        flat=flat,
        sizes=(CHUNK, POINTS),
    )
    q = single.q if is_first else record.q
    in_memory = is_in_panels(q) and isinstance(record.q, np.ndarray)
    count_all = count_in_memory if in_memory else count_record
    count_all(q, exact, law, state, work)
    return state


def _evaluated(
    found: NDArray[np.void], block: _Normalised, stress: BlockStress, samples: int, rule: CycleRule
) -> BlockCount:
    """Turn the sums of normalised stress into a ``BlockCount``."""
    size = stress.size[:, None]
    k = float(rule.law.slopes[0])
    to_damage = np.exp(k * np.log(block.scale * size) - rule.law.log_constants[0])
    I_same = rule.ratio_factor(stress.same_ratio)
    nan = np.full(stress.same_ratio.shape, np.nan)
    turning = found["first_up"] >= 0
    mean = block.mean + stress.level
    minimum, maximum = mean + block.scale * found["minimum"], mean + block.scale * found["maximum"]
    return BlockCount(
        damage=to_damage * found["damage"],
        damage_same_ratio=to_damage * I_same**-k * found["power_sum"],
        damage_with_shear=np.zeros_like(nan),
        damage_mean_stress=nan,
        cycles=found["cycles"].copy(),
        power_sum=block.scale**k * found["power_sum"],
        max_range=block.scale * (found["maximum"] - found["minimum"]),
        r_largest=np.divide(minimum, maximum, out=nan.copy(), where=turning & (maximum != 0.0)),
        max_equivalent_range=block.scale * size * found["largest"] ** (1.0 / k),
        mean=mean,
        kurtosis=np.divide(samples * found["fourth"], found["second"] ** 2, out=nan.copy(), where=turning),
        histogram=np.zeros((len(stress), 2, 0, 2)),
    )
