"""Cuts to which the register gives one name, made one cut of the mesh."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from fatigue.errors import DataError, Problem, refuse
from fatigue.readers.neutral.register.weld_register import RegisterRow, contradictions
from fatigue.weld.cuts import WeldCut, plate_round
from fatigue.weld.detection import Topology
from fatigue.weld.join import Joint, joined, joined_elements


def joined_cuts(
    topo: Topology, rows: Sequence[RegisterRow], cuts: Mapping[str, WeldCut], register: Path | None
) -> dict[str, WeldCut]:
    """Cuts to assess that have one name, each joined to one cut, by this name.

    Raises
    ------
    DataError : they do not join end to end on one plate side, or their rows contradict each other
    """
    of_weld: dict[str, list[RegisterRow]] = {}
    for row in rows:
        if row.status == "assess":
            of_weld.setdefault(row.weld, []).append(row)
    found: dict[str, WeldCut] = {}
    problems: list[Problem] = []
    for name, own in of_weld.items():
        if len(own) == 1:
            continue
        where = f"{register.name if register else 'weld lines'}: weld {name}"
        problems += (here := list(contradictions(own, where)))
        if not here:
            try:
                found[name] = _joined(topo, [cuts[row.line] for row in own], [row.line for row in own], where)
            except DataError as error:
                problems += error.problems
    refuse(DataError, problems)
    return found


def _joined(topo: Topology, cuts: Sequence[WeldCut], names: Sequence[str], where: str) -> WeldCut:
    """Cuts of one plate side as one: the elements round a joint lie on the plate between the two lines."""
    line, joints = joined([cut.line for cut in cuts], names, where)
    sides = [cut.elements for cut in cuts]
    together = np.unique(np.concatenate(sides))
    mesh = topo.mesh
    fans, touching = [], []
    for joint in joints:
        first, last = (cuts[at] for at in joint.lines)
        fans.append(plate_round(topo, first, joint.node, joint.before, joint.after))
        if not fans[-1] & _with_edge(topo, last, joint):
            what = f"the plate does not go on from one line to the other at node {joint.node}"
            raise DataError(Problem("not_joined", where, what, "Give the lines two names"))
        at = np.searchsorted(mesh.node, joint.node)
        touching.append(set(mesh.element[(mesh.corner == at).any(axis=1)].tolist()) & set(together.tolist()))
    return replace(cuts[0], line=line, elements=joined_elements(sides, touching, fans))


def _with_edge(topo: Topology, cut: WeldCut, joint: Joint) -> set[int]:
    """Elements of a cut along its first edge behind the joint."""
    mesh = topo.mesh
    ends = np.searchsorted(mesh.node, [joint.node, joint.after])
    along = np.logical_and.reduce([(mesh.corner == end).any(axis=1) for end in ends])
    return set(mesh.element[along].tolist()) & set(cut.elements.tolist())
