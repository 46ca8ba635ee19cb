"""Some stresses counted over the whole mission: every event in turn, loops of events behind them."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from fatigue.verify.recount.anew.across_events.loop import loop_pass
from fatigue.verify.recount.anew.curve import RecountCurve
from fatigue.verify.recount.anew.mean_stress import MeanStress
from fatigue.verify.recount.anew.mission import RecountEvent, bounds_of_point, point_values
from fatigue.verify.recount.anew.point import OnePass, RecountPoint, Values, one_pass
from fatigue.verify.recount.anew.record import read_record, spectrum_rules
from fatigue.verify.recount.anew.rounding import Bounds
from fatigue.verify.recount.inputs.case import RecountInputs
from fatigue.verify.recount.inputs.coordinates import RecountCoordinates

Floats = NDArray[np.float64]


def signal(
    stress: Floats,
    largest: Floats,
    curve: RecountCurve,
    thickness: float,
    bending: Floats | None = None,
    attachment: float = np.inf,
) -> RecountPoint:
    """A stress per unit coordinate (c,) and its bending part, to be counted on a curve.

    ``largest`` (c,) is the size of what it was made of, where that may cancel.
    """
    nothing = np.zeros_like(stress)
    parts = stress, nothing if bending is None else bending
    return RecountPoint(*parts, nothing, nothing, largest, curve, thickness, attachment)


def missions(
    inputs: RecountInputs,
    coordinates: RecountCoordinates,
    signals: Sequence[RecountPoint],
    sampling: Sequence[tuple[float, int]],
    mean_stress: MeanStress,
) -> list[tuple[Values, Bounds]]:
    """Columns of the mission of each stress, as of a point, and what rounding may do to them.

    f_M is for curves in dS only.
    """
    mission = inputs.case["mission"]
    names = [event["name"] for event in mission["event"]]
    loops = mission.get("sequence", [])
    passes: list[list[OnePass]] = [[] for _ in signals]
    f_M = [mean_stress if one.curve.on_equivalent else MeanStress(None, counts=False) for one in signals]
    events = []
    for number, given in enumerate(mission["event"]):
        record = replace(read_record(inputs, given, coordinates, *sampling[number]), has_spectrum=False)
        rules = spectrum_rules(inputs.case, coordinates, record.step)
        events.append(RecountEvent(record.name, record.length_km, record.passes_per_km))
        keeps = number if any(given["name"] in loop["order"] for loop in loops) else None
        for of, one, factor in zip(passes, signals, f_M, strict=True):
            of.append(replace(one_pass(one, record, rules, factor, keeps), rows={}))
    events += [RecountEvent(f"(sequence {i})", None, loop["per_1000_km"] / 1000) for i, loop in enumerate(loops, 1)]
    orders = [[names.index(name) for name in loop["order"]] for loop in loops]
    found = []
    for of, one, factor in zip(passes, signals, f_M, strict=True):
        of += [loop_pass(one, order, of[: len(names)], factor)[0] for order in orders]
        raw = [each.quantities["damage_per_pass"] for each in of]
        values = point_values(of, raw, events, mission, one.curve, factor)
        of_raw = [each.bounds["damage_per_pass"] for each in of]
        found.append((values, bounds_of_point(of, of_raw, events, mission, one.curve, values)))
    return found
