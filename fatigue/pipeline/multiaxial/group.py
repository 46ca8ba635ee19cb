"""Shear at the toes of a group of welds as a story: bounded, traced, counted, until every toe has its verdict.

Nothing is traced that a bound settles, and nothing counted that its trace settles; so the ordinary assessment counts
the paths of few points. A method of the path counter that the case names has all toe points counted.
"""

from collections.abc import Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass, field
from threading import Lock

import numpy as np
from numpy.typing import NDArray

from fatigue.case import Method
from fatigue.life.bounds.path_extent import PathExtent
from fatigue.life.mission import Plan
from fatigue.pipeline.count.group import weld_names
from fatigue.pipeline.count.overflow import no_overflow
from fatigue.pipeline.count.result import GroupResult
from fatigue.pipeline.count.worst import WorstPoint, worst_points
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.multiaxial.asme import asme_bound, asme_counted
from fatigue.pipeline.multiaxial.counted import LONGEST_PATH, path_sums
from fatigue.pipeline.multiaxial.found import MODELS, NULL, STATUSES, Found, nothing_found, verdicts
from fatigue.pipeline.multiaxial.settle import first_tier, second_tier, shear_required
from fatigue.pipeline.multiaxial.toes import Toes, passes_at_target, toes_of
from fatigue.pipeline.solve.model import Model
from fatigue.pipeline.solve.stations import modal_stress

Floats = NDArray[np.float64]

FAILS_NORMAL, PASSES, FAILS, COUNTED = range(len(STATUSES))


@dataclass(frozen=True, slots=True, eq=False)
class Shear:
    """How shear is counted with the normal stress.

    Attributes
    ----------
    method : as the case has it
    beta, alpha : weights of the square of the shear and of the path moment
    extents : how far the modal coordinates of each event move
    counted_from : utilisation from which on the worst point of a weld is counted, whatever settles it
    is_large : a job so large that the closer bound settles a point, if it does, whose path nothing else needs
    one_at_a_time : held while the path of a long record is counted
    """

    method: Method
    beta: float
    alpha: float | None
    extents: tuple[PathExtent, ...]
    counted_from: float
    is_large: bool = False
    one_at_a_time: AbstractContextManager[object] = field(default_factory=Lock)

    @property
    def counts_all(self) -> bool:
        """Whether a method of the path counter decides, so that no bound is enough."""
        return self.method in MODELS


def group_multiaxial(model: Model, result: GroupResult, loads: Sequence[EventLoad], plan: Plan, shear: Shear) -> Found:
    """What shear adds at every station of a group of welds, (n, 2).

    Raises
    ------
    NumericalError : stress or damage exceeds double precision
    """
    stations, found = model.stations, nothing_found((len(model.stations), 2))
    worst = worst_points(stations, result)
    for rated, rows in model.by_curve():
        own, names = rated.plan(plan), weld_names(stations, rows)
        toes = toes_of(modal_stress(stations, rows, rated), stations.toe, result, rows, own)
        with no_overflow("mission", names):
            found[rows] = of_curve(toes, _wanted(rows, worst, result, shear), loads, own, shear, names)
    return found


def _wanted(
    rows: NDArray[np.intp], worst: Sequence[WorstPoint], result: GroupResult, shear: Shear
) -> NDArray[np.bool_]:
    """Points (n, 2) of some stations that are counted whatever settles them: each weld's worst one that matters."""
    wanted = np.zeros((len(result.tier), 2), dtype=np.bool_)
    for point in worst:
        at = point.station, point.face
        wanted[at] = result.mission.utilisation[at] >= shear.counted_from
    return wanted[rows]


def of_curve(
    toes: Toes, wanted: NDArray[np.bool_], loads: Sequence[EventLoad], plan: Plan, shear: Shear, names: str
) -> Found:
    """What shear adds at stations that share a curve, (n, 2); ``names`` are their welds in words."""
    found, passes = nothing_found(toes.toe.shape), passes_at_target(plan)
    first = first_tier(toes, loads, shear.extents, passes, shear.beta)
    found["shear_required"] = shear_required(toes, first, loads, shear.extents)
    found["bound"], found["normal"], found["asme"] = first.bound, toes.normal, toes.with_shear
    bounded = np.flatnonzero(~toes.counted & toes.toe.any(axis=1))
    if bounded.size:
        found["asme"][bounded] = asme_bound(toes, bounded, loads, passes)

    found["status"][toes.toe & (toes.normal > 1.0)] = FAILS_NORMAL
    _settle(found, toes, wanted, loads, plan, shear, names)
    if all(load.counted.q.shape[1] <= LONGEST_PATH for load in loads):
        counts = (found["status"] == COUNTED) | wanted | shear.counts_all
        _count(found, toes, toes.toe & counts, loads, passes, shear)
    else:
        found["status"][found["status"] == COUNTED] = NULL
    for name in ("bound", "normal", "asme"):
        found[name][~toes.toe] = np.nan
    found["verdict"] = np.where(toes.toe, verdicts(found), NULL)
    return found


def _settle(
    found: Found,
    toes: Toes,
    wanted: NDArray[np.bool_],
    loads: Sequence[EventLoad],
    plan: Plan,
    shear: Shear,
    names: str,
) -> None:
    """Find the status of every toe point, ``counted`` where only the counter can tell; trace points as it is needed."""
    passes = passes_at_target(plan)
    left = toes.toe & (found["status"] != FAILS_NORMAL) & ~_is_settled(found)
    traces = left | (toes.toe & (wanted | shear.counts_all))
    at = _places(traces)
    if at[0].size:
        bound, closer = second_tier(toes, at, loads, passes, shear.beta)
        bound = np.minimum(found["bound"][at], bound)
        settles = (bound > 1.0) & (closer <= 1.0) & ~wanted[at] & shear.is_large
        found["bound"][at] = np.where(settles, closer, bound)
    rows = np.flatnonzero(left.any(axis=1) & ~toes.counted)
    if rows.size:
        found["normal"][rows], found["asme"][rows] = asme_counted(toes, rows, loads, plan, names)
    passed = _is_settled(found)
    open_ = toes.toe & (found["status"] != FAILS_NORMAL)
    found["status"][open_ & passed], found["status"][open_ & ~passed] = PASSES, COUNTED


def _is_settled(found: Found) -> NDArray[np.bool_]:
    """Whether neither the range of the path nor the ASME factor can take a point to its limit."""
    return np.asarray((found["bound"] <= 1.0) & (found["asme"] <= 1.0))


def _count(
    found: Found,
    toes: Toes,
    counts: NDArray[np.bool_],
    loads: Sequence[EventLoad],
    passes: Floats,
    shear: Shear,
) -> None:
    """Count the paths of some points; where their most distant pair alone is enough to fail, the status says so."""
    at = _places(counts)
    if not at[0].size:
        return
    sums, top = path_sums(
        [toes.point(*one) for one in zip(*at, strict=True)], loads, passes, shear.beta, shear.alpha, shear.one_at_a_time
    )
    across = toes.transitions[at]
    for name in MODELS:
        found[name][at] = sums[name] + across
    for name in ("path_factor", "path_moment", "range_MPa", "event"):
        found[name][at] = sums[name]
    fails = counts.copy()
    fails[at] = top + across > 1.0
    found["status"][fails & (found["status"] == COUNTED)] = FAILS


def _places(chosen: NDArray[np.bool_]) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Stations and faces of the points that are chosen, (n, 2)."""
    station, face = np.nonzero(chosen)
    return station, face
