"""Some points counted: one pass of every event, one run of every loop of events, and the columns of each point."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
import pandas as pd

from fatigue.results import TABLES
from fatigue.verify.recount.anew.across_events.loop import bound_per_km, loop_pass
from fatigue.verify.recount.anew.mean_stress import MeanStress
from fatigue.verify.recount.anew.mission import RecountEvent, bounds_of_point, point_values
from fatigue.verify.recount.anew.point import OnePass, RecountPoint, Values, one_pass, point_of
from fatigue.verify.recount.anew.record import RecountRecord, read_record, spectrum_rules
from fatigue.verify.recount.anew.rounding import Bounds
from fatigue.verify.recount.anew.shear.columns import ShearExtent, shear_extent
from fatigue.verify.recount.anew.shear.passes import ShearPass, shear_pass
from fatigue.verify.recount.inputs.case import RecountInputs
from fatigue.verify.recount.inputs.coordinates import RecountCoordinates
from fatigue.verify.recount.layout import Key
from fatigue.verify.recount.stored.compare import Row
from fatigue.verify.recount.stored.histogram import histogram_rows
from fatigue.verify.recount.stored.loop_cycles import loop_rows
from fatigue.verify.recount.stored.rows import Station, cycle_row
from fatigue.verify.recount.stored.shear import PATH_COLUMNS, StoredShear, half_cycle_row
from fatigue.verify.recount.stored.tables import Stored

HISTOGRAM_COLUMNS = ["kind", "bin", "count_per_pass", "power_sum_per_pass"]
CYCLE_COLUMNS = [c.name for c in TABLES["cycles"] if c.type == "float" or c.name in ("start_event", "end_event")]


@dataclass(slots=True, eq=False)
class Passes:
    """One pass of every event and one run of every loop at a point, its cycles and classes of ranges compared.

    ``raw`` are the same without end treatment. ``bound`` is what cycles across events add at most per km in any order,
    NaN where nobody asks for it. ``extents`` and ``paths`` are those of normal stress and shear, the latter where they
    are counted; ``half_cycles`` are compared.
    """

    treated: list[OnePass] = field(default_factory=list)
    raw: list[OnePass] = field(default_factory=list)
    cycles: list[Row] = field(default_factory=list)
    histograms: list[Row] = field(default_factory=list)
    bound: float = np.nan
    extents: list[ShearExtent] = field(default_factory=list)
    paths: list[ShearPass] = field(default_factory=list)
    half_cycles: list[Row] = field(default_factory=list)


def loop_names(inputs: RecountInputs) -> list[str]:
    """Names under which the loops of the case stand among the events."""
    return [f"(sequence {number})" for number, _ in enumerate(inputs.case["mission"].get("sequence", []), start=1)]


def count(
    inputs: RecountInputs,
    coordinates: RecountCoordinates,
    stations: Mapping[int, Station],
    sampling: Sequence[tuple[float, int]],
    stored: Stored,
    cycles_of: frozenset[int],
    histogram_of: frozenset[int],
    shear: StoredShear | None,
    paths_of: frozenset[int],
) -> tuple[dict[int, Passes], list[RecountEvent]]:
    """Passes of every event at every point, counted one record in memory at a time; cycles are compared at once.

    ``sampling`` is the highest rate of peaks of all points [1/s] in every event, and its recorded upsampling factor.
    """
    mean_stress, in_a_row = mean_stress_of(inputs), _in_a_row(inputs)
    counted = {point: Passes() for point in stations}
    events = []
    for number, given in enumerate(inputs.case["mission"]["event"]):
        record = read_record(inputs, given, coordinates, *sampling[number])
        rules = spectrum_rules(inputs.case, coordinates, record.step)
        events.append(RecountEvent(record.name, record.length_km, record.passes_per_km))
        there = stored.cycles.of_event(number, [point for point in stations if point in cycles_of], CYCLE_COLUMNS)
        binned = _classes_of(stored, number, [point for point in stations if point in histogram_of])
        half_cycles = _half_cycles_of(stored, number, [point for point in stations if point in paths_of], shear)
        keeps = number if number in in_a_row else None
        for point, station in stations.items():
            key, of = stored.body.key(point), counted[point]
            one = one_pass(treated_point(station, key[3]), record, rules, mean_stress, keeps)
            if point in there:
                of.cycles.append(cycle_row(key, events[-1], one, there[point]))
            if point in binned:
                of.histograms += histogram_rows(key, events[-1], one, station.weld.curve.slopes[0], binned[point])
            if shear is not None:
                _add_shear(of, key, treated_point(station, key[3]), record, events[-1], one, shear, mean_stress,
                           counts=point in paths_of, there=half_cycles.get(point))  # fmt: skip
            one = replace(one, rows={})
            of.treated.append(one)
            of.raw.append(
                replace(one_pass(_raw(station, key[3]), record, rules, mean_stress, keeps), rows={})
                if _is_treated(station)
                else one
            )
    return counted, events + _count_loops(inputs, stations, counted, stored, cycles_of, histogram_of)


def _classes_of(stored: Stored, event: int, points: Sequence[int]) -> dict[int, pd.DataFrame]:
    """Stored classes of ranges of one event at some points, by point."""
    return {} if stored.histogram is None else stored.histogram.of_event(event, points, HISTOGRAM_COLUMNS)


def _half_cycles_of(
    stored: Stored, event: int, points: Sequence[int], shear: StoredShear | None
) -> dict[int, pd.DataFrame]:
    """Stored half cycles of one event at some points that have to have some, by point."""
    if shear is None or stored.path_cycles is None:
        return {}
    some = [point for point in points if point in shear.half_cycles]
    return stored.path_cycles.of_event(event, some, PATH_COLUMNS)


def _add_shear(
    of: Passes,
    key: Key,
    point: RecountPoint,
    record: RecountRecord,
    event: RecountEvent,
    one: OnePass,
    shear: StoredShear,
    mean_stress: MeanStress,
    *,
    counts: bool,
    there: pd.DataFrame | None,
) -> None:
    """Add how far normal stress and shear go in an event; where it ``counts``, its path and the rows of this."""
    of.extents.append(shear_extent(point, record, shear.rules.beta))
    if counts:
        path = shear_pass(point, record, shear.rules, mean_stress)
        row = None if there is None else half_cycle_row(key, event, path, one, there)
        of.half_cycles += [] if row is None else [row]
        of.paths.append(replace(path, rows={}))


def _count_loops(
    inputs: RecountInputs,
    stations: Mapping[int, Station],
    counted: Mapping[int, Passes],
    stored: Stored,
    cycles_of: frozenset[int],
    histogram_of: frozenset[int],
) -> list[RecountEvent]:
    """Runs of every loop at every point, and what they do at most where no order is known."""
    case, mean_stress = inputs.case["mission"], mean_stress_of(inputs)
    number = {event["name"]: i for i, event in enumerate(case["event"])}
    stints = {i: event["stints_per_1000_km"] / 1000 for i, event in enumerate(case["event"]) if _is_stint(event)}
    loops = [
        (RecountEvent(name, None, loop["per_1000_km"] / 1000), [number[entry] for entry in loop["order"]])
        for name, loop in zip(loop_names(inputs), case.get("sequence", []), strict=True)
    ]
    some, few = ([point for point in stations if point in of] for of in (cycles_of, histogram_of))
    there = [
        (stored.cycles.of_event(event, some, CYCLE_COLUMNS), _classes_of(stored, event, few))
        for event in range(len(number), len(number) + len(loops))
    ]
    for point, station in stations.items():
        key, of = stored.body.key(point), counted[point]
        passes, raw = list(of.treated), list(of.raw)
        for (event, order), (found, binned) in zip(loops, there, strict=True):
            one, net = loop_pass(treated_point(station, key[3]), order, passes, mean_stress)
            if point in found:
                of.cycles += loop_rows(key, event, one, net, found[point], list(number))
            if point in binned:
                k = station.weld.curve.slopes[0]
                of.histograms += histogram_rows(key, event, one, k, binned[point], of_loop=True)
            of.treated.append(replace(one, rows={}))
            of.raw.append(loop_pass(_raw(station, key[3]), order, raw, mean_stress)[0] if _is_treated(station) else one)
        if stints:
            of.bound = bound_per_km(treated_point(station, key[3]), stints, passes, mean_stress)
        of.treated[: len(passes)] = [replace(one, turns=None) for one in passes]
        of.raw[: len(raw)] = [replace(one, turns=None) for one in raw]
    return [event for event, _ in loops]


def _in_a_row(inputs: RecountInputs) -> set[int]:
    """Numbers of the events whose passes are counted in a row with others."""
    mission = inputs.case["mission"]
    names = {name for loop in mission.get("sequence", []) for name in loop["order"]}
    return {i for i, event in enumerate(mission["event"]) if event["name"] in names or _is_stint(event)}


def _is_stint(event: Mapping[str, object]) -> bool:
    return bool(event.get("stints_per_1000_km", 0.0))


def _is_treated(station: Station) -> bool:
    """Whether the treatment of an end has changed the stress."""
    return not np.array_equal(station.solved.raw[station.at], station.solved.treated[station.at])


def treated_point(station: Station, surface: str) -> RecountPoint:
    """One face of a station, its end treated."""
    thickness = float(station.solved.line.thickness[station.at])
    return point_of(
        station.solved.treated[station.at],
        station.largest,
        surface,
        station.weld.curve,
        thickness,
        station.weld.attachment,
    )


def _raw(station: Station, surface: str) -> RecountPoint:
    thickness = float(station.solved.line.thickness[station.at])
    return point_of(
        station.solved.raw[station.at], station.largest, surface, station.weld.curve, thickness, station.weld.attachment
    )


def mean_stress_of(inputs: RecountInputs) -> MeanStress:
    """What the case says of mean stress."""
    asked = inputs.case["curve"]
    return MeanStress(asked.get("yield_MPa"), counts=asked.get("mean_stress", "none") == "asme")


def values_of(
    inputs: RecountInputs, stations: Mapping[int, Station], passes: Mapping[int, Passes], events: Sequence[RecountEvent]
) -> dict[int, Values]:
    """Columns of the table of points, point by point: the events weighted with the mission."""
    mission, mean_stress, loops = inputs.case["mission"], mean_stress_of(inputs), len(loop_names(inputs))
    found = {}
    for point, of in passes.items():
        raw_damage = [one.quantities["damage_per_pass"] for one in of.raw]
        values = point_values(of.treated, raw_damage, events, mission, stations[point].weld.curve, mean_stress)
        added = [
            event.passes_per_km * one.quantities["damage_per_pass"]
            for event, one in zip(events, of.treated, strict=True)
        ]
        values["damage_per_km_transitions"] = float(sum(added[len(events) - loops :])) if loops else np.nan
        values["damage_per_km_transitions_bound"] = of.bound
        found[point] = values
    return found


def bounds_of(
    inputs: RecountInputs,
    stations: Mapping[int, Station],
    passes: Mapping[int, Passes],
    events: Sequence[RecountEvent],
    values: Mapping[int, Values],
) -> dict[int, Bounds]:
    """What rounding may do to the columns of the table of points, point by point."""
    mission = inputs.case["mission"]
    return {
        point: bounds_of_point(
            of.treated,
            [one.bounds["damage_per_pass"] for one in of.raw],
            events,
            mission,
            stations[point].weld.curve,
            values[point],
        )
        for point, of in passes.items()
    }
