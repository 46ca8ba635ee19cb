"""Stress of static load cases at weld toes and at points."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.case import EnduranceCheck
from fatigue.pipeline.solve.body import Body
from fatigue.pipeline.solve.modal_stress import faces
from fatigue.pipeline.solve.model import Model
from fatigue.readers.neutral.endurance.static_cases import CaseGroup
from fatigue.readers.neutral.points.modal_stresses import PointStress
from fatigue.readers.neutral.points.stress_points import StressPoints

Floats = NDArray[np.float64]

SURFACES = np.array(["top", "bottom"])


@dataclass(frozen=True, slots=True, eq=False)
class CaseStress:
    """Stress of the static load cases of a group at n points.

    Attributes
    ----------
    group : the cases
    static : (n, 3) stress of the static cases together, components as in ``COMPONENTS`` [MPa]
    loads : (n, s, 3) stress of the states, or of the alternating loads
    thickness : (n,) [mm], for curves
    place : what names the points: arrays (n,) of columns of ``check_rows``
    """

    group: CaseGroup
    static: Floats
    loads: Floats
    thickness: Floats
    place: Mapping[str, Any]

    def __len__(self) -> int:
        """Count the points."""
        return len(self.static)


def stress_at_welds(model: Model, check: EnduranceCheck) -> CaseStress:
    """Stress of the cases of a check at the toes of the welds that it is for: across the weld, and shear."""
    stations, group = model.stations, model.body.compared.groups[check.cases]
    looked_at = set(check.welds or stations.names)
    asked = np.array([name in looked_at for name in stations.names])
    at, face = np.nonzero(stations.toe & asked[stations.weld][:, None])
    stress, n = stations.treated, np.arange(at.size)
    normal = faces(stress.membrane[at], stress.bending[at])[n, face]
    shear = faces(stress.in_plane_shear[at], stress.twist_shear[at])[n, face]
    modal = np.stack([normal, np.zeros_like(normal), shear], axis=-1)
    place = {
        "weld": np.array(stations.names, dtype=np.str_)[stations.weld[at]],
        "part": stations.part[at],
        "order": stations.order[at],
        "surface": SURFACES[face],
    }
    return CaseStress(group, group.static_of(modal), group.loads_of(modal), stations.thickness[at], place)


def stress_at_points(body: Body, stress: PointStress | None, check: EnduranceCheck) -> CaseStress:
    """Stress of the cases of a check at its points: at each of their surfaces, or as the cases give it.

    ``stress`` is that of the stress points of the body, None without them.
    """
    group = body.compared.groups[check.cases]
    if group.points:
        return _given_stress(body, group, check.points)
    assert body.points is not None
    assert stress is not None
    return _stress_of_points(body.points, group, stress, check.points)


def _stress_of_points(points: StressPoints, group: CaseGroup, stress: PointStress, names: Sequence[str]) -> CaseStress:
    """Stress of the cases at the surfaces of some stress points, from their stress per unit of the coordinates."""
    asked = np.array([points.name.index(name) for name in names])
    which, side = np.nonzero(stress.given[asked])
    at = asked[which]
    modal = np.moveaxis(stress.tensor[at, side], 2, 1)
    place = {
        "point": np.array(points.name, dtype=np.str_)[at],
        "weld": np.array(points.weld, dtype=np.str_)[at],
        "surface": [stress.surface[i][j] for i, j in zip(at, side, strict=True)],
    }
    return CaseStress(group, group.static_of(modal), group.loads_of(modal), points.thickness[at], place)


def _given_stress(body: Body, group: CaseGroup, names: Sequence[str]) -> CaseStress:
    """Stress of cases that is given as it is; a stress point of the same name says the thickness and the weld."""
    static, loads = group.stress_at(names)
    known = {} if body.points is None else {name: i for i, name in enumerate(body.points.name)}
    thickness = [body.points.thickness[known[name]] if body.points and name in known else np.nan for name in names]
    weld = [body.points.weld[known[name]] if body.points and name in known else "" for name in names]
    return CaseStress(group, static, loads, np.array(thickness), {"point": [*names], "weld": weld})
