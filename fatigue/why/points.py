"""Which points of a result are diagnosed, and what is needed of them: modal stress and the rule of their damage."""

from collections.abc import Iterator
from dataclasses import dataclass, fields, replace
from itertools import islice
from pathlib import Path
from typing import Self

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem
from fatigue.pipeline.solve.model import Model, solve_group
from fatigue.pipeline.solve.weld_groups import SideForces, WeldGroups
from fatigue.results import read_codes, read_table
from fatigue.weld.line_geometry import split_at_kinks

Floats = NDArray[np.float64]

MOST_SAMPLES = 100_000_000  # stress samples up to which all points are worth some minutes
MOST_SAMPLES_OF_WORST = 200_000_000  # the same for the worst points
MOST_NUMBERS = 20_000_000  # of all points, that are held at a time: 160 MB


@dataclass(frozen=True, slots=True, eq=False)
class Points:
    """Points whose damage is shared out.

    Attributes
    ----------
    weld, part, order, node, face : (p,) where they are; face 0 is the top, 1 the bottom
    chosen : (p,) why they were chosen
    membrane, bending : (p, m) modal stress with treated ends, bending of the top face [MPa per unit modal coordinate]
    rule : (p,) from stress range to damage, a ``CycleRule`` each
    size, size_exponent : (p,) factor of the thickness on the range, and d ln(size) / d ln(t)
    damage_limit : (p,) allowed damage sum on the curve of each
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
    size: Floats
    size_exponent: Floats
    damage_limit: Floats

    def __len__(self) -> int:
        """Number of points."""
        return len(self.node)

    @property
    def side(self) -> Floats:
        """Sign of the bending stress, +1 on the top face, -1 on the bottom face."""
        return np.where(self.face == 0, 1.0, -1.0)

    def of(self, index: NDArray[np.int64] | slice) -> Self:
        """The same of some of the points."""
        return replace(self, **{f.name: getattr(self, f.name)[index] for f in fields(self)})


def points_of(model: Model, station: NDArray[np.int64], face: NDArray[np.int64], chosen: NDArray[np.object_]) -> Points:
    """Points of a model, given by station and face."""
    stations = model.stations
    names = np.array([weld.name for weld in model.welds], dtype=object)
    rated_of_weld = model.curve_of_weld
    rule = np.empty(len(station), dtype=object)
    size, exponent, limit = np.empty(len(station)), np.empty(len(station)), np.empty(len(station))
    for i, at in enumerate(station):
        rated, t = rated_of_weld[stations.weld[at]], stations.thickness[at : at + 1]
        rule[i], limit[i] = rated.rule, rated.damage_limit(model.case.mission.damage_limit)
        size[i] = rated.size(t)[0]
        exponent[i] = rated.size_exponent(float(t[0]))
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
        size=size,
        size_exponent=exponent,
        damage_limit=limit,
    )


@dataclass(frozen=True, slots=True, eq=False)
class Chosen:
    """The points to diagnose.

    Attributes
    ----------
    rows : (p,) their rows in ``nodes.parquet``, ascending
    why : (p,) why each was chosen
    worst : (w,) index of each weld's worst point among them
    what : the choice in words
    """

    rows: NDArray[np.int64]
    why: NDArray[np.object_]
    worst: NDArray[np.int64]
    what: str


def choose_points(folder: Path, samples: int, share_of_limit: float, numbers: int) -> Chosen:
    """All points if that is affordable, else the worst of every weld and the points above a share of the limit.

    ``samples`` is how many are counted at each point, ``numbers`` how many numbers are held for it. Where even the
    worst points are too many, those with the highest utilisation stay. Points that a bound has settled have no cycles
    to share out and are never chosen.
    """
    weld, _ = read_codes(folder, "nodes", "weld")
    tier, tiers = read_codes(folder, "nodes", "screened")
    table = read_table(folder, "nodes", ["utilisation", "toe"])
    counted = np.array([name == "" for name in [*tiers, ""]])[tier]
    toe = table["toe"].to_numpy()
    utilisation = np.where(toe & counted, table["utilisation"].to_numpy(), -1.0)  # a face without a toe never governs
    worst = np.sort(pd.Series(utilisation).groupby(weld).idxmax().to_numpy())

    if counted.all() and len(weld) * samples <= MOST_SAMPLES and len(weld) * numbers <= MOST_NUMBERS:
        rows = np.arange(len(weld))
        return Chosen(rows, np.full(len(rows), "all", dtype=object), worst, f"all {len(rows)} points")
    above = f"above {share_of_limit:g} of the limit"
    others = np.setdiff1d(np.flatnonzero(utilisation >= share_of_limit), worst)
    most = max(1, min(MOST_SAMPLES_OF_WORST // samples, MOST_NUMBERS // numbers))
    named, kept = worst, others
    if len(worst) + len(others) > most:
        named = _highest(worst, utilisation, most)
        kept = _highest(others, utilisation, most - len(named))
    rows = np.union1d(named, kept)
    why = np.where(np.isin(rows, named), "worst of its weld", above).astype(object)
    if len(rows) == len(worst) + len(others):
        which = f"the worst point of every weld and those {above}, {len(rows)} of {len(weld)}: all would take long"
    elif len(named) == len(worst):
        which = (
            f"the worst point of every weld and, of the {len(others)} others {above}, the {len(kept)} with the "
            f"shortest lives, {len(rows)} of {len(weld)}: more would take long"
        )
    else:
        which = (
            f"the worst points of the {len(named)} of {len(worst)} welds with the shortest lives, of {len(weld)} "
            "points: more would take long"
        )
    return Chosen(rows, why, np.searchsorted(rows, named), which)


def _highest(rows: NDArray[np.int64], utilisation: NDArray[np.float64], most: int) -> NDArray[np.int64]:
    """Rows with the highest utilisation, ascending."""
    return np.sort(rows[np.argsort(-utilisation[rows], kind="stable")[:most]])


def gather_points(folder: Path, groups: WeldGroups, chosen: Chosen) -> Points:
    """Points that were chosen, from the groups of welds they lie in, solved one after the other.

    Raises
    ------
    DataError : the result in the folder has other points than the case
    """
    solved = solved_rows(folder, groups, chosen.rows)
    gathered = [points_of(model, rows // 2, rows % 2, chosen.why[here]) for model, rows, here in solved]
    return Points(*(np.concatenate([getattr(points, f.name) for points in gathered]) for f in fields(Points)))


def solved_rows(
    folder: Path, groups: WeldGroups, rows: NDArray[np.int64]
) -> Iterator[tuple[Model, NDArray[np.int64], slice]]:
    """Groups of welds that hold some ``rows`` of ``nodes.parquet``, ascending, solved one after the other.

    With each group come the rows it holds, counted from its first, ``2 station + face``, and where among ``rows``
    they stand.

    Raises
    ------
    DataError : the result in the folder has other points than the case
    """
    node = read_table(folder, "nodes", ["node"])["node"].to_numpy()
    first = 0
    for number, of_case in enumerate(_nodes(groups)):
        end = first + 2 * len(of_case)
        if not np.array_equal(node[first:end], np.repeat(of_case, 2)):
            raise DataError(_other_points(folder, f"has other points than the case from row {first + 1} on"))
        here = slice(*np.searchsorted(rows, [first, end]).tolist())
        if here.stop > here.start:
            yield solve_group(groups, number), rows[here] - first, here
        first = end
    if first != len(node):
        raise DataError(_other_points(folder, f"has {len(node)} points where the case has {first}"))


def _nodes(groups: WeldGroups) -> Iterator[NDArray[np.int64]]:
    """Nodes of the stations of every group of welds, known before it is solved."""
    lines, is_split = iter(groups.body.lines), isinstance(groups.forces, SideForces)
    for group in groups.groups:
        some = islice(lines, len(range(*group.indices(len(groups.body.welds)))))
        yield np.concatenate([part.node for line in some for part in (split_at_kinks(line) if is_split else (line,))])


def _other_points(folder: Path, what: str) -> Problem:
    return Problem("other_points", str(folder / "nodes.parquet"), what, "Run the assessment again")
