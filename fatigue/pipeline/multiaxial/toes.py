"""Points of one curve in a group of welds, with what the count of their normal stress has found."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.life.mission import Plan
from fatigue.pipeline.count.result import GroupResult
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.multiaxial.counted import Point
from fatigue.pipeline.solve.modal_stress import ModalStress

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Toes:
    """Stations of a group of welds that share a curve; arrays are (n, 2), top and bottom face, (e, n, 2) per event.

    Attributes
    ----------
    stress : modal stress of the stations, and the rule of their curve
    toe : faces that carry a weld toe
    counted : (n,) stations whose cycles of normal stress were counted; bounds stand for the others
    normal : Miner sum by normal stress at the target, over the limit; or a bound of it
    transitions : the part of it from cycles across events, 0 without sequences
    with_shear : the sum with the ASME factor for shear, NaN at stations that were not counted
    normal_range : largest range of the normal stress in each event [MPa], or a bound of it
    normal_mean : its mean in each event, constants included [MPa]
    of_events : damage of one pass by normal stress, or a bound of it
    largest : largest equivalent range of the normal stress in each event, or a bound of it
    """

    stress: ModalStress
    toe: NDArray[np.bool_]
    counted: NDArray[np.bool_]
    normal: Floats
    transitions: Floats
    with_shear: Floats
    normal_range: Floats
    normal_mean: Floats
    of_events: Floats
    largest: Floats

    def point(self, station: int, face: int) -> Point:
        """What the path counter needs of a face."""
        stress = self.stress
        parts = (stress.membrane, stress.bending, stress.in_plane_shear, stress.twist_shear)
        return Point(np.stack([part[station] for part in parts]), face, float(stress.size[station]), stress.rule)


def toes_of(
    stress: ModalStress, toe: NDArray[np.bool_], result: GroupResult, rows: NDArray[np.intp], plan: Plan
) -> Toes:
    """The stations ``rows`` of a group of welds, which share a curve."""
    mission, of_target = result.mission, plan.target_km / plan.damage_limit
    transitions = np.nan_to_num(mission.transitions[rows]) * of_target
    return Toes(
        stress=stress,
        toe=toe[rows],
        counted=result.tier[rows] == 0,
        normal=mission.utilisation[rows],
        transitions=transitions,
        with_shear=mission.damage_with_shear[rows] * of_target + transitions,
        normal_range=result.of_events("max_range_MPa")[:, rows],
        normal_mean=result.of_events("mean_stress_MPa")[:, rows],
        of_events=result.of_events("damage_per_pass")[:, rows],
        largest=result.of_events("max_equivalent_range_dS")[:, rows],
    )


def passes_at_target(plan: Plan) -> Floats:
    """Passes of every event up to the target over the limit of the Miner sum, (e,)."""
    per_km = np.array([one.passes_per_km for one in plan.passes])
    return np.asarray(per_km * plan.target_km / plan.damage_limit)


def weights_of(stress: ModalStress, station: NDArray[np.intp], face: NDArray[np.intp], load: EventLoad) -> Floats:
    """Normal stress and shear (2, k, m) of some faces per unit coordinate, the factor of an event included [MPa]."""
    side = np.where(face == 0, 1.0, -1.0)[:, None]
    normal = stress.membrane[station] + side * stress.bending[station]
    shear = stress.in_plane_shear[station] + side * stress.twist_shear[station]
    return load.stress_factor * np.stack([normal, shear])
