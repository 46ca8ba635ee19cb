"""The surfaces of a model on which weld lines are found: its shells, and the skin of its solids."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fatigue.errors import DataError, Problem, refuse
from fatigue.readers.convert.coordinate_lines import GivenLine
from fatigue.readers.foreign.fe.model import FeModel
from fatigue.readers.neutral.register.weld_register import RegisterRow
from fatigue.weld.along.corridor import local_edges
from fatigue.weld.along.path import Gap, edges_along
from fatigue.weld.cuts import WeldCut
from fatigue.weld.detection import Key, Topology, classify, topology
from fatigue.weld.solid.skin import Skin, skin_of
from fatigue.weld.solid.through import cut_through
from fatigue.weld.solid.toes import toes

SHELL_ON_SOLID = "shell_on_solid"
"""Kind of lines where shells end at the nodes of solids."""

MEETS_SOLIDS = "shells end at solids there: this joint of two idealisations has no cut through one plate"


@dataclass(frozen=True, slots=True, eq=False)
class Surface:
    """Edges of shells, or of the skin of solids; ``welded`` are edges of shells that end at nodes of solids."""

    topo: Topology
    skin: Skin | None = None
    welded: Mapping[int, Key] | None = None

    def edges(self) -> dict[int, Key]:
        """Kind and properties of every edge that may be a weld."""
        if self.skin is not None:
            return toes(self.topo)
        return classify(self.topo) | dict(self.welded or {})


def surfaces_of(model: FeModel) -> list[Surface]:
    """Shells, and the skin of solids; one of them where the model has no other elements."""
    if model.solids is None:
        return [Surface(topology(model.mesh))]
    skin = skin_of(model.solids)
    of_solids = Surface(topology(skin.mesh), skin)
    if not model.mesh.element.size:
        return [of_solids]
    topo = topology(model.mesh)
    return [Surface(topo, welded=_welded(topo, model)), of_solids]


def _welded(topo: Topology, model: FeModel) -> dict[int, Key]:
    """Free edges of shells whose ends are nodes of solids."""
    assert model.solids is not None
    of_solids = np.zeros(model.mesh.node.size, bool)
    of_solids[np.unique(model.solids.corner[model.solids.corner >= 0])] = True
    free = np.flatnonzero((np.diff(topo.first) == 1) & of_solids[topo.ends].all(axis=1))
    pid = topo.mesh.pid[topo.sides[topo.first[free]] // 4]
    return {int(edge): (SHELL_ON_SOLID, (int(p),)) for edge, p in zip(free, pid, strict=True)}


def lines_of(surfaces: Sequence[Surface], given: Sequence[GivenLine]) -> list[list[GivenLine]]:
    """Given lines of each surface: of a line that several could have, the first that it lies on, else the last."""
    left = list(given)
    if not given:
        return [[] for _ in surfaces]
    found: list[list[GivenLine]] = []
    for surface in surfaces[:-1]:
        topo, local = surface.topo, local_edges(surface.topo)
        own = [line for line in left if not isinstance(edges_along(topo, local, line.polyline, line.tolerance), Gap)]
        left = [line for line in left if line not in own]
        found.append(own)
    return [*found, left]


def through_all(skin: Skin, cuts: Iterable[WeldCut]) -> tuple[list[WeldCut], dict[str, str]]:
    """Cuts of a skin as cuts through the plates beneath, and why some cannot be assessed, by name."""
    found = [cut_through(skin, cut) for cut in cuts]
    return [cut for cut, _ in found], {cut.name: fault for cut, fault in found if fault}


def joined_through(skin: Skin, cut: WeldCut) -> WeldCut:
    """Cut through the plate beneath a joined line of a skin.

    Raises
    ------
    DataError : there is no such cut
    """
    whole, fault = cut_through(skin, cut)
    if fault:
        raise DataError(Problem("not_joined", f"weld {cut.name}", fault, "Give the lines two names"))
    return whole


def rows_of(
    surfaces: Sequence[Surface], rows: Sequence[RegisterRow], on_skin: Mapping[str, WeldCut], register: Path | None
) -> list[list[RegisterRow]]:
    """Rows to assess of each surface.

    Raises
    ------
    DataError : one weld has lines of shells and of solids
    """
    assessed = [row for row in rows if row.status == "assess"]
    solid = [row for row in assessed if row.line in on_skin]
    shell = [row for row in assessed if row.line not in on_skin]
    where = register.name if register else "weld lines"
    what = "it has lines of shells and of solids, which do not join"
    both = sorted({row.weld for row in solid} & {row.weld for row in shell})
    refuse(
        DataError,
        [Problem("not_joined", f"{where}: weld {name}", what, "Give the lines two names") for name in both],
    )
    return [shell if surface.skin is None else solid for surface in surfaces]
