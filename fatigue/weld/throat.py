"""Stress in the throat of fillet welds at a plate that ends, by statics from the line force and moment on this plate.

The frame is that of the plate: y = 0 at the line, y' out of the plate, z = 0 at its mid-surface, x along the line. The
throat of a weld on the side s = +1 (top) or -1 (bottom) begins at its root, u points from there to the face of the
weld, n is normal to it and points out of the half of the weld that hangs on the plate:

    n = (cos a, s sin a),    u = (-sin a, s cos a),    centroid (y_c, z_c) = root + u throat / 2.

Two welds share f_x, f_y and f_z, and take the moments as couples of forces over h = 2 z_c; one weld takes all, and the
moment m_c about its centroid:

    two:  F_x = f_x/2 +- m_y/h,   F_y = f_y/2 -+ m'/h,   F_z = f_z/2,   m' = m_x - y_c f_z,   upper sign: top weld
    one:  F = f,   m_c = m_x - (y_c F_z - z_c F_y).

The throat stresses are those of a section of the weld, linear in the forces and so in the modal coordinates. Assumed:
f_z is shared equally by two welds, the plate touches nothing but its welds, and a single weld takes no twist m_y.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from fatigue.weld.structural_stress import StructuralStress

Floats = NDArray[np.float64]
Side: TypeAlias = Literal["top", "bottom"]
Lever: TypeAlias = Literal["throats", "t"]

SIGN: dict[Side, float] = {"top": 1.0, "bottom": -1.0}


@dataclass(frozen=True, slots=True, eq=False)
class LineForce:
    """Line force [N/mm] and moment [N] on the plate, in its local axes; arrays (n, m) per unit modal coordinate."""

    x: Floats
    y: Floats
    z: Floats
    mx: Floats
    my: Floats


@dataclass(frozen=True, slots=True, eq=False)
class Throat:
    """Throat of a weld on the top side of n cuts of a plate; that of a weld on its bottom side is the mirror image.

    Attributes
    ----------
    throat : a, length of the section, penetration included [mm]
    angle_deg : of its normal n from y' [deg]: 45 at a tee of equal legs, -45 at a lap joint, 0 and 90 cut the legs
    root_y, root_z : (n,) place of the root [mm]
    """

    throat: float
    angle_deg: float
    root_y: Floats
    root_z: Floats

    @property
    def centroid(self) -> tuple[Floats, Floats]:
        """y_c and z_c of the weld on the top side [mm], (n,) each."""
        angle, half = np.radians(self.angle_deg), 0.5 * self.throat
        return self.root_y - half * np.sin(angle), self.root_z + half * np.cos(angle)


@dataclass(frozen=True, slots=True, eq=False)
class WeldForce:
    """Force [N/mm] of one weld, and moment m_c about its centroid [N], (n, m) per unit modal coordinate."""

    x: Floats
    y: Floats
    z: Floats
    moment: Floats


@dataclass(frozen=True, slots=True, eq=False)
class ThroatStress:
    """Stress in the throat of one weld, (n, m) [MPa per unit modal coordinate].

    Attributes
    ----------
    sigma_perp : mean normal stress on the throat, F n / a
    tau_perp : mean shear stress across the weld, F u / a
    tau_par : mean shear stress along the weld, F_x / a
    bending : normal stress of m_c at the root, s 6 m_c / a^2; at the face it has the other sign
    """

    sigma_perp: Floats
    tau_perp: Floats
    tau_par: Floats
    bending: Floats

    @property
    def root(self) -> Floats:
        """Structural stress of the throat at the root."""
        return self.sigma_perp + self.bending

    @property
    def face(self) -> Floats:
        """Structural stress of the throat at the face of the weld."""
        return self.sigma_perp - self.bending


def tee_throat(thickness: Floats, throat: float, penetration: float, line_offset: float) -> Throat:
    """Throat of a fillet of equal legs at a tee or cruciform joint, in plates of some thickness (n,) [mm].

    ``penetration`` is how far the root lies past the surface of the plate; ``line_offset`` is y of the root plane minus
    y of the line: 0 with the line on the surface of the base plate, minus half the base plate with the line at its
    mid-surface.
    """
    return Throat(throat, 45.0, np.full_like(thickness, line_offset), 0.5 * thickness - penetration)


def lap_throat(thickness: Floats, throat: float, penetration: float, line_offset: float) -> Throat:
    """Throat of a fillet of equal legs at the edge of a lapped plate, on its face away from the other plate."""
    return Throat(throat, -45.0, np.full_like(thickness, line_offset - penetration), -0.5 * thickness)


def line_force(stress: StructuralStress, thickness: Floats) -> LineForce:
    """The line force and moment that five components of structural stress stand for, in plates (n,) [mm].

    >>> one = np.ones((1, 1))
    >>> force = line_force(StructuralStress(one, one, one, one, one), np.array([6.0]))
    >>> float(force.y[0, 0]), float(force.mx[0, 0]), float(force.my[0, 0])
    (6.0, -6.0, 6.0)
    """
    t = thickness[:, np.newaxis]
    section = t**2 / 6.0
    return LineForce(
        x=t * stress.in_plane_shear,
        y=t * stress.membrane,
        z=t * stress.transverse_shear,
        mx=-section * stress.bending,
        my=section * stress.twist_shear,
    )


def weld_forces(
    line: LineForce, throat: Throat, sides: Sequence[Side], thickness: Floats, lever: Lever = "throats"
) -> dict[Side, WeldForce]:
    """Force and moment of the weld on each of one or two sides of a plate (n,) [mm].

    ``lever``: the couples of two welds act over the distance of the centroids of their throats; or over the thickness
    t, as in the section modulus a t of some programs, which is not in equilibrium but for a of 0.
    """
    y_c, z_c = (part[:, np.newaxis] for part in throat.centroid)
    if len(sides) == 1:
        (side,) = sides
        moment = line.mx - (y_c * line.z - SIGN[side] * z_c * line.y)
        return {side: WeldForce(line.x, line.y, line.z, moment)}
    h = 2.0 * z_c if lever == "throats" else thickness[:, np.newaxis]
    moment = line.mx - y_c * line.z
    return {
        side: WeldForce(
            x=0.5 * line.x + SIGN[side] * line.my / h,
            y=0.5 * line.y - SIGN[side] * moment / h,
            z=0.5 * line.z,
            moment=np.zeros_like(moment),
        )
        for side in sides
    }


def throat_stress(force: WeldForce, throat: Throat, side: Side) -> ThroatStress:
    """Stress in the throat of the weld on one side under its force and moment."""
    a, angle, s = throat.throat, np.radians(throat.angle_deg), SIGN[side]
    cos, sin = np.cos(angle), np.sin(angle)
    return ThroatStress(
        sigma_perp=(cos * force.y + s * sin * force.z) / a,
        tau_perp=(-sin * force.y + s * cos * force.z) / a,
        tau_par=force.x / a,
        bending=s * 6.0 * force.moment / a**2,
    )
