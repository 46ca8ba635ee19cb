"""Dong's structural stress: the line load in the local axes of the weld, over the plate's section.

With z' the plate normal, y' out of the plate across the line, x' = y' x z' and forces on the assessed elements, the
traction sigma(z) y' has the resultant f_y' = int sigma dz and the moment m_x' = -int z sigma dz, the shear traction
tau(z) x' the moment m_y' = int z tau dz (Dong, Int. J. Fatigue 23 (2001) 865; ASME VIII-2 5.5.5.2 and Annex 5-A).
"""

from dataclasses import dataclass, fields

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

    Bending and twist are those of the top surface; on the bottom they have the other sign.

    Attributes
    ----------
    membrane : mean normal stress across the line
    bending : normal stress of the bending part, top surface
    in_plane_shear : mean shear stress along the line
    twist_shear : shear stress of the twisting part, top surface
    transverse_shear : mean shear stress through the plate
    """

    membrane: Floats
    bending: Floats
    in_plane_shear: Floats
    twist_shear: Floats
    transverse_shear: Floats


def structural_stress(axes: Floats, t: Floats, load: Floats) -> StructuralStress:
    """Structural stress of a line force and moment in global axes, (n, m, 6) [N/mm, N].

    ``axes`` are the local axes of each node, (n, 3, 3), as `local_axes` gives them; ``t`` is the thickness, (n,) [mm].
    """
    x, y, z = np.moveaxis(axes, 1, 0)
    t = t[:, np.newaxis]
    along = np.stack([y / t, -6 * x / t**2, x / t, 6 * y / t**2, z / t], axis=1)
    stress = np.empty((5, *load.shape[:2]))
    _components(np.ascontiguousarray(load), along, stress)
    return StructuralStress(*stress)


@compiled()
def _components(load: Floats, along: Floats, stress: Floats) -> None:
    """Write the products of the load, (n, m, 6), with the vectors of each node, (n, 5, 3), as (5, n, m).

    The order is that of `StructuralStress`; bending and twist are those of the moment, its last three components.
    """
    for i in range(load.shape[0]):
        across, bending, along_line, twist, through = along[i]
        for j in range(load.shape[1]):
            fx, fy, fz, mx, my, mz = load[i, j]
            stress[0, i, j] = fx * across[0] + fy * across[1] + fz * across[2]
            stress[1, i, j] = mx * bending[0] + my * bending[1] + mz * bending[2]
            stress[2, i, j] = fx * along_line[0] + fy * along_line[1] + fz * along_line[2]
            stress[3, i, j] = mx * twist[0] + my * twist[1] + mz * twist[2]
            stress[4, i, j] = fx * through[0] + fy * through[1] + fz * through[2]


@dataclass(frozen=True, slots=True, eq=False)
class LineStress:
    """Structural stress along a line or a stack of lines, with the ends treated and as it was solved (raw).

    Attributes
    ----------
    line : the weld line or lines, n nodes
    treated : structural stress after the treatment of weld ends
    mended, before : (z,) nodes whose stress the treatment has replaced, ascending, and their stress before
    at_end, at_corner : (n,) near a weld end; at a kink of more than 30 degrees
    unresolved : (n,) end node whose edge is longer than the end zone
    """

    line: Lines
    treated: StructuralStress
    mended: NDArray[np.intp]
    before: StructuralStress
    at_end: NDArray[np.bool_]
    at_corner: NDArray[np.bool_]
    unresolved: NDArray[np.bool_]

    @property
    def raw(self) -> StructuralStress:
        """Structural stress of all nodes before the treatment of weld ends."""
        raw = [part.copy() for part in _parts(self.treated)]
        for part, before in zip(raw, _parts(self.before), strict=True):
            part[self.mended] = before
        return StructuralStress(*raw)


def assess_line(line: Lines, nodal_force: NDArray[np.floating]) -> LineStress:
    """Structural stress of nodal forces and moments on the assessed elements, (n, m, 6) [N, N mm], in global axes."""
    return line_stress(line, line_load(line, nodal_force))


def line_stress(line: Lines, load: Floats) -> LineStress:
    """Structural stress of a line or lines under a line force and moment in global axes, (n, m, 6) [N/mm, N]."""
    axes, ends, at_corner = local_axes(line), treat_ends(line, load), corners(line)
    at_corner[line.begin[:-1]] |= line.corner_start
    at_corner[line.begin[1:] - 1] |= line.corner_end
    mended = np.flatnonzero(ends.treated)
    stress = structural_stress(axes, line.thickness, load)
    before = StructuralStress(*(part[mended] for part in _parts(stress)))
    after = structural_stress(axes[mended], line.thickness[mended], ends.mean)
    for part, of_mean in zip(_parts(stress), _parts(after), strict=True):
        part[mended] = of_mean
    return LineStress(
        line=line,
        treated=stress,
        mended=mended,
        before=before,
        at_end=ends.at_end,
        at_corner=at_corner,
        unresolved=ends.unresolved,
    )


def _parts(stress: StructuralStress) -> list[Floats]:
    return [getattr(stress, part.name) for part in fields(stress)]
