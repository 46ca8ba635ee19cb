"""Wheel and rail, linear: creep, gravity and spin on a wheelset, as matrices in 1/V and in the conicity.

With y, psi of a wheelset, u the lateral irregularity under it, V the speed, lambda the equivalent conicity::

    m y''   + 2 f22/V y' + 2 f23/V psi' + 2 W eps/b (y - u) - 2 f22 psi = F
    I psi'' + 2 f11 b^2/V psi' - 2 f23/V y' + 2 f11 b lambda/r0 (y - u) + (2 f23 - 2 W b lambda) psi = M

Coefficients are per wheel. Spin from conicity is left out. Only u enters, not its rate. Linear Kalker creep, as in
Wickens, Fundamentals of Rail Vehicle Dynamics, chapter 2.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.vehicle.definition import Contact, Wheelset

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Creep:
    """Of one wheelset over (y, psi): ``C = over_speed/V``, ``K = stiffness + lambda over_conicity``.

    The irregularity pushes with ``(lateral + lambda lateral_over_conicity) u``, (2,) each.
    """

    over_speed: Floats
    stiffness: Floats
    over_conicity: Floats
    lateral: Floats
    lateral_over_conicity: Floats


def creep(contact: Contact, wheelset: Wheelset) -> Creep:
    """Creep, gravitational and spin terms of one wheelset (equations above)."""
    f11, f22, f23, W = contact.f11_N, contact.f22_N, contact.f23_Nm, contact.load_N
    b, r0, eps = wheelset.half_gauge_m, wheelset.radius_m, contact.contact_angle_rate
    return Creep(
        over_speed=np.array([[2 * f22, 2 * f23], [-2 * f23, 2 * f11 * b**2]]),
        stiffness=np.array([[2 * W * eps / b, -2 * f22], [0.0, 2 * f23]]),
        over_conicity=np.array([[0.0, 0.0], [2 * f11 * b / r0, -2 * W * b]]),
        lateral=np.array([2 * W * eps / b, 0.0]),
        lateral_over_conicity=np.array([0.0, 2 * f11 * b / r0]),
    )


def klingel_hz(speed_m_s: float, conicity: float, wheelset: Wheelset) -> float:
    """Frequency of a free wheelset that rolls without creep, ``V/(2 pi) sqrt(lambda/(b r0))`` (Klingel 1883).

    >>> round(klingel_hz(5.0, 0.1, Wheelset()), 4)
    0.4294
    """
    return float(speed_m_s / (2 * np.pi) * np.sqrt(conicity / (wheelset.half_gauge_m * wheelset.radius_m)))
