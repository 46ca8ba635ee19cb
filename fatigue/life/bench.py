"""A block programme for a test bench: how many cycles of given loads do the damage that the mission does.

Block b swings every load between minus and plus half of its range, all of them at the same instants; a negative range
swings against the others. One cycle of it does the damage G_ib at point i, by the rule of the assessment. Of the target
damages D_i it does A_ib = G_ib / D_i, and n_b cycles of every block achieve a = A n:

    least squares:  minimise |A n - 1|,   n >= 0                    as close as it gets: some points above, some below
    cover:          minimise tau,  1 <= A n <= tau,   n >= 0        every point at least, none more than need be

A bench runs whole cycles: n is rounded up, and evaluated again.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linprog, nnls

from fatigue.errors import NumericalError, Problem
from fatigue.life.rule import CycleRule, bending_ratio, cycle_damage, equivalent_range

Floats = NDArray[np.float64]

MOST_CYCLES = 1e12  # of a block: three hundred years at 100 Hz; what takes more is not reached
_CLOSE = 1e-9  # of the smallest tau: within it the programme with the fewest cycles is taken
_EXACTLY = {"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10}


@dataclass(frozen=True, slots=True, eq=False)
class BlockCycles:
    """One cycle of each of b blocks at each of p points; arrays are (p, b).

    Attributes
    ----------
    membrane_range, bending_range : [MPa]
    range : of the structural stress at the face [MPa]
    bending_ratio : of the cycle
    equivalent_range : dS [MPa mm^-0.222], [MPa] on curves in structural stress
    damage : of one cycle
    """

    membrane_range: Floats
    bending_range: Floats
    range: Floats
    bending_ratio: Floats
    equivalent_range: Floats
    damage: Floats


@dataclass(frozen=True, slots=True, eq=False)
class Programme:
    """Cycles of every block, and what they achieve at every point, as found and rounded up to whole cycles.

    Attributes
    ----------
    method : ``least_squares`` or ``cover``
    cycles, whole_cycles : (b,)
    achieved, achieved_whole : (p,) damage over target
    """

    method: str
    cycles: Floats
    whole_cycles: Floats
    achieved: Floats
    achieved_whole: Floats

    @property
    def norm(self) -> float:
        """Root of the sum of squares of achieved / target - 1."""
        return float(np.linalg.norm(self.achieved - 1.0))

    @property
    def tau(self) -> float:
        """Largest achieved / target over the smallest; inf where a point gets nothing."""
        smallest = float(self.achieved.min())
        return float(self.achieved.max()) / smallest if smallest > 0.0 else np.inf


def block_cycles(
    membrane: Floats, bending: Floats, side: Floats, size: Floats, ranges: Floats, rule: CycleRule
) -> BlockCycles:
    """One cycle of each block at points that share a curve, its mean stress left out: R = -1, where f_M is 1.

    Parameters
    ----------
    membrane, bending : (p, c) stress per unit of each load, bending of the top face [MPa per unit]
    side : (p,) +1 for the top face, -1 for the bottom face
    size : (p,) factor of the thickness on the range
    ranges : (b, c) range of every load in every block, its sign the phase
    rule : of the curve
    """
    dm, db = membrane @ ranges.T, bending @ ranges.T
    S = np.abs(dm + side[:, None] * db)
    r = bending_ratio(dm, db)
    dS = equivalent_range(S, size[:, None], rule.ratio_factor(r), np.ones_like(S))
    return BlockCycles(np.abs(dm), np.abs(db), S, r, dS, cycle_damage(dS, rule.law))


def unreached(share: Floats) -> NDArray[np.bool_]:
    """Points (p,) that no block reaches within ``MOST_CYCLES``, from the share (p, b) of the target in one cycle."""
    return np.asarray(share.max(axis=1) * MOST_CYCLES < 1.0)


def idle(share: Floats) -> NDArray[np.bool_]:
    """Blocks (b,) that reach no point within ``MOST_CYCLES``; no programme has them."""
    return np.asarray(share.max(axis=0) * MOST_CYCLES < 1.0)


def least_squares(share: Floats) -> Programme:
    """The programme closest to all targets, from the share (p, b) of the target that one cycle of a block achieves.

    Blocks may do the same, as those of one shape and two levels on a curve of one slope: of all programmes as close the
    one with the fewest cycles is taken.

    Raises
    ------
    NumericalError : no solution was found
    """
    scaled, scale = _scaled(share)
    try:
        found, _ = nnls(scaled, np.ones(len(share)))
    except RuntimeError as error:
        raise _not_found("least_squares", str(error)) from error
    achieved = scaled @ found
    found = _fewest(scaled, scale, (1.0 - _CLOSE) * achieved, (1.0 + _CLOSE) * achieved, found)
    return _programme("least_squares", found / scale, share)


def cover(share: Floats) -> Programme:
    """The programme that reaches every target and exceeds none by more than need be: of all such, the fewest cycles.

    Raises
    ------
    NumericalError : none keeps all points within a factor 1e9 of each other
    """
    scaled, scale = _scaled(share)
    points, blocks = scaled.shape
    above = np.hstack([-scaled, np.zeros((points, 1))])
    below = np.hstack([scaled, -np.ones((points, 1))])
    limits = np.concatenate([-np.ones(points), np.zeros(points)])
    tau_alone = np.append(np.zeros(blocks), 1.0)
    least = linprog(tau_alone, np.vstack([above, below]), limits, method="highs", options=_EXACTLY)
    if least.x is None:
        raise _not_found("cover", least.message)
    found, tau = least.x[:blocks], least.x[blocks]
    found = _fewest(scaled, scale, np.ones(points), np.full(points, (1.0 + _CLOSE) * tau), found)
    cycles = np.maximum(found, 0.0) / scale
    if (smallest := float((share @ cycles).min())) <= 0.0:
        raise _not_found("cover", "a point gets nothing")
    return _programme("cover", cycles / smallest, share)


def _scaled(share: Floats) -> tuple[Floats, Floats]:
    """Share of each block over its largest, and that (b,): such columns are solved well. Those of idle blocks are 0."""
    is_idle = idle(share)
    scale = np.where(is_idle, 1.0, share.max(axis=0))
    return np.where(is_idle, 0.0, share) / scale, scale


def _fewest(scaled: Floats, scale: Floats, low: Floats, high: Floats, found: Floats) -> Floats:
    """Of all that achieve from ``low`` to ``high`` what takes the fewest cycles; ``found`` where that is about it."""
    length = scale.min() / scale  # of a programme, in cycles, but for a factor
    limits = np.concatenate([-low, high])
    fewest = linprog(length, np.vstack([-scaled, scaled]), limits, method="highs", options=_EXACTLY)
    shorter = fewest.x is not None and length @ fewest.x < (1.0 - 1e-6) * (length @ found)
    return np.maximum(fewest.x, 0.0) if shorter else found


def _programme(method: str, cycles: Floats, share: Floats) -> Programme:
    whole = np.ceil(cycles)
    return Programme(method, cycles, whole, share @ cycles, share @ whole)


def _not_found(method: str, why: str) -> NumericalError:
    what = f"no programme was found ({why.strip().splitlines()[0].rstrip('.')})"
    return NumericalError(Problem("bench_no_solution", method, what, "Give blocks that differ less at these points"))
