"""The oscillation a vehicle ends in on worn contact everywhere and a perfect track: hunting without a cause outside."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.vehicle.assembly import assembled
from fatigue.vehicle.definition import Vehicle
from fatigue.vehicle.elastic import ElasticBody
from fatigue.vehicle.in_time.contact import contact_of
from fatigue.vehicle.in_time.recorded import accelerations, moved
from fatigue.vehicle.in_time.stepping import Met

Floats = NDArray[np.float64]

STEP_S, DURATION_S, SETTLED_S = 0.5e-3, 30.0, 20.0
PUSHED_M = 1e-3  # the first wheelset to the left, all else at rest
AT_REST = 1e-3  # of that push: a wheelset that moves less has come to rest
STEADY = 0.01  # by which the halves of the settled part may differ


@dataclass(frozen=True, slots=True, eq=False)
class LimitCycle:
    """What a vehicle does from 20 to 30 s after a push.

    ``frequency_hz`` is NaN where it comes to rest. ``wheelsets_mm`` (axles,) are lateral amplitudes, ``rms`` those of
    accelerations by name [m/s2]. ``steady`` says whether the motion of the wheelsets has stopped growing and decaying.
    """

    frequency_hz: float
    wheelsets_mm: Floats
    rms: Mapping[str, float]
    steady: bool


def limit_cycle(vehicle: Vehicle, body: ElasticBody) -> LimitCycle:
    """Limit cycle of a vehicle at its speed, its treads worn everywhere.

    Raises
    ------
    CaseError : keys of [run] or [contact] that no ride has
    DataError : the car body lacks a point where the suspension takes hold
    NumericalError : the vehicle leaves the track
    """
    of = assembled(vehicle, body)
    steps, axles = round(DURATION_S / STEP_S), len(of.axle_x_m)
    met = Met(np.zeros((steps, of.B.shape[1])), np.zeros((steps, axles)), np.ones((steps, axles)))
    start = np.zeros(len(of.A))
    start[of.coordinates.wheelset_y[0]] = PUSHED_M
    motion = moved(of, contact_of(vehicle, of.speed_m_s), met, start, STEP_S)
    settled = slice(round(SETTLED_S / STEP_S), None)
    y, found = motion.over_track[:, settled], accelerations(motion.velocity, STEP_S, settled)
    largest = np.abs(y).max(axis=1)
    halves = np.stack([np.std(half, axis=1) for half in np.array_split(y, 2, axis=1)])
    moves = bool(largest.max() > AT_REST * PUSHED_M)
    return LimitCycle(
        frequency_hz=frequency_of(found["bog_y"], STEP_S) if moves else np.nan,
        wheelsets_mm=1000.0 * largest,
        rms={name: float(np.sqrt(np.mean(a**2))) for name, a in found.items()},
        steady=not moves or bool((np.abs(halves[1] - halves[0]) <= STEADY * halves.max(axis=0)).all()),
    )


def frequency_of(values: Floats, step_s: float) -> float:
    """Frequency [Hz] of an oscillation (n,) from its upward zero crossings; NaN with fewer than two.

    >>> round(frequency_of(np.sin(2 * np.pi * 8.3 * 0.001 * np.arange(5000)), 0.001), 6)
    8.3
    """
    before = np.flatnonzero((values[:-1] < 0.0) & (values[1:] >= 0.0))
    if len(before) < 2:
        return float(np.nan)
    at = before - values[before] / (values[before + 1] - values[before])
    return float((len(at) - 1) / ((at[-1] - at[0]) * step_s))
