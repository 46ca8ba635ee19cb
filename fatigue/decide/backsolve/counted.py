"""Points of a result counted again, as the assessment counts them: as they are, or with another strength.

The points are solved again from inputs that may not have changed since. What is counted is what ``count`` of the
assessment counts, in double precision, cycles across events included.
"""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from fatigue.decide.backsolve.strength import Kind, under
from fatigue.life.counting.block import BlockStress
from fatigue.life.counting.count import count, count_and_residue
from fatigue.life.mission import Plan
from fatigue.life.recorded_curve import recorded_size
from fatigue.pipeline.count.joined.loops import PassResidue, joined_events, pass_residue
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.mission.events import event_loads
from fatigue.pipeline.mission.offsets import face_offset
from fatigue.pipeline.mission.plan import mission_plan
from fatigue.pipeline.solve.assessed_body import assessed_body
from fatigue.pipeline.solve.modal_stress import ModalStress
from fatigue.pipeline.solve.weld_groups import weld_groups
from fatigue.results import upsampling_factors
from fatigue.side_by_side import in_order
from fatigue.weld.structural_stress import RawEnds, StructuralStress
from fatigue.why.points import Chosen, Points, gather_points

Floats = NDArray[np.float64]
Rows = NDArray[np.int64]

AT_ONCE = 8  # points of one count


@dataclass(frozen=True, slots=True, eq=False)
class Plates:
    """What the size factor of points follows from: thickness (p,) and attachment (p,) [mm], and the curve of each."""

    thickness: Floats
    attachment: Floats
    curve: tuple[str, ...]


@dataclass(frozen=True, slots=True, eq=False)
class CountedPoints:
    """Points ready to be counted, with the events and the mission.

    Attributes
    ----------
    rows : (p,) their rows in the table of nodes, ascending
    points, plates : what they are
    loads, plan : the events, and how often they are passed
    record : provenance of the result
    threads : that count, by default one per processor core
    """

    rows: Rows
    points: Points
    plates: Plates
    loads: tuple[EventLoad, ...]
    plan: Plan
    record: Mapping[str, Any]
    threads: int | None

    def of(self, index: NDArray[np.int64]) -> "CountedPoints":
        """Some of the points."""
        plates = self.plates
        some = Plates(plates.thickness[index], plates.attachment[index], tuple(plates.curve[i] for i in index))
        return replace(self, rows=self.rows[index], points=self.points.of(index), plates=some)

    def per_pass(self, kind: Kind | None = None, x: Floats | None = None) -> Floats:
        """Damage (p, r) of one pass of each event and one run of each loop, with ``x`` (p,) times the strength."""
        points = self.points if kind is None or x is None else under(self.points, kind, x, self._size)
        blocks = [points.of(slice(i, i + AT_ONCE)) for i in range(0, len(points), AT_ONCE)]
        return np.concatenate(list(in_order(self._block, blocks, self.threads)))

    def utilisation(self, kind: Kind, x: Floats, target_km: float) -> Floats:
        """Utilisation (p,) at a target with ``x`` (p,) times the strength."""
        return self.per_pass(kind, x) @ self.plan.weights * target_km / self.points.damage_limit

    def _size(self, x: Floats) -> Floats:
        """Size factor (p,) of ``x`` times the thickness."""
        plates, size = self.plates, np.empty(len(x))
        for name in set(plates.curve):
            some = np.array([other == name for other in plates.curve])
            recorded, rule = self.record["curves"][name], self.record["rules"]["thickness_rule"]
            thick = plates.thickness[some] * x[some]
            size[some] = recorded_size(name, recorded, thick, rule, plates.attachment[some])
        return size

    def _block(self, points: Points) -> Floats:
        """Damage (p, r) of some points."""
        damage = np.empty((len(points), len(self.plan.names)))
        for rule in {id(rule): rule for rule in points.rule}.values():
            rows = np.flatnonzero([other is rule for other in points.rule])
            damage[rows] = _damage(points.of(rows), self.loads, self.plan)
        return damage


def _damage(points: Points, loads: Sequence[EventLoad], plan: Plan) -> Floats:
    """Damage (p, r) of points of one rule: one pass of each event, one run of each loop."""
    n, face = len(points), points.face
    nothing = np.zeros((n, points.membrane.shape[1]))
    none = RawEnds(np.zeros(0, np.intp), StructuralStress(*(nothing[:0],) * 5))
    rule = points.rule[0]
    stress = ModalStress(
        points.membrane, points.bending, nothing, nothing, points.size, rule, none, np.zeros(0, np.bool_)
    )
    each, residues, found = np.arange(n), [], []
    for number, load in enumerate(loads):
        membrane, bending = load.stress_factor * stress.membrane, load.stress_factor * stress.bending
        block = BlockStress(
            membrane, bending, stress.size, np.zeros((n, 2)), offset=face_offset(membrane, bending, load)
        )
        if plan.loops and plan.joins(number):
            counted, open_end = count_and_residue(block, load.record, rule)
            residues.append(pass_residue(open_end, block, load))
        else:
            counted = count(block, load.record, rule)
            residues.append(PassResidue.nothing(n))
        found.append(counted.damage[each, face])
    if plan.loops:
        found += [loop.count.damage[each, face] for loop in joined_events(stress, plan, residues, residues).loops]
    return np.stack(found, axis=1)


@contextmanager
def counted_points(
    folder: Path,
    record: Mapping[str, Any],
    rows: Rows,
    plates: Plates,
    *,
    case_file: Path | None,
    threads: int | None,
) -> Iterator[CountedPoints]:
    """Points of a result, by their rows in its table of nodes (ascending), ready to be counted.

    Raises
    ------
    DataError : the case or an input is gone or has changed since
    """
    body = assessed_body(record, folder, case_file)
    plan, _ = mission_plan(body, threads)
    with TemporaryDirectory(prefix="fatigue-") as scratch, threadpool_limits(limits=1, user_api="blas"):
        groups = weld_groups(body, Path(scratch) / "forces")
        chosen = Chosen(rows, np.full(len(rows), "", object), np.arange(len(rows)), "")
        points = gather_points(folder, groups, chosen)
        loads = event_loads(groups, plan, Path(scratch) / "histories", threads, upsampling_factors(record))
        in_double = tuple(replace(load, single=None) for load in loads)
        yield CountedPoints(rows, points, plates, in_double, plan, record, threads)
