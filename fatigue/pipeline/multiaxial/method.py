"""The method that a case names for shear at the toe: the larger of two damage sums decides about life and verdict."""

import numpy as np

from fatigue.life.mission import Plan, life_km, straight_load_factor
from fatigue.pipeline.count.result import GroupResult
from fatigue.pipeline.multiaxial.found import MODELS
from fatigue.pipeline.solve.model import Model

DECIDING = (*MODELS, "asme")


def decided_by(method: str, model: Model, result: GroupResult, plan: Plan) -> GroupResult:
    """The result of a group of welds with damage, life, utilisation and load factor by the method, where it is worse.

    On a straight curve without mean stress all ranges, lengths and moments scale with the load, so the load factor
    follows from the larger sum; else there is none (NaN).
    """
    mission, of_method = result.mission, result.multiaxial[method]
    utilisation = np.fmax(mission.utilisation, of_method)
    governs = utilisation > mission.utilisation
    damage = np.where(governs, utilisation * plan.damage_limit / plan.target_km, mission.damage_per_km)
    load_factor = mission.load_factor.copy()
    toe = model.stations.toe
    for weld, rated in enumerate(model.curve_of_weld):
        law, rows = rated.rule.law, model.stations.weld == weld
        straight = law.is_straight and rated.rule.yield_of_damage is None
        factor = straight_load_factor(utilisation[rows], float(law.slopes[0])) if straight else np.nan
        load_factor[rows] = np.where(toe[rows], factor, load_factor[rows])
    return result.with_mission(
        damage_per_km=damage,
        life_km=np.where(governs, life_km(damage, plan.damage_limit), mission.life_km),
        utilisation=utilisation,
        load_factor=load_factor,
    )
