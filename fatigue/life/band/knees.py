"""Life at every strength of a curve with knees or a cut-off, from the histogram of one point.

A curve of another strength has its knees at the same numbers of cycles: it is the same curve on ranges over one
factor. So the damage at each strength is that of the histogram under a load factor. Each class stands for its range
``(sum n x^k / sum n)^(1/k)``, exact on the first slope; the ratio of two such sums is taken to the life that was found.
Where the cut-off is inside the highest class this mean may lie beneath it, though the cycles above it have done all of
the damage: then it is taken just above, as a life that is finite on the law has to be.
"""

import numpy as np
from numpy.typing import NDArray

from fatigue.life.curves import DamageLaw

Floats = NDArray[np.float64]

_ABOVE = 1.0 + 1e-9  # a cut-off, on whichever side of it rounding leaves the curve


def log_life_factors(count: Floats, power_sum: Floats, law: DamageLaw, range_factor: Floats) -> Floats:
    """Ln of the life at other strengths over the finite one on the law itself, (z,); +inf where nothing damages.

    Parameters
    ----------
    count, power_sum : (b,) sum n and sum n x^k of the classes in ascending order, k the first slope of the law
    range_factor : (z,) range that each strength bears, over that of the law
    """
    used = (count > 0.0) & (power_sum > 0.0)
    n, x = count[used], (power_sum[used] / count[used]) ** (1.0 / law.slopes[0])
    x[-1:] = np.maximum(x[-1:], law.cutoff * _ABOVE)
    damage = _damages(n, x, law, np.append(range_factor, 1.0))
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(damage[:-1] > 0.0, np.log(damage[-1]) - np.log(damage[:-1]), np.inf)


def _damages(n: Floats, x: Floats, law: DamageLaw, range_factor: Floats) -> Floats:
    """Damage of cycles of ascending ranges over each factor: on every segment a sum of powers between two of them."""
    damage = np.zeros(len(range_factor))
    edges = np.append(law.knees, law.cutoff)  # below which a segment ends
    upper = np.full(len(range_factor), len(x))
    for k, log_A, edge in zip(law.slopes, law.log_constants, edges, strict=True):
        powers = np.append(0.0, np.cumsum(n * np.exp(k * np.log(x) - log_A)))
        lower = np.minimum(np.searchsorted(x, edge * range_factor, side="left"), upper)
        damage += (powers[upper] - powers[lower]) * range_factor ** (-k)
        upper = lower
    return damage
