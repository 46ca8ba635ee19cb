"""Whether the conditions of a fleet fit together: loops of events that units must run often enough, and doubts."""

from collections.abc import Iterator, Mapping

import numpy as np
from numpy.typing import NDArray

from fatigue.decide.fleet.conditions import Points, Result
from fatigue.decide.fleet.distances import Distances
from fatigue.decide.fleet.fleet_file import Fleet
from fatigue.decide.of_result import loops_of, shear_method
from fatigue.errors import DataError, Problem, refuse
from fatigue.shown import few, visible

Floats = NDArray[np.float64]

ENOUGH = 1e-9  # relative: passes that a loop needs, up to rounding


def refuse_short_loops(fleet: Fleet, results: Mapping[str, Result], distances: Distances) -> None:
    """Refuse units that run a loop of events more often than they run its events.

    What a loop adds replaces cycles of one pass of each of its entries: without these its damage means nothing.

    Raises
    ------
    DataError : the units, and the first event that they run too little
    """
    refuse(DataError, _short_loops(fleet, results, distances))


def _short_loops(fleet: Fleet, results: Mapping[str, Result], distances: Distances) -> Iterator[Problem]:
    for c, condition in enumerate(fleet.condition):
        loops = loops_of(results[condition.results].record)
        loop = next((one for one in loops if one["name"] == condition.event), None)
        if loop is None:
            continue
        for event in dict.fromkeys(loop["order"]):
            passes = _passes(fleet, results, distances, condition.results, event)
            needed = loop["order"].count(event) * distances.distance[:, c]
            short = passes < needed * (1.0 - ENOUGH)
            if short.any():
                u = int(short.argmax())
                what = f"unit {visible(distances.units[u])!r} runs it {distances.distance[u, c]:g} times a year, which "
                what += f"takes {needed[u]:g} passes of the event {visible(event)!r}; the unit has {passes[u]:g}"
                remedy = f"Give conditions of {condition.results!r} with this event and enough km, or run it less often"
                yield Problem("fleet_short_loop", f"condition {condition.name!r}", what, remedy, int(short.sum()))


def _passes(fleet: Fleet, results: Mapping[str, Result], distances: Distances, result: str, event: str) -> Floats:
    """Passes (u,) of an event of a result in a year, under all conditions with it."""
    length = {one["event"]: one["length"] for one in results[result].record["mission"]["events"]}[event]
    own = [c for c, one in enumerate(fleet.condition) if (one.results, one.event) == (result, event)]
    return np.asarray(distances.distance[:, own].sum(axis=1) / (1.0 if length is None else length))


def doubts(fleet: Fleet, results: Mapping[str, Result], points: Points) -> Iterator[Problem]:
    """Doubts about the sums of a fleet, each once."""
    versions = {name: result.record["software"]["fatigue"] for name, result in results.items()}
    if len(set(versions.values())) > 1:
        told = few([f"{visible(name)!r} {version}" for name, version in versions.items()])
        what = f"results of different versions of the program are summed: {told}"
        yield Problem("fleet_versions", fleet.path.name, what, "Assess them again with one version")
    for name, result in results.items():
        yield from _of_result(fleet, name, result)
    screened = np.flatnonzero(points.is_bound.any(axis=1))
    if len(screened):
        what = (
            f"{len(screened)} of {len(points.key)} points were screened in some result: upper bounds stand for their "
        )
        what += "damage. A life that rests on one is at least as long as told"
        yield Problem("fleet_bounds", fleet.path.name, what, "Assess with --exact where such a point governs a weld")


def _of_result(fleet: Fleet, name: str, result: Result) -> Iterator[Problem]:
    """What the sums leave out of one result."""
    where = f"results {visible(name)!r}"
    used = {condition.event for condition in fleet.condition if condition.results == name}
    loops = [loop for loop in loops_of(result.record) if used.intersection(loop["order"])]
    absent = [loop["name"] for loop in loops if loop["name"] not in used]
    if absent:
        what = f"its cycles across events, {few(absent)}, are in no condition and in no sum"
        yield Problem("fleet_transitions", where, what, f"Add a condition with event = {absent[0]!r}, in runs per year")
    if any(
        one.get("stints_per_1000_km") is not None and one["event"] in used for one in result.record["mission"]["events"]
    ):
        what = "the order of its events is not known, and the bound of their cycles across events is in no sum"
        yield Problem("fleet_transitions", where, what, "See damage_per_km_transitions_bound of its points")
    if shear := shear_method(result.record):
        what = f"its verdicts rest on normal stress and shear (multiaxial method {shear!r}); the sums are of normal "
        yield Problem("fleet_shear", where, f"{what}stress alone", "See utilisation of its points for shear")
    beside = result.welds["worst_check"].fillna("").ne("").sum()
    if beside:
        what = f"{beside} of its welds have checks beside the toe (root, hot spot, nominal stress), which no sum has"
        yield Problem("fleet_checks", where, what, "See checks.parquet of the result")
