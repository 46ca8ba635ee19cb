"""The stability map: over speed and conicity the least damped root of what runs, and whether the vehicle is stable.

Equipment and modes of the car body have roots that hardly depend on either, with 1.5 to 7 % of damping; the least of
all roots would be one of them almost everywhere. Shown is the least damping of the roots whose kinetic energy is for
the larger part that of the rigid car body, bogies and wheelsets, and of every root that grows, whatever moves in it.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.vehicle.assembly import LinearVehicle, SuspendedVehicle
from fatigue.vehicle.equations.coordinates import BOGIES, CAR, WHEELSETS
from fatigue.vehicle.roots import SWINGS, root_of
from fatigue.vehicle.stability.naming import Named

Floats = NDArray[np.float64]
Progress = Callable[[str, int, int], None]

RUNS = 0.5  # share of the energy on the rigid car body, bogies and wheelsets
UPTO_RAD_S = 2.0 * np.pi * 40.0  # the vehicle means nothing above
LABEL = "stability map"


@dataclass(frozen=True, slots=True, eq=False)
class StabilityMap:
    """Over ``speeds`` (k,) [km/h] and ``conicities`` (m,): the least damped root of what runs.

    ``damping`` and ``frequency_hz`` are (m, k), and so is ``stable``, which is of all roots of the vehicle; ``of``
    holds names, row by row.
    """

    speeds: Floats
    conicities: Floats
    damping: Floats
    frequency_hz: Floats
    stable: NDArray[np.bool_]
    of: tuple[tuple[Named, ...], ...]


def stability_map(
    of: SuspendedVehicle, speeds: Floats, conicities: Floats, progress: Progress | None = None
) -> StabilityMap:
    """Map of a vehicle over speeds (k,) [km/h] and conicities (m,)."""
    shape = (len(conicities), len(speeds))
    damping, frequency, stable = np.empty(shape), np.empty(shape), np.empty(shape, dtype=np.bool_)
    names: list[tuple[Named, ...]] = []
    for i, conicity in enumerate(conicities):
        row = []
        for j, speed in enumerate(speeds):
            damping[i, j], frequency[i, j], stable[i, j], name = least_damped(of.at(float(speed), float(conicity)))
            row.append(name)
        names.append(tuple(row))
        if progress is not None:
            progress(LABEL, i + 1, len(conicities))
    return StabilityMap(speeds, conicities, damping, frequency, stable, tuple(names))


def least_damped(of: LinearVehicle) -> tuple[float, float, bool, Named]:
    """Damping ratio and frequency [Hz] of the least damped root of what runs, whether all roots decay, its name.

    A root that grows without swinging has the damping -1 and the frequency ``|s|/2 pi``.
    """
    s, X = np.linalg.eig(of.A)
    Q = X[: of.coordinates.size]
    energy = np.real(Q.conj() * (of.M @ Q))
    share = energy[of.coordinates.of(CAR, *BOGIES, *WHEELSETS)].sum(axis=0) / energy.sum(axis=0)
    swings = (s.imag > SWINGS) & (np.abs(s) < UPTO_RAD_S) & (share >= RUNS)
    grows = (s.real > 0.0) & (s.imag >= 0.0)
    considered = np.flatnonzero(swings | grows)
    k = considered[np.argmin(-s[considered].real / np.abs(s[considered]))]
    root = root_of(of, s[k], X[:, k])
    return root.damping, root.frequency_hz, not bool(grows.any()), root.of
