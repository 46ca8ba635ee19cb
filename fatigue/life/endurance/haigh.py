"""Endurance lines in the Haigh plane: the stress amplitude that is endured for ever, by the mean stress beside it.

A line is given by its upper stress at some stress ratios R. It is read by kappa = mean / amplitude = (1 + R) / (1 - R),
so that neither compression nor a maximum of 0 makes a case of its own. Between two points (M_1, A_1) and (M_2, A_2) of
the line the allowed amplitude of a cycle lies where its ray from the origin meets their chord:

    l = (kappa A_1 - M_1) / ((M_2 - M_1) - kappa (A_2 - A_1)),    A = A_1 + l (A_2 - A_1).
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from fatigue.compiled import compiled

Floats = NDArray[np.float64]
Component = Literal["perp", "par", "shear"]

COMPONENTS: tuple[Component, ...] = ("perp", "par", "shear")  # across the weld, along it, shear between the two
AT_THE_END = 1e-9  # of kappa (relative above 1): a cycle that is at the last row of a line but for rounding


@dataclass(frozen=True, slots=True, eq=False)
class EnduranceLine:
    """Endurance of one component of stress.

    Attributes
    ----------
    name, component : of the line
    kappa : (r,) mean / amplitude of each point, ascending
    amplitude : (r,) allowed stress amplitude there [MPa]
    edition, clause : where the numbers come from
    """

    name: str
    component: Component
    kappa: Floats
    amplitude: Floats
    edition: str
    clause: str


def endurance_line(
    name: str, component: Component, R: Floats, stress_max: Floats, edition: str = "", clause: str = ""
) -> EnduranceLine:
    """Line through the upper stresses (r,) [MPa] at stress ratios R (r,), ascending and below 1.

    >>> endurance_line("a", "perp", np.array([-1.0, 0.0]), np.array([60.0, 92.0])).amplitude
    array([60., 46.])
    """
    return EnduranceLine(name, component, kappa_of(R), 0.5 * stress_max * (1.0 - R), edition, clause)


def kappa_of(R: Floats) -> Floats:
    """Mean over amplitude of cycles of the stress ratio R, ``(1 + R) / (1 - R)``.

    >>> kappa_of(np.array([-1.0, 0.0, 0.5]))
    array([0., 1., 3.])
    """
    return np.asarray((1.0 + R) / (1.0 - R))


def stress_ratio(minimum: Floats, maximum: Floats) -> Floats:
    """``R = minimum / maximum`` of cycles; -inf where the maximum is 0, and 1 where nothing alternates.

    >>> stress_ratio(np.array([-42.0, -50.0, -50.0, 0.0]), np.array([60.0, 0.0, -10.0, 0.0]))
    array([-0.7, -inf,  5. ,  1. ])
    """
    R = np.full(np.shape(maximum), -np.inf)
    np.divide(minimum, maximum, out=R, where=maximum != 0.0)
    return np.where(minimum == maximum, 1.0, R)


def allowed_amplitudes(line: EnduranceLine, kappa: Floats) -> Floats:
    """Allowed stress amplitude (n,) [MPa] of cycles of kappa (n,); NaN above the last point of the line.

    Below the first point it is the amplitude of that point.

    >>> line = endurance_line("a", "perp", np.array([-1.0, 0.0, 0.5]), np.array([60.0, 1200 / 13, 2400 / 19]))
    >>> allowed_amplitudes(line, kappa_of(np.array([-5.0, -0.7, 0.0, 0.6]))).round(4)
    array([60.    , 56.9832, 46.1538,     nan])
    """
    return np.array([allowed_amplitude(one, line.kappa, line.amplitude) for one in np.atleast_1d(kappa).tolist()])


def utilisations(line: EnduranceLine, minimum: Floats, maximum: Floats) -> tuple[Floats, NDArray[np.bool_]]:
    """Amplitude over allowed amplitude (n,) of cycles, and whether the line has them; an upper bound where not.

    Of shear the cycles are ``mirrored`` already.
    """
    pairs = zip(minimum.tolist(), maximum.tolist(), strict=True)
    found = [utilisation(low, high, line.kappa, line.amplitude) for low, high in pairs]
    return np.array([u for u, _ in found]), np.array([inside for _, inside in found], dtype=np.bool_)


def mirrored(minimum: Floats, maximum: Floats) -> tuple[Floats, Floats]:
    """Cycles of shear: the value of larger magnitude is the maximum, as the sign of shear is a matter of the frame.

    >>> mirrored(np.array([-42.0, -60.0]), np.array([60.0, 42.0]))
    (array([-42., -42.]), array([60., 60.]))
    """
    other = -minimum > maximum
    return np.where(other, -maximum, minimum), np.where(other, -minimum, maximum)


@compiled()
def allowed_amplitude(kappa: float, kappas: Floats, amplitudes: Floats) -> float:
    """Allowed amplitude of one cycle on the line through (kappas, amplitudes); NaN above its last point."""
    last = len(kappas) - 1
    if kappa > kappas[last]:
        above = kappa - kappas[last] > AT_THE_END * max(1.0, abs(kappa))
        return np.nan if above else float(amplitudes[last])
    if kappa <= kappas[0]:
        return float(amplitudes[0])
    j = 0
    while kappa > kappas[j + 1]:
        j += 1
    A_1, A_2 = amplitudes[j], amplitudes[j + 1]
    M_1, M_2 = kappas[j] * A_1, kappas[j + 1] * A_2
    along = (kappa * A_1 - M_1) / ((M_2 - M_1) - kappa * (A_2 - A_1))
    return float(A_1 + along * (A_2 - A_1))


@compiled()
def utilisation(minimum: float, maximum: float, kappas: Floats, amplitudes: Floats) -> tuple[float, bool]:
    """Amplitude of one cycle over the allowed one, and whether the line has its kappa.

    Above the last point it is an upper bound: ``maximum`` over the upper stress of the last point. The cycle lies
    inside another one of the same maximum and the R of that point, which is not less severe.
    """
    amplitude, mean = 0.5 * (maximum - minimum), 0.5 * (maximum + minimum)
    if amplitude <= 0.0:
        return 0.0, True
    allowed = allowed_amplitude(mean / amplitude, kappas, amplitudes)
    if np.isnan(allowed):
        last = len(kappas) - 1
        return maximum / (amplitudes[last] * (1.0 + kappas[last])), False
    return amplitude / allowed, True
