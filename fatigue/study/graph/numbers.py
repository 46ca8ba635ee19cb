"""The analysis graph of one vehicle as numbers that a sentence can be held against.

Conicities are looked at from 0.01 to 1.2, speeds from 60 to 700 km/h. Of several stable ranges of conicity that of the
largest ratio of its ends counts. A number that cannot be had is NaN with the reason.
"""

import math

from fatigue.study.graph.converter import converter_numbers
from fatigue.study.graph.stability import least_damped
from fatigue.vehicle.assembly import SuspendedVehicle, suspended
from fatigue.vehicle.critical import (
    CONICITIES,
    SPEEDS_KM_H,
    Crossing,
    conicity_crossings,
    speed_crossings,
    stable_ranges,
)
from fatigue.vehicle.definition import Vehicle
from fatigue.vehicle.elastic import ElasticBody
from fatigue.vehicle.roots import largest_real_part
from fatigue.vehicle.settled import settled

HUNTS_ABOVE_HZ = 3.0  # a root above that loses stability is hunting of a bogie; car bodies sway and yaw below 2.5 Hz

Value = tuple[float, str, str]  # value, unit, reason


def graph_numbers(vehicle: Vehicle, body: ElasticBody) -> dict[str, Value]:
    """Value, unit and reason of every number of the graph, by name.

    ``conicity_min``, ``conicity_max`` : ends of the stable range at the speed of the run
    ``conicity_min_hz``, ``conicity_max_hz`` : frequency of the root that loses stability there [Hz]
    ``hunting_hz_at_crossing`` : frequency of the hunting that sets in at ``conicity_max`` [Hz]
    ``critical_speed_km_h`` : lowest speed at which any root loses stability, at the conicity of the contact
    ``stable_again_km_h`` : speed above which the vehicle is stable again, where it was unstable below
    ``hunting_speed_km_h``, ``hunting_speed_hz`` : lowest speed at which a bogie begins to hunt, and its frequency [Hz]
    ``least_damping``, ``least_damping_hz`` : of what runs, at speed and conicity of the vehicle
    ``worn_hunting_hz`` : frequency of the least damped root at the conicity of worn wheels at small amplitude [Hz]
    ``converter_coupled_hz`` ... : lateral frequencies of the converter, see ``converter_numbers``

    Raises
    ------
    CaseError : a setting nobody knows
    DataError : the car body lacks a point where the suspension takes hold
    """
    of = suspended(vehicle, body)
    speed, conicity = vehicle.run.speed_km_h, vehicle.contact.conicity
    damping, frequency, _, _ = least_damped(of.at(speed, conicity))
    worn = settled(vehicle).worn_conicity
    _, worn_hz, _, _ = least_damped(of.at(speed, worn))
    return (
        _over_conicity(of, speed)
        | _over_speed(of, conicity)
        | {
            "least_damping": (damping, "-", ""),
            "least_damping_hz": (frequency, "Hz", ""),
            "worn_hunting_hz": (worn_hz, "Hz", ""),
        }
        | converter_numbers(vehicle, body)
    )


def _over_conicity(of: SuspendedVehicle, speed: float) -> dict[str, Value]:
    """Ends of the widest stable range of conicity, and what sets in there."""
    crossed = conicity_crossings(of, speed)
    first = largest_real_part(of.state_matrix(speed, CONICITIES[0])) < 0.0
    ranges = stable_ranges(crossed, CONICITIES, stable_at_first=first)
    if not ranges:
        why = f"at {speed:g} km/h no conicity from {CONICITIES[0]:g} to {CONICITIES[1]:g} is stable"
        of_range = dict.fromkeys(("conicity_min", "conicity_max"), (math.nan, "-", why))
        return of_range | dict.fromkeys(_FREQUENCIES, (math.nan, "Hz", why))
    low, high = max(ranges, key=lambda ends: ends[1] / ends[0])
    at = {end: next((c for c in crossed if c.at == end), None) for end in (low, high)}
    below = f"at {speed:g} km/h the vehicle is stable at every conicity down to {CONICITIES[0]:g}"
    above = f"at {speed:g} km/h the vehicle is stable at every conicity up to {CONICITIES[1]:g}"
    return {
        "conicity_min": (low, "-", ""),
        "conicity_max": (high, "-", ""),
        "conicity_min_hz": _frequency(at[low], below),
        "conicity_max_hz": _frequency(at[high], above),
        "hunting_hz_at_crossing": _frequency(at[high], above),
    }


_FREQUENCIES = ("conicity_min_hz", "conicity_max_hz", "hunting_hz_at_crossing")


def _over_speed(of: SuspendedVehicle, conicity: float) -> dict[str, Value]:
    """Speeds at which stability is lost and regained."""
    crossed = speed_crossings(of, conicity)
    slowest, fastest = SPEEDS_KM_H
    first = largest_real_part(of.state_matrix(slowest, conicity)) < 0.0
    stable = stable_ranges(crossed, SPEEDS_KM_H, stable_at_first=first)
    lost = next((c for c in crossed if c.change == "loses"), None)
    again = next((c for c in reversed(crossed) if c.change == "gains"), None)
    hunts = next((c for c in crossed if c.change == "loses" and c.root.frequency_hz > HUNTS_ABOVE_HZ), None)
    nowhere = f"at a conicity of {conicity:g} the vehicle is stable from {slowest:g} to {fastest:g} km/h"
    if not stable:
        nowhere = f"at a conicity of {conicity:g} the vehicle is unstable from {slowest:g} to {fastest:g} km/h"
    none = (
        f"at a conicity of {conicity:g} no root above {HUNTS_ABOVE_HZ:g} Hz takes stability away up to {fastest:g} km/h"
    )
    never = f"at a conicity of {conicity:g} the vehicle gains stability at no speed up to {fastest:g} km/h"
    return {
        "critical_speed_km_h": _at(lost, nowhere if not crossed else never.replace("gains", "loses")),
        "stable_again_km_h": _at(again, nowhere if not crossed else never),
        "hunting_speed_km_h": _at(hunts, none),
        "hunting_speed_hz": _frequency(hunts, none),
    }


def _at(crossing: Crossing | None, why: str) -> Value:
    return (math.nan, "km/h", why) if crossing is None else (crossing.at, "km/h", "")


def _frequency(crossing: Crossing | None, why: str) -> Value:
    return (math.nan, "Hz", why) if crossing is None else (crossing.root.frequency_hz, "Hz", "")
