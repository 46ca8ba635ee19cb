"""The lateral frequency at which equipment hangs below an elastic car body: mounts and hangers in series.

``fe_hz`` of a vehicle is the frequency of the mounts with the car body held still, hangers and all. Soft hangers make
equipment hang lower, whatever its mounts. In the whole vehicle that frequency is found again as a root where no mode of
the body is near; where one is, both move in two roots, neither of them at it (``lateral_root`` tells).
"""

from typing import Literal

import numpy as np

from fatigue.errors import NumericalError, Problem
from fatigue.vehicle.assembly import LinearVehicle
from fatigue.vehicle.definition import Equipment, Vehicle
from fatigue.vehicle.elastic import ElasticBody
from fatigue.vehicle.equations.coordinates import CONVERTER, TRANSFORMER
from fatigue.vehicle.roots import Root, roots

Which = Literal["converter", "transformer"]
COORDINATES = {"converter": CONVERTER, "transformer": TRANSFORMER}
MOUNTS = 4
LATERAL = 1  # of a shape
UPTO_HZ = 60.0


def hanger_flexibility(body: ElasticBody, which: Which = "converter") -> float:
    """Lateral flexibility [m/N] of the four hangers under a load they share, ``sum of (mean shape)^2/w^2``.

    It is that of the free body, inertia relief, and as complete as its modes are.
    """
    shapes = [body.points[f"{which}_{mount + 1}"].shape[LATERAL] for mount in range(MOUNTS)]
    return float(np.sum((np.mean(shapes, axis=0) / (2.0 * np.pi * body.frequency_hz)) ** 2))


def coupled_hz(vehicle: Vehicle, body: ElasticBody, which: Which = "converter") -> float:
    """Lateral frequency [Hz] of equipment on mounts and hangers in series, ``1/k = 1/k_mounts + flexibility``."""
    of: Equipment = getattr(vehicle, which)
    return _series_hz(of, 1.0 / _stiffness(of.mass_kg, of.fe_hz), hanger_flexibility(body, which))


def mounts_for(vehicle: Vehicle, body: ElasticBody, wanted_hz: float, which: Which = "converter") -> float:
    """``fe_hz`` of the mounts that with the hangers in series give the lateral frequency that is wanted [Hz].

    Raises
    ------
    NumericalError : no mounts do: the hangers are too soft
    """
    of: Equipment = getattr(vehicle, which)
    hangers = hanger_flexibility(body, which)
    left = 1.0 / _stiffness(of.mass_kg, wanted_hz) - hangers
    if left <= 0.0:
        what = f"no mounts give {wanted_hz:g} Hz: on rigid ones its hangers give {_series_hz(of, 0.0, hangers):.4g} Hz"
        raise NumericalError(Problem("no_mounts", which, what, "Stiffen the hangers, or ask for a lower frequency"))
    return _series_hz(of, left, 0.0)


def _series_hz(of: Equipment, mounts: float, hangers: float) -> float:
    """Frequency [Hz] on two flexibilities [m/N] in series."""
    return float(np.sqrt(1.0 / ((mounts + hangers) * of.mass_kg)) / (2.0 * np.pi))


def lateral_root(of: LinearVehicle, which: Which = "converter") -> tuple[Root, float]:
    """The root in which the equipment moves most along y, and the share of that motion in its kinetic energy."""
    y = of.coordinates.column(COORDINATES[which], "y")
    found = max(roots(of, UPTO_HZ), key=lambda root: float(abs(root.shape[y])))
    return found, float(of.M[y, y] * abs(found.shape[y]) ** 2)


def _stiffness(mass_kg: float, frequency_hz: float) -> float:
    return float(mass_kg * (2.0 * np.pi * frequency_hz) ** 2)
