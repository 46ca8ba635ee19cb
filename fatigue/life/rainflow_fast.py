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
from numba.extending import intrinsic, overload
from numpy.polynomial import Chebyshev, Polynomial
from numpy.typing import NDArray

from fatigue.life import damage
from fatigue.life.curves import DamageLaw
from fatigue.life.history import Residue
from fatigue.life.rainflow import BlockCount, compiled, count_block, not_finite

if importlib.util.find_spec("fatigue.life.rainflow_simd"):
    from fatigue.life import rainflow_simd as simd
else:
    simd = None

Floats = NDArray[np.float64]
Singles = NDArray[np.float32]
Numbers = NDArray[np.floating]  # single precision, or double where a point is counted again

CHUNK = 8192  # samples of a block recovered at once
PAD = 32  # room behind a row for vector instructions that write more than they keep
RESIDUE = 1024  # reversals of a point that may wait for the next chunk
FEW = 64  # reversals that are not worth another pass

STEEPEST = 12.0  # slope up to which S^k stays within single precision
FLAT = 4e-8  # doubt about a difference of stresses of rms 1, per root of the number of modes: 3 standard deviations
SHORTEST = 512  # samples; a few cycles do not average rounding errors out
CANCELLATION = 8.0  # modal stresses over their sum from which on single precision is not enough
RATIO_DEGREE = 10
POINTS = 128  # counted at a time, so that 256 rows of stress stay in the cache


@dataclass(frozen=True, slots=True, eq=False)
class Record:
    """What all points share of the modal coordinates they are counted on; threads may read it at the same time.

    Attributes
    ----------
    exact : (m, t) the modal coordinates as given
    q : (m, t) the same without their mean and over ``scale``, in single precision
    scale : (m,) powers of 2 near the standard deviations
    mean : (m,) time mean
    covariance : (m, m)
    """

    exact: NDArray[np.floating]
    q: Singles
    scale: Floats
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

    ``mean`` is that of the normalised stress, 0 in single precision. ``start`` are membrane and bending of the first sample. ``first_up`` and ``up`` are the directions of the first step
    and of the last one, -1 before there is any; ``plateau_m`` is the membrane stress before the first step. The first
    ``waiting`` of the reversals ``z``, ``m`` have not closed a cycle. The sums are those of `BlockCount` for normalised
    stress. ``doubtful``: rounding may have decided; ``crowded``: there was no room for all that waits.
    """

    wanted: NDArray[np.bool_]
    mean: Numbers
    start: Numbers
    plateau_m: Numbers
    first_up: NDArray[np.int64]
    up: NDArray[np.int64]
    waiting: NDArray[np.int64]
    z: Numbers
    m: Numbers
    doubtful: NDArray[np.bool_]
    crowded: NDArray[np.bool_]
    cycles: Floats
    power_sum: Floats
    damage: Floats
    largest: Floats
    second: Floats
    fourth: Floats
    maximum: Floats
    minimum: Floats


class _Block(NamedTuple):
    """Shapes of a block over ``scale`` [MPa], and the mean of its stress [MPa].

    ``membrane`` and ``bending`` (n, m); ``scale`` (n, 1); ``mean`` and ``trusted`` (n, 2): single precision is enough.
    """

    membrane: Floats
    bending: Floats
    scale: Floats
    mean: Floats
    trusted: NDArray[np.bool_]


class _Stage(NamedTuple):
    """Where in the record a chunk is, whether the record recurs, and up to what difference rounding may decide."""

    begins: bool
    ends: bool
    recurs: bool
    flat: np.float32


class _Room(NamedTuple):
    """Work space of one row: signed reversals, and the ranges of full and of half cycles with their membrane part."""

    z: Numbers
    m: Numbers
    S: Numbers
    dm: Numbers
    half_S: Numbers
    half_dm: Numbers
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
def raise_to_slope(S: Numbers, dm: Numbers, n: int, law: _Law) -> None:
    """Replace S by S^k, and the membrane range dm by S^k I(r)^(-k/m) with r = db / (dm + db)."""
    for i in range(n):
        db = abs(S[i] - dm[i])
        r = np.float32(db / max(abs(dm[i]) + db, _TINY))
        shifted = bits_of(np.float32(max(S[i], _ZERO))) - _ROOT_BITS
        e = np.float32(shifted >> _SHIFT)  # S = 2^e (1 + t)
        t = number_of((shifted & _MANTISSA) + _ROOT_BITS) - _ONE
        rest = law.tail * e + law.slope * (t * horner(_LOG2, t))
        whole = max((law.head * e + rest + _ROUND) - _ROUND, _SMALLEST)
        fraction = (law.head * e - whole) + rest
        power = horner(_EXP2, max(fraction, -_HALF)) * number_of((np.int32(whole) + _BIAS) << _SHIFT)
        S[i] = power
        dm[i] = power * horner(law.ratio_power, r - _HALF)


@compiled("reassoc", "nsz", "nnan", "contract")
def add_up(power: Numbers, damage: Numbers, n: int) -> tuple[float, float, float]:
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
def add_powers(m: Numbers, b: Numbers, side: np.float32, mean: np.floating) -> tuple[float, float]:
    """Sums of the second and fourth powers of the stress of one surface without its mean."""
    second = _ZERO
    fourth = _ZERO
    for i in range(m.size):
        square = (m[i] + side * b[i] - mean) ** 2
        second += square
        fourth += square * square
    return second, fourth


@compiled()
def write_reversals(
    m: Numbers, b: Numbers, side: np.float32, flat: np.float32, samples: int, up: int, room: _Room, n: int
) -> tuple[int, int, bool]:
    """Append the reversals among the first samples of a row; ``up`` is the direction before them.

    Returns how many reversals there are now, the direction behind them, and whether any step is as small as rounding.
    """
    z, zm, step, at = room.z, room.m, room.step, room.at
    small_steps = 0
    for i in range(samples):
        ds = (m[i + 1] + side * b[i + 1]) - (m[i] + side * b[i])
        step[i] = int(ds > 0) - int(ds < 0)
        doubt = flat + flat * abs(m[i] + side * b[i])
        small_steps += int(abs(ds) <= doubt) & int(m[i + 1] != m[i])
    reversals = 0
    direction = 2 * up - 1
    for i in range(samples):
        at[reversals] = i
        reversals += int(step[i] * direction < 0)  # adding 0 or 1 is cheaper than a branch nobody can predict
        direction = step[i] if step[i] != 0 else direction
    sign = np.float32(2 * up - 1)
    for k in range(reversals):
        i = at[k]
        z[n + k] = sign * (m[i] + side * b[i])
        zm[n + k] = sign * m[i]
        sign = -sign
    return n + reversals, int(direction > 0), small_steps > 0


@compiled()
def close_pass(room: _Room, n: int, cycles: int, flat: np.float32) -> tuple[int, int, bool]:
    """Take out every range smaller than the one before and not larger than the one after; none begins at the start.

    Returns how many reversals are left, how many cycles there are now, and whether rounding may have decided.
    """
    z, zm, S, dm = room.z, room.m, room.S, room.dm
    z[n] = z[n + 1] = -np.inf
    kept = 0
    before = 1  # whether the range before is not larger
    taken = 0
    close_calls = 0
    for i in range(n):
        after = int(z[i + 2] >= z[i])
        doubt = flat + flat * abs(z[i])
        close_calls += int(abs(z[i + 2] - z[i]) <= doubt) & int(zm[i + 2] != zm[i])
        was_taken, taken = taken, after & (1 - before)
        S[cycles] = z[i] + z[i + 1]
        dm[cycles] = zm[i] + zm[i + 1]
        cycles += taken
        z[kept], zm[kept] = z[i], zm[i]
        kept += 1 - (taken | was_taken)
        before = after
    return kept, cycles, close_calls > 0


def find_reversals(*args: Any) -> Any:
    """Call `write_reversals`, in vector instructions where they are."""
    return write_reversals(*args)


def close_ranges(*args: Any) -> Any:
    """Call `close_pass`, in vector instructions where they are."""
    return close_pass(*args)


@overload(find_reversals, strict=False)
def _find_reversals(m: Any, b: Any, side: Any, flat: Any, samples: Any, up: Any, room: Any, n: Any) -> Any:
    step = simd.write_reversals if simd and simd.lanes(m) else write_reversals
    return lambda m, b, side, flat, samples, up, room, n: step(m, b, side, flat, samples, up, room, n)


@overload(close_ranges, strict=False)
def _close_ranges(room: Any, n: Any, cycles: Any, flat: Any) -> Any:
    step = simd.close_pass if simd and simd.lanes(room.types[0]) else close_pass
    return lambda room, n, cycles, flat: step(room, n, cycles, flat)


@compiled()
def rotate_to_maximum(room: _Room, n: int, first_peak: int) -> int:
    """Begin the cyclic list at its first largest peak and close it; returns its length."""
    z, zm, path, path_m = room.z, room.m, room.half_S, room.half_dm
    first = first_peak
    for i in range(first_peak + 2, n, 2):
        first = i if z[i] > z[first] else first
    for i in range(n + 1):
        path[i], path_m[i] = z[(first + i) % n], zm[(first + i) % n]
    for i in range(n + 1):
        z[i], zm[i] = path[i], path_m[i]
    return n + 1


@compiled()
def close_on_stack(room: _Room, n: int, recurs: bool, cycles: int, flat: np.float32) -> tuple[int, int, bool]:
    """Do what `rainflow.close_cycles` does, on signed reversals.

    Returns how many full and half cycles there are, and whether rounding may have decided.
    """
    z, zm, S, dm, half_S, half_dm = room.z, room.m, room.S, room.dm, room.half_S, room.half_dm
    halves = 0
    base = 0
    top = -1
    close_call = False
    for k in range(n):
        top += 1
        z[top], zm[top] = z[k], zm[k]
        while top - base >= 2:
            close_call |= abs(z[top] - z[top - 2]) <= flat + flat * abs(z[top]) and zm[top] != zm[top - 2]
            if z[top] < z[top - 2]:
                break
            if top - base == 2 and not recurs:
                half_S[halves], half_dm[halves] = z[base] + z[base + 1], zm[base] + zm[base + 1]
                halves += 1
                base += 1
            else:
                S[cycles], dm[cycles] = z[top - 2] + z[top - 1], zm[top - 2] + zm[top - 1]
                cycles += 1
                z[top - 2], zm[top - 2] = z[top], zm[top]
                top -= 2
    for k in range(base, top):
        half_S[halves], half_dm[halves] = z[k] + z[k + 1], zm[k] + zm[k + 1]
        halves += 1
    return cycles, halves, close_call


@compiled()
def extremes(z: Numbers, n: int, first_peak: int) -> tuple[float, float]:
    """Largest and smallest stress: closing cycles never takes the last one of either out."""
    largest, smallest = -np.inf, -np.inf
    for i in range(n):
        if (i - first_peak) % 2 == 0:
            largest = max(largest, z[i])
        else:
            smallest = max(smallest, z[i])
    return largest, -smallest


@compiled()
def add_cycles(power: Numbers, damage: Numbers, n: int, count: float, at: tuple[int, int], state: _State) -> None:
    """Add the first n cycles, counting ``count`` each, to the sums."""
    power_sum, damage_sum, largest = add_up(power, damage, n)
    state.cycles[at] += count * n
    state.power_sum[at] += count * power_sum
    state.damage[at] += count * damage_sum
    state.largest[at] = max(state.largest[at], largest)


@compiled()
def begin_side(m: Numbers, b: Numbers, side: np.float32, steps: int, at: tuple[int, int], state: _State) -> None:
    """Look for the first step of the record."""
    for i in range(steps):
        s, following = m[i] + side * b[i], m[i + 1] + side * b[i + 1]
        if s != following:
            state.up[at] = state.first_up[at] = int(following > s)
            state.plateau_m[at] = m[i]
            return


@compiled()
def count_side(
    m: Numbers, b: Numbers, steps: int, at: tuple[int, int], stage: _Stage, law: _Law, state: _State, room: _Room
) -> None:
    """Count one surface of one point over the steps of a chunk."""
    side = np.float32(1 - 2 * at[1])
    z, zm = room.z, room.m
    n = state.waiting[at]
    for i in range(n):
        z[i], zm[i] = state.z[at][i], state.m[at][i]
    if state.up[at] < 0:
        begin_side(m, b, side, steps, at, state)
        if state.up[at] < 0:
            return
        if not stage.recurs:  # a single pass turns at its first sample
            sign = np.float32(1 - 2 * state.first_up[at])
            z[0], zm[0] = sign * (state.start[at[0], 0] + side * state.start[at[0], 1]), sign * state.start[at[0], 0]
            n = 1
    first_up = state.first_up[at]
    n, up, doubtful = find_reversals(m, b, side, stage.flat, steps, state.up[at], room, n)
    state.up[at] = up
    if stage.ends and not (stage.recurs and up == first_up):  # a block that recurs turns where its first plateau ends
        sign = np.float32(2 * up - 1)
        z[n] = sign * (m[steps] + side * b[steps])
        zm[n] = sign * (state.plateau_m[at] if stage.recurs else m[steps])
        n += 1

    cycles, before = 0, 2 * n
    while n > FEW and before - n > before // 8:
        before = n
        n, cycles, close_call = close_ranges(room, n, cycles, stage.flat)
        doubtful |= close_call
    if stage.ends:
        first_peak = 1 - first_up if stage.recurs else first_up
        state.maximum[at], state.minimum[at] = extremes(z, n, first_peak)
        if stage.recurs:
            n = rotate_to_maximum(room, n, first_peak)
        cycles, halves, close_call = close_on_stack(room, n, stage.recurs, cycles, stage.flat)
        doubtful |= close_call
        raise_to_slope(room.half_S, room.half_dm, halves, law)
        add_cycles(room.half_S, room.half_dm, halves, 0.5, at, state)
    elif n <= state.z.shape[2]:
        for i in range(n):
            state.z[at][i], state.m[at][i] = z[i], zm[i]
        state.waiting[at] = n
    else:
        state.crowded[at] = True
        state.waiting[at] = 0
    raise_to_slope(room.S, room.dm, cycles, law)
    add_cycles(room.S, room.dm, cycles, 1.0, at, state)
    state.doubtful[at] |= doubtful


@compiled()
def count_chunk(stress: Numbers, samples: int, stage: _Stage, law: _Law, state: _State, room: _Room) -> None:
    """Count the steps between the first samples + 1 columns of a block, its membrane rows above its bending rows."""
    points = stress.shape[0] // 2
    for row in range(points):
        m, b = stress[row], stress[points + row]
        if stage.begins:
            m[0], b[0] = m[1], b[1]
            state.start[row, 0], state.start[row, 1] = m[1], b[1]
        steps = samples
        if stage.ends and stage.recurs:  # and the step from the last sample to the first one
            steps += 1
            m[steps], b[steps] = state.start[row, 0], state.start[row, 1]
        for i in range(steps + 1, steps + PAD):
            m[i], b[i] = m[steps], b[steps]  # level, so that nothing turns here
        for surface in range(2):
            if state.wanted[row, surface]:
                second, fourth = add_powers(
                    m[1 : samples + 1], b[1 : samples + 1], np.float32(1 - 2 * surface), state.mean[row, surface]
                )
                state.second[row, surface] += second
                state.fourth[row, surface] += fourth
                count_side(m, b, steps, (row, surface), stage, law, state, room)
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
    pieces = [slice(first, first + CHUNK) for first in range(0, q.shape[1], CHUNK)]
    for piece in pieces:
        centred = q[:, piece] - mean[:, None]
        covariance += centred @ centred.T / q.shape[1]
    scale = np.ldexp(1.0, np.frexp(np.sqrt(np.diagonal(covariance)))[1])
    record = Record(q, np.empty(q.shape, np.float32), scale, mean, covariance)
    for piece in pieces:
        record.q[:, piece] = (q[:, piece] - mean[:, None]) / scale[:, None]
    return record


def is_fast(law: DamageLaw, record: Record) -> bool:
    """Whether `count_block_fast` counts itself: a law of one slope, not too steep, and a record not too short."""
    return law.is_straight and float(law.slopes[0]) <= STEEPEST and record.q.shape[1] >= SHORTEST


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
        membrane, bending = S_m[rows] @ record.exact, S_b[rows] @ record.exact
        return count_block(membrane, bending, size[rows], same_ratio[rows], law, **choices)

    if not is_fast(law, record):
        return exactly(slice(None))
    block = _normalised(S_m, S_b, record)
    rules = _law(float(law.slopes[0]), uses_bending_ratio)
    everywhere = np.ones((len(size), 2), np.bool_)
    state = _count(block, everywhere, record, rules, residue == "repeat", np.float32)
    doubtful = (state.doubtful | ~block.trusted) & ~state.crowded
    rows = np.flatnonzero(doubtful.any(axis=1))
    if rows.size:
        wanted = doubtful[rows]
        again = _count(_Block(*(a[rows] for a in block)), wanted, record, rules, residue == "repeat", np.float64)
        for name in ("first_up", "cycles", "power_sum", "damage", "largest", "second", "fourth", "crowded"):
            getattr(state, name)[doubtful] = getattr(again, name)[wanted]
        state.maximum[doubtful] = (again.maximum - again.mean)[wanted]
        state.minimum[doubtful] = (again.minimum - again.mean)[wanted]
    count = _evaluated(state, block, record, size, same_ratio, law, uses_bending_ratio)
    unsuited = state.crowded
    if yield_MPa is not None:  # f_M is 1 where no cycle reaches this tension
        unsuited |= 2.0 * (block.mean + block.scale * state.maximum) >= (1.0 - 1e-6) * yield_MPa
        count = replace(count, damage_mean_stress=count.damage.copy())
    rows = np.flatnonzero(unsuited.any(axis=1))
    if rows.size:
        exact = exactly(rows)
        for field in fields(BlockCount):
            getattr(count, field.name)[rows] = getattr(exact, field.name)
    return count


def _normalised(S_m: Floats, S_b: Floats, record: Record) -> _Block:
    """Divide the shapes of each point by a power of 2 so that its modal stresses have an rms of about 1."""
    membrane, bending, both = (((a @ record.covariance) * b).sum(axis=1) for a, b in ((S_m, S_m), (S_b, S_b), (S_m, S_b)))
    variance = np.maximum((membrane + bending)[:, None] + 2.0 * np.stack([both, -both], axis=1), 0.0)
    mean_m, mean_b = S_m @ record.mean, S_b @ record.mean
    modal = (S_m**2 + S_b**2) @ np.diagonal(record.covariance)
    scale = np.ldexp(1.0, np.frexp(np.sqrt(modal))[1])[:, None]
    return _Block(
        membrane=S_m * record.scale / scale,
        bending=S_b * record.scale / scale,
        scale=scale,
        mean=np.stack([mean_m + mean_b, mean_m - mean_b], axis=1),
        trusted=variance * CANCELLATION**2 >= modal[:, None],
    )


def _count(block: _Block, wanted: NDArray[np.bool_], record: Record, rules: _Law, recurs: bool, precision: type[np.floating]) -> _State:
    """Count normalised stress, some points and some samples at a time."""
    single = precision is np.float32
    flat = np.float32(FLAT * math.sqrt(len(record.q)) if single else -1.0)
    points, t = len(wanted), record.q.shape[1]
    edges = np.linspace(0, t, -(-t // CHUNK) + 1).astype(int).tolist()
    width = max(end - first for first, end in pairwise(edges)) + 1 + PAD
    room = _room(width, precision)
    state = _fresh_state(wanted, precision)
    if not single:
        state.mean[:] = block.mean / block.scale
    for first_point in range(0, points, POINTS):
        piece = slice(first_point, first_point + POINTS)
        weights = np.concatenate([block.membrane[piece], block.bending[piece]]).astype(precision)
        stress = np.empty((len(weights), width), precision)
        piece_of_state = _State(*(a[piece] for a in state))
        for first, end in pairwise(edges):
            q = record.q[:, first:end] if single else record.exact[:, first:end] / record.scale[:, None]
            np.matmul(weights, q, out=stress[:, 1 : end - first + 1])
            stage = _Stage(first == 0, end == t, recurs, flat)
            count_chunk(stress, end - first, stage, rules, piece_of_state, room)
    return state


def _evaluated(
    state: _State, block: _Block, record: Record, size: Floats, same_ratio: Floats, law: DamageLaw, uses_bending_ratio: bool
) -> BlockCount:
    """Turn the sums of normalised stress into those of `BlockCount`."""
    k = float(law.slopes[0])
    to_damage = np.exp(k * np.log(block.scale * size[:, None]) - law.log_constants[0])
    I_same = damage.ratio_factor(same_ratio) if uses_bending_ratio else 1.0
    samples, nan = record.q.shape[1], np.full(same_ratio.shape, np.nan)
    turning = state.first_up >= 0
    minimum, maximum = block.mean + block.scale * state.minimum, block.mean + block.scale * state.maximum
    return BlockCount(
        damage=to_damage * state.damage,
        damage_same_ratio=to_damage * I_same**-k * state.power_sum,
        damage_mean_stress=nan,
        cycles=state.cycles,
        power_sum=block.scale**k * state.power_sum,
        max_range=block.scale * (state.maximum - state.minimum),
        r_largest=np.divide(minimum, maximum, out=nan.copy(), where=turning & (maximum != 0.0)),
        max_equivalent_range=block.scale * size[:, None] * state.largest ** (1.0 / k),
        mean=block.mean,
        kurtosis=np.divide(samples * state.fourth, state.second**2, out=nan.copy(), where=turning),
        histogram=np.zeros((len(size), 2, 0, 2)),
    )


def _fresh_state(wanted: NDArray[np.bool_], precision: type[np.floating]) -> _State:
    """Nothing counted yet."""
    shape = wanted.shape
    kinds = {
        "wanted": (shape, np.bool_), "mean": (shape, precision), "start": (shape, precision), "plateau_m": (shape, precision), "first_up": (shape, np.int64),
        "up": (shape, np.int64), "waiting": (shape, np.int64), "z": ((*shape, RESIDUE), precision), "m": ((*shape, RESIDUE), precision),
        "doubtful": (shape, np.bool_), "crowded": (shape, np.bool_),
    }
    state = _State(*(np.zeros(*kinds.get(name, (shape, np.float64))) for name in _State._fields))
    state.wanted[:] = wanted
    state.up[:] = state.first_up[:] = -1
    return state


def _room(width: int, precision: type[np.floating]) -> _Room:
    kinds = (precision,) * 6 + (np.int8, np.int32)
    return _Room(*(np.empty(width + RESIDUE + PAD, kind) for kind in kinds))


@cache
def _law(k: float, uses_bending_ratio: bool) -> _Law:
    head = np.round(k * 2**8) / 2**8
    if uses_bending_ratio:
        ratio = _series(lambda x: damage.ratio_factor(x + 0.5) ** -k, -0.5, 0.5, RATIO_DEGREE)
    else:
        ratio = (*(_ZERO,) * RATIO_DEGREE, _ONE)
    return _Law(np.float32(k), np.float32(head), np.float32(k - head), ratio)
