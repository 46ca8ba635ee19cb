"""Half cycles of the paths of few points, and their Miner sums by range, by length and by path moment."""

from collections.abc import Iterable, Iterator, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import Problem
from fatigue.life.path.count import COUNT, PathCycles, count_path
from fatigue.life.path.ranges import EndRanges, at_instants, combined_range, end_ranges, path_damage
from fatigue.life.records.history import stress_history
from fatigue.life.rule import CycleRule, cycle_damage
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.multiaxial.found import MODELS, Found, nothing_found

Floats = NDArray[np.float64]

SAMPLES_AT_ONCE = 1_000_000  # of each of the four stresses: 32 MB
LONGEST_PATH = 2_000_000  # samples of a record whose paths are counted: some 250 bytes for each
EQUAL = 1e-9  # ranges that differ by less
LONG_PATH = 200_000  # samples, from which on one thread counts at a time


@dataclass(frozen=True, slots=True, eq=False)
class Point:
    """A toe point: its stresses (4, m) per unit coordinate [MPa] at the top face, and what is its own in a cycle.

    The stresses are membrane, bending, in-plane and twist shear; ``face`` is 0 at the top and 1 at the bottom.
    """

    stress: Floats
    face: int
    size: float
    rule: CycleRule


@dataclass(frozen=True, slots=True, eq=False)
class PathParts:
    """Half cycles of one point in one event, what is between their ends, and the combined equivalent range x (h,)."""

    cycles: PathCycles
    between: EndRanges
    x: Floats


def long_paths(case: str, events: Iterable[tuple[str, int, int]]) -> Iterator[Problem]:
    """Refusals of events whose records are too long for the path counter.

    ``case`` is the name of the case file, ``events`` have their names, samples as they are counted and upsampling.
    """
    for event, samples, factor in events:
        if samples > LONGEST_PATH:
            what = f"the record of event '{event}' has {samples} samples as it is counted, upsampled "
            what += f"{factor} times; paths are counted in records of {LONGEST_PATH} samples at most"
            remedy = "Upsample less, divide the record into events, or give method = 'asme' or 'report'"
            yield Problem("path_too_long", f"{case}: multiaxial.method", what, remedy)


def paths_of(
    points: Sequence[Point], load: EventLoad, beta: float, one_at_a_time: AbstractContextManager[object] | None = None
) -> Iterator[PathParts]:
    """Half cycles of one pass of an event at some points, one after the other.

    ``one_at_a_time`` is held while a long record is counted.
    """
    q, samples = load.counted.q, load.counted.q.shape[1]
    at_once = max(1, SAMPLES_AT_ONCE // samples)
    with (one_at_a_time if samples >= LONG_PATH else None) or nullcontext():
        for first in range(0, len(points), at_once):
            some = points[first : first + at_once]
            histories = stress_history(load.stress_factor * np.stack([point.stress for point in some]), q)
            for point, of_point in zip(some, histories, strict=True):
                yield path_parts(point, of_point, load, beta)


def path_parts(point: Point, histories: Floats, load: EventLoad, beta: float) -> PathParts:
    """Half cycles of one point with its four stress histories (4, t) [MPa]."""
    side = 1.0 - 2.0 * point.face
    membrane, bending, in_plane, twist = histories
    cycles = count_path(membrane + side * bending, in_plane + side * twist, beta, load.residue)
    between = end_ranges(cycles, membrane, bending, in_plane, twist, side)
    x = combined_range(between, point.size, beta, point.rule)
    if point.rule.yield_of_damage is not None or point.rule.stress_ratio != "none":
        x = x / _mean_stress_factor(point, membrane + side * bending, cycles, load)
    return PathParts(cycles, between, x)


def _mean_stress_factor(point: Point, normal: Floats, cycles: PathCycles, load: EventLoad) -> Floats:
    """``f_M`` or f(R) of half cycles by the normal stress (t,) at their ends, constants included."""
    side = 1.0 - 2.0 * point.face
    offset = load.stress_factor * float((point.stress[0] + side * point.stress[1]) @ load.offset)
    ends = np.stack([at_instants(normal, t) for t in (cycles.start, cycles.end)]) + offset
    return point.rule.mean_stress_factor(ends.min(axis=0), ends.max(axis=0))


def path_sums(
    points: Sequence[Point],
    loads: Sequence[EventLoad],
    passes: Floats,
    beta: float,
    alpha: float | None,
    one_at_a_time: AbstractContextManager[object] | None = None,
) -> tuple[Found, Floats]:
    """Miner sums (k,) of some points at the target, over the limit, of their passes alone; and those of the top pairs.

    ``passes`` (e,) are those up to the target, over the limit.
    """
    found, top, largest = nothing_found((len(points),)), np.zeros(len(points)), np.zeros(len(points))
    for name in (*MODELS, "range_MPa"):
        found[name] = 0.0
    found["mlp"] = np.nan if alpha is None else 0.0
    for number, (load, weight) in enumerate(zip(loads, passes, strict=True)):
        for i, parts in enumerate(paths_of(points, load, beta, one_at_a_time)):
            law, cycles = points[i].rule.law, parts.cycles
            if not cycles.range.size:
                continue
            damage = path_damage(cycles, parts.x, law, alpha)
            for model in MODELS:
                found[model][i] += weight * getattr(damage, model)
            widest = cycles.range >= (1.0 - EQUAL) * cycles.range.max()
            of_pair = float(cycle_damage(parts.x[widest], law).max())
            top[i] += weight * (1.0 if load.residue == "repeat" else COUNT) * of_pair
            if weight * damage.range > largest[i]:
                largest[i], found["event"][i] = weight * damage.range, number
            _keep_largest(found[i : i + 1], cycles, widest)
    return found, top


def _keep_largest(found: Found, cycles: PathCycles, widest: NDArray[np.bool_]) -> None:
    """Keep what is said of the half cycle with the largest range: of equal ones the largest factor and moment."""
    largest, factor, moment = cycles.range.max(), cycles.factor[widest].max(), cycles.moment[widest].max()
    if largest > found["range_MPa"][0] * (1.0 + EQUAL):
        found["range_MPa"], found["path_factor"], found["path_moment"] = largest, factor, moment
    elif largest >= found["range_MPa"][0] * (1.0 - EQUAL):
        found["path_factor"] = max(found["path_factor"][0], factor)
        found["path_moment"] = max(found["path_moment"][0], moment)
