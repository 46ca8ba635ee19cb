"""Dong's structural stress: the line load in the local axes of the weld, over the plate's section.

With z' the plate normal, y' out of the plate across the line, x' = y' x z' and forces on the assessed elements, the
traction sigma(z) y' has the resultant f_y' = int sigma dz and the moment m_x' = -int z sigma dz, the shear traction
tau(z) x' the moment m_y' = int z tau dz (Dong, Int. J. Fatigue 23 (2001) 865; ASME VIII-2 5.5.5.2 and Annex 5-A).
"""

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from fatigue.weld.line import Lines
from fatigue.weld.line_geometry import corners, local_axes
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


def structural_stress(line: Lines, load: NDArray[np.float64]) -> StructuralStress:
    """Structural stress of a line force and moment in global axes, (n, m, 6) [N/mm, N]."""
    return _of_section(local_axes(line), line.thickness, load)


def _of_section(axes: NDArray[np.float64], t: NDArray[np.float64], load: NDArray[np.float64]) -> StructuralStress:
    """Structural stress at nodes with the given local axes, (n, 3, 3), and thickness, (n,) [mm]."""
    x, y, z = np.moveaxis(axes, 1, 0) / t[:, np.newaxis]
    force, moment = load[..., :3], load[..., 3:]
    return StructuralStress(
        membrane=_component(force, y),
        bending=_component(moment, -6 * x / t[:, np.newaxis]),
        in_plane_shear=_component(force, x),
        twist_shear=_component(moment, 6 * y / t[:, np.newaxis]),
        transverse_shear=_component(force, z),
    )


def _component(vectors: NDArray[np.float64], along: NDArray[np.float64]) -> NDArray[np.float64]:
    """Product of each node's vectors, (n, m, 3), with a vector of its own, (n, 3), as (n, m)."""
    return np.ascontiguousarray(np.einsum("nmc,nc->nm", vectors, along, order="F"))


@dataclass(frozen=True, slots=True, eq=False)
class LineStress:
    """Structural stress along a line or a stack of lines, as solved (raw) and with the ends treated.

    Attributes
    ----------
    line : the weld line or lines, n nodes
    raw, treated : structural stress before and after the treatment of weld ends
    at_end, at_corner : (n,) near a weld end; at a kink of more than 30 degrees
    unresolved : (n,) end node whose edge is longer than the end zone
    """

    line: Lines
    raw: StructuralStress
    treated: StructuralStress
    at_end: NDArray[np.bool_]
    at_corner: NDArray[np.bool_]
    unresolved: NDArray[np.bool_]


def assess_line(line: Lines, nodal_force: NDArray[np.floating]) -> LineStress:
    """Structural stress of nodal forces and moments on the assessed elements, (n, m, 6) [N, N mm], in global axes."""
    return line_stress(line, line_load(line, nodal_force))


def line_stress(line: Lines, load: NDArray[np.float64]) -> LineStress:
    """Structural stress of a line or lines under a line force and moment in global axes, (n, m, 6) [N/mm, N]."""
    axes, ends, at_corner = local_axes(line), treat_ends(line, load), corners(line)
    raw = _of_section(axes, line.thickness, load)
    near = ends.treated
    mended = _of_section(axes[near], line.thickness[near], ends.mean)
    pairs = zip(_parts(raw), _parts(mended), strict=True)
    at_corner[line.begin[:-1]] |= line.corner_start
    at_corner[line.begin[1:] - 1] |= line.corner_end
    return LineStress(
        line=line,
        raw=raw,
        treated=StructuralStress(*(_replaced(old, near, new) for old, new in pairs)),
        at_end=ends.at_end,
        at_corner=at_corner,
        unresolved=ends.unresolved,
    )


def _parts(stress: StructuralStress) -> list[NDArray[np.float64]]:
    return [getattr(stress, part.name) for part in fields(stress)]


def _replaced(old: NDArray[np.float64], at: NDArray[np.bool_], new: NDArray[np.float64]) -> NDArray[np.float64]:
    mended = old.copy()
    mended[at] = new
    return mended
