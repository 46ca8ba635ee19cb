"""What makes damage uncertain, or different from unit to unit: variance shares in closed form, nothing is sampled.

D = sum_c d_c k_c, d_c the damage of condition c per km (or pass), k_c the distance (or number of passes) under it.
Distances may be correlated with each other, as the parts of a budget are; the damage of different conditions is not.
Then, with means d, k and variances v of d,

    var D = d' Cov(k) d  +  sum_g v_g K_g^2  +  sum_g v_g var(K_g),      K_g = sum of the k_c with the same damage g

and each term falls apart into shares of the conditions that add up: covariance shares of the first and the last, which
may be negative, k_c K_g of the middle one. With independent distances they are the first-order shares (Sobol) of
distance and damage, and their interaction.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Variance:
    """Parts (c,) of the variance of a damage; ``distance``, ``damage`` and ``both`` at once, of every condition."""

    distance: Floats
    damage: Floats
    both: Floats

    @property
    def total(self) -> float:
        """Variance of the damage."""
        return float(self.distance.sum() + self.damage.sum() + self.both.sum())


def variance_of_damage(
    damage: Floats,
    distance: Floats,
    covariance: Floats,
    damage_variance: Floats | None = None,
    same: NDArray[np.integer] | None = None,
) -> Variance:
    """Parts of the variance of D = sum_c d_c k_c.

    Parameters
    ----------
    damage, distance : (c,) means of d_c [1/km] and k_c [km]
    covariance : (c, c) of the distances [km^2]
    damage_variance : (c,) of d_c [1/km^2]; None: the damage is exact
    same : (c,) conditions of the same number have the same damage d_c, not only an equal one; None: none have

    >>> var = variance_of_damage(np.array([2e-8, 9e-8, 3e-8]), np.zeros(3), np.diag([1e12, 1.6e11, 1e12]))
    >>> (var.distance / var.total).round(8)
    array([0.1540832 , 0.49922958, 0.34668721])
    """
    of_distance = damage * (covariance @ damage)
    if damage_variance is None:
        return Variance(of_distance, np.zeros_like(damage), np.zeros_like(damage))
    group = np.arange(len(damage)) if same is None else same
    together = (group[:, None] == group[None, :]).astype(np.float64)
    of_damage = damage_variance * distance * (together @ distance)
    of_both = damage_variance * (together * covariance).sum(axis=1)
    return Variance(of_distance, of_damage, of_both)
