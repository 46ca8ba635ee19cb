"""What the variants need of the stations of one curve in a group of welds."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from fatigue.case import Case
from fatigue.life.mission import Plan
from fatigue.pipeline.count.block import Block
from fatigue.pipeline.count.bounds import Screening
from fatigue.pipeline.count.group import weld_names
from fatigue.pipeline.count.mission_block import MissionBlock
from fatigue.pipeline.count.modal_bound import bounded_raw_ends
from fatigue.pipeline.count.result import GroupResult
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.multiaxial.found import Found
from fatigue.pipeline.sensitivity.closed import Floats
from fatigue.pipeline.solve.modal_stress import ModalStress
from fatigue.pipeline.solve.model import Model
from fatigue.pipeline.solve.rated.rated_curves import RatedCurve
from fatigue.pipeline.solve.stations import modal_stress


@dataclass(frozen=True, slots=True, eq=False)
class Toes:
    """The n stations of one curve in a group of welds.

    Attributes
    ----------
    case, plan, rated : how they were assessed
    welds : (w,) numbers of their welds in the group
    rows : (n,) their numbers in the group, ascending
    first : (w + 1,) first station of each weld, and n
    toe : (n, 2) faces that carry a weld toe
    counted : (n, 2) where cycles were counted; elsewhere a bound stands for them
    mission : the whole mission
    stress, thickness : modal stress, and thickness [mm]
    samples_per_peak : (n, 2) the fewest of all events that damage
    shear : (n, 2) what shear adds, ``multiaxial.found``; None where the case wants none of it
    raw_end_bound : (n, 2) what the utilisation of a raw end does not exceed where it was not counted
    """

    case: Case
    plan: Plan
    rated: RatedCurve
    welds: NDArray[np.intp]
    rows: NDArray[np.intp]
    first: NDArray[np.intp]
    toe: NDArray[np.bool_]
    counted: NDArray[np.bool_]
    mission: MissionBlock
    stress: ModalStress
    thickness: Floats
    samples_per_peak: Floats
    shear: Found | None
    raw_end_bound: Floats

    @property
    def utilisation(self) -> Floats:
        """Utilisation (n, 2) as it was assessed, or a bound of it."""
        return self.mission.utilisation


def toes_of_curve(
    model: Model, result: GroupResult, plan: Plan, loads: Sequence[EventLoad], screening: Screening | None
) -> Iterator[Toes]:
    """The stations of every curve of a group of welds."""
    stations = model.stations
    for rated, rows in model.by_curve():
        welds = np.unique(stations.weld[rows])
        stress, own_plan = modal_stress(stations, rows, rated), rated.plan(plan)
        bound = np.full((len(rows), 2), np.inf)
        ends = stress.raw_ends.rows
        if screening is not None and ends.size:
            names = weld_names(stations, rows)
            block = Block(stress, stations.weld[rows], stations.toe[rows], loads, own_plan, names)
            bound[ends] = bounded_raw_ends(block, screening)
        yield Toes(
            case=model.case,
            plan=own_plan,
            rated=rated,
            welds=welds,
            rows=rows,
            first=np.searchsorted(stations.weld[rows], [*welds, len(stations.welds)]),
            toe=stations.toe[rows],
            counted=np.repeat(result.tier[rows, None] == 0, 2, axis=1),
            mission=_at(result.mission, rows),
            stress=stress,
            thickness=stations.thickness[rows],
            samples_per_peak=_fewest(result, rows),
            shear=result.multiaxial[rows] if result.multiaxial.size else None,
            raw_end_bound=bound,
        )


def _at(mission: MissionBlock, rows: NDArray[np.intp]) -> MissionBlock:
    """The whole mission at some stations."""
    return replace(mission, **{name: getattr(mission, name)[rows] for name in MissionBlock.__dataclass_fields__})


def _fewest(result: GroupResult, rows: NDArray[np.intp]) -> Floats:
    """The fewest samples per peak (n, 2) of the events that damage; +inf where none does."""
    samples = result.of_events("samples_per_peak")[:, rows]
    damages = result.of_events("damage_per_pass")[:, rows] > 0.0
    return np.asarray(np.where(damages & ~np.isnan(samples), samples, np.inf).min(axis=0))
