"""A ride over a rough track in time: modal coordinates of the car body, accelerations, where the treads are worn.

The story: what the axles meet, exact steps of the linear vehicle with worn contact, flange and saturation as forces on
its wheelsets, and what is read off its states.

A record holds modes far above its sampling rate, and rightly so. A mode whose frequency and damping let it forget
within a step follows its load, ``q = f/w^2``: its coordinate is as slow as the forces at the interface and is sampled
like them, and the exact step is what makes it decay. It carries the static part of what enters at attachments; without
it they lose most of their force.
"""

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import CaseError, Problem, refuse
from fatigue.vehicle.assembly import LinearVehicle, assembled
from fatigue.vehicle.definition import Vehicle
from fatigue.vehicle.elastic import ElasticBody
from fatigue.vehicle.in_time.contact import contact_of, worn_flag
from fatigue.vehicle.in_time.recorded import Ride, accelerations, moved
from fatigue.vehicle.in_time.stepping import Met
from fatigue.vehicle.track import LATERAL, Realisation, realised, under_axles

__all__ = ["Ride", "ride"]

Floats = NDArray[np.float64]

MOST_STEPS = 10**7  # 24 inputs of each are held in memory: 2 GB


def ride(vehicle: Vehicle, body: ElasticBody) -> Ride:
    """Let a vehicle with this car body ride over its track.

    Raises
    ------
    CaseError : keys of [run], [track] or [contact] that no ride has
    DataError : the car body lacks a point where the suspension takes hold
    NumericalError : the vehicle leaves the track, or something in it grows beyond all numbers
    """
    of = assembled(vehicle, body)
    contact = contact_of(vehicle, of.speed_m_s)
    track = realised(vehicle.track, _seed(vehicle))
    time = _times(vehicle, of.speed_m_s)
    met = _met(vehicle, of, track, time)
    motion = moved(of, contact, met, np.zeros(len(of.A)), vehicle.run.step_s)
    kept = slice(round(vehicle.run.dropped_s / vehicle.run.step_s), None)
    q = motion.q[:, kept]
    return Ride(
        step_s=vehicle.run.step_s,
        speed_m_s=of.speed_m_s,
        time_s=time[kept],
        q=q,
        channels=accelerations(motion.velocity, vehicle.run.step_s, kept),
        recovered={name: row[of.coordinates.flex] @ q for name, row in of.recovered.items()},
        wheelsets_m=motion.over_track[:, kept],
        worn=met.worn.T[:, kept],
    )


def _times(vehicle: Vehicle, speed_m_s: float) -> Floats:
    """Instants of the steps of a ride (n,) [s]: as many as fit into its distance.

    Raises
    ------
    CaseError : a step or a start that no ride has
    """
    run, duration = vehicle.run, vehicle.track.distance_m / speed_m_s
    problems = []
    if not 0.0 < run.step_s < np.inf:
        problems.append(Problem("run", "[run] step_s", f"{run.step_s} s is no step", "Give a time above 0, as 0.001"))
    if not 0.0 <= run.dropped_s < duration - 2.0 * max(run.step_s, 0.0):
        what = f"{run.dropped_s} s of the start are dropped of a ride that lasts {duration:.3g} s"
        problems.append(Problem("run", "[run] dropped_s", what, "Drop less, or make [track] distance_m longer"))
    elif duration > MOST_STEPS * run.step_s > 0.0:
        what = f"a ride of {duration:.3g} s in steps of {run.step_s} s takes more than {MOST_STEPS:.0e} of them"
        problems.append(Problem("run", "[run] step_s", what, "Give longer steps, or make [track] distance_m shorter"))
    refuse(CaseError, problems)
    return np.asarray(run.step_s * np.arange(int(duration / run.step_s * (1.0 + 1e-12))))


def _seed(vehicle: Vehicle) -> int:
    """Seed of the track, or refuse one below 0."""
    seed = vehicle.run.seed
    if seed < 0:
        raise CaseError(Problem("run", "[run] seed", f"{seed} is no seed", "Give a whole number of 0 or more"))
    return seed


def _met(vehicle: Vehicle, of: LinearVehicle, track: Realisation, time_s: Floats) -> Met:
    """What the axles meet at every step: the track with its rates, and worn sections where the contact is worn."""
    way = of.speed_m_s * time_s
    rails = under_axles(track, of.axle_x_m, way, of.speed_m_s)
    u = np.concatenate([rails.value, rails.rate]).reshape(-1, len(time_s)).T
    contact = vehicle.contact
    sections = contact.worn_sections_m if contact.state == "worn" else ()
    worn = worn_flag(way[:, None] + of.axle_x_m, sections, contact.worn_ramp_m)
    return Met(u, rails.value[LATERAL].T, worn)
