"""What a strain gauge makes of the stress under it: strain along its grid, transverse sensitivity, bridges.

Sources: measured_data.md 1.2, 1.6; plane stress on a free surface. Tension is positive.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

CALIBRATED_ON_NU = 0.285  # of the steel on which makers calibrate gauge factors
MICRO = 1e6
MICROSTRAIN = "µε"  # the unit on a page; ue in tables and files


def normal_stress(stress: Floats, angle_deg: float) -> Floats:
    """Normal stress in a direction [MPa], of s_xx, s_yy, s_xy (3, ...) and the angle from x towards y [deg].

    >>> float(normal_stress(np.array([5.0, 0.0, 0.0]), 60.0).round(9))
    1.25
    """
    c, s = _cos_sin(angle_deg)
    return np.asarray(stress[0] * c * c + stress[1] * s * s + 2.0 * stress[2] * s * c)


def normal_strain(stress: Floats, angle_deg: float, E: float, nu: float) -> Floats:
    """Strain in a direction [ue] under plane stress s_xx, s_yy, s_xy (3, ...) [MPa].

    >>> normal_strain(np.array([5.0, 0.0, 0.0]), 45.0, 70000.0, 0.3).round(6)
    np.float64(25.0)
    """
    c, s = _cos_sin(angle_deg)
    e_xx = (stress[0] - nu * stress[1]) / E
    e_yy = (stress[1] - nu * stress[0]) / E
    g_xy = 2.0 * (1.0 + nu) * stress[2] / E
    return np.asarray(MICRO * (e_xx * c * c + e_yy * s * s + g_xy * s * c))


def grid_reading(along: Floats, across: Floats, transverse_sensitivity: float) -> Floats:
    """Strain that a grid shows [ue], of the strains along and across it and its transverse sensitivity K_t [-].

    ``(e_a + K_t e_t) / (1 - nu_0 K_t)``: its gauge factor is that in uniaxial stress on steel of nu_0 = 0.285.

    >>> float(grid_reading(np.array(100.0), np.array(-30.0), 0.01).round(7))
    99.9849571
    """
    K_t = transverse_sensitivity
    return np.asarray((along + K_t * across) / (1.0 - CALIBRATED_ON_NU * K_t))


def strain_reading(stress: Floats, angle_deg: float, E: float, nu: float, transverse_sensitivity: float) -> Floats:
    """Strain that a grid in a direction shows [ue] under plane stress (3, ...) [MPa]."""
    along, across = (normal_strain(stress, angle_deg + turn, E, nu) for turn in (0.0, 90.0))
    return grid_reading(along, across, transverse_sensitivity)


def bridge(rows: Floats, names: Sequence[str], weights: Sequence[tuple[str, float]]) -> Floats:
    """Weighted sum of the rows (g, ...) of some gauges by name: what a bridge of several grids reads.

    A full bridge on a beam in bending, two grids on either face:

    >>> bridge(np.array([[100.0], [-100.0]]), ["top", "bottom"], [("top", 2.0), ("bottom", -2.0)])
    array([400.])

    Raises
    ------
    ValueError : a gauge that is not among the names
    """
    place = {name: i for i, name in enumerate(names)}
    if unknown := [name for name, _ in weights if name not in place]:
        raise ValueError(f"no gauge {unknown[0]!r}")
    return np.asarray(sum(weight * rows[place[name]] for name, weight in weights))


def _cos_sin(angle_deg: float) -> tuple[float, float]:
    angle = np.deg2rad(angle_deg)
    return float(np.cos(angle)), float(np.sin(angle))
