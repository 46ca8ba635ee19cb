"""Stress in the throat of fillet welds once more: forces and moments on the plate that ends, set equal to its welds'.

In the frame of the plate, y out of it and z its normal, a weld force (F_x, F_y, F_z) at (y, z) has the moments
``m_x = y F_z - z F_y`` and ``m_y = z F_x`` about the line. The couples of two welds make up the moments of the plate.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

SIDES = {"both": ("top", "bottom"), "top": ("top",), "bottom": ("bottom",)}


def throat_stress(throat: Mapping[str, Any], components: Floats, thickness: float, side: str) -> dict[str, Floats]:
    """``sigma_perp``, ``tau_perp``, ``tau_par`` and ``bending`` at the root (c,) of the weld on one side.

    ``components`` (c, 5) are membrane, bending, in-plane, twist and transverse shear stress in the plate per unit
    coordinate, ``throat`` is the row of the weld in its table.
    """
    t, s = thickness, 1.0 if side == "top" else -1.0
    membrane, bending, in_plane, twist, transverse = components.T
    f = np.stack([in_plane, membrane, transverse]) * t
    m_x, m_y = -bending * t**2 / 6.0, twist * t**2 / 6.0
    normal, along, root = _section(throat, t, s)
    a = throat["throat_mm"]
    y, z = root + along * a / 2.0
    if len(SIDES[throat["sides"]]) == 2:
        lever = t if throat.get("lever") == "t" else 2.0 * abs(z)
        couple = (m_x - y * f[2]) / lever
        F = np.stack([f[0] / 2.0 + s * m_y / lever, f[1] / 2.0 - s * couple, f[2] / 2.0])
        own = np.zeros_like(m_x)
    else:
        F, own = f, m_x - (y * f[2] - z * f[1])
    return {
        "sigma_perp": (normal[0] * F[1] + normal[1] * F[2]) / a,
        "tau_perp": (along[0] * F[1] + along[1] * F[2]) / a,
        "tau_par": F[0] / a,
        "bending": s * 6.0 * own / a**2,
    }


def _section(throat: Mapping[str, Any], t: float, s: float) -> tuple[Floats, Floats, Floats]:
    """Normal of the throat, direction from its root to its face, and root, in (y, z)."""
    joint, half = throat["joint"], np.sqrt(0.5)
    offset, e = throat["line_offset_mm"], throat["penetration_mm"]
    if joint == "tee":
        return np.array([half, s * half]), np.array([-half, s * half]), np.array([offset, s * (t / 2.0 - e)])
    if joint == "lap":
        return np.array([half, -s * half]), np.array([half, s * half]), np.array([offset - e, -s * t / 2.0])
    angle = np.deg2rad(throat["angle_deg"])
    normal = np.array([np.cos(angle), s * np.sin(angle)])
    along = np.array([-np.sin(angle), s * np.cos(angle)])
    return normal, along, np.array([throat["root_y_mm"], s * throat["root_z_mm"]])
