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
from fatigue.verify.recount.anew.shear.path import half_cycles
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


def path_mission(
    inputs: RecountInputs,
    coordinates: RecountCoordinates,
    parts: Floats,
    curve: RecountCurve,
    thickness: float,
    sampling: Sequence[tuple[float, int]],
) -> Values:
    """Columns of the mission of two stresses (2, c) whose path is counted by range, each half cycle as half a cycle."""
    mission, size = inputs.case["mission"], curve.size_factor(thickness)
    ranges, counts, damages, names = [], [], [], []
    for number, given in enumerate(mission["event"]):
        record = read_record(inputs, given, coordinates, *sampling[number])
        path = half_cycles((record.factor * parts @ record.counted).T, recurs=record.recurs)
        ranges.append(path.range)
        counts.append(np.full(len(path.range), 0.5 * record.passes_per_km))
        damages.append(float(counts[-1] @ curve.damage(size * path.range)))
        names.append(record.name)
    S, n, limit, target = np.concatenate(ranges), np.concatenate(counts), curve.limit(mission), mission["target_km"]
    damage = sum(damages)

    def is_too_much(log_factor: float) -> bool:
        return bool(float(n @ curve.damage(np.exp(log_factor) * size * S)) * target > limit)

    low, high = -60.0, 60.0
    for _ in range(80):
        middle = (low + high) / 2.0
        low, high = (low, middle) if is_too_much(middle) else (middle, high)
    return {
        "damage_per_km": damage,
        "life_km": limit / damage if damage > 0.0 else np.inf,
        "utilisation": damage * target / limit,
        "fulfilled": damage * target <= limit,
        "load_factor": float(np.exp(low)) if S.any() else np.inf,
        "max_range_MPa": float(S.max(initial=0.0)),
        "governing_event": names[int(np.argmax(damages))] if damage > 0.0 else "",
    }
