"""Superposition, rainflow counting and damage of a block of points in one pass over time, in single precision.

The stress histories come out of a matrix product, some thousand samples at a time, and are used up before the next
product. Three steps follow per point and surface:

1. `write_reversals` appends the turning points, z = stress at a peak and minus the stress at a valley, so that every
   z[i] + z[i + 1] is a range. The membrane stress carries the same sign.
2. `close_cycles` takes out every range that is smaller than the one before it and not larger than the one after it, all
   of them at once: two neighbours never both qualify, and taking one never disqualifies another, so the cycles are those
   of the stack machine in `rainflow`, in another order. What is left after a few passes, some tens of points, waits for
   the next samples; at the end of the record the stack finishes it.
3. `raise_to_slope` has S^k of all cycles from polynomials for log2 and exp2, and I(r)^(-k/m) from a polynomial in r.

Where single precision cannot tell which of two samples is the extreme, and the choice would show in the damage, the
point is counted again in double precision by `count_block`, and so is every point the shortcuts here do not cover.
`rainflow_simd` has steps 1 and 2 in vector instructions; without that file the plain loops below do the same, bit for bit.
"""

import importlib.util
import math
from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from functools import cache
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from llvmlite import ir
from numba import types
from numba.extending import intrinsic
from numpy.polynomial import Chebyshev, Polynomial
from numpy.typing import NDArray

from fatigue.life import damage
from fatigue.life.curves import DamageLaw
from fatigue.life.history import Residue
from fatigue.life.rainflow import BlockCount, compiled, count_block, not_finite

Floats = NDArray[np.float64]
Singles = NDArray[np.float32]

CHUNK = 8192  # samples of a block recovered at once
PAD = 32  # room behind a row for vector instructions that write more than they keep
RESIDUE = 1024  # reversals of a point that may wait for the next chunk
FEW = 32  # reversals that are not worth another pass

STEEPEST = 12.0  # slope up to which S^k stays within single precision
FLAT = 1e-6  # stress difference lost to rounding, in units of the rms of the modal stresses
CANCELLATION = 16.0  # modal stresses over their sum from which on single precision is not enough
RATIO_DEGREE = 10
DOUBT = 2e-7  # relative doubt about the damage that is let pass


@dataclass(frozen=True, slots=True, eq=False)
class Record:
    """What all points share of the modal coordinates they are counted on; threads may read it at the same time.

    Attributes
    ----------
    exact : (m, t) the modal coordinates as given
    q : (m, t) the same without their mean, in single precision
    mean : (m,) time mean
    covariance : (m, m)
    """

    exact: NDArray[np.floating]
    q: Singles
    mean: Floats
    covariance: Floats


class _Law(NamedTuple):
    """A straight law for compiled code: its slope k, k = head + tail with 12 bits in the head, and I(r)^(-k/m)."""

    slope: np.float32
    head: np.float32
    tail: np.float32
    ratio_power: tuple[np.float32, ...]


class _State(NamedTuple):
    """What the counter knows of each point and surface (n, 2) between two chunks, and what it has summed up.

    ``first_up`` and ``up`` are the directions of the first step and of the last one, -1 before there is any; ``near``
    tells whether the last step was flat; ``waiting`` of the reversals ``z``, ``m`` have not closed a cycle. The sums
    are those of `BlockCount` for normalised stress; ``doubt`` is the sum of the membrane differences between samples of
    which either may be the extreme.
    """

    start: Singles
    flat: Singles
    first_m: Singles
    first_up: NDArray[np.int64]
    up: NDArray[np.int64]
    near: NDArray[np.int64]
    waiting: NDArray[np.int64]
    z: Singles
    m: Singles
    cycles: Floats
    power_sum: Floats
    damage: Floats
    largest: Floats
    fourth: Floats
    doubt: Floats
    maximum: Floats
    minimum: Floats


class _Block(NamedTuple):
    """Shapes of a block over ``scale`` [MPa] in single precision, mean [MPa] and normalised variance of its stress.

    ``weights`` (2 n, m) are membrane rows above bending rows; ``scale`` (n, 1); ``mean`` and ``variance`` (n, 2);
    ``trusted`` (n,): single precision is enough.
    """

    weights: Singles
    scale: Floats
    mean: Floats
    variance: Floats
    trusted: NDArray[np.bool_]


class _Stage(NamedTuple):
    """Where in the record a chunk is, and whether the record recurs."""

    begins: bool
    ends: bool
    recurs: bool


class _Room(NamedTuple):
    """Work space of one row: signed reversals, and the ranges of full and of half cycles with their membrane part."""

    z: Singles
    m: Singles
    S: Singles
    dm: Singles
    half_S: Singles
    half_dm: Singles
    step: NDArray[np.int8]
    at: NDArray[np.int32]


def _series(function: Callable[[Floats], Floats], low: float, high: float, degree: int) -> tuple[np.float32, ...]:
    """Coefficients, highest power first, of the Chebyshev interpolant of a function on an interval."""
    fit = Chebyshev.interpolate(function, degree, domain=[low, high])
    coefficients = fit.convert(kind=Polynomial, domain=[-1, 1], window=[-1, 1]).coef
    return tuple(np.float32(c) for c in coefficients[::-1])


_ROOT = math.sqrt(0.5)
_LOG2 = _series(lambda t: np.divide(np.log2(1 + t), t, where=t != 0, out=np.full_like(t, 1 / np.log(2))), _ROOT - 1, 2 * _ROOT - 1, 8)
_EXP2 = _series(np.exp2, -0.5, 0.5, 6)
_HALF, _ONE, _ZERO, _TINY = np.float32(0.5), np.float32(1.0), np.float32(0.0), np.float32(1e-30)
_ROUND = np.float32(1.5 * 2**23)  # adding and subtracting it rounds to an integer
_SMALLEST = np.float32(-126.0)  # exponent
_ROOT_BITS = np.float32(_ROOT).view(np.int32)
_MANTISSA = np.int32(2**23 - 1)
_SHIFT, _BIAS = np.int32(23), np.int32(127)


@intrinsic
def bits_of(context: Any, x: Any) -> Any:
    """Bits of a single precision number as an integer."""
    return types.int32(types.float32), lambda _, builder, __, args: builder.bitcast(args[0], ir.IntType(32))


@intrinsic
def number_of(context: Any, bits: Any) -> Any:
    """Single precision number that has these bits."""
    return types.float32(types.int32), lambda _, builder, __, args: builder.bitcast(args[0], ir.FloatType())


@compiled("contract")
def horner(c: tuple[np.float32, ...], x: np.float32) -> np.float32:
    y = c[0]
    for k in range(1, len(c)):
        y = y * x + c[k]
    return y


@compiled("contract")
def raise_to_slope(S: Singles, dm: Singles, n: int, law: _Law) -> None:
    """Replace S by S^k, and the membrane range dm by S^k I(r)^(-k/m) with r = db / (dm + db)."""
    for i in range(n):
        db = abs(S[i] - dm[i])
        r = db / max(abs(dm[i]) + db, _TINY)
        shifted = bits_of(max(S[i], _ZERO)) - _ROOT_BITS
        e = np.float32(shifted >> _SHIFT)  # S = 2^e (1 + t)
        t = number_of((shifted & _MANTISSA) + _ROOT_BITS) - _ONE
        rest = law.tail * e + law.slope * (t * horner(_LOG2, t))
        whole = max((law.head * e + rest + _ROUND) - _ROUND, _SMALLEST)
        fraction = (law.head * e - whole) + rest
        power = horner(_EXP2, max(fraction, -_HALF)) * number_of((np.int32(whole) + _BIAS) << _SHIFT)
        S[i] = power
        dm[i] = power * horner(law.ratio_power, r - _HALF)


@compiled("reassoc", "nsz", "nnan", "contract")
def add_up(power: Singles, damage: Singles, n: int) -> tuple[float, float, float]:
    """Sums of both and the largest damage."""
    power_sum = 0.0
    damage_sum = 0.0
    largest = _ZERO
    for i in range(n):
        power_sum += power[i]
        damage_sum += damage[i]
        largest = max(largest, damage[i])
    return power_sum, damage_sum, largest


@compiled("reassoc", "nsz", "nnan", "contract")
def fourth_powers(m: Singles, b: Singles) -> tuple[float, float]:
    """Sums of (m + b)^4 and (m - b)^4."""
    top = _ZERO
    bottom = _ZERO
    for i in range(m.size):
        square = (m[i] + b[i]) * (m[i] + b[i])
        top += square * square
        square = (m[i] - b[i]) * (m[i] - b[i])
        bottom += square * square
    return top, bottom


@compiled()
def write_reversals(
    m: Singles, b: Singles, side: np.float32, flat: np.float32, samples: int, up: int, near: int, room: _Room, n: int
) -> tuple[int, int, int, int]:
    """Append the reversals among the first samples of the row, and return how many there are now, the direction behind
    them, whether the last step was flat, and whether any reversal has a flat step beside it.
    """
    z, zm, step, at = room.z, room.m, room.step, room.at
    for i in range(samples):
        ds = (m[i + 1] + side * b[i + 1]) - (m[i] + side * b[i])
        step[i] = (int(ds > 0) - int(ds < 0)) * (2 - int(abs(ds) <= flat))  # flat steps are 1 high, others 2
    reversals = 0
    direction = 2 * up - 1
    for i in range(samples):
        at[reversals] = i
        reversals += int(step[i] * direction < 0)  # adding 0 or 1 is cheaper than a branch nobody can predict
        direction = step[i] if step[i] != 0 else direction
    doubtful = 0
    sign = np.float32(2 * up - 1)
    for k in range(reversals):
        i = at[k]
        z[n + k] = sign * (m[i] + side * b[i])
        zm[n + k] = sign * m[i]
        doubtful |= int(abs(step[i]) < 2) | (int(abs(step[i - 1]) < 2) if i > 0 else near)
        sign = -sign
    return n + reversals, int(direction > 0), int(abs(step[samples - 1]) < 2), doubtful


@compiled()
def close_pass(room: _Room, n: int, cycles: int) -> tuple[int, int]:
    """Take out every range smaller than the one before and not larger than the one after; none begins at the start.

    Returns how many reversals are left and how many cycles there are now.
    """
    z, zm, S, dm = room.z, room.m, room.S, room.dm
    z[n : n + PAD] = -np.inf
    kept = 0
    before = 1  # whether the range before is not larger
    taken = 0
    for i in range(n):
        after = int(z[i + 2] >= z[i])
        was_taken, taken = taken, after & (1 - before)
        S[cycles] = z[i] + z[i + 1]
        dm[cycles] = zm[i] + zm[i + 1]
        cycles += taken
        z[kept], zm[kept] = z[i], zm[i]
        kept += 1 - (taken | was_taken)
        before = after
    return kept, cycles


write_reversals_in_lanes, close_pass_in_lanes = write_reversals, close_pass
if importlib.util.find_spec("fatigue.life.rainflow_simd"):
    from fatigue.life import rainflow_simd
    if rainflow_simd.LANES:
        write_reversals_in_lanes, close_pass_in_lanes = rainflow_simd.write_reversals, rainflow_simd.close_pass


@compiled()
def material_difference(m: Singles, b: Singles, side: np.float32, flat: np.float32, samples: int) -> float:
    """Sum of the membrane differences over flat steps."""
    total = 0.0
    for i in range(samples):
        if abs((m[i + 1] + side * b[i + 1]) - (m[i] + side * b[i])) <= flat:
            total += abs(m[i + 1] - m[i])
    return total


@compiled()
def rotate_to_maximum(room: _Room, n: int, first_peak: int) -> int:
    """Begin the cyclic list at its first largest peak and close it; returns its length."""
    z, zm, path, path_m = room.z, room.m, room.half_S, room.half_dm
    first = first_peak
    for i in range(first_peak + 2, n, 2):
        first = i if z[i] > z[first] else first
    for i in range(n + 1):
        path[i], path_m[i] = z[(first + i) % n], zm[(first + i) % n]
    z[: n + 1], zm[: n + 1] = path[: n + 1], path_m[: n + 1]
    return n + 1


@compiled()
def close_on_stack(room: _Room, n: int, recurs: bool, cycles: int) -> tuple[int, int]:
    """Do what `rainflow.close_cycles` does on signed reversals; returns how many full and half cycles there are."""
    z, zm = room.z, room.m
    halves = 0
    base = 0
    top = -1
    for k in range(n):
        top += 1
        z[top], zm[top] = z[k], zm[k]
        while top - base >= 2 and z[top] >= z[top - 2]:
            if top - base == 2 and not recurs:
                room.half_S[halves], room.half_dm[halves] = z[base] + z[base + 1], zm[base] + zm[base + 1]
                halves += 1
                base += 1
            else:
                room.S[cycles], room.dm[cycles] = z[top - 2] + z[top - 1], zm[top - 2] + zm[top - 1]
                cycles += 1
                z[top - 2], zm[top - 2] = z[top], zm[top]
                top -= 2
    for k in range(base, top):
        room.half_S[halves], room.half_dm[halves] = z[k] + z[k + 1], zm[k] + zm[k + 1]
        halves += 1
    return cycles, halves


@compiled()
def begin(m: Singles, b: Singles, side: np.float32, flat: np.float32, samples: int) -> tuple[int, np.float32, float]:
    """Find the first step: its direction (-1: there is none), the membrane stress before it, and the doubt about it."""
    for i in range(samples):
        s, following = m[i] + side * b[i], m[i + 1] + side * b[i + 1]
        if s != following:
            return int(following > s), m[i], abs(m[i + 1] - m[i]) if abs(following - s) <= flat else _ZERO
    return -1, _ZERO, _ZERO


@compiled()
def extremes(z: Singles, n: int, first_peak: int) -> tuple[float, float]:
    """Largest and smallest stress: closing cycles never takes the last one of either out."""
    largest, smallest = -np.inf, -np.inf
    for i in range(n):
        if (i - first_peak) % 2 == 0:
            largest = max(largest, z[i])
        else:
            smallest = max(smallest, z[i])
    return largest, -smallest


@compiled()
def count_side(
    m: Singles, b: Singles, at: tuple[int, int], samples: int, stage: _Stage, law: _Law, state: _State, room: _Room
) -> None:
    """Count one surface of one point over the steps of one chunk."""
    side = np.float32(1 - 2 * at[1])
    flat = state.flat[at[0]]
    z, zm = room.z, room.m
    n = state.waiting[at]
    z[:n], zm[:n] = state.z[at][:n], state.m[at][:n]
    if state.up[at] < 0:
        first_up, state.first_m[at], doubt = begin(m, b, side, flat, samples)
        state.up[at] = state.first_up[at] = first_up
        state.doubt[at] += doubt
        if first_up < 0:
            return
        if not stage.recurs:  # a single pass has a reversal at its first sample
            first, first_m = state.start[at[0], 0] + side * state.start[at[0], 1], state.start[at[0], 0]
            z[0], zm[0] = (-first, -first_m) if first_up else (first, first_m)
            n = 1
    first_up = state.first_up[at]
    n, up, near, doubtful = write_reversals_in_lanes(m, b, side, flat, samples, state.up[at], state.near[at], room, n)
    state.up[at], state.near[at] = up, near
    if doubtful:
        state.doubt[at] += material_difference(m, b, side, flat, samples)
    if stage.ends and not (stage.recurs and up == first_up):
        last = m[samples] + side * b[samples]
        last_m = state.first_m[at] if stage.recurs else m[samples]
        z[n], zm[n] = (last, last_m) if up else (-last, -last_m)
        n += 1

    cycles, before = 0, 2 * n
    while n > FEW and before - n > before // 8:
        before = n
        n, cycles = close_pass_in_lanes(room, n, cycles)
    if stage.ends:
        first_peak = 1 - first_up if stage.recurs else first_up
        state.maximum[at], state.minimum[at] = extremes(z, n, first_peak)
        if stage.recurs:
            n = rotate_to_maximum(room, n, first_peak)
        cycles, halves = close_on_stack(room, n, stage.recurs, cycles)
        raise_to_slope(room.half_S, room.half_dm, halves, law)
        add_cycles(room.half_S, room.half_dm, halves, 0.5, at, state)
    elif n <= RESIDUE:
        state.z[at][:n], state.m[at][:n] = z[:n], zm[:n]
        state.waiting[at] = n
    else:
        state.doubt[at] = np.inf
        state.waiting[at] = 0
    raise_to_slope(room.S, room.dm, cycles, law)
    add_cycles(room.S, room.dm, cycles, 1.0, at, state)


@compiled()
def add_cycles(power: Singles, damage: Singles, n: int, count: float, at: tuple[int, int], state: _State) -> None:
    """Add the first n cycles, counting ``count`` each, to the sums."""
    power_sum, damage_sum, largest = add_up(power, damage, n)
    state.cycles[at] += count * n
    state.power_sum[at] += count * power_sum
    state.damage[at] += count * damage_sum
    state.largest[at] = max(state.largest[at], largest)


@compiled()
def count_chunk(stress: Singles, samples: int, stage: _Stage, law: _Law, state: _State, room: _Room) -> None:
    """Count the steps between the first samples + 1 columns of the block, membrane rows above bending rows."""
    points = stress.shape[0] // 2
    for row in range(points):
        m, b = stress[row], stress[points + row]
        if stage.begins:
            m[0], b[0] = m[1], b[1]
            state.start[row, 0], state.start[row, 1] = m[1], b[1]
        top, bottom = fourth_powers(m[1 : samples + 1], b[1 : samples + 1])
        state.fourth[row, 0] += top
        state.fourth[row, 1] += bottom
        steps = samples
        if stage.ends and stage.recurs:  # and the step from the last sample to the first one
            steps += 1
            m[steps], b[steps] = state.start[row, 0], state.start[row, 1]
        m[steps + 1 : steps + PAD], b[steps + 1 : steps + PAD] = m[steps], b[steps]  # level, so nothing turns there
        for surface in range(2):
            count_side(m, b, (row, surface), steps, stage, law, state, room)
        m[0], b[0] = m[samples], b[samples]


# ------------------------------------------------------------------------------------------------ the block


def record_of(q: NDArray[np.floating]) -> Record:
    """Prepare modal coordinates (m, t) for `count_block_fast`, once for all points.

    Raises
    ------
    NumericalError : a sample is not finite
    """
    finite = np.isfinite(q)
    if not finite.all():
        mode, sample = np.argwhere(~finite)[0]
        raise not_finite(f"sample {sample} of modal coordinate {mode}")
    mean = q.mean(axis=1, dtype=np.float64)
    covariance = np.zeros((len(q), len(q)))
    single = np.empty(q.shape, np.float32)
    for first in range(0, q.shape[1], CHUNK):
        piece = slice(first, first + CHUNK)
        centred = q[:, piece] - mean[:, None]
        covariance += centred @ centred.T
        single[:, piece] = centred
    return Record(q, single, mean, covariance / max(q.shape[1], 1))


def is_fast(law: DamageLaw, record: Record) -> bool:
    """Whether `count_block_fast` counts itself: a law of one slope, not too steep, and more than one sample."""
    return law.is_straight and float(law.slopes[0]) <= STEEPEST and record.q.shape[1] > 1


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
    choices = {"uses_bending_ratio": uses_bending_ratio, "residue": residue, "yield_MPa": yield_MPa, "mean_stress": mean_stress}

    def exactly(rows: Any) -> BlockCount:
        q = record.exact
        return count_block(S_m[rows] @ q, S_b[rows] @ q, size[rows], same_ratio[rows], law, **choices)

    if not is_fast(law, record):
        return exactly(slice(None))
    block = _normalised(S_m, S_b, record)
    state = _count(block, record, residue == "repeat", law, uses_bending_ratio)
    count = _evaluated(state, block, record, size, same_ratio, law, uses_bending_ratio)
    top = block.mean + block.scale * state.maximum
    doubtful = ~block.trusted[:, None] | _in_doubt(state, law)
    if yield_MPa is not None:  # f_M is 1 where no cycle reaches this tension
        doubtful |= 2.0 * top >= (1.0 - 1e-6) * yield_MPa
        count = replace(count, damage_mean_stress=count.damage.copy())
    again = np.flatnonzero(doubtful.any(axis=1))
    if again.size:
        exact = exactly(again)
        for field in fields(BlockCount):
            getattr(count, field.name)[again] = getattr(exact, field.name)
    return count


def _normalised(S_m: Floats, S_b: Floats, record: Record) -> _Block:
    """Divide the shapes of each point by a power of 2 so that its modal stresses have an rms of about 1."""
    points = len(S_m)
    S = np.concatenate([S_m, S_b])
    mean_m, mean_b = np.split(S @ record.mean, 2)
    CS = S @ record.covariance
    membrane, bending = np.split((CS * S).sum(axis=1), 2)
    both = 2.0 * (CS[:points] * S_b).sum(axis=1)
    variance = np.maximum((membrane + bending)[:, None] + np.stack([both, -both], axis=1), 0.0)
    modal = np.sum(np.split(S**2 @ np.diagonal(record.covariance), 2), axis=0)
    scale = np.ldexp(1.0, np.frexp(np.sqrt(modal))[1])
    return _Block(
        weights=(S / np.tile(scale, 2)[:, None]).astype(np.float32),
        scale=scale[:, None],
        mean=np.stack([mean_m + mean_b, mean_m - mean_b], axis=1),
        variance=variance / scale[:, None] ** 2,
        trusted=(variance.min(axis=1) * CANCELLATION**2 >= modal),
    )


def _count(block: _Block, record: Record, recurs: bool, law: DamageLaw, uses_bending_ratio: bool) -> _State:
    """Count a block of normalised stress chunk by chunk."""
    points, t = len(block.scale), record.q.shape[1]
    state = _fresh_state(points)
    state.flat[:] = FLAT if uses_bending_ratio else -1.0
    edges = np.linspace(0, t, -(-t // CHUNK) + 1).astype(int)
    longest = int(np.diff(edges).max())
    stress = np.empty((2 * points, longest + 1 + PAD), np.float32)
    kinds = (np.float32,) * 6 + (np.int8, np.int32)
    room = _Room(*(np.empty(longest + RESIDUE + 2 * PAD, kind) for kind in kinds))
    rules = _law(float(law.slopes[0]), uses_bending_ratio)
    for first, end in pairwise(edges.tolist()):
        samples = end - first
        np.matmul(block.weights, record.q[:, first:end], out=stress[:, 1 : samples + 1])
        count_chunk(stress, samples, _Stage(first == 0, end == t, recurs), rules, state, room)
    return state


def _evaluated(
    state: _State, block: _Block, record: Record, size: Floats, same_ratio: Floats, law: DamageLaw, uses_bending_ratio: bool
) -> BlockCount:
    """Turn the sums of normalised stress into those of `BlockCount`."""
    k = float(law.slopes[0])
    to_damage = np.exp(k * np.log(block.scale * size[:, None]) - law.log_constants[0])
    I_same = damage.ratio_factor(same_ratio) if uses_bending_ratio else 1.0
    turning = state.first_up >= 0
    minimum, maximum = block.mean + block.scale * state.minimum, block.mean + block.scale * state.maximum
    return BlockCount(
        damage=to_damage * state.damage,
        damage_same_ratio=to_damage * I_same**-k * state.power_sum,
        damage_mean_stress=np.full_like(minimum, np.nan),
        cycles=state.cycles,
        power_sum=block.scale**k * state.power_sum,
        max_range=block.scale * (state.maximum - state.minimum),
        r_largest=np.divide(minimum, maximum, out=np.full_like(minimum, np.nan), where=turning & (maximum != 0.0)),
        max_equivalent_range=block.scale * size[:, None] * state.largest ** (1.0 / k),
        mean=block.mean,
        kurtosis=np.where(turning, state.fourth / (record.q.shape[1] * np.maximum(block.variance, 1e-300) ** 2), np.nan),
        histogram=np.zeros((len(size), 2, 0, 2)),
    )


def _in_doubt(state: _State, law: DamageLaw) -> NDArray[np.bool_]:
    """Where the choice between samples at flat extremes could change the damage by more than ``DOUBT`` of it.

    A cycle of range S that takes the other sample, with a membrane stress that differs by e, has a bending ratio that
    differs by at most 2 e / S; ln I^(1/m) changes by at most 0.254 per unit of it.
    """
    k = float(law.slopes[0])
    worst = 2.0 * 0.254 * k * state.doubt * (state.maximum - state.minimum) ** (k - 1.0) * damage.ratio_factor(np.zeros(1)) ** -k
    return np.asarray(worst > DOUBT * state.damage)


def _fresh_state(points: int) -> _State:
    shape = (points, 2)
    return _State(
        start=np.zeros(shape, np.float32),
        flat=np.zeros(points, np.float32),
        first_m=np.zeros(shape, np.float32),
        first_up=np.full(shape, -1),
        up=np.full(shape, -1),
        near=np.zeros(shape, np.int64),
        waiting=np.zeros(shape, np.int64),
        z=np.empty((*shape, RESIDUE), np.float32),
        m=np.empty((*shape, RESIDUE), np.float32),
        **{name: np.zeros(shape) for name in _State._fields[9:]},
    )


@cache
def _law(k: float, uses_bending_ratio: bool) -> _Law:
    head = np.round(k * 2**8) / 2**8
    if uses_bending_ratio:
        ratio = _series(lambda x: damage.ratio_factor(x + 0.5) ** -k, -0.5, 0.5, RATIO_DEGREE)
    else:
        ratio = (*(_ZERO,) * RATIO_DEGREE, _ONE)
    return _Law(np.float32(k), np.float32(head), np.float32(k - head), ratio)
