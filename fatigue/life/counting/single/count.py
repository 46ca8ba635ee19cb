"""Superposition, rainflow counting and damage of a block of points in one pass over time, in single precision.

The stress histories come out of a matrix product, some thousand samples at a time, and are used up before the next
product. Three steps follow per point and surface:

1. `write_reversals` appends the turning points, z = stress at a peak and minus the stress at a valley, so that every
   z[i] + z[i + 1] is a range. The membrane stress carries the same sign.
2. `close_pass` takes out every range that is smaller than the one before it and not larger than the one after it, all
   of them at once: two neighbours never both qualify, and taking one never disqualifies another, so the cycles are
   those of the stack machine in `rainflow`, in another order. What is left after a few passes, some tens of points,
   waits for the next samples; at the end of the record the stack finishes it.
3. `raise_to_slope` has S^k of all cycles from polynomials for log2 and exp2, and I(r)^(-k/m) from a polynomial in r.

Where single precision cannot tell which of two neighbouring samples is the extreme, or which of two ranges is the
larger one, double precision does in that chunk, see `single.doubt`. The few surfaces of which that is not enough are
counted again in the same way in double precision, all of a call together. Points in high mean tension, laws with knees,
and short records go to `count_block_long`. The loop over time is in `single.run`, those over samples
are in `single.loops` and `single.power`;
`single.simd` has steps 1 and 2 in vector instructions, and without that file the plain loops do the same, bit for
bit.

Modal coordinates are only read in slices of some thousand samples, so they may be on disk.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fatigue.life import damage
from fatigue.life.counting.chunks import count_block_long
from fatigue.life.counting.rainflow import BlockCount
from fatigue.life.counting.signal import not_finite
from fatigue.life.counting.single.doubt import Exact
from fatigue.life.counting.single.power import PowerLaw, power_law
from fatigue.life.counting.single.product import (
    block_for,
    is_in_panels,
    prepared_samples,
    prepared_shapes,
    samples_between,
    space_for_samples,
)
from fatigue.life.counting.single.run import Run, count_in_memory, count_record
from fatigue.life.counting.single.state import PAD, fresh_state, room_for
from fatigue.life.curves import DamageLaw
from fatigue.life.records.history import Residue, mean_and_covariance
from fatigue.life.records.spool import Samples, Spool

Floats = NDArray[np.float64]
Singles = NDArray[np.float32]

POINTS = 48  # counted at a time, twice as many fill whole tiles; the stress of more would not stay in the cache
CHUNK = 4096  # samples recovered at a time, a multiple of `product.STEP`
RESIDUE = 512  # reversals of a point that may wait for the next chunk

SHORTEST = 512  # samples of a record; a few cycles do not average rounding errors out
STEEPEST = 12.0  # slope up to which S^k stays within single precision
CANCELLATION = 8.0  # modal stresses over their sum from which on single precision is not enough
FLAT = 4e-8  # doubt about a difference of stresses of rms 1, per root of the number of modes: 3 standard deviations


@dataclass(frozen=True, slots=True, eq=False)
class Record:
    """What all points share of the modal coordinates they are counted on; threads may read it at the same time.

    Attributes
    ----------
    exact : (m, t) the modal coordinates as given
    q : the same without their mean and over ``scale``, in single precision: in memory as `single.product` lays them
        out, or (m, t) on disk
    scale : (m,) powers of 2 near the standard deviations
    mean : (m,) time mean
    covariance : (m, m)
    """

    exact: Samples
    q: Singles | Spool
    scale: Floats
    mean: Floats
    covariance: Floats


class _Block(NamedTuple):
    """Shapes of a block over ``scale`` [MPa], and the mean of its stress [MPa].

    ``membrane`` and ``bending`` (n, m); ``scale`` (n, 1); ``mean`` and ``trusted`` (n, 2): single precision is enough.
    """

    membrane: Floats
    bending: Floats
    scale: Floats
    mean: Floats
    trusted: NDArray[np.bool_]


def record_of(q: Samples, single: Spool | None = None, known: tuple[Floats, Floats] | None = None) -> Record:
    """Prepare modal coordinates (m, t) for `count_block_fast`, once for all points.

    Their copy in single precision is written to ``single`` (m, t), by default to memory. ``known`` are their mean and
    covariance, see `mean_and_covariance`, where somebody has computed them before.

    Raises
    ------
    NumericalError : a sample is not finite
    """
    modes, t = q.shape
    pieces = [slice(first, min(first + CHUNK, t)) for first in range(0, t, CHUNK)]
    with np.errstate(invalid="ignore"):
        mean, covariance = mean_and_covariance(q) if known is None else known
    if not np.isfinite(np.diagonal(covariance)).all():
        _refuse_not_finite(q, pieces)
    exponent = np.frexp(np.sqrt(np.diagonal(covariance)))[1]
    scale, over_scale = np.ldexp(1.0, exponent), np.ldexp(1.0, -exponent)

    def normalised(piece: slice) -> Singles:
        centred = q[:, piece] - mean[:, None]
        centred *= over_scale[:, None]
        return centred.astype(np.float32)

    if single is not None:
        for piece in pieces:
            single[:, piece] = normalised(piece)
        return Record(q, single, scale, mean, covariance)
    laid_out = space_for_samples(modes, t, np.float32)
    for piece in pieces:
        prepared_samples(normalised(piece), samples_between(laid_out, piece.start, piece.stop))
    return Record(q, laid_out, scale, mean, covariance)


def _refuse_not_finite(q: Samples, pieces: Sequence[slice]) -> None:
    """Name the first sample that is not finite."""
    for piece in pieces:
        finite = np.isfinite(q[:, piece])
        if not finite.all():
            mode, sample = np.argwhere(~finite)[0]
            raise not_finite(f"sample {piece.start + sample} of modal coordinate {mode}")


def is_fast(law: DamageLaw, record: Record) -> bool:
    """Whether `count_block_fast` counts itself: a law of one slope, not too steep, and a record not too short."""
    return law.is_straight and float(law.slopes[0]) <= STEEPEST and record.exact.shape[1] >= SHORTEST


def count_block_fast(
    S_m: Floats,
    S_b: Floats,
    record: Record,
    size: Floats,
    same_ratio: Floats,
    law: DamageLaw,
    *,
    uses_bending_ratio: bool,
    residue: Residue,
    yield_MPa: float | None,
    mean_stress: bool,
) -> BlockCount:
    """Count the stress S_m @ q + S_b @ q (top) and S_m @ q - S_b @ q (bottom) of a block as `count_block` does.

    Parameters
    ----------
    S_m, S_b : (n, m) membrane stress, and bending stress of the top surface [MPa per unit modal coordinate]
    record : the modal coordinates
    size, same_ratio, law, uses_bending_ratio, residue, yield_MPa, mean_stress : as in `count_block`

    Raises
    ------
    NumericalError : a stress is not finite; CaseError : ``mean_stress`` without a yield stress
    """

    def exactly(rows: slice | NDArray[np.intp]) -> BlockCount:
        return count_block_long(
            S_m[rows],
            S_b[rows],
            record.exact,
            size[rows],
            same_ratio[rows],
            law,
            uses_bending_ratio=uses_bending_ratio,
            residue=residue,
            yield_MPa=yield_MPa,
            mean_stress=mean_stress,
        )

    if not is_fast(law, record) or (mean_stress and yield_MPa is None):  # the latter it refuses
        return exactly(slice(None))
    finite = np.isfinite(S_m).all(axis=1) & np.isfinite(S_b).all(axis=1)
    if not finite.all():
        raise not_finite(f"row {np.flatnonzero(~finite)[0]} of the block")
    block = _normalised(S_m, S_b, record)
    rules = power_law(float(law.slopes[0]), uses_bending_ratio)
    recurs = residue == "repeat"
    everywhere = np.ones((len(size), 2), np.bool_)
    found = _count(block, everywhere, record, rules, recurs, np.float32)
    doubtful = found["doubtful"] & ~found["crowded"]
    rows = np.flatnonzero(doubtful.any(axis=1))
    if rows.size:
        wanted = doubtful[rows]
        again = _count(_Block._make(a[rows] for a in block), wanted, record, rules, recurs, np.float64)
        for name in ("maximum", "minimum"):
            again[name] -= again["mean"]
        found[doubtful] = again[wanted]
    count = _evaluated(found, block, record, size, same_ratio, law, uses_bending_ratio)
    unsuited = found["crowded"]
    if yield_MPa is not None:  # f_M is 1 where no cycle reaches this tension
        unsuited |= 2.0 * (block.mean + block.scale * found["maximum"]) >= (1.0 - 1e-6) * yield_MPa
        count = replace(count, damage_mean_stress=count.damage.copy())
    rows = np.flatnonzero(unsuited.any(axis=1))
    if rows.size:
        exact = exactly(rows)
        for field in fields(BlockCount):
            getattr(count, field.name)[rows] = getattr(exact, field.name)
    return count


def _surfaces(membrane: Floats, bending: Floats) -> Floats:
    """Stress of top and bottom surface side by side."""
    return np.stack([membrane + bending, membrane - bending], axis=1)


def _normalised(S_m: Floats, S_b: Floats, record: Record) -> _Block:
    """Divide the shapes of each point by a power of 2 so that its modal stresses have an rms of about 1."""
    of_membrane, of_bending = S_m @ record.covariance, S_b @ record.covariance
    pairs = (of_membrane, S_m), (of_bending, S_b), (of_membrane, S_b)
    membrane, bending, both = (np.einsum("nm,nm->n", a, b) for a, b in pairs)
    variance = np.maximum(_surfaces(membrane + bending, 2.0 * both), 0.0)
    modal = (S_m**2 + S_b**2) @ np.diagonal(record.covariance)
    scale = np.ldexp(1.0, np.frexp(np.sqrt(modal))[1])[:, None]
    return _Block(
        membrane=S_m * record.scale / scale,
        bending=S_b * record.scale / scale,
        scale=scale,
        mean=_surfaces(S_m @ record.mean, S_b @ record.mean),
        trusted=variance * CANCELLATION**2 >= modal[:, None],
    )


def _count(
    block: _Block,
    wanted: NDArray[np.bool_],
    record: Record,
    rules: PowerLaw,
    recurs: bool,
    precision: type[np.floating],
) -> NDArray[np.void]:
    """Count normalised stress, some samples and some points at a time, into numbers of type `SIDE` (n, 2)."""
    single = precision is np.float32
    modes, t = record.exact.shape
    flat = np.float32(FLAT * math.sqrt(modes) if single else -1.0)
    state = fresh_state(len(wanted), RESIDUE, precision)
    state.sides["wanted"] = wanted
    if single:
        state.sides["doubtful"] = ~block.trusted
    else:
        state.sides["mean"] = block.mean / block.scale
    exact = Exact(block.membrane / record.scale, block.bending / record.scale, record.exact)
    shapes = (block.membrane, block.bending) if single else (exact.membrane, exact.bending)
    pieces = (slice(first, first + POINTS) for first in range(0, len(wanted), POINTS))
    in_pieces = np.concatenate([part[piece] for piece in pieces for part in shapes])
    rows, width = 2 * min(len(wanted), POINTS), 1 + min(t, CHUNK) + 1 + PAD
    run = Run(
        shapes=prepared_shapes(in_pieces.astype(precision)),
        stress=block_for(rows, width, precision),
        space=space_for_samples(modes, min(t, CHUNK), precision),
        room=room_for(width, RESIDUE, precision),
        recurs=recurs,
        flat=flat,
        sizes=(CHUNK, POINTS),
    )
    q = record.q if single else record.exact
    in_memory = is_in_panels(q) and isinstance(record.exact, np.ndarray)
    count_all = count_in_memory if in_memory else count_record
    count_all(q, exact, rules, state, run)
    return state.sides


def _evaluated(
    found: NDArray[np.void],
    block: _Block,
    record: Record,
    size: Floats,
    same_ratio: Floats,
    law: DamageLaw,
    uses_bending_ratio: bool,
) -> BlockCount:
    """Turn the sums of normalised stress into those of `BlockCount`."""
    k = float(law.slopes[0])
    to_damage = np.exp(k * np.log(block.scale * size[:, None]) - law.log_constants[0])
    I_same = damage.ratio_factor(same_ratio) if uses_bending_ratio else 1.0
    samples, nan = record.exact.shape[1], np.full(same_ratio.shape, np.nan)
    turning = found["first_up"] >= 0
    minimum, maximum = block.mean + block.scale * found["minimum"], block.mean + block.scale * found["maximum"]
    return BlockCount(
        damage=to_damage * found["damage"],
        damage_same_ratio=to_damage * I_same**-k * found["power_sum"],
        damage_mean_stress=nan,
        cycles=found["cycles"].copy(),
        power_sum=block.scale**k * found["power_sum"],
        max_range=block.scale * (found["maximum"] - found["minimum"]),
        r_largest=np.divide(minimum, maximum, out=nan.copy(), where=turning & (maximum != 0.0)),
        max_equivalent_range=block.scale * size[:, None] * found["largest"] ** (1.0 / k),
        mean=block.mean,
        kurtosis=np.divide(samples * found["fourth"], found["second"] ** 2, out=nan.copy(), where=turning),
        histogram=np.zeros((len(size), 2, 0, 2)),
    )
