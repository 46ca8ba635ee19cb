"""Lines and plate sides of the welds as they are registered: renamed, left out, joined."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem, refuse
from fatigue.readers.neutral.body.welds import Weld
from fatigue.readers.neutral.register.registered import Registered
from fatigue.weld.element_forces import ElementForces, elements_around
from fatigue.weld.join import Joint, fan, joined, joined_elements
from fatigue.weld.line import LineStack, WeldLine, stacked
from fatigue.weld.line_check import check_line

Joints = Mapping[str, tuple[Joint, ...]]
"""Where the lines of a joined weld meet, by its name."""

_ROUNDED = 1e-3  # relative: as somebody may write a thickness down


def registered_lines(
    lines: LineStack, register: Registered, *, summed: bool
) -> tuple[tuple[Weld, ...], LineStack, Joints]:
    """Welds as registered, their lines in the same order, and where the lines of joined welds meet.

    Parameters
    ----------
    lines : of all welds in the tables
    summed : whether forces are summed over the plate side already, so that no lines can be joined

    Raises
    ------
    DataError : lines of one name do not join end to end on one plate side, or their forces are summed
    """
    place = {name: at for at, name in enumerate(lines.weld)}
    welds: list[Weld] = []
    found: list[WeldLine] = []
    joints: dict[str, tuple[Joint, ...]] = {}
    problems: list[Problem] = []
    for weld, sources in zip(register.welds, register.sources, strict=True):
        some = [_with_thickness(lines[place[name]], register.thickness.get(name)) for name in sources]
        line = some[0]
        where = f"{register.file}: weld {weld.name}"
        try:
            if len(some) > 1:
                for part, source in zip(some, sources, strict=True):
                    check_line(part, f"{where}, line {source}")
                line, joints[weld.name] = joined(some, sources, where)
        except DataError as error:
            problems += error.problems
            continue
        if len(some) > 1 and summed:
            problems.append(_summed(where, sources, joints[weld.name][0].node, register.again))
        welds.append(replace(weld, closed=line.closed))
        found.append(replace(line, weld=weld.name, end_length=weld.end_length))
    refuse(DataError, problems)
    return tuple(welds), stacked(found), joints


def unconfirmed_thickness(lines: LineStack, register: Registered) -> list[Problem]:
    """Warn of thicknesses in the register that nobody has confirmed and the tables do not have."""
    place = {name: at for at, name in enumerate(lines.weld)}
    warnings = []
    for name, where, wanted in register.unconfirmed:
        there = lines[place[name]].thickness
        thinnest, thickest = float(there.min()), float(there.max())
        if wanted < thinnest * (1.0 - _ROUNDED) or wanted > thickest * (1.0 + _ROUNDED):
            own = f"{thinnest:g} mm" if thinnest == thickest else f"{thinnest:g} to {thickest:g} mm"
            what = f"{wanted:g} mm is not confirmed, and the weld is assessed with the {own} of the tables"
            remedy = "Write true under confirmed to have it, or empty the cell"
            warnings.append(Problem("unconfirmed_thickness", where, what, remedy))
    return warnings


def registered_sides(
    sides: Mapping[str, NDArray[np.int64]], forces: ElementForces, register: Registered, joints: Joints
) -> dict[str, NDArray[np.int64]]:
    """Elements on the assessed side of each registered weld, made of the elements that the tables give.

    Raises
    ------
    DataError : an element of the plate round the node where two lines join is in neither side
    """
    found = {}
    problems: list[Problem] = []
    for weld, sources in zip(register.welds, register.sources, strict=True):
        own = [sides[name] for name in sources]
        if len(own) == 1:
            found[weld.name] = own[0]
            continue
        of_side = forces.of(np.concatenate(own))
        around = [elements_around(joint.node, of_side) for joint in joints[weld.name]]
        fans = []
        for joint, touching in zip(joints[weld.name], around, strict=True):
            first, last = (set(own[at].tolist()) for at in joint.lines)
            elements = fan(touching, joint, first, last)
            if elements is None:
                problems.append(_gap(f"{register.file}: weld {weld.name}", joint.node, register.again))
            else:
                fans.append(elements)
        if len(fans) == len(around):
            found[weld.name] = joined_elements(own, around, fans)
    refuse(DataError, problems)
    return found


def _with_thickness(line: WeldLine, thickness: float | None) -> WeldLine:
    return line if thickness is None else replace(line, thickness=np.full(line.node.size, thickness))


def _summed(where: str, sources: Sequence[str], node: int, again: str) -> Problem:
    return Problem(
        "summed_forces",
        where,
        f"{' and '.join(sources)} cannot be joined: their nodal forces are summed, and which elements round node "
        f"{node} are in both sums is not known",
        again or "Give element_forces and weld_elements, or write the forces of the whole line",
    )


def _gap(where: str, node: int, again: str) -> Problem:
    return Problem(
        "gap_at_joint",
        where,
        f"the elements of the two lines that join at node {node} do not make one plate round it",
        again or "Complete weld_elements and element_forces round the node, or give the lines two names",
    )
