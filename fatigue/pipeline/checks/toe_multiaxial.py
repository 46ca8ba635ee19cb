"""Rows of the check of shear with normal stress at the toe, by the method that the case names."""

import numpy as np

from fatigue.life.mission import Plan, stress_utilisation
from fatigue.pipeline.checks.rows import CheckRows, check_rows
from fatigue.pipeline.count.result import GroupResult
from fatigue.pipeline.multiaxial.found import FACES, MODELS
from fatigue.pipeline.solve.model import Model

IN_WORDS = {
    "range": "half cycles of the path by range",
    "length": "half cycles of the path by range times path factor",
    "mlp": "half cycles of the path by range times 1 + alpha path moment",
    "asme": "cycles of the normal stress with the ASME factor for shear, covariance form",
}


def toe_multiaxial_rows(method: str, model: Model, result: GroupResult, plan: Plan) -> CheckRows:
    """Rows of all toe points of a group of welds; the larger one of two sums decides, as it does about the life."""
    stations, mission, found = model.stations, result.mission, result.multiaxial
    station, face = np.nonzero(stations.toe)
    at = station, face
    utilisation = mission.utilisation[at]
    by_normal = ~(found[method][at] > found["normal"][at])
    of_path = (method in MODELS) & ~by_normal
    event = np.where(of_path, found["event"][at], mission.governing[at])
    names = np.array([*plan.names, ""])
    limit = model.damage_limits(plan.damage_limit)[station]
    curve = np.array([rated.curve.name for rated in model.curve_of_weld])
    return check_rows(
        len(station),
        check="toe_multiaxial",
        weld=np.array(stations.names)[stations.weld[station]],
        part=stations.part[station],
        order=stations.order[station],
        surface=np.array(FACES)[face],
        component=method,
        curve=curve[stations.weld[station]],
        range_max_MPa=found["range_MPa"][at] if method in MODELS else mission.max_range[at],
        damage_per_km=mission.damage_per_km[at],
        damage_sum=utilisation * limit,
        damage_limit=limit,
        utilisation_stress=stress_utilisation(mission.load_factor[at]),
        fulfilled=utilisation <= 1.0,
        governing_event=names[event],
        note=np.where(by_normal, "the normal stress alone does more damage", IN_WORDS[method]),
    )
