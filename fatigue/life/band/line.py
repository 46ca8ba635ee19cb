"""The weakest link: how probably a whole line of weld survives, its toes many independent lengths of weld.

A specimen is a length of weld, the *reference length*; what scatters from one specimen to the next scatters from one
such length of a line to the next. Nodes are no unit: a finer mesh makes more of them, not more weld. Each node stands
for its part of the line in reference lengths, w_i. Within one weld part of the strength is common, one batch, one
welder, one procedure: the dependence rho of the strengths of two lengths::

    S(L) = int phi(z) prod_i Phi( -[u_i(L) - sqrt(rho) z] / sqrt(1 - rho) )^w_i dz

with u_i(L) the strength at which node i just lives to L; ``ln(L / L50_i) / sigma_N`` on one slope. rho = 1: the worst
point's survival; rho = 0: the plain product. Load and Miner sum are common to the line.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.special import log_ndtr, ndtr, ndtri

from fatigue.life.band.quantiles import STEP, STRENGTHS, WEIGHTS, normal_grid

Floats = NDArray[np.float64]
Strength = Callable[[float], Floats]  # ln of a life [km] -> (i,) the strength z at which each node just reaches it

_OUTER = 10  # of the other normal integral every tenth strength: 73 of them, in steps of 0.25
_LONGEST = 600.0  # ln of a life [km]: one that more than half of all lines outlive has no end
_FINEST = 40  # parts of a step: what is left of a single length does not matter any more


def tributary_lengths(arc_length: Floats) -> Floats:
    """Length of line that each node of a part stands for [mm]: half of the way to either neighbour.

    >>> tributary_lengths(np.array([0.0, 10.0, 30.0]))
    array([ 5., 15., 10.])
    """
    if len(arc_length) < 2:
        return np.zeros(len(arc_length))
    half = 0.5 * np.abs(np.diff(arc_length))
    return np.asarray(np.append(half, 0.0) + np.append(0.0, half))


def strength_survival(strength: Floats, lengths: Floats, dependence: float, common: float = 0.0) -> float:
    """Survival of a line at strengths (i,) just needed, by the scatter of its strength; its lengths (i,) in units.

    ``common`` is the standard deviation of what else is common to the line, in standard deviations of ln N. Sums of
    normal numbers are normal: it makes one integral with the dependence.
    """
    spread, own = np.sqrt(dependence + common**2), np.sqrt(1.0 - dependence)
    if own == 0.0:
        return float(ndtr(-strength.max(initial=-np.inf, where=lengths > 0.0) / spread))
    if spread == 0.0:
        return float(np.exp(lengths @ log_ndtr(-strength)))
    finer = int(np.clip(np.ceil(spread * STEP / own), 1, _FINEST))  # no step wider than a single length scatters
    z, weight = (STRENGTHS, WEIGHTS) if finer == 1 else normal_grid(STEP / finer)
    conditional = lengths @ log_ndtr(-(strength[:, None] - spread * z) / own)
    return float(weight @ np.exp(conditional))


def line_survival(
    log_life: float, strength: Strength, lengths: Floats, dependence: float, sigma_other: float = 0.0
) -> float:
    """Survival of a line at a life, curves with knees among them: ``sigma_other`` of load and Miner sum outermost."""
    if sigma_other == 0.0:
        return strength_survival(strength(log_life), lengths, dependence)
    x, weight = STRENGTHS[::_OUTER], WEIGHTS[::_OUTER] / WEIGHTS[::_OUTER].sum()
    used = weight > 1e-12
    of_x = [strength_survival(strength(log_life - sigma_other * at), lengths, dependence) for at in x[used]]
    return float(weight[used] @ np.array(of_x))


def straight_line_survival(
    log_life: float, log_median: Floats, sigma_N: float, lengths: Floats, dependence: float, sigma_other: float = 0.0
) -> float:
    """Survival of a line on one slope at a life; ``log_median`` (i,) are the ln of the median lives of its nodes."""
    return strength_survival((log_life - log_median) / sigma_N, lengths, dependence, sigma_other / sigma_N)


def median_life(survival: Callable[[float], float], low: float, high: float) -> float:
    """Life that half of all lines reach [km]; ``survival`` is a function of the ln of the life, sought from two on.

    +inf where more than half of them outlive everything.
    """

    def above(log_life: float) -> float:
        return float(ndtri(np.clip(survival(log_life), 1e-300, 1.0 - 1e-16)))

    if not np.isfinite(low + high):
        return float(np.inf)
    step = 1.0
    while above(low) < 0.0:
        low, step = low - step, 2.0 * step
    step = 1.0
    while above(high) > 0.0:
        if high > _LONGEST:
            return float(np.inf)
        high, step = high + step, 2.0 * step
    from scipy.optimize import brentq  # noqa: PLC0415 - a fifth of a second that few runs have to wait for

    return float(np.exp(brentq(above, low, high, xtol=1e-10)))
