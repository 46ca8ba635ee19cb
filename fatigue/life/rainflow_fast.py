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

import math
from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import Any, NamedTuple

import numpy as np
from llvmlite import ir
from numba import njit, types
from numba.extending import intrinsic
from numpy.polynomial import Chebyshev, Polynomial
from numpy.typing import NDArray

from fatigue.life import damage
from fatigue.life.curves import DamageLaw
from fatigue.life.history import Residue
from fatigue.life.rainflow import BlockCount, compiled, count_block

Floats = NDArray[np.float64]
Singles = NDArray[np.float32]

CHUNK = 8192  # samples of a block recovered at once
PAD = 32  # room behind a row for vector instructions that write more than they keep
RESIDUE = 1024  # reversals of a point that may wait for the next chunk
FEW = 32  # reversals that are not worth another pass

STEEPEST = 12.0  # slope up to which S^k stays within single precision
FLAT = 1e-6  # stress difference lost to rounding, in units of the rms of the modal stresses
CANCELLATION = 16.0  # modal stresses over their sum from which on single precision is not enough
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

    first: Singles
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


class _Room(NamedTuple):
    """Work space of one row: signed reversals, and the ranges of full and of half cycles with their membrane part."""

    z: Singles
    m: Singles
    S: Singles
    dm: Singles
    half_S: Singles
    half_dm: Singles


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


@compiled()
def horner(c: tuple[np.float32, ...], x: np.float32) -> np.float32:
    y = c[0]
    for k in range(1, len(c)):
        y = y * x + c[k]
    return y


@compiled()
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
    z, zm = room.z, room.m
    doubtful = 0
    s = m[0] + side * b[0]
    for i in range(samples):
        following = m[i + 1] + side * b[i + 1]
        rises, level = int(following > s), int(following == s)
        turns = (1 - level) & (rises ^ up)
        z[n] = s if up else -s
        zm[n] = m[i] if up else -m[i]
        n += turns
        was_near, near = near, int(abs(following - s) <= flat)
        doubtful |= turns & (near | was_near)
        up = up if level else rises
        s = following
    return n, up, near, doubtful


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
def begin(m: Singles, b: Singles, side: np.float32, flat: np.float32, samples: int, at: tuple[int, int], state: _State) -> None:
    """Find the first step of a record. A single pass has a reversal at its first sample; a block that recurs may have
    one at the last sample of its first plateau, which shows at its end."""
    for i in range(samples):
        s, following = m[i] + side * b[i], m[i + 1] + side * b[i + 1]
        if s != following:
            state.up[at] = state.first_up[at] = int(following > s)
            state.first_m[at] = m[i]
            state.doubt[at] += abs(m[i + 1] - m[i]) if abs(following - s) <= flat else _ZERO
            return


@compiled()
def finish(at: tuple[int, int], n: int, recurs: bool, law: _Law, state: _State, room: _Room, last: tuple[np.float32, np.float32]) -> None:
    """Close the record"""
