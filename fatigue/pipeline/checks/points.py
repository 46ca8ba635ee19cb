"""Checks of stress points: hot spots, nominal stress, parent metal and heat-affected zones.

The stress state of a point is linear in the coordinates, and so is the stress on every plane across the plate. Each
plane is counted over the mission; at a toe ``normal`` is the plane of the weld and ``planes_60`` the critical one
within 60 deg of it, elsewhere all planes are tried. Top and bottom are the two faces of one signal, so that a rule of
the curve that asks for bending has its ratio.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.life.mission import Plan
from fatigue.pipeline.checks.linear.counted import counted_columns
from fatigue.pipeline.checks.linear.planes import critical_planes, face_pairs
from fatigue.pipeline.checks.linear.signals import counted_mission
from fatigue.pipeline.checks.rows import CheckRows, check_rows, joined, no_rows
from fatigue.pipeline.count.mission_block import MissionBlock
from fatigue.pipeline.count.overflow import no_overflow
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.solve.body import Body
from fatigue.pipeline.solve.rated.rated_curves import RatedCurve
from fatigue.readers.neutral.points.modal_stresses import PointStress
from fatigue.readers.neutral.points.stress_points import AT_TOE, CHECK_OF, HAZ, StressPoints
from fatigue.side_by_side import in_order
from fatigue.stages import stage
from fatigue.weld.beside.hot_spot import EDGE
from fatigue.weld.beside.planes import PARENT_DEG, TOE_DEG, normal_stress, shear_stress

AT_ONCE = 1024  # signals of two faces counted together: some 3 MB at 100 coordinates
NORMAL_ONLY = (0,)
ORDER = ("normal", "planes_60", "planes", "shear")  # components of a point
_COMPONENT = {NORMAL_ONLY: "normal", TOE_DEG: "planes_60", PARENT_DEG: "planes"}
AT_LIMIT = "critical plane at its limit of 60 deg, where stress along the weld enters with 3/4"


Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Batch:
    """Some points, by number, whose stress of one quantity is counted on the same planes [deg] and with one curve."""

    points: NDArray[np.intp]
    rated: RatedCurve
    planes: tuple[int, ...]
    shear: bool


def point_checks(
    body: Body, stress: PointStress | None, loads: Sequence[EventLoad], plan: Plan, threads: int | None
) -> CheckRows:
    """Rows of the checks of the stress points of a body, none without ``stress`` at such points.

    Raises
    ------
    NumericalError : stress or damage exceeds double precision
    """
    if body.points is None or stress is None:
        return no_rows()
    stage("counting stress at %d points beside welds and in parent metal", len(body.points))
    return point_rows(body.points, stress, body.curves, loads, plan, threads)


def point_rows(
    points: StressPoints,
    stress: PointStress,
    curves: Mapping[str, RatedCurve],
    loads: Sequence[EventLoad],
    plan: Plan,
    threads: int | None,
) -> CheckRows:
    """Rows of the checks of some points, in the order of the points; ``threads``: by default one per processor core."""
    found = in_order(lambda batch: _checked(batch, points, stress, loads, plan), batches(points, curves), threads)
    place = np.concatenate([at for at, _ in found])
    return joined([rows for _, rows in found])[np.argsort(place, kind="stable")]


def batches(points: StressPoints, curves: Mapping[str, RatedCurve]) -> Iterator[Batch]:
    """All that is to be counted, in batches of few enough signals."""
    alike: dict[tuple[bool, str, tuple[int, ...]], list[int]] = {}
    for number, kind in enumerate(points.kind):
        planes = PARENT_DEG if kind not in AT_TOE else NORMAL_ONLY
        if points.curve_shear[number]:
            alike.setdefault((True, points.curve_shear[number], planes), []).append(number)
        planes = TOE_DEG if kind in AT_TOE and kind != EDGE and points.planes[number] == "planes_60" else planes
        alike.setdefault((False, points.curve[number], planes), []).append(number)
    for (shear, curve, planes), numbers in alike.items():
        step = max(1, AT_ONCE // len(planes))
        for first in range(0, len(numbers), step):
            yield Batch(np.array(numbers[first : first + step]), curves[curve], planes, shear)


def _checked(
    batch: Batch, points: StressPoints, stress: PointStress, loads: Sequence[EventLoad], plan: Plan
) -> tuple[NDArray[np.intp], CheckRows]:
    """Rows of a batch, and the place of each: point by point, component by component, surface by surface."""
    names = f"stress points {points.name[batch.points[0]]} to {points.name[batch.points[-1]]}"
    with no_overflow("mission", names):
        signals = _on_planes(batch, stress)
    size, planes = batch.rated.size(points.thickness[batch.points]), len(batch.planes)
    plan = batch.rated.plan(plan)
    worst = np.zeros((len(batch.points), 2), dtype=np.intp)
    if planes > 1:
        worst = critical_planes(signals, size, batch.rated.rule, loads, plan, names)
    of_components = {_COMPONENT[batch.planes]: worst} if not batch.shear else {"shear": worst}
    if batch.planes == TOE_DEG:
        of_components = {"normal": np.zeros_like(worst), **of_components}
    first = planes * np.arange(len(worst))[:, None]  # of each point, among all signals
    at = {component: first + plane for component, plane in of_components.items()}
    kept = np.unique(np.concatenate([x.ravel() for x in at.values()]))
    of_kept = signals.reshape(-1, *signals.shape[2:])[kept]
    pairs = face_pairs(of_kept, size[kept // planes], batch.rated.rule)
    mission = counted_mission(pairs, loads, plan, names)
    found = [
        _rows(batch, points, stress, plan, mission, np.searchsorted(kept, rows), of_components[component], component)
        for component, rows in at.items()
    ]
    return np.concatenate([place for place, _ in found]), joined([rows for _, rows in found])


def _on_planes(batch: Batch, stress: PointStress) -> Floats:
    """Stress (k, d, 2, c) of k points on d planes at two faces; a face that is not there has that of the other one."""
    given = stress.given[batch.points][:, :, None, None]
    tensor = stress.tensor[batch.points]
    tensor = np.where(given, tensor, tensor[:, ::-1])
    planes = np.array(batch.planes, dtype=np.float64)
    on_planes = shear_stress(tensor, planes) if batch.shear else normal_stress(tensor, planes)
    return on_planes.swapaxes(1, 2)


def _rows(
    batch: Batch,
    points: StressPoints,
    stress: PointStress,
    plan: Plan,
    mission: MissionBlock,
    at: NDArray[np.intp],
    plane: NDArray[np.intp],
    component: str,
) -> tuple[NDArray[np.intp], CheckRows]:
    """Rows of one component, and their places; the missions of k points at two faces are in the rows ``at`` (k, 2)."""
    of, face = np.nonzero(stress.given[batch.points])
    row, number = at[of, face], batch.points[of]
    direction = np.array(batch.planes)[plane[of, face]]
    some = number.tolist()
    rows = check_rows(
        len(row),
        check=[CHECK_OF[points.kind[i]] for i in some],
        weld=[points.weld[i] for i in some],
        point=[points.name[i] for i in some],
        surface=[stress.surface[i][j] for i, j in zip(some, face.tolist(), strict=True)],
        direction_deg=direction,
        component=component,
        curve=batch.rated.curve.name,
        **counted_columns(mission, row, face, plan),
        note=[_note(points, stress, i, component, d) for i, d in zip(some, direction.tolist(), strict=True)],
    )
    return (number * len(ORDER) + ORDER.index(component)) * 2 + face, rows


def _note(points: StressPoints, stress: PointStress, number: int, component: str, direction: int) -> str:
    """What a reader has to know of a row."""
    at_limit = component == "planes_60" and abs(direction) == max(TOE_DEG)
    told = (stress.read_outs[number], "HAZ" * (points.kind[number] == HAZ), AT_LIMIT * at_limit)
    return "; ".join(text for text in told if text)
