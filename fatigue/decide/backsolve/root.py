"""The smallest strength with which a target is met, and with all larger ones that were looked at.

Strength x is a factor that damage falls with: on a plate thickness, on the ranges of a curve, or 1 over one on the
load. Damage need not fall all the way: where membrane and bending stress oppose each other, thicker may be worse.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
UtilisationAt = Callable[[Floats], Floats]

CLOSE = 1e-11  # of the utilisation from 1
JUMPS = 1e-7  # of the utilisation from 1, where nothing lies between
NARROW = 1e-13  # of ln x: what is left between is a jump
MOST_STEPS = 100
WIDE = 8.0  # factor on a guess, either way
MOST_SHIFTS = 5  # of the range about a guess, each by the square of that
RISES = 1e-9  # relative, by which a utilisation may rise from rounding


@dataclass(frozen=True, slots=True, eq=False)
class Smallest:
    """Smallest strengths of n curves; all arrays are (n,).

    Attributes
    ----------
    x : the strength; 0 where every one that was looked at meets the target, inf where the largest does not
    utilisation : at ``x``; NaN without a finite one above 0
    not_monotonic : whether the utilisation rises anywhere along the scan
    jumps : whether the utilisation passes 1 in a jump: at ``x`` it is below
    """

    x: Floats
    utilisation: Floats
    not_monotonic: NDArray[np.bool_]
    jumps: NDArray[np.bool_]


def log_steps(low: float, high: float, steps: int) -> Floats:
    """Values from ``low`` to ``high`` in equal ratios, both ends included."""
    return np.geomspace(low, high, steps)


def smallest_that_meets(utilisation_at: UtilisationAt, scan: Floats, n: int) -> Smallest:
    """Smallest strength from which all larger ones of an ascending ``scan`` meet the target, refined.

    Parameters
    ----------
    utilisation_at : utilisation (n,) of n curves at the strengths (n,)
    scan : (s,) strengths, ascending
    n : number of curves

    Source: ``loads_and_decisions`` B3.
    """
    found = np.stack([utilisation_at(np.full(n, x)) for x in scan])
    fails = ~(found <= 1.0)
    last = np.where(fails.any(axis=0), len(scan) - 1 - fails[::-1].argmax(axis=0), -1)  # the last that fails
    rises = np.any(found[1:] > found[:-1] * (1.0 + RISES), axis=0)
    inside = (last >= 0) & (last < len(scan) - 1)
    at = np.clip(last, 0, len(scan) - 2)
    each = np.arange(n)
    x, utilisation, jumps = _refined(
        utilisation_at, scan[at], scan[at + 1], found[at, each], found[at + 1, each], inside
    )
    x = np.where(inside, x, np.where(last < 0, 0.0, np.inf))
    return Smallest(x, np.where(inside, utilisation, np.nan), np.asarray(rises), jumps & inside)


def smallest_around(utilisation_at: UtilisationAt, guess: Floats, steps: int) -> Smallest:
    """Smallest strength (n,) as ``smallest_that_meets``, about a ``guess`` (n,) that may be far off.

    An eighth to eight times the guess is scanned, and beyond it as long as the answer is not inside.
    """
    scan, n = log_steps(1.0 / WIDE, WIDE, steps), len(guess)
    found = smallest_that_meets(lambda y: utilisation_at(guess * y), scan, n)
    x = found.x * guess
    for _ in range(MOST_SHIFTS):
        above, below = np.isinf(x), x == 0.0
        if not (above | below).any():
            break
        guess = guess * np.where(above, WIDE**2, np.where(below, WIDE**-2, 1.0))
        next_ = smallest_that_meets(lambda y, at=guess: utilisation_at(at * y), scan, n)  # type: ignore[misc]
        new = above | below
        x = np.where(new, next_.x * guess, x)
        found = Smallest(*(np.where(new, getattr(next_, k), getattr(found, k)) for k in Smallest.__slots__))
    return Smallest(x, found.utilisation, found.not_monotonic, found.jumps)


def _refined(
    utilisation_at: UtilisationAt, low: Floats, high: Floats, of_low: Floats, of_high: Floats, wanted: NDArray[np.bool_]
) -> tuple[Floats, Floats, NDArray[np.bool_]]:
    """Strengths between one that fails and one that meets the target, at which it is just met.

    Secants of ln(utilisation) over ln(strength), halved where they are slow: the Illinois rule.
    """
    a, b = np.log(low), np.log(high)
    with np.errstate(divide="ignore"):
        u_a, u_b = np.log(of_low), np.log(of_high)
    best, of_best = b.copy(), of_high.copy()
    side = np.zeros(len(a))
    for step in range(MOST_STEPS):
        open_ = wanted & (np.abs(of_best - 1.0) > CLOSE) & (b - a > NARROW)
        if not open_.any():
            break
        with np.errstate(divide="ignore", invalid="ignore"):
            secant = b - u_b * (b - a) / (u_b - u_a)
        usable = np.isfinite(secant) & (secant > a) & (secant < b) & (step % 4 != 3)
        at = np.where(open_, np.where(usable, secant, 0.5 * (a + b)), b)
        u = utilisation_at(np.exp(at))
        with np.errstate(divide="ignore"):
            log_u = np.log(u)
        meets = u <= 1.0
        b, a = np.where(open_ & meets, at, b), np.where(open_ & ~meets, at, a)
        u_a = np.where(open_ & meets & (side > 0), 0.5 * u_a, np.where(open_ & ~meets, log_u, u_a))
        u_b = np.where(open_ & ~meets & (side < 0), 0.5 * u_b, np.where(open_ & meets, log_u, u_b))
        side = np.where(open_, np.where(meets, 1.0, -1.0), side)
        better = open_ & (meets | (np.abs(u - 1.0) <= CLOSE))
        best, of_best = np.where(better, at, best), np.where(better, u, of_best)
    return np.exp(best), of_best, np.abs(of_best - 1.0) > JUMPS
