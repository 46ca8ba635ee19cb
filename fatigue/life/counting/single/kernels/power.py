"""S^k of many ranges at once, and sums over them, in loops that compilers turn into vector instructions.

x^k = 2^(k log2 x), both functions by polynomials, in single precision: 1e-7 for ranges within a few powers of ten of 1.
"""

import math
from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple, cast

import numpy as np
from llvmlite import ir
from numba import types
from numba.extending import intrinsic
from numpy.polynomial import Chebyshev, Polynomial
from numpy.typing import NDArray

from fatigue.compiled import compiled
from fatigue.life.rule import ratio_factor

Floats = NDArray[np.float64]
Numbers = NDArray[np.floating]

RATIO_DEGREE = 10
LANES = 16  # single precision numbers in the widest vectors: loops over a multiple of them need no remainder
DEPTH = 4  # numbers of a lane that are added up in one go, in double precision
SUMMED = 256  # numbers summed up in single precision


class PowerLaw(NamedTuple):
    """A straight law for compiled code: its slope k, k = head + tail with 12 bits in the head, and I(r)^(-k/m)."""

    slope: np.float32
    head: np.float32
    tail: np.float32
    ratio_power: tuple[np.float32, ...]


@cache
def power_law(k: float, uses_bending_ratio: bool) -> PowerLaw:
    """Prepare the slope k, and the bending ratio where the law uses it."""
    head = np.round(k * 2**8) / 2**8
    if uses_bending_ratio:
        ratio = _series(lambda x: ratio_factor(x + 0.5) ** -k, -0.5, 0.5, RATIO_DEGREE)
    else:
        ratio = (*(_ZERO,) * RATIO_DEGREE, _ONE)
    return PowerLaw(np.float32(k), np.float32(head), np.float32(k - head), ratio)


def _series(function: Callable[[Floats], Floats], low: float, high: float, degree: int) -> tuple[np.float32, ...]:
    """Coefficients, highest power first, of the Chebyshev interpolant of a function on an interval."""
    fit = Chebyshev.interpolate(function, degree, domain=[low, high])
    coefficients = fit.convert(kind=Polynomial, domain=[-1, 1], window=[-1, 1]).coef
    return tuple(np.float32(c) for c in coefficients[::-1])


_ROOT = math.sqrt(0.5)
_LOG2 = _series(
    lambda t: np.divide(np.log2(1 + t), t, where=t != 0, out=np.full_like(t, 1 / np.log(2))),
    _ROOT - 1,
    2 * _ROOT - 1,
    8,
)
_EXP2 = _series(np.exp2, -0.5, 0.5, 6)
_HALF, _ONE, _ZERO, _TINY = np.float32(0.5), np.float32(1.0), np.float32(0.0), np.float32(1e-30)
_ROUND = np.float32(1.5 * 2**23)  # adding and subtracting it rounds to an integer
_SMALLEST = np.float32(-126.0)  # exponent
_ROOT_BITS = np.float32(_ROOT).view(np.int32)
_MANTISSA = np.int32(2**23 - 1)
_SHIFT, _BIAS = np.int32(23), np.int32(127)


def _bits_of(context: Any, x: Any) -> Any:
    """Bits of a single precision number as an integer."""
    return types.int32(types.float32), lambda _, builder, __, args: builder.bitcast(args[0], ir.IntType(32))


def _number_of(context: Any, bits: Any) -> Any:
    """Single precision number that has these bits."""
    return types.float32(types.int32), lambda _, builder, __, args: builder.bitcast(args[0], ir.FloatType())


def _widest_vectors(context: Any) -> Any:
    """Tell LLVM to use all of AVX-512 in the function that calls this: by itself it stops at half."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        attributes = builder.function.attributes
        attributes.add("noinline")  # or the attributes of the caller would count
        for name in ("prefer-vector-width", "min-legal-vector-width"):
            set.add(attributes, f'"{name}"="512"')  # llvmlite's own ``add`` knows no such attributes
        return context.get_dummy_value()

    return types.void(), generate


bits_of = cast(Callable[[np.float32], np.int32], intrinsic(_bits_of))
number_of = cast(Callable[[np.int32], np.float32], intrinsic(_number_of))
widest_vectors = cast(Callable[[], None], intrinsic(_widest_vectors))


@compiled("contract")
def polynomial(c: tuple[np.float32, ...], x: np.float32) -> np.float32:
    """``c_0 x^n + c_1 x^(n-1) + ... + c_n`` of even degree n: even and odd powers do not wait for each other."""
    square = x * x
    even, odd = c[0], c[1]
    for k in range(2, len(c) - 1, 2):
        even = even * square + c[k]
        odd = odd * square + c[k + 1]
    return (even * square + c[-1]) + odd * x


@compiled("contract")
def raise_to_slope(S: Numbers, dm: Numbers, n: int, law: PowerLaw) -> None:
    """``S <- S^k`` and ``dm <- S^k I(r)^(-k/m)``, with ``r = db / (|dm| + db)`` and ``db = |S - dm|``.

    ``S^k = 2^(k log2 S)`` with ``S = 2^e (1 + t)`` and ``log2 S = e + t p(t)``. What is behind is overwritten with
    anything, up to a multiple of ``LANES``.
    """
    widest_vectors()
    for i in range((n + LANES - 1) // LANES * LANES):
        db = abs(S[i] - dm[i])
        r = np.float32(db / max(abs(dm[i]) + db, _TINY))
        shifted = np.int32(bits_of(np.float32(max(S[i], _ZERO))) - _ROOT_BITS)
        e = np.float32(shifted >> _SHIFT)  # S = 2^e (1 + t)
        t = number_of((shifted & _MANTISSA) + _ROOT_BITS) - _ONE
        rest = law.tail * e + law.slope * (t * polynomial(_LOG2, t))
        whole = max((law.head * e + rest + _ROUND) - _ROUND, _SMALLEST)
        fraction = (law.head * e - whole) + rest
        power = polynomial(_EXP2, max(fraction, -_HALF)) * number_of((np.int32(whole) + _BIAS) << _SHIFT)
        S[i] = power
        dm[i] = power * polynomial(law.ratio_power, r - _HALF)


@compiled("nsz", "nnan", "contract")
def add_up(power: Numbers, damage: Numbers, n: int) -> tuple[float, float, np.floating]:
    """``sum power``, ``sum damage`` and ``max damage`` of the first n, summed in the order of ``add_powers``."""
    widest_vectors()
    sums = np.zeros((2, LANES))
    whole = n - n % (LANES * DEPTH)
    for first in range(0, whole, LANES * DEPTH):
        for lane in range(LANES):
            power_sum = damage_sum = 0.0
            for row in range(DEPTH):
                i = first + LANES * row + lane
                power_sum += power[i]
                damage_sum += damage[i]
            sums[0, lane] += power_sum
            sums[1, lane] += damage_sum
    for i in range(whole, n):
        sums[0, i % LANES] += power[i]
        sums[1, i % LANES] += damage[i]
    power_sum = damage_sum = 0.0
    for lane in range(LANES):
        power_sum += sums[0, lane]
        damage_sum += sums[1, lane]
    largest = _ZERO
    for i in range(n):
        largest = max(largest, damage[i])
    return power_sum, damage_sum, largest


@compiled("contract")
def add_powers(m: Numbers, b: Numbers, top_total: Any, bottom_total: Any) -> None:
    """Add ``sum x^2`` and ``sum x^4`` of both surfaces, ``x = m + b - mean`` and ``x = m - b - mean``.

    The order of the sums is written out, lane by lane: left to the compiler, it is another one in the process that
    compiles than in those that read the compiled code from disk.
    """
    widest_vectors()
    top_mean, bottom_mean = m.dtype.type(top_total.mean), m.dtype.type(bottom_total.mean)
    sums = np.zeros((4, LANES))
    whole = m.size - m.size % SUMMED
    for first in range(0, whole, SUMMED):
        for lane in range(LANES):
            top_2 = top_4 = bottom_2 = bottom_4 = _ZERO
            for row in range(SUMMED // LANES):
                i = first + LANES * row + lane
                top, bottom = m[i] + b[i] - top_mean, m[i] - b[i] - bottom_mean
                top *= top
                bottom *= bottom
                top_2 += top
                bottom_2 += bottom
                top_4 += top * top
                bottom_4 += bottom * bottom
            sums[0, lane] += top_2
            sums[1, lane] += top_4
            sums[2, lane] += bottom_2
            sums[3, lane] += bottom_4
    for i in range(whole, m.size):
        top, bottom = m[i] + b[i] - top_mean, m[i] - b[i] - bottom_mean
        top *= top
        bottom *= bottom
        sums[0, 0] += top
        sums[1, 0] += top * top
        sums[2, 0] += bottom
        sums[3, 0] += bottom * bottom
    for lane in range(LANES):
        top_total.second += sums[0, lane]
        top_total.fourth += sums[1, lane]
        bottom_total.second += sums[2, lane]
        bottom_total.fourth += sums[3, lane]
