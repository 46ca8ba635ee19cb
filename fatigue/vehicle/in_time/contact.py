"""What the linear contact of wheel and rail leaves out: hollow treads in worn sections, flanges, creep saturation.

With the lateral displacement ``d = y - u`` of a wheelset over the track, half the difference of the rolling radii is

    delta(d) = lambda d + flag (lambda0 - lambda) s0 tanh(d/s0),

so that the conicity is ``lambda0`` at small amplitude and falls towards ``lambda``: a hollow tread, or contact at two
points. ``flag`` is 1 in worn sections. The law and its constants are invented.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fatigue.compiled import compiled
from fatigue.errors import CaseError, Problem, refuse
from fatigue.vehicle.definition import Vehicle
from fatigue.vehicle.settled import settled

Floats = NDArray[np.float64]
Sections = tuple[tuple[float, float], ...]

STATES = ("sound", "worn")
SATURATED = 3.0  # creep force over friction force from which all of the contact slides


class Contact(NamedTuple):
    """Constants of the contact of wheel and rail.

    ``conicity``, ``worn_conicity`` [-] and ``hollow`` [m] are lambda, lambda0 and s0; ``f11``, ``f22`` [N] the creep
    coefficients of a wheel, ``half_gauge`` and ``radius`` [m] b and r0; ``clearance`` [m] and ``flange`` [N/m] of the
    flange of a wheelset; ``friction`` [N] ``mu W`` of a wheel, infinite without saturation; ``speed`` [m/s].
    """

    conicity: float
    worn_conicity: float
    hollow: float
    f11: float
    f22: float
    half_gauge: float
    radius: float
    clearance: float
    flange: float
    friction: float
    speed: float


def contact_of(vehicle: Vehicle, speed_m_s: float) -> Contact:
    """Contact of a vehicle at a speed.

    Raises
    ------
    CaseError : lengths, stiffness or friction that no contact has, or a setting nobody knows
    """
    given, mu = vehicle.contact, vehicle.contact.saturation_mu
    problems = [
        Problem("contact", f"[contact] {key}", f"{getattr(given, key)} is out of range", f"Give a value {lowest}")
        for key, lowest, sound in (
            ("worn_amplitude_mm", "above 0", 0.0 < given.worn_amplitude_mm < np.inf),
            ("worn_ramp_m", "of 0 or above", 0.0 <= given.worn_ramp_m < np.inf),
            ("flange_clearance_mm", "of 0 or above", given.flange_clearance_mm >= 0.0),
            ("flange_N_m", "of 0 or above", 0.0 <= given.flange_N_m < np.inf),
            ("saturation_mu", "above 0, or leave it out", mu is None or 0.0 < mu < np.inf),
        )
        if not sound
    ]
    if given.state not in STATES:
        what, remedy = f"{given.state!r} is no state of the contact", f"Choose one of {', '.join(STATES)}"
        problems.append(Problem("contact", "[contact] state", what, remedy))
    refuse(CaseError, problems)
    of = Contact(
        conicity=given.conicity,
        worn_conicity=settled(vehicle).worn_conicity,
        hollow=given.worn_amplitude_mm / 1000.0,
        f11=given.f11_N,
        f22=given.f22_N,
        half_gauge=vehicle.wheelset.half_gauge_m,
        radius=vehicle.wheelset.radius_m,
        clearance=given.flange_clearance_mm / 1000.0,
        flange=given.flange_N_m,
        friction=np.inf if mu is None else mu * given.load_N,
        speed=speed_m_s,
    )
    return Contact(*(float(constant) for constant in of))  # whole numbers would be compiled anew


def worn_flag(distance_m: Floats, sections_m: Sections, ramp_m: float) -> Floats:
    """How far a place [m] is worn, 0 to 1: linear ramps inside the ends of each section, the largest of them counts.

    >>> worn_flag(np.array([1500.0, 1505.0, 1800.0, 2090.0, 2100.0]), ((1500.0, 2100.0),), 20.0).tolist()
    [0.0, 0.25, 1.0, 0.5, 0.0]
    """
    worn = np.zeros(np.shape(distance_m))
    for begin, end in sections_m:
        inside = np.minimum(distance_m - begin, end - distance_m)
        part = np.clip(inside / ramp_m, 0.0, 1.0) if ramp_m > 0.0 else np.asarray(inside >= 0.0, np.float64)
        worn = np.maximum(worn, part)
    return worn


def equivalent_conicity(amplitude_m: ArrayLike, conicity: float, worn_conicity: float, hollow_m: float) -> Floats:
    """Conicity of a worn tread for a sine of the lateral displacement, by its amplitude A (n,) [m]; lambda0 at rest.

    Harmonic linearisation, over a period of p: ``lambda + (lambda0 - lambda) s0/(pi A) integral tanh(A sin p/s0) sin p
    dp``. The integral is a mean over equal steps of p, which converges faster than any power of their number.

    Raises
    ------
    CaseError : an amplitude below 0 or not finite, or s0 not above 0

    >>> equivalent_conicity([0.0, 0.002, 0.008], 0.1, 1.2, 0.002).round(4).tolist()
    [1.2, 0.9928, 0.4405]
    """
    A = np.asarray(amplitude_m, np.float64)
    possible = np.isfinite(A) & (A >= 0.0)
    if not np.all(possible):
        what = f"an amplitude of {A[~possible].flat[0]} m has no conicity"
        raise CaseError(Problem("contact", "equivalent conicity", what, "Give amplitudes of 0 m or more"))
    if not 0.0 < hollow_m < np.inf:
        what = f"a tread that is hollow over {hollow_m} m has no conicity at rest"
        raise CaseError(Problem("contact", "[contact] worn_amplitude_mm", what, "Give a length above 0"))
    ratio = A / hollow_m
    steps = 40 + 24 * int(np.ceil(np.max(ratio, initial=0.0)))  # tanh turns within s0/A of a period
    sine = np.sin(2.0 * np.pi * (np.arange(steps) + 0.5) / steps)
    mean = np.mean(np.tanh(ratio[..., None] * sine) * sine, axis=-1)
    falls = np.where(ratio > 0.0, 2.0 * mean / np.where(ratio > 0.0, ratio, 1.0), 1.0)
    return np.asarray(conicity + (worn_conicity - conicity) * falls)


@compiled()
def worn_part(d: float, worn: float, of: Contact) -> float:
    """``delta(d) - lambda d`` [m]: what a worn tread adds to half the difference of rolling radii."""
    return float(worn * (of.worn_conicity - of.conicity) * of.hollow * np.tanh(d / of.hollow))


@compiled()
def flange_force(d: float, of: Contact) -> float:
    """Lateral force of the flange on a wheelset [N], ``-k (|d| - c) sign d`` beyond the clearance."""
    beyond = abs(d) - of.clearance
    return -of.flange * beyond * np.sign(d) if beyond > 0.0 else 0.0


@compiled()
def saturation(creep_force: float, friction: float) -> float:
    """Factor on a linear creep force [N] that friction [N] limits (Johnson and Vermeulen).

    ``1 - e/3 + e^2/27`` with ``e`` creep force over friction; 1/e from e = 3 on, where all of the contact slides.
    """
    e = creep_force / friction
    return 1.0 - e / 3.0 + e * e / 27.0 if e < SATURATED else 1.0 / e


@compiled()
def remainder(d: float, psi: float, y_rate: float, psi_rate: float, worn: float, of: Contact) -> tuple[float, float]:
    """Lateral force [N] and yaw moment [N m] on a wheelset beyond those of linear contact with the conicity lambda.

    Creep forces of a wheel are ``F_x = f11 (b psi'/V + delta/r0)``, ``F_y = f22 (y'/V - psi)``; the wheelset feels
    ``-2 F_y`` and ``-2 b F_x``, both times the factor of saturation. The linear equations hold them without it, and
    with ``lambda d`` for ``delta``. Spin is not saturated.
    """
    hollow = of.f11 * worn_part(d, worn, of) / of.radius
    lateral = flange_force(d, of)
    if of.friction == np.inf:
        return lateral, -2.0 * of.half_gauge * hollow
    linear = of.f11 * (of.half_gauge * psi_rate / of.speed + of.conicity * d / of.radius)
    F_x, F_y = linear + hollow, of.f22 * (y_rate / of.speed - psi)
    factor = saturation(np.hypot(F_x, F_y), of.friction)
    return lateral - 2.0 * (factor - 1.0) * F_y, -2.0 * of.half_gauge * (factor * F_x - linear)
