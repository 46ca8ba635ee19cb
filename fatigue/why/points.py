"""Which points of a result are diagnosed, and what is needed of them: stress shapes and the rule of their damage."""

from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Self

import numpy as np
from numpy.typing import NDArray

from fatigue.case import Case
from fatigue.errors import DataError, Problem
from fatigue.life.attribution import DamageRule, size_exponent
from fatigue.life.damage import size_factor
from fatigue.life.mission import Plan
from fatigue.pipeline.model import Model, WeldGroups, solve_group
from fatigue.results import read_table

Floats = NDArray[np.float64]

MOST_SAMPLES = 100_000_000  # stress samples up to which all points are worth a minute


@dataclass(frozen=True, slots=True, eq=False)
class Points:
    """Points whose damage is shared out.

    Attributes
    ----------
    weld, part, order, node, face : (p,) where they are; face 0 is the top, 1 the bottom
    chosen : (p,) why they were chosen
    membrane, bending : (p, m) stress shapes with treated ends, bending of the top face [MPa per unit modal coordinate]
    rule : (p,) from stress range to damage
    rule_exponent : (p,) d ln(size) / d ln(t) of the thickness rule
    """

    weld: NDArray[np.object_]
    part: NDArray[np.int64]
    order: NDArray[np.int64]
    node: NDArray[np.int64]
    face: NDArray[np.int64]
    chosen: NDArray[np.object_]
    membrane: Floats
    bending: Floats
    rule: NDArray[np.object_]
    rule_exponent: Floats

    def __len__(self) -> int:
        """Count the points."""
        return len(self.node)

    @property
    def side(self) -> Floats:
        """Sign of the bending stress, +1 on the top face, -1 on the bottom face."""
        return np.where(self.face == 0, 1.0, -1.0)

    def of(self, index: NDArray[np.int64] | slice) -> Self:
        """Take some of the points."""
        return replace(self, **{f.name: getattr(self, f.name)[index] for f in fields(self)})


def points_of(model: Model, station: NDArray[np.int64], face: NDArray[np.int64], chosen: NDArray[np.object_]) -> Points:
    """Take points of a model, given by station and face."""
    stations, curve = model.stations, model.case.curve
    names = np.array([weld.name for weld in model.welds], dtype=object)
    yield_MPa = curve.yield_MPa if curve.mean_stress == "asme" else None
    rated_of_weld = [model.curves[name] for name in model.curve_of_weld]
    rule = np.empty(len(station), dtype=object)
    exponent = np.empty(len(station))
    for i, at in enumerate(station):
        rated, t = rated_of_weld[stations.weld[at]], stations.thickness[at : at + 1]
        size = float(size_factor(t, rated.curve, curve.thickness_rule)[0])
        rule[i] = DamageRule(rated.law, size, rated.curve.applies == "dS", yield_MPa)
        exponent[i] = size_exponent(float(t[0]), rated.curve, curve.thickness_rule)
    return Points(
        weld=names[stations.weld[station]],
        part=stations.part[station],
        order=stations.order[station],
        node=stations.node[station],
        face=face,
        chosen=chosen,
        membrane=stations.treated.membrane[station],
        bending=stations.treated.bending[station],
        rule=rule,
        rule_exponent=exponent,
    )


def choose_points(
    folder: Path, case: Case, plan: Plan, share_of_limit: float
) -> tuple[NDArray[np.object_], NDArray[np.int64], str]:
    """Choose all points if that is affordable, else the worst of every weld and those above a share of the limit.

    Points that a bound has settled have no cycles to share out and are never chosen.
    Returns for every row of ``nodes.parquet`` why it is chosen, empty if it is not; where among the chosen rows the
    worst of every weld is; and the choice in words.
    """
    nodes = read_table(folder, "nodes", ["weld", "utilisation", "toe", "screened"]).to_pandas()
    counted = nodes["screened"] == ""
    utilisation = nodes["utilisation"].where(nodes["toe"] & counted, -1.0)  # a face without a toe never governs
    worst = np.sort(utilisation.groupby(nodes["weld"]).idxmax().to_numpy())

    upsample = case.counting.upsample
    samples = sum(one.samples for one in plan.passes) * (upsample if isinstance(upsample, int) else 1)
    if counted.all() and len(nodes) * samples <= MOST_SAMPLES:
        return np.full(len(nodes), "all", dtype=object), worst, f"all {len(nodes)} points"
    above = f"above {share_of_limit:g} of the limit"
    chosen = np.where(utilisation >= share_of_limit, above, "").astype(object)
    chosen[worst] = "worst of its weld"
    rows = np.flatnonzero(chosen)
    which = f"the worst point of every weld and those {above}, {len(rows)} of {len(nodes)}: all would take long"
    return chosen, np.searchsorted(rows, worst), which


def gather_points(folder: Path, groups: WeldGroups, chosen: NDArray[np.object_]) -> Points:
    """Solve the welds group by group and keep what is needed of the chosen points only.

    Raises
    ------
    DataError : the result in the folder has other points than the case
    """
    node = read_table(folder, "nodes", ["node"])["node"].to_numpy()
    pieces, first = [], 0
    for number in range(len(groups)):
        model = solve_group(groups, number)
        here = slice(first, first + 2 * len(model.stations))
        if not np.array_equal(node[here], np.repeat(model.stations.node, 2)):
            problem = Problem(
                "other_points",
                str(folder / "nodes.parquet"),
                f"has other points than the case from row {first + 1} on",
                "Run the assessment again",
            )
            raise DataError(problem)
        rows = np.flatnonzero(chosen[here])
        pieces.append(points_of(model, rows // 2, rows % 2, chosen[here][rows]))
        first = here.stop
    return Points(*(np.concatenate([getattr(piece, f.name) for piece in pieces]) for f in fields(Points)))
