"""What is kept of the states of a vehicle, what a ride leaves of it, and where it has left the track."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import NumericalError, Problem
from fatigue.vehicle.assembly import LinearVehicle
from fatigue.vehicle.in_time.contact import Contact
from fatigue.vehicle.in_time.stepping import AxleRows, Met, exact_step, states

Floats = NDArray[np.float64]

OFF_TRACK_M = 0.1  # of a wheelset, a dozen times the clearance of its flange: small motions say nothing beyond it


@dataclass(frozen=True, slots=True, eq=False)
class Ride:
    """What a ride leaves, from the end of its start on: n samples, one every ``step_s``.

    Attributes
    ----------
    time_s : (n,) since the ride began; the middle of the vehicle has come ``speed_m_s`` times as many metres
    q : (m, n) modal coordinates of the car body of unit modal mass [m sqrt(kg)]
    channels : accelerations (n,) by name [m/s2]
    recovered : further outputs (n,) of the car body by name, in its unit
    wheelsets_m : (axles, n) lateral displacement over the track [m]
    worn : (axles, n) how far the contact of an axle is worn, 0 to 1
    """

    step_s: float
    speed_m_s: float
    time_s: Floats
    q: Floats
    channels: Mapping[str, Floats]
    recovered: Mapping[str, Floats]
    wheelsets_m: Floats
    worn: Floats


@dataclass(frozen=True, slots=True, eq=False)
class Motion:
    """What is kept of n states.

    Modal coordinates ``q`` (m, n), lateral displacement of the wheelsets over the track ``over_track`` (axles, n) [m],
    and velocities (n,) of the outputs by name [m/s].
    """

    q: Floats
    over_track: Floats
    velocity: Mapping[str, Floats]


def moved(of: LinearVehicle, contact: Contact, met: Met, start: Floats, step_s: float) -> Motion:
    """Motion of a vehicle from a state ``start`` (N,) on, over what its axles meet.

    Raises
    ------
    NumericalError : it leaves the track, or something in it grows beyond all numbers
    """
    n, steps = len(of.M), len(met.u)
    q, y = np.empty((of.coordinates.modes, steps)), np.empty((len(of.axle_x_m), steps))
    velocity = np.empty((len(of.outputs), steps))
    outputs = np.stack(list(of.outputs.values()))
    at = 0
    for found in _chunks(of, contact, met, start, step_s):
        some = slice(at, at + len(found))
        y[:, some] = found[:, of.coordinates.wheelset_y].T - met.lateral[some].T
        _refuse_off_track(of, found, y[:, some], at * step_s, step_s)
        q[:, some] = found[:, of.coordinates.flex].T
        velocity[:, some] = outputs @ found[:, n : 2 * n].T
        at = some.stop
    return Motion(q, y, dict(zip(of.outputs, velocity, strict=True)))


def accelerations(velocity: Mapping[str, Floats], step_s: float, kept: slice) -> dict[str, Floats]:
    """Accelerations of some samples [m/s2] by name: central differences of the velocities (n,) [m/s]."""
    return {name: np.gradient(of, step_s)[kept] for name, of in velocity.items()}


def _chunks(of: LinearVehicle, contact: Contact, met: Met, start: Floats, step_s: float) -> Iterator[Floats]:
    """States of a vehicle, chunk by chunk."""
    n, y, psi = len(of.M), of.coordinates.wheelset_y, of.coordinates.wheelset_yaw
    step = exact_step(of.A, np.hstack([of.B, of.G]), step_s)
    return states(step, start, met, AxleRows(y, psi, n + y, n + psi), contact)


def _refuse_off_track(of: LinearVehicle, found: Floats, y: Floats, begin_s: float, step_s: float) -> None:
    """Refuse states (steps, N) in which a wheelset is off the track, or that are no numbers.

    What grew is the coordinate with most of the kinetic energy at the last instant that has one.
    """
    lost = ~(np.abs(y) <= OFF_TRACK_M).all(axis=0) | ~np.isfinite(found).all(axis=1)
    if not lost.any():
        return
    first, n = int(np.argmax(lost)), len(of.M)
    time = begin_s + first * step_s
    with np.errstate(over="ignore", invalid="ignore"):
        energy = np.diag(of.M) * found[: first + 1, n : 2 * n] ** 2
    last = np.flatnonzero(np.isfinite(energy).all(axis=1))
    grown = of.coordinates.names[int(np.argmax(energy[last[-1]]))] if len(last) else "all coordinates"
    off = np.nan_to_num(np.abs(y[:, first]), nan=0.0)
    place = f"wheelset {int(np.argmax(off)) + 1} is {off.max():.2g} m beside the track"
    what = place if OFF_TRACK_M < off.max() < np.inf else "the motion is beyond all numbers"
    raise NumericalError(
        Problem(
            "left_the_track",
            f"ride at {of.speed_m_s * 3.6:.4g} km/h",
            f"{what} after {time:.3f} s, {of.speed_m_s * time:.0f} m from the start; {grown} moves most",
            "Look at the roots of this vehicle: something grows that neither flange nor worn tread limits. A stiff "
            "flange asks for a shorter step",
        )
    )
