"""What a vehicle answers to a rough track in the frequency domain: transfer functions, densities, modal split.

The track comes as three independent signals, lateral, vertical and roll. Axle i meets them ``(x_1 - x_i)/V`` after axle
1. A signal s of amplitude 1 moves the states of ``x' = A x + B [w, w']`` by
``H_s = (i w - A)^-1 sum_i (B_si + i w B'_si) exp(-i w (x_1 - x_i)/V)``, B' the columns of rates. Densities add up:
``G = sum_s |r H_s|^2 S_s``, those of accelerations times ``w^4``.

The answer of an unstable vehicle grows without bound: it has no such densities and is refused.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import matrix_balance, schur, solve_triangular

from fatigue.errors import CaseError, Problem
from fatigue.vehicle.assembly import KM_H, LinearVehicle
from fatigue.vehicle.definition import Track
from fatigue.vehicle.elastic import ElasticBody
from fatigue.vehicle.equations.suspension import AXLES, SIGNALS
from fatigue.vehicle.roots import is_stable, least_stable
from fatigue.vehicle.track import spectra_per_hz
from fatigue.vibration.standards.sperling import Direction, wz_of_density

Floats = NDArray[np.float64]
Complex = NDArray[np.complex128]

GRID_HZ = np.arange(25, 3001) / 50.0  # 0.50, 0.52, ... 60.00 Hz
COMFORT_HZ = (0.5, 40.0)  # band of Wz


@dataclass(frozen=True, slots=True, eq=False)
class Response:
    """Densities over ``frequency_hz`` (k,), one-sided, and the motion they come from.

    ``acceleration`` by output: (k,) [(m/s2)2/Hz]. ``recovered`` by name: (k,), the square of its unit per Hz.
    ``transfer`` (3, k, n): coordinates per unit of lateral, vertical [m] and roll [rad] of the track, ``track`` (3, k)
    their densities; ``modes`` are the coordinates of the car body's modes.
    """

    frequency_hz: Floats
    acceleration: Mapping[str, Floats]
    recovered: Mapping[str, Floats]
    transfer: Complex
    track: Floats
    modes: slice


def response(of: LinearVehicle, track: Track, frequency_hz: Floats = GRID_HZ) -> Response:
    """Densities of all outputs of a stable vehicle on a rough track.

    Raises
    ------
    CaseError : the vehicle is unstable; the root that grows fastest is named
    """
    refuse_unstable(of)
    S = spectra_per_hz(frequency_hz, of.speed_m_s, track)
    H = transfer(of, frequency_hz)
    w4 = (2.0 * np.pi * frequency_hz) ** 4
    acceleration = {name: w4 * density(row, H, S) for name, row in of.outputs.items()}
    recovered = {name: density(row, H, S) for name, row in of.recovered.items()}
    return Response(frequency_hz, acceleration, recovered, H, S, of.coordinates.flex)


def density(row: Floats, H: Complex, S: Floats) -> Floats:
    """One-sided density (k,) of what a row (n,) over the coordinates gives, ``sum_s |r H_s|^2 S_s``."""
    return np.asarray(np.sum(np.abs(H @ row) ** 2 * S, axis=0))


def rms(frequency_hz: Floats, density_per_hz: Floats, above_hz: float = 0.0) -> float:
    """Root of the integral of a density (k,) by the trapezoidal rule, from a frequency on."""
    from_here = frequency_hz >= above_hz
    return float(np.sqrt(np.trapezoid(density_per_hz[from_here], frequency_hz[from_here])))


def peak_hz(frequency_hz: Floats, density_per_hz: Floats) -> float:
    """Frequency [Hz] of the highest value of a density (k,)."""
    return float(frequency_hz[density_per_hz.argmax()])


def wz(of: Response, output: str) -> float:
    """Sperling's index of an output, filter form, 0.5 to 40 Hz; its name ends in the direction, ``_y`` or ``_z``."""
    direction: Direction = "y" if output.endswith("_y") else "z"
    return wz_of_density(of.frequency_hz, of.acceleration[output], direction, COMFORT_HZ)


def transfer(of: LinearVehicle, frequency_hz: Floats) -> Complex:
    """Motion (3, k, n) of the coordinates per unit of lateral, vertical and roll of the track under axle 1.

    The Schur form ``A = Z T Z*`` is computed once; each frequency then costs the solution of a triangular system.
    """
    n = len(of.M)
    lag_s = (of.axle_x_m[0] - of.axle_x_m) / of.speed_m_s
    balanced, (scale, _) = matrix_balance(of.A, permute=False, separate=True)
    T, Z = schur(balanced, output="complex")
    ZB = (Z.conj().T @ (of.B / scale[:, None])).reshape(len(Z), 2, SIGNALS, AXLES)
    back, shifted, diagonal = scale[:n, None] * Z[:n], np.asfortranarray(-T), np.diag(T)
    H = np.empty((SIGNALS, len(frequency_hz), n), dtype=np.complex128)
    for k, iw in enumerate(2j * np.pi * frequency_hz):
        np.fill_diagonal(shifted, iw - diagonal)
        force = (ZB[:, 0] + iw * ZB[:, 1]) @ np.exp(-iw * lag_s)
        H[:, k] = (back @ solve_triangular(shifted, force, check_finite=False)).T
    return H


@dataclass(frozen=True, slots=True, eq=False)
class ModalSplit:
    """What excites the modes (m,) of the car body, and how much of their answer is static.

    ``f = q'' + 2 z w q' + w^2 q`` [N/sqrt(kg)], ``q_static = f/w^2``, ``q_dynamic = q - q_static``; each as the
    rms of mode by mode, ``rms_q`` [m sqrt(kg)].
    """

    mode_hz: Floats
    rms_q: Floats
    rms_excitation: Floats
    static_share: Floats
    dynamic_share: Floats


def modal_split(of: Response, body: ElasticBody) -> ModalSplit:
    """Effective excitation of the modes of the car body, static and dynamic part of their answer over all of it."""
    iw = 2j * np.pi * of.frequency_hz[:, None]
    w, z = 2.0 * np.pi * body.frequency_hz, body.damping_ratio
    q = of.transfer[:, :, of.modes]
    f = (iw**2 + 2.0 * z * w * iw + w**2) * q
    rms_q, rms_f, rms_dynamic = (
        np.sqrt(np.trapezoid(np.einsum("skm,sk->km", np.abs(motion) ** 2, of.track), of.frequency_hz, axis=0))
        for motion in (q, f, q - f / w**2)
    )
    return ModalSplit(body.frequency_hz, rms_q, rms_f, rms_f / w**2 / rms_q, rms_dynamic / rms_q)


def refuse_unstable(of: LinearVehicle) -> None:
    """Refuse an unstable vehicle a linear response.

    Raises
    ------
    CaseError : names the root that grows fastest: what moves, its frequency, damping and share of energy
    """
    if is_stable(of):
        return
    where = f"{KM_H * of.speed_m_s:g} km/h, conicity {of.conicity:g}"
    what = f"the vehicle is unstable, so that it has no linear response: {least_stable(of)}"
    remedy = "Choose a speed and a conicity at which all roots decay, or let it ride in time"
    raise CaseError(Problem("unstable", where, what, remedy))
