"""Interaction of the damage sums of normal stress and of shear at weld toes."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.case import Interaction
from fatigue.life.interaction import combined_factor
from fatigue.life.mission import Plan, stress_utilisation
from fatigue.pipeline.checks.linear.signals import Signals, counted_mission
from fatigue.pipeline.checks.rows import CheckRows, check_rows, joined
from fatigue.pipeline.count.result import GroupResult
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.multiaxial.method import DECIDING
from fatigue.pipeline.solve.model import Model
from fatigue.pipeline.solve.rated.rated_curves import RatedCurve
from fatigue.pipeline.solve.stations import modal_stress

Floats = NDArray[np.float64]
Rows = NDArray[np.intp]

SURFACES = np.array(["top", "bottom"])
EN1993_LIMIT = 1.0  # EN 1993-1-9:2005, 8(3): the two damage sums together


@dataclass(frozen=True, slots=True, eq=False)
class Counted:
    """One stress at both faces of some stations, over the whole mission; arrays are (n, 2).

    ``u`` is 1 / the largest factor on the stress up to which the damage sum at target_km stays within the limit of the
    rule, ``k`` the smallest slope of the curve, ``governing`` the event with the largest share of the damage.
    """

    damage_per_km: Floats
    u: Floats
    governing: NDArray[np.int64]
    k: float


def weld_interaction(model: Model, result: GroupResult, loads: Sequence[EventLoad], plan: Plan) -> CheckRows:
    """Rows of the interactions at the toes of some welds that have a curve for their shear stress.

    Raises
    ------
    NumericalError : stress or damage exceeds double precision
    """
    rows = []
    for interaction in model.case.checks.interaction:
        for curves, stations in _by_curves(model, interaction).items():
            normal, shear = (model.body.curves[name] for name in curves)
            limit = interaction.damage_limit or EN1993_LIMIT
            own = replace(plan, damage_limit=limit)
            of_normal = _normal(model, result, stations, normal, loads, plan, own)
            of_shear = _shear(model, stations, shear, loads, own)
            rows.append(_rows(model, interaction, stations, curves, of_normal, of_shear, own))
    return joined(rows)


def _by_curves(model: Model, interaction: Interaction) -> dict[tuple[str, str], Rows]:
    """Stations of the welds that an interaction is for, by the names of their curves of normal stress and of shear."""
    own: dict[tuple[str, str], list[int]] = {}
    for i, weld in enumerate(model.welds):
        if weld.curve_shear and (not interaction.welds or weld.name in interaction.welds):
            own.setdefault((weld.curve or model.case.curve.name, weld.curve_shear), []).append(i)
    return {curves: np.flatnonzero(np.isin(model.stations.weld, welds)) for curves, welds in own.items()}


def _normal(
    model: Model,
    result: GroupResult,
    stations: Rows,
    rated: RatedCurve,
    loads: Sequence[EventLoad],
    plan: Plan,
    own: Plan,
) -> Counted:
    """Normal stress under the limit of the rule: as it was assessed, where that was counted and has this limit.

    On one slope the factor follows from the damage sum for any limit. It is counted again where bounds stand for
    counting, where the assessment has shear in its damage, and on other curves under another limit.
    """
    law, limit = rated.rule.law, own.damage_limit
    scales = law.is_straight and rated.rule.yield_of_damage is None
    has_shear = model.case.multiaxial.method in DECIDING
    as_assessed = not result.tier[stations].any() and not has_shear
    if not as_assessed or not (scales or rated.damage_limit(plan.damage_limit) == limit):
        stress = modal_stress(model.stations, stations, rated)
        signals = Signals(stress.membrane, stress.bending, stress.size, stress.rule)
        return _counted(signals, loads, own, "normal stress at the toe")
    mission, k = result.mission, float(law.slopes.min())
    damage = mission.damage_per_km[stations]
    u = (damage * plan.target_km / limit) ** (1.0 / k) if scales else stress_utilisation(mission.load_factor[stations])
    return Counted(damage, u, mission.governing[stations], k)


def _shear(model: Model, stations: Rows, rated: RatedCurve, loads: Sequence[EventLoad], own: Plan) -> Counted:
    """Shear stress at the surface, in the plane and by twist, on its own curve."""
    stress = modal_stress(model.stations, stations, rated)
    signals = Signals(stress.in_plane_shear, stress.twist_shear, stress.size, stress.rule)
    return _counted(signals, loads, own, "shear stress at the toe")


def _counted(signals: Signals, loads: Sequence[EventLoad], own: Plan, names: str) -> Counted:
    mission = counted_mission(signals, loads, own, names)
    k = float(signals.rule.law.slopes.min())
    return Counted(mission.damage_per_km, stress_utilisation(mission.load_factor), mission.governing, k)


def _rows(
    model: Model,
    interaction: Interaction,
    stations: Rows,
    curves: tuple[str, str],
    normal: Counted,
    shear: Counted,
    plan: Plan,
) -> CheckRows:
    """Rows of one rule at the toe points of some stations."""
    own = model.stations
    at, face = np.nonzero(own.toe[stations])
    u_n, u_t = normal.u[at, face], shear.u[at, face]
    per_km = normal.damage_per_km[at, face], shear.damage_per_km[at, face]
    sums = [one * plan.target_km for one in per_km]
    larger = np.where(sums[0] >= sums[1], normal.governing[at, face], shear.governing[at, face])
    common: dict[str, Any] = {
        "check": "interaction",
        "weld": np.array(own.names, dtype=np.str_)[own.weld[stations][at]],
        "part": own.part[stations][at],
        "order": own.order[stations][at],
        "surface": SURFACES[face],
        "component": interaction.rule,
        "curve": " + ".join(curves),
        "governing_event": np.array([*plan.names, ""])[larger],
    }
    if interaction.rule == "iiw":
        assert interaction.cv is not None
        value = u_n**2 + u_t**2
        return check_rows(
            at.size,
            **common,
            damage_limit=plan.damage_limit,
            value=value,
            normal_part=u_n**2,
            shear_part=u_t**2,
            limit_value=interaction.cv,
            utilisation_stress=np.sqrt(value / interaction.cv),
            fulfilled=value <= interaction.cv,
        )
    value = sums[0] + sums[1]
    return check_rows(
        at.size,
        **common,
        damage_per_km=per_km[0] + per_km[1],
        damage_sum=value,
        damage_limit=plan.damage_limit,
        value=value,
        normal_part=sums[0],
        shear_part=sums[1],
        limit_value=plan.damage_limit,
        utilisation_stress=_utilisation(u_n, u_t, sums, plan.damage_limit, normal.k, shear.k),
        fulfilled=value <= plan.damage_limit,
    )


def _utilisation(u_n: Floats, u_t: Floats, sums: Sequence[Floats], limit: float, k_n: float, k_t: float) -> Floats:
    """1 / the factor on all stresses up to which both damage sums together stay within a limit.

    On one slope each it is exact. Else it is the better of two values that are never below it, one from the factor of
    each stress and one from the damage sums as they are.
    """
    from_factors = combined_factor(u_n, k_n, u_t, k_t)
    met = sums[0] + sums[1] <= limit
    from_sums = combined_factor((sums[0] / limit) ** (1.0 / k_n), k_n, (sums[1] / limit) ** (1.0 / k_t), k_t)
    return stress_utilisation(np.where(met, np.maximum(from_factors, 1.0), np.maximum(from_factors, from_sums)))
