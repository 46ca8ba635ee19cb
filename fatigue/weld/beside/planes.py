"""Stress on planes across a plate: of a plane stress state, a normal and a shear stress for each direction.

For a fixed direction both are linear in the stress state, so that they are counted as any other stress is. The largest
principal stress, or one of von Mises, is not: where its direction turns, its range says nothing.
"""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

TOE_DEG = tuple(sorted(range(-60, 61, 5), key=lambda phi: (abs(phi), -phi)))
"""Planes at a toe [deg], those nearest to the weld first: 0, 5, -5 ... 60, -60."""

PARENT_DEG = tuple(range(0, 180, 5))
"""Planes in parent metal, which has no direction of its own [deg]."""


def normal_stress(tensor: Floats, phi_deg: Floats) -> Floats:
    """``sx cos^2 + sy sin^2 + 2 txy sin cos`` on planes (p,) of states (..., 3, c) of sx, sy, txy: (..., p, c).

    >>> normal_stress(np.array([[100.0], [20.0], [30.0]]), np.array([0.0, 90.0])).round(9).ravel().tolist()
    [100.0, 20.0]
    """
    phi = np.deg2rad(phi_deg)
    cos, sin = np.cos(phi), np.sin(phi)
    return np.asarray(np.stack([cos**2, sin**2, 2.0 * sin * cos], axis=-1) @ tensor)


def shear_stress(tensor: Floats, phi_deg: Floats) -> Floats:
    """``-(sx - sy) / 2 sin 2 phi + txy cos 2 phi`` on planes (p,) of states (..., 3, c): (..., p, c).

    >>> shear_stress(np.array([[100.0], [20.0], [30.0]]), np.array([0.0, 45.0])).round(9).ravel().tolist()
    [30.0, -40.0]
    """
    double = 2.0 * np.deg2rad(phi_deg)
    cos, sin = np.cos(double), np.sin(double)
    return np.asarray(np.stack([-0.5 * sin, 0.5 * sin, cos], axis=-1) @ tensor)
