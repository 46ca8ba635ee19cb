"""Stress under a gauge from the tables of stress points: as the FE program gave it, in the frame of the point."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem
from fatigue.gauges.gauge_file import Gauge
from fatigue.readers.neutral.points.modal_stresses import PointStress
from fatigue.readers.neutral.points.stress_points import AT_TOE, StressPoints
from fatigue.weld.beside.hot_spot import EDGE

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class AtPoint:
    """Stress at a stress point, where it is, and whether it is extrapolated to a toe: then nothing can be mounted.

    Attributes
    ----------
    stress : (3, c) s_xx, s_yy, s_xy in the frame [MPa]
    axes : (3, 3) x, y, z as rows: the direction of the stress, across it, outward
    xyz : (3,) [mm]
    thickness : of the plate [mm]
    stand_in : it is the stress at a toe
    """

    stress: Floats
    axes: Floats
    xyz: Floats
    thickness: float
    stand_in: bool


def at_point(gauge: Gauge, points: StressPoints | None, stress: PointStress | None, where: str) -> AtPoint:
    """Stress at the point of a gauge, that of its own name where it names none; ``where``: name of the case file.

    The axes of a point are e1, normal x e1 and the normal of the top side, on both faces; on the edge of a plate, where
    stress is along e1 alone, e1, normal and what points out of the edge.

    Raises
    ------
    DataError : there is no such point, or no stress on this surface of it
    """
    if points is None or stress is None:
        what = "it is of kind table, and the case has no stress points"
        raise DataError(Problem("no_points", gauge.where, what, f"Give stress_points and modal_stresses in {where}"))
    name = gauge.point or gauge.name
    if name not in points.name:
        what = f"there is no stress point {name!r} in {points.file}"
        raise DataError(Problem("unknown_id", gauge.where, what, "Correct point, or add it there with its stresses"))
    p = points.name.index(name)
    surfaces = [face for face, there in zip(stress.surface[p], stress.given[p], strict=True) if there]
    if gauge.surface not in surfaces:
        what = f"stress point {name!r} has no stress on surface {gauge.surface}, but on {' and '.join(surfaces)}"
        raise DataError(Problem("surface", gauge.where, what, "Correct surface"))
    face = stress.surface[p].index(gauge.surface)
    e1, normal = points.e1[p], points.normal[p]
    across = np.cross(normal, e1)
    axes = np.stack([e1, normal, -across] if points.kind[p] == EDGE else [e1, across, normal])
    return AtPoint(
        stress=stress.tensor[p, face],
        axes=axes,
        xyz=points.xyz[p],
        thickness=float(points.thickness[p]),
        stand_in=points.kind[p] in AT_TOE,
    )
