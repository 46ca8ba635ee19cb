"""Dong's structural stress: the line load in the local axes of the weld, over the plate's section.

With z' the plate normal, y' out of the plate across the line, x' = y' x z' and forces on the assessed elements, the
traction sigma(z) y' has the resultant f_y' = int sigma dz and the moment m_x' = -int z sigma dz, the shear traction
tau(z) x' the moment m_y' = int z tau dz (Dong, Int. J. Fatigue 23 (2001) 865; ASME VIII-2 5.5.5.2 and Annex 5-A).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.weld.line import WeldLine, corners, local_axes
from fatigue.weld.line_load import line_load, treat_ends


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

    membrane: NDArray[np.float64]
    bending: NDArray[np.float64]
    in_plane_shear: NDArray[np.float64]
    twist_shear: NDArray[np.float64]
    transverse_shear: NDArray[np.float64]


def structural_stress(line: WeldLine, load: NDArray[np.float64]) -> StructuralStress:
    """Structural stress of a line force and moment in global axes, (n, m, 6) [N/mm, N]."""
    to_local = local_axes(line).swapaxes(1, 2)
    fx, fy, fz = np.moveaxis(load[..., :3] @ to_local, -1, 0)
    mx, my, _ = np.moveaxis(load[..., 3:] @ to_local, -1, 0)
    t = line.thickness[:, np.newaxis]
    return StructuralStress(
        membrane=fy / t,
        bending=-6 * mx / t**2,
        in_plane_shear=fx / t,
        twist_shear=6 * my / t**2,
        transverse_shear=fz / t,
    )


@dataclass(frozen=True, slots=True, eq=False)
class LineStress:
    """Structural stress along one line, as solved (raw) and with its ends treated.

    Attributes
    ----------
    line : the weld line, n nodes
    raw, treated : structural stress before and after the treatment of weld ends
    at_end, at_corner : (n,) near a weld end; at a kink of more than 30 degrees
    unresolved : (n,) end node whose edge is longer than the end zone
    """

    line: WeldLine
    raw: StructuralStress
    treated: StructuralStress
    at_end: NDArray[np.bool_]
    at_corner: NDArray[np.bool_]
    unresolved: NDArray[np.bool_]


def assess_line(line: WeldLine, nodal_force: NDArray[np.floating]) -> LineStress:
    """Structural stress of nodal forces and moments on the assessed elements, (n, m, 6) [N, N mm], in global axes."""
    load = line_load(line, nodal_force)
    ends = treat_ends(line, load)
    at_corner = corners(line)
    at_corner[0] |= line.corner_start
    at_corner[-1] |= line.corner_end
    return LineStress(
        line=line,
        raw=structural_stress(line, load),
        treated=structural_stress(line, ends.value),
        at_end=ends.at_end,
        at_corner=at_corner,
        unresolved=ends.unresolved,
    )
