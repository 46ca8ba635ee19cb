"""The equations of motion of a vehicle at a speed and a conicity, and its state matrix.

With coordinates q, elongations d of the yaw dampers, irregularities w of the track under the axles and forces g on the
wheelsets::

    M q'' + C q' + K q + sum of k r'(r q - d) = B_value w + B_rate w' + g,    c d' = k (r q - d)

    x = [q, q', d],    x' = A x + B [w, w'] + G g

Speed and conicity enter through creep alone: ``A = A_0 + A_V/V + lambda A_lambda``. ``suspended`` computes the parts
once, ``SuspendedVehicle.at`` adds them up, so that a map of roots costs its eigenvalues and nothing else.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import block_diag

from fatigue.errors import CaseError, Problem, refuse
from fatigue.vehicle.definition import Equipment, Vehicle
from fatigue.vehicle.elastic import ElasticBody
from fatigue.vehicle.equations.coordinates import Coordinates
from fatigue.vehicle.equations.creep import creep
from fatigue.vehicle.equations.output_rows import output_rows, recovered_rows
from fatigue.vehicle.equations.springs import Maxwell, damping, from_rail, stiffness
from fatigue.vehicle.equations.suspension import AXLES, SIGNALS, Places, require_points, springs, yaw_dampers
from fatigue.vehicle.settled import axle_places

Floats = NDArray[np.float64]

KM_H = 3.6  # km/h in a m/s


@dataclass(frozen=True, slots=True, eq=False)
class LinearVehicle:
    """A vehicle at one speed and conicity: matrices over n coordinates, and N = 2 n + (yaw dampers) states [q, q', d].

    ``M``, ``C``, ``K`` (n, n) hold creep and all springs but the yaw dampers ``maxwell``. ``B_value``, ``B_rate``
    (n, 12) are the forces of irregularities and their rates: lateral of axles 1 to 4, then vertical, then roll. State
    matrix ``A`` (N, N), ``B`` (N, 24) for [w, w'], ``G`` (N, 8) for forces along y on the four wheelsets [N], then
    moments about z [N m]. ``body_hz`` (m,) are the frequencies of the bare car body. ``outputs`` and
    ``recovered`` are rows (n,) over the coordinates: displacements [m] by name, and what the body recovers from modes.
    """

    coordinates: Coordinates
    speed_m_s: float
    conicity: float
    axle_x_m: Floats
    M: Floats
    C: Floats
    K: Floats
    maxwell: tuple[Maxwell, ...]
    B_value: Floats
    B_rate: Floats
    A: Floats
    B: Floats
    G: Floats
    body_hz: Floats
    outputs: Mapping[str, Floats]
    recovered: Mapping[str, Floats]


@dataclass(frozen=True, slots=True, eq=False)
class SuspendedVehicle:
    """All of a vehicle that neither speed nor conicity changes, and how these two enter: see the module.

    ``C``, ``K`` are without what is divided by V or multiplied with the conicity: ``C_speed``, ``K_conicity``.
    """

    coordinates: Coordinates
    axle_x_m: Floats
    M: Floats
    C: Floats
    C_speed: Floats
    K: Floats
    K_conicity: Floats
    maxwell: tuple[Maxwell, ...]
    B_value: Floats
    B_conicity: Floats
    B_rate: Floats
    A_0: Floats
    A_speed: Floats
    A_conicity: Floats
    inverse_mass: Floats
    body_hz: Floats
    outputs: Mapping[str, Floats]
    recovered: Mapping[str, Floats]

    def state_matrix(self, speed_km_h: float, conicity: float) -> Floats:
        """``A = A_0 + A_V/V + lambda A_lambda`` (N, N).

        Raises
        ------
        CaseError : no speed, or a conicity that no wheel has
        """
        _refuse_rest(speed_km_h, conicity)
        return self.A_0 + self.A_speed / (speed_km_h / KM_H) + conicity * self.A_conicity

    def at(self, speed_km_h: float, conicity: float) -> LinearVehicle:
        """The vehicle at a speed [km/h] and an equivalent conicity.

        Raises
        ------
        CaseError : no speed, or a conicity that no wheel has
        """
        A = self.state_matrix(speed_km_h, conicity)
        n, states, V = len(self.M), len(A), speed_km_h / KM_H
        B_value = self.B_value + conicity * self.B_conicity
        B = np.zeros((states, 2 * SIGNALS * AXLES))
        B[n : 2 * n] = self.inverse_mass @ np.hstack([B_value, self.B_rate])
        G = np.zeros((states, 2 * AXLES))
        G[n : 2 * n] = self.inverse_mass[:, np.r_[self.coordinates.wheelset_y, self.coordinates.wheelset_yaw]]
        return LinearVehicle(
            coordinates=self.coordinates,
            speed_m_s=V,
            conicity=conicity,
            axle_x_m=self.axle_x_m,
            M=self.M,
            C=self.C + self.C_speed / V,
            K=self.K + conicity * self.K_conicity,
            maxwell=self.maxwell,
            B_value=B_value,
            B_rate=self.B_rate,
            A=A,
            B=B,
            G=G,
            body_hz=self.body_hz,
            outputs=self.outputs,
            recovered=self.recovered,
        )


def assembled(
    vehicle: Vehicle, body: ElasticBody, speed_km_h: float | None = None, conicity: float | None = None
) -> LinearVehicle:
    """A vehicle at a speed [km/h] and a conicity; left out, they are those of ``[run]`` and ``[contact]``.

    Raises
    ------
    CaseError : a setting nobody knows, no speed, or a conicity that no wheel has
    DataError : the car body lacks a point where the suspension takes hold
    """
    speed = vehicle.run.speed_km_h if speed_km_h is None else speed_km_h
    return suspended(vehicle, body).at(speed, vehicle.contact.conicity if conicity is None else conicity)


def suspended(vehicle: Vehicle, body: ElasticBody) -> SuspendedVehicle:
    """A vehicle with this car body, ready for any speed and conicity.

    Raises
    ------
    CaseError : a setting nobody knows
    DataError : the car body lacks a point where the suspension takes hold
    """
    require_points(body)
    at = Coordinates(len(body.frequency_hz))
    places = Places(vehicle, body, at)
    elements, dampers = springs(places), tuple(yaw_dampers(places))
    M = mass(vehicle, body)
    K, C = stiffness(elements), damping(elements)
    w = 2.0 * np.pi * body.frequency_hz
    K[at.flex, at.flex] += np.diag(w**2)
    C[at.flex, at.flex] += np.diag(2.0 * body.damping_ratio * w)
    B_value, B_rate = from_rail(elements, SIGNALS * AXLES)
    C_speed, K_conicity, B_conicity = np.zeros_like(C), np.zeros_like(K), np.zeros_like(B_value)
    of_wheelset = creep(vehicle.contact, vehicle.wheelset)
    for axle, rows in enumerate(zip(at.wheelset_y, at.wheelset_yaw, strict=True)):
        both = np.ix_(rows, rows)
        C_speed[both] += of_wheelset.over_speed
        K[both] += of_wheelset.stiffness
        K_conicity[both] += of_wheelset.over_conicity
        B_value[rows, axle] += of_wheelset.lateral
        B_conicity[rows, axle] += of_wheelset.lateral_over_conicity
    inverse = np.asarray(np.linalg.inv(M))
    return SuspendedVehicle(
        coordinates=at,
        axle_x_m=np.array(axle_places(vehicle)),
        M=M,
        C=C,
        C_speed=C_speed,
        K=K,
        K_conicity=K_conicity,
        maxwell=dampers,
        B_value=B_value,
        B_conicity=B_conicity,
        B_rate=B_rate,
        A_0=_state_matrix(inverse, C, K, dampers),
        A_speed=_accelerations(-inverse @ C_speed, len(M), len(dampers), of_velocity=True),
        A_conicity=_accelerations(-inverse @ K_conicity, len(M), len(dampers), of_velocity=False),
        inverse_mass=inverse,
        body_hz=body.frequency_hz,
        outputs=output_rows(places),
        recovered=recovered_rows(places),
    )


def mass(vehicle: Vehicle, body: ElasticBody) -> Floats:
    """Mass matrix (n, n): the car body as a rigid one, 1 for its modes, equipment, bogies and wheelsets."""
    bogie, wheelset = vehicle.bogie, vehicle.wheelset
    of_bogie = _rigid(bogie.mass_kg, np.diag([bogie.ixx_kg_m2, bogie.iyy_kg_m2, bogie.izz_kg_m2]))
    of_wheelset = np.diag([wheelset.mass_kg, wheelset.izz_kg_m2])
    return np.asarray(
        block_diag(
            _rigid(body.mass, body.inertia),
            np.eye(len(body.frequency_hz)),
            *(_equipment_mass(equipment) for equipment in (vehicle.converter, vehicle.transformer)),
            *([of_bogie] * 2),
            *([of_wheelset] * AXLES),
        )
    )


def _equipment_mass(of: Equipment) -> Floats:
    return _rigid(of.mass_kg, np.diag([of.ixx_kg_m2, of.iyy_kg_m2, of.izz_kg_m2]))


def _rigid(mass_kg: float, inertia: Floats) -> Floats:
    """Mass matrix (5, 5) of a rigid body about its centre of gravity: y, z, rx, ry, rz."""
    return np.asarray(block_diag(mass_kg * np.eye(2), inertia))


def _state_matrix(inverse: Floats, C: Floats, K: Floats, dampers: tuple[Maxwell, ...]) -> Floats:
    """``A`` (N, N) of ``[q, q', d]``; a yaw damper pulls with ``k (r q - d)``, and ``d' = k/c (r q - d)``."""
    n, m = len(C), len(dampers)
    R = np.stack([damper.row for damper in dampers]) if dampers else np.zeros((0, n))
    k, c = (np.array([getattr(damper, key) for damper in dampers]) for key in ("stiffness", "damping"))
    A = np.zeros((2 * n + m, 2 * n + m))
    q, v, d = slice(n), slice(n, 2 * n), slice(2 * n, None)
    A[q, v] = np.eye(n)
    A[v, q] = -inverse @ (K + R.T @ (k[:, None] * R))
    A[v, v] = -inverse @ C
    A[v, d] = inverse @ (R.T * k)
    A[d, q] = (k / c)[:, None] * R
    A[d, d] = -np.diag(k / c)
    return A


def _accelerations(block: Floats, n: int, dampers: int, *, of_velocity: bool) -> Floats:
    """A state matrix (N, N) whose only part is accelerations (n, n) of velocities, or of displacements."""
    A = np.zeros((2 * n + dampers, 2 * n + dampers))
    A[n : 2 * n, n : 2 * n] = block if of_velocity else 0.0
    A[n : 2 * n, :n] = 0.0 if of_velocity else block
    return A


def _refuse_rest(speed_km_h: float, conicity: float) -> None:
    """Refuse a speed at which creep has no law, and a conicity that is none."""
    problems = []
    if not 0.0 < speed_km_h < np.inf:
        what = f"wheels that do not roll have neither creep nor conicity, and {speed_km_h:g} km/h was asked for"
        problems.append(Problem("at_rest", "[run] speed_km_h", what, "Give a speed above 0"))
    if not 0.0 <= conicity < np.inf:
        what = f"{conicity:g} is no equivalent conicity"
        problems.append(Problem("conicity", "[contact] conicity", what, "Give 0 or a number above it, such as 0.1"))
    refuse(CaseError, problems)
