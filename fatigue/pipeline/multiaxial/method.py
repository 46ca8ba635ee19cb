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
    mission, toe = result.mission, model.stations.toe
    utilisation = np.fmax(mission.utilisation, result.multiaxial[method])
    governs = utilisation > mission.utilisation
    damage, life, load_factor = mission.damage_per_km.copy(), mission.life_km.copy(), mission.load_factor.copy()
    for weld, rated in enumerate(model.curve_of_weld):
        rows, limit = model.stations.weld == weld, rated.damage_limit(plan.damage_limit)
        by_method = utilisation[rows] * limit / plan.target_km
        damage[rows] = np.where(governs[rows], by_method, damage[rows])
        life[rows] = np.where(governs[rows], life_km(by_method, limit), life[rows])
        law = rated.rule.law
        scales = law.is_straight and rated.rule.yield_of_damage is None
        factor = straight_load_factor(utilisation[rows], float(law.slopes[0])) if scales else np.nan
        load_factor[rows] = np.where(toe[rows], factor, load_factor[rows])
    return result.with_mission(damage_per_km=damage, life_km=life, utilisation=utilisation, load_factor=load_factor)
