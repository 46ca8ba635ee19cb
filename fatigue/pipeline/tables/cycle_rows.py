"""Rows of the table of cycles: what its columns are, for a cycle of an event as for one across events."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.life.rule import bending_ratio, cycle_damage, equivalent_range
from fatigue.pipeline.count.worst import WorstPoint
from fatigue.pipeline.solve.model import Model
from fatigue.pipeline.solve.rated.rated_curves import RatedCurve
from fatigue.pipeline.tables.rows import FACES
from fatigue.results import coded

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class KeptPoint:
    """A point whose cycles are kept, without the stations it is one of.

    ``membrane`` and ``bending`` (m,) are its modal stress, of the top face [MPa per unit modal coordinate];
    ``thickness`` is the thickness of its plate [mm].
    """

    weld: str
    part: int
    node: int
    order: int
    face: int
    thickness: float
    membrane: NDArray[np.float64]
    bending: NDArray[np.float64]
    rated: RatedCurve

    @property
    def side(self) -> float:
        """Sign of the bending stress at its face: 1 at the top, -1 at the bottom."""
        return 1.0 - 2.0 * self.face


@dataclass(frozen=True, slots=True, eq=False)
class CycleParts:
    """Some cycles of one point, arrays (c,).

    Structural stress range and mean, ranges of ``membrane`` and ``bending`` stress and the ``minimum`` of the stress
    [MPa], the ``count`` of each, and the file times of its two reversals [s].
    """

    range: Floats
    mean: Floats
    count: Floats
    membrane: Floats
    bending: Floats
    minimum: Floats
    start_s: NDArray[np.floating]
    end_s: NDArray[np.floating]


def kept_point(model: Model, point: WorstPoint) -> KeptPoint:
    """What the cycles of a point need of the stations of its group of welds."""
    stations, at = model.stations, point.station
    treated = stations.treated
    return KeptPoint(
        weld=stations.welds[point.weld].name,
        part=int(stations.part[at]),
        node=int(stations.node[at]),
        order=int(stations.order[at]),
        face=point.face,
        thickness=float(stations.thickness[at]),
        membrane=treated.membrane[at].copy(),
        bending=treated.bending[at].copy(),
        rated=model.curve_of_weld[point.weld],
    )


def cycle_rows(points: Sequence[KeptPoint], event: str, cycles: Sequence[CycleParts]) -> dict[str, Any]:
    """Rows of some cycles of each of some points in an event, with what the rule of its curve makes of them."""
    numbers = [_numbers(point, own) for point, own in zip(points, cycles, strict=True)]
    lengths = [len(own.range) for own in cycles]
    same, none = np.zeros(sum(lengths), dtype=np.int32), np.full(sum(lengths), -1, dtype=np.int32)
    welds = list(dict.fromkeys(point.weld for point in points))
    own = [(welds.index(p.weld), p.part, p.node, p.order, p.face) for p in points]
    weld, part, node, order, face = np.repeat(np.array(own).T, lengths, axis=1)
    return {
        "weld": coded(weld, welds),
        "part": part,
        "node": node,
        "order": order,
        "surface": coded(face, FACES),
        "event": coded(same, [event]),
        "start_event": coded(none, [event]),
        "end_event": coded(none, [event]),
        **{name: np.concatenate([own[name] for own in numbers]) for name in numbers[0]},
    }


def _numbers(point: KeptPoint, cycles: CycleParts) -> dict[str, NDArray[np.floating]]:
    """The columns of numbers of some cycles of one point."""
    rated, rule = point.rated, point.rated.rule
    r = bending_ratio(cycles.membrane, cycles.bending)
    size = rated.size(np.array([point.thickness]))
    f_M = rule.mean_stress_factor(cycles.minimum, cycles.minimum + cycles.range)
    dS = equivalent_range(cycles.range, size, rule.ratio_factor(r), f_M)
    return {
        "start_s": cycles.start_s,
        "end_s": cycles.end_s,
        "range_MPa": cycles.range,
        "mean_MPa": cycles.mean,
        "count": cycles.count,
        "membrane_range_MPa": cycles.membrane,
        "bending_range_MPa": cycles.bending,
        "bending_ratio": r,
        "equivalent_range_dS": dS,
        "damage": cycles.count * cycle_damage(dS, rule.law),
    }
