"""Damage of a cycle: from its structural stress range, bending ratio and thickness to Miner's sum."""

from typing import Literal

import numpy as np
from numpy.typing import NDArray

from fatigue.life.curves import DamageLaw, SNCurve

ThicknessRule = Literal["actual", "asme"]

M_SS = 3.6  # crack-growth exponent of the master curve (ASME VIII-2 5.5.5.2)
ASME_THICKNESS_LIMITS = (16.0, 150.0)  # [mm], ASME VIII-2 5.5.5.2: 0.625 in and 6 in


def bending_ratio(membrane_range: NDArray[np.float64], bending_range: NDArray[np.float64]) -> NDArray[np.float64]:
    """``r = |d sigma_b| / (|d sigma_m| + |d sigma_b|)`` of ranges of equal shape [MPa]; 0 where both are 0."""
    bending = np.abs(bending_range)
    total = np.abs(membrane_range) + bending
    return np.asarray(np.divide(bending, total, out=np.zeros_like(total), where=total > 0.0))


def ratio_factor(r: NDArray[np.float64]) -> NDArray[np.float64]:
    """``I(r)^(1/m)`` of the load-controlled edge crack, 1.221 in pure membrane to 1.331 in pure bending.

    Source: ASME VIII-2 5.5.5.2.
    """
    return (1.23 - 0.364 * r - 0.17 * r**2) / (1.007 - 0.306 * r - 0.178 * r**2)


def size_factor(thickness: NDArray[np.float64], curve: SNCurve, rule: ThicknessRule) -> NDArray[np.float64]:
    """Factor of the plate thickness [mm] on the range, so that ``x = size * S / I(r)^(1/m)``.

    Master curve: ``t_ess^((m-2)/(2m))`` with the actual thickness, or with the one that ASME VIII-2 5.5.5.2 limits to
    16 to 150 mm. Other curves: ``(t / t_ref)^n`` for t above the reference thickness of the curve.
    """
    if curve.applies == "dS":
        t_ess = np.clip(thickness, *ASME_THICKNESS_LIMITS) if rule == "asme" else thickness
        return np.asarray(t_ess ** ((M_SS - 2.0) / (2.0 * M_SS)))
    if curve.thickness_reference is None:
        return np.ones_like(thickness)
    return np.asarray(np.maximum(thickness / curve.thickness_reference, 1.0) ** curve.thickness_exponent)


def mean_stress_factor(
    minimum: NDArray[np.float64], maximum: NDArray[np.float64], yield_MPa: float
) -> NDArray[np.float64]:
    """``f_M = (1 - R)^(1/m)`` for cycles in high mean tension, else 1; the range is divided by it.

    Applies where the mean of the cycle is at least half the yield stress, R > 0 and the range at most twice the yield
    stress; ``minimum`` and ``maximum`` are the structural stresses at the two reversals, dead load included [MPa].
    Source: ASME VIII-2 5.5.5.2.
    """
    applies = (minimum + maximum >= yield_MPa) & (minimum > 0.0) & (maximum - minimum <= 2.0 * yield_MPa)
    R = np.divide(minimum, maximum, out=np.zeros_like(maximum), where=applies)
    return np.where(applies & (R < 1.0), (1.0 - R) ** (1.0 / M_SS), 1.0)


def cycle_damage(equivalent_range: NDArray[np.float64], law: DamageLaw) -> NDArray[np.float64]:
    """Damage ``d(x) = x^k / A`` of one cycle of each equivalent range (Palmgren-Miner: damages add)."""
    x = np.asarray(equivalent_range, dtype=np.float64)
    segment = np.sum(x[..., None] < law.knees, axis=-1)
    damaging = (x > 0.0) & (x >= law.cutoff)
    log_x = np.log(x, out=np.zeros_like(x), where=damaging)
    return np.where(damaging, np.exp(law.slopes[segment] * log_x - law.log_constants[segment]), 0.0)


def shear_factor(
    variance: NDArray[np.float64], shear_variance: NDArray[np.float64], covariance: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Factor on the equivalent range if shear were counted with the normal stress, from their covariance [MPa^2].

    ASME VIII-2 5.5.5.3 combines ``sqrt(dS^2 + 3 dT^2) / F(delta)`` for a harmonic path with phase delta. In the plane
    of (sigma, sqrt(3) tau) its F is ``sqrt(l1 / (l1 + l2))`` with the principal variances l1 >= l2. It needs no phase
    and carries the rule over to random histories (an extension of the clause). The variances are those of normal and
    shear stress already divided by their own ``I(r)^(1/m)``. NaN where the normal stress does not vary.
    """
    a, b, c = variance, 3.0 * shear_variance, np.sqrt(3.0) * covariance
    largest = 0.5 * (a + b) + np.sqrt(0.25 * (a - b) ** 2 + c**2)
    return np.asarray(np.divide(a + b, np.sqrt(largest * a), out=np.full_like(a, np.nan), where=a > 0.0))
