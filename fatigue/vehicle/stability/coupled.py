"""Which lateral frequency equipment has in the vehicle, and which mounts give it a wanted one.

The nominal frequency ``fe_hz`` is that of the mounts with the car body held still. What counts in service is another:

- in series: the body gives way where the mounts hang, by the flexibility G (4, 4) that its modes above 40 Hz have
  there, as if static. Moved by y the equipment pulls with ``k_s y``, ``k_s = 1'(I/k + G)^-1 1``, k of one mount.
  However stiff the mounts are, ``k_s`` does not pass ``1' G^-1 1``, the stiffness of the hangers.
- coupled: of the modes of the free car body with its equipment, undamped, the one with most lateral energy of the
  equipment. Its share tells how much it still is a mode of the equipment: near a mode of the body two share it.
- running: the root of the vehicle at its speed and conicity with most lateral energy of the equipment.
"""

from dataclasses import dataclass, replace
from typing import Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh
from scipy.optimize import brentq

from fatigue.errors import CaseError, Problem
from fatigue.vehicle.assembly import mass, suspended
from fatigue.vehicle.definition import Equipment, Vehicle
from fatigue.vehicle.elastic import ElasticBody
from fatigue.vehicle.equations.coordinates import CAR, CONVERTER, FLEX, TRANSFORMER, Coordinates
from fatigue.vehicle.equations.springs import stacked, stiffness
from fatigue.vehicle.equations.suspension import MOUNTS, Places, mount_rates, springs
from fatigue.vehicle.roots import Root, roots

Floats = NDArray[np.float64]
EquipmentName: TypeAlias = Literal["converter", "transformer"]

IN_COORDINATES = {"converter": CONVERTER, "transformer": TRANSFORMER}
LOCAL_FROM_HZ = 40.0  # up to which the vehicle is valid: what modes above it add is taken as static
STIFFEST = 30.0  # logarithm of the stiffest mounts that are tried over those that a still body would want
CLOSE = 1e-6  # of a frequency: how closely a mount has to give the wanted one
LOOKED_AT_HZ = np.geomspace(0.5, 500.0, 91)  # mount frequencies whose coupled ones are told in a refusal


@dataclass(frozen=True, slots=True, eq=False)
class Coupled:
    """Lateral frequencies [Hz] of equipment: nominal, in series, coupled, in the running vehicle; see the module.

    ``coupled_share`` and ``running_share`` are the share of kinetic energy in lateral motion of the equipment.
    """

    nominal_hz: float
    in_series_hz: float
    coupled_hz: float
    coupled_share: float
    running: Root
    running_share: float


@dataclass(frozen=True, slots=True, eq=False)
class FreeBody:
    """The free car body with its equipment, undamped, before the lateral mounts of one piece are put in.

    ``K`` and ``M`` (n, n); ``R`` (4, n) are the rows of its lateral mounts, ``y`` is its lateral coordinate.
    """

    K: Floats
    M: Floats
    R: Floats
    y: int

    def mode(self, k: float) -> tuple[float, float]:
        """Frequency [Hz] with lateral mounts of k [N/m] each, and the share of its energy that is lateral motion.

        It is that of the mode of ``K + k R'R, M`` with most of it.
        """
        w2, shapes = eigh(self.K + k * self.R.T @ self.R, self.M)
        shares = self.M[self.y, self.y] * shapes[self.y] ** 2
        most = int(shares.argmax())
        return float(np.sqrt(max(w2[most], 0.0)) / (2.0 * np.pi)), float(shares[most])

    def mounts_with(self, hz: float) -> list[float]:
        """All stiffnesses k > 0 [N/m] that make hz a frequency of ``K + k R'R, M``.

        ``-1/k`` is an eigenvalue of ``R (K - w^2 M)^-1 R'``.
        """
        G = self.R @ np.linalg.solve(self.K - (2.0 * np.pi * hz) ** 2 * self.M, self.R.T)
        flexibility = np.linalg.eigvalsh(0.5 * (G + G.T))
        return sorted(float(-1.0 / g) for g in flexibility if g < 0.0)


def coupled(vehicle: Vehicle, body: ElasticBody, equipment: EquipmentName = "converter") -> Coupled:
    """Lateral frequencies of equipment of a vehicle, the running one at the speed and conicity of the vehicle.

    Raises
    ------
    CaseError : a setting nobody knows, no speed, or a conicity that no wheel has
    DataError : the car body lacks a point where the suspension takes hold
    """
    of = suspended(vehicle, body).at(vehicle.run.speed_km_h, vehicle.contact.conicity)
    y = of.coordinates.column(IN_COORDINATES[equipment], "y")
    candidates = roots(of, upto_hz=np.inf)
    shares = [float(of.M[y, y] * np.abs(root.shape[y]) ** 2) for root in candidates]
    most = int(np.argmax(shares))
    nominal = _of(vehicle, equipment)
    k, _ = mount_rates(nominal, nominal.fe_hz)
    return Coupled(
        nominal.fe_hz,
        in_series_hz(vehicle, body, equipment),
        *free_body(vehicle, body, equipment).mode(k),
        candidates[most],
        shares[most],
    )


def in_series_hz(vehicle: Vehicle, body: ElasticBody, equipment: EquipmentName = "converter") -> float:
    """Lateral frequency [Hz] of equipment on its mounts with the hangers in series, the body held still otherwise."""
    of = _of(vehicle, equipment)
    k, _ = mount_rates(of, of.fe_hz)
    return _hz(_in_series(k, *_hangers(body, equipment)), of.mass_kg)


def hanger_stiffness(body: ElasticBody, equipment: EquipmentName = "converter") -> float:
    """Lateral stiffness [N/m] of the body where equipment hangs, ``1' G^-1 1``; infinite without local flexibility."""
    return _in_series(np.inf, *_hangers(body, equipment))


def mount_in_series(
    vehicle: Vehicle, body: ElasticBody, wanted_hz: float, equipment: EquipmentName = "converter"
) -> float:
    """Nominal ``fe_hz`` of mounts that give equipment a wanted frequency with the hangers in series.

    Raises
    ------
    CaseError : the hangers are too soft for it; tells the highest frequency they allow
    """
    mass_kg, hangers = _of(vehicle, equipment).mass_kg, _hangers(body, equipment)
    _refuse_no_frequency(wanted_hz, equipment)
    needed = mass_kg * (2.0 * np.pi * wanted_hz) ** 2
    limit = _in_series(np.inf, *hangers)
    if limit <= needed * (1.0 + CLOSE):
        what = f"with its hangers in series ({limit / 1e6:.3g} MN/m) it has {_hz(limit, mass_kg):.2f} Hz at most"
        raise _unreachable(equipment, wanted_hz, f"{what}, however stiff the mounts")
    first = np.log(needed / len(MOUNTS) * (1.0 - CLOSE))
    log_k = brentq(lambda at: _in_series(float(np.exp(at)), *hangers) - needed, first, first + STIFFEST, xtol=1e-13)
    return _hz(len(MOUNTS) * float(np.exp(log_k)), mass_kg)


def mount_coupled(
    vehicle: Vehicle, body: ElasticBody, wanted_hz: float, equipment: EquipmentName = "converter"
) -> float:
    """Nominal ``fe_hz`` of mounts that give equipment a wanted coupled frequency.

    Of all mounts that make it a frequency of the free body, those count for which its mode has most lateral energy of
    the equipment; of these the softest.

    Raises
    ------
    CaseError : no mounts give it; tells what the coupled frequency reaches, and where it goes on beyond body modes
    """
    _refuse_no_frequency(wanted_hz, equipment)
    mass_kg, free = _of(vehicle, equipment).mass_kg, free_body(vehicle, body, equipment)
    for k in free.mounts_with(wanted_hz):
        if abs(free.mode(k)[0] / wanted_hz - 1.0) < CLOSE:
            return _hz(len(MOUNTS) * k, mass_kg)
    reached = np.array([free.mode(mass_kg * (2.0 * np.pi * hz) ** 2 / len(MOUNTS))[0] for hz in LOOKED_AT_HZ])
    what = f"coupled with the car body it has {reached[reached < wanted_hz].max(initial=0.0):.2f} Hz"
    if (above := reached[reached > wanted_hz]).size:
        what += f" at most below, {above.min():.2f} Hz at least above, and modes of the body in between"
    else:
        what += (
            f" at most, however stiff the mounts; its hangers have {hanger_stiffness(body, equipment) / 1e6:.3g} MN/m"
        )
    raise _unreachable(equipment, wanted_hz, what)


def with_mounts(vehicle: Vehicle, fe_hz: float, equipment: EquipmentName = "converter") -> Vehicle:
    """The vehicle with lateral mounts of this nominal frequency under the equipment."""
    if equipment == "converter":
        return replace(vehicle, converter=replace(vehicle.converter, fe_hz=fe_hz))
    return replace(vehicle, transformer=replace(vehicle.transformer, fe_hz=fe_hz))


def free_body(vehicle: Vehicle, body: ElasticBody, equipment: EquipmentName) -> FreeBody:
    """The car body of a vehicle with converter and transformer, free, ready for lateral mounts of one of them."""
    places = Places(vehicle, body, Coordinates(len(body.frequency_hz)))
    names = {f"{equipment} mount {mount} y" for mount in MOUNTS}
    rows = stacked([spring for spring in springs(places) if spring.name in names])
    on_body = [
        spring
        for spring in springs(replace(places, vehicle=with_mounts(vehicle, 0.0, equipment)))
        if "mount" in spring.name
    ]
    K = stiffness(on_body)
    K[places.at.flex, places.at.flex] += np.diag((2.0 * np.pi * body.frequency_hz) ** 2)
    kept = places.at.of(CAR, FLEX, CONVERTER, TRANSFORMER)
    both = np.ix_(kept, kept)
    y = int(np.flatnonzero(kept == places.at.column(IN_COORDINATES[equipment], "y"))[0])
    return FreeBody(K[both], mass(vehicle, body)[both], rows[:, kept], y)


def _hangers(body: ElasticBody, equipment: EquipmentName) -> tuple[Floats, Floats]:
    """Eigenvalues (4,) [m/N] of the flexibility G along y at the mounts, and ``(U'1)^2`` (4,) of its eigenvectors U."""
    local = body.frequency_hz > LOCAL_FROM_HZ
    phi = np.stack([body.points[f"{equipment}_{mount}"].shape[1, local] for mount in MOUNTS])
    flexibility, U = np.linalg.eigh((phi / (2.0 * np.pi * body.frequency_hz[local]) ** 2) @ phi.T)
    return np.maximum(flexibility, 0.0), U.sum(axis=0) ** 2


def _in_series(k: float, flexibility: Floats, moved: Floats) -> float:
    """``1'(I/k + G)^-1 1`` [N/m]."""
    soft = 1.0 / k + flexibility
    return float(np.sum(moved / soft)) if (soft > 0.0).all() else np.inf


def _hz(k: float, mass_kg: float) -> float:
    return float(np.sqrt(k / mass_kg) / (2.0 * np.pi))


def _of(vehicle: Vehicle, equipment: EquipmentName) -> Equipment:
    return vehicle.converter if equipment == "converter" else vehicle.transformer


def _refuse_no_frequency(wanted_hz: float, equipment: EquipmentName) -> None:
    if not 0.0 < wanted_hz < np.inf:
        what = f"{wanted_hz:g} Hz is no frequency"
        raise CaseError(Problem("unreachable", f"[{equipment}] fe_hz", what, "Give a frequency above 0"))


def _unreachable(equipment: EquipmentName, wanted_hz: float, what: str) -> CaseError:
    remedy = f"Ask for another frequency, make the {equipment} lighter, or its hangers stiffer"
    where = f"[{equipment}] fe_hz"
    return CaseError(Problem("unreachable", where, f"no mounts give {wanted_hz:g} Hz laterally: {what}", remedy))
