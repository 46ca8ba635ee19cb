"""The coupled frequency of equipment below a car body: mounts, hangers and a body that moves as well, in one root.

``fe_hz`` of a vehicle is the lateral frequency of the mounts with the car body held still. Hangers in series make it
hang lower, and a body that is not much heavier swings against it and makes it higher; a measurement sees the root.
"""

from dataclasses import replace
from typing import Literal

from scipy.optimize import brentq

from fatigue.errors import NumericalError, Problem
from fatigue.vehicle.assembly import LinearVehicle, suspended
from fatigue.vehicle.definition import Vehicle
from fatigue.vehicle.elastic import ElasticBody
from fatigue.vehicle.equations.coordinates import CONVERTER, TRANSFORMER
from fatigue.vehicle.roots import Root, roots

Which = Literal["converter", "transformer"]
COORDINATES = {"converter": CONVERTER, "transformer": TRANSFORMER}
UPTO_HZ = 60.0
SOFTEST, STIFFEST = 0.5, 20.0  # mounts that are tried, over the frequency that is wanted
CLOSE = 1e-4  # relative


def lateral_root(of: LinearVehicle, which: Which = "converter") -> Root:
    """The root in which the lateral motion of the equipment has its largest share of the kinetic energy."""
    y = of.coordinates.column(COORDINATES[which], "y")
    return max(roots(of, UPTO_HZ), key=lambda root: abs(root.shape[y]) ** 2)


def coupled_hz(vehicle: Vehicle, body: ElasticBody, which: Which = "converter") -> float:
    """Coupled lateral frequency [Hz] of equipment, at speed and conicity of the vehicle.

    Raises
    ------
    CaseError, DataError : as ``suspended``
    """
    of = suspended(vehicle, body).at(vehicle.run.speed_km_h, vehicle.contact.conicity)
    return lateral_root(of, which).frequency_hz


def mounts_for(vehicle: Vehicle, body: ElasticBody, wanted_hz: float, which: Which = "converter") -> float:
    """``fe_hz`` of the mounts whose coupled lateral frequency is the one wanted [Hz].

    Raises
    ------
    NumericalError : no mounts reach it: the hangers are too soft
    CaseError, DataError : as ``suspended``
    """

    def above(fe_hz: float) -> float:
        equipment = replace(getattr(vehicle, which), fe_hz=fe_hz)
        return coupled_hz(replace(vehicle, **{which: equipment}), body, which) - wanted_hz

    low, high = SOFTEST * wanted_hz, STIFFEST * wanted_hz
    highest = above(high)
    if highest < 0.0 or above(low) > 0.0:
        what = f"no mounts give {wanted_hz:g} Hz: the stiffest tried give {highest + wanted_hz:.4g} Hz"
        raise NumericalError(Problem("no_mounts", which, what, "Stiffen the hangers, or ask for a lower frequency"))
    return float(brentq(above, low, high, rtol=CLOSE))
