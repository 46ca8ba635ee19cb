"""Dong's structural stress: the line load in the local axes of the weld, over the plate's section.

With z' the plate normal, y' out of the plate across the line, x' = y' x z' and forces on the assessed elements, the
traction sigma(z) y' has the resultant f_y' = int sigma dz and the moment m_x' = -int z sigma dz; the shear traction
tau(z) x' has the moment m_y' = int z tau dz. Hence the signs of Eq. 3. Sources: Dong, Int. J. Fatigue 23 (2001) 865;
ASME VIII-2 5.5.5.2 and Annex 5-A.
"""

from dataclasses import dataclass, fields
from typing import Self

import numpy as np
from numpy.typing import NDArray

from fatigue.compiled import compiled
from fatigue.weld.line import Lines
from fatigue.weld.line_geometry import corners, local_axes
from fatigue.weld.line_load import line_load, treat_ends

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class StructuralStress:
    """Structural stress of each node and mode, (n, m) [MPa per unit modal coordinate].

    Bending and twist belong to the top surface; on the bottom they have the other sign.

    Attributes
    ----------
    membrane : mean normal stress across the line, f_y' / t
    bending : normal stress of the bending part, top surface, -6 m_x' / t^2
    in_plane_shear : mean shear stress along the line, f_x' / t
    twist_shear : shear stress of the twisting part, top surface, 6 m_y' / t^2
    transverse_shear : mean shear stress through the plate, f_z' / t
    """

    membrane: Floats
    bending: Floats
    in_plane_shear: Floats
    twist_shear: Floats
    transverse_shear: Floats


def structural_stress(axes: Floats, t: Floats, load: Floats) -> StructuralStress:
    """Structural stress of a line force and moment, Eq. 3.

    Parameters
    ----------
    axes : (n, 3, 3) local axes x', y', z' of each node, as ``local_axes`` returns them
    t : (n,) thickness [mm]
    load : (n, m, 6) line force and moment in global axes [N/mm, N]

    Examples
    --------
    A plate of 10 mm under 100 N/mm across the line and a moment of 50 N mm/mm about it:

    >>> load = np.array([[[0.0, 100.0, 0.0, 50.0, 0.0, 0.0]]])
    >>> found = structural_stress(np.eye(3)[np.newaxis], np.array([10.0]), load)
    >>> float(found.membrane[0, 0]), float(found.bending[0, 0])
    (10.0, -3.0)
    """
    x, y, z = np.moveaxis(axes, 1, 0)
    t = t[:, np.newaxis]
    along = np.stack([y / t, -6 * x / t**2, x / t, 6 * y / t**2, z / t], axis=1)
    stress = np.empty((5, *load.shape[:2]))
    _components(np.ascontiguousarray(load), along, stress)
    return StructuralStress(*stress)


@compiled()
def _components(load: Floats, along: Floats, stress: Floats) -> None:
    """Write ``f . a`` and ``m . a`` of the load (n, m, 6) and the vectors a of each node (n, 5, 3) as (5, n, m).

    The five stand in the order of ``StructuralStress``. Bending and twist come from the moment m, the last three
    components of the load; the others come from the force f.
    """
    for i in range(load.shape[0]):
        for j in range(load.shape[1]):
            for part in range(5):
                first = 3 if part in (1, 3) else 0
                product = load[i, j, first] * along[i, part, 0] + load[i, j, first + 1] * along[i, part, 1]
                stress[part, i, j] = product + load[i, j, first + 2] * along[i, part, 2]


@dataclass(frozen=True, slots=True, eq=False)
class RawEnds:
    """Nodes whose stress the treatment of weld ends replaces, and their raw stress: as it was solved.

    Attributes
    ----------
    rows : (e,) these nodes, ascending
    stress : their stress before the treatment, (e, m)
    """

    rows: NDArray[np.intp]
    stress: StructuralStress

    def at(self, rows: NDArray[np.intp]) -> Self:
        """Take those among some nodes, ascending, by their places among these."""
        _, mine, theirs = np.intersect1d(self.rows, rows, assume_unique=True, return_indices=True)
        return type(self)(theirs, StructuralStress(*(part[mine] for part in _parts(self.stress))))


@dataclass(frozen=True, slots=True, eq=False)
class LineStress:
    """Structural stress along a line or a stack of lines, with the ends treated and as it was solved (raw).

    Attributes
    ----------
    line : the weld line or lines, n nodes
    treated : structural stress after the treatment of weld ends
    raw_ends : nodes whose stress the treatment has replaced, and their stress before
    at_end, at_corner : (n,) near a weld end; at a kink of more than 30 degrees
    summed_corner : (n,) at such a kink inside the line, where the forces of both legs are one sum
    unresolved : (n,) end node whose edge is longer than the end zone
    """

    line: Lines
    treated: StructuralStress
    raw_ends: RawEnds
    at_end: NDArray[np.bool_]
    at_corner: NDArray[np.bool_]
    summed_corner: NDArray[np.bool_]
    unresolved: NDArray[np.bool_]

    @property
    def raw(self) -> StructuralStress:
        """Structural stress of all nodes before the treatment of weld ends."""
        raw = [part.copy() for part in _parts(self.treated)]
        for part, at_ends in zip(raw, _parts(self.raw_ends.stress), strict=True):
            part[self.raw_ends.rows] = at_ends
        return StructuralStress(*raw)


def assess_line(line: Lines, nodal_force: NDArray[np.floating]) -> LineStress:
    """Structural stress of nodal forces and moments on the assessed elements, (n, m, 6) [N, N mm], in global axes."""
    return line_stress(line, line_load(line, nodal_force))


def line_stress(line: Lines, load: Floats) -> LineStress:
    """Structural stress of a line or lines under a line force and moment in global axes, (n, m, 6) [N/mm, N]."""
    axes, ends, inside = local_axes(line), treat_ends(line, load), corners(line)
    at_corner = inside.copy()
    at_corner[line.begin[:-1]] |= line.corner_start
    at_corner[line.begin[1:] - 1] |= line.corner_end
    rows = np.flatnonzero(ends.treated)
    stress = structural_stress(axes, line.thickness, load)
    raw_ends = RawEnds(rows, StructuralStress(*(part[rows] for part in _parts(stress))))
    after = structural_stress(axes[rows], line.thickness[rows], ends.mean)
    for part, of_mean in zip(_parts(stress), _parts(after), strict=True):
        part[rows] = of_mean
    return LineStress(
        line=line,
        treated=stress,
        raw_ends=raw_ends,
        at_end=ends.at_end,
        at_corner=at_corner,
        summed_corner=inside,
        unresolved=ends.unresolved,
    )


def _parts(stress: StructuralStress) -> list[Floats]:
    return [getattr(stress, part.name) for part in fields(stress)]
