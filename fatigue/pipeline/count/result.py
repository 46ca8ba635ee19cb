"""The result of a group of welds as few arrays, to be stored or sent: what its rows in the tables need."""

from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from operator import attrgetter
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from fatigue.pipeline.count.block import Settled
from fatigue.pipeline.count.event_block import EventBlock
from fatigue.pipeline.count.joined.loops import LoopBlock
from fatigue.pipeline.count.mission_block import MissionBlock

OF_EVENT: dict[str, Callable[[EventBlock], NDArray[np.float64]]] = {  # columns of damage.parquet, from one pass
    "damage_per_pass": attrgetter("count.damage"),
    "damage_dirlik_per_pass": attrgetter("estimate.dirlik"),
    "damage_tb_per_pass": attrgetter("estimate.tb"),
    "damage_tb_whole_per_pass": attrgetter("estimate.tb_whole"),
    "damage_same_ratio_per_pass": attrgetter("count.damage_same_ratio"),
    "cycles_per_pass": attrgetter("count.cycles"),
    "max_range_MPa": attrgetter("count.max_range"),
    "max_equivalent_range_dS": attrgetter("count.max_equivalent_range"),
    "bending_ratio": attrgetter("estimate.bending_ratio"),
    "mean_stress_MPa": attrgetter("estimate.mean"),
    "kurtosis": attrgetter("count.kurtosis"),
    "outside_share": attrgetter("estimate.outside_share"),
    "irregularity": attrgetter("estimate.irregularity"),
    "peaks_per_s": attrgetter("estimate.peaks_per_s"),
    "samples_per_peak": attrgetter("estimate.samples_per_peak"),
}
OF_LOOP: dict[str, Callable[[LoopBlock], NDArray[np.float64]]] = {  # the same, from one run of a loop
    "damage_per_pass": attrgetter("count.damage"),
    "cycles_per_pass": attrgetter("count.cycles"),
    "max_range_MPa": attrgetter("count.max_range"),
    "max_equivalent_range_dS": attrgetter("count.max_equivalent_range"),
}
_OF_MISSION = tuple(f.name for f in fields(MissionBlock) if f.name not in ("governing", "verdict"))


@dataclass(frozen=True, slots=True, eq=False)
class GroupResult:
    """Results of the n stations of one group of welds under e events, in the order of its stations.

    Attributes
    ----------
    event_columns : (e, c, n, 2) the columns of ``OF_EVENT`` for every event
    loop_columns : (l, c, n, 2) the columns of ``OF_LOOP`` for every loop
    verdicts : (e, n, 2) the verdict of every event
    of_mission : (f, n, 2) the fields of the ``MissionBlock`` but the two that follow
    governing, verdict : (n, 2) of the mission
    tier : (n,) index into ``block.TIERS``, 0 where cycles were counted
    multiaxial : (n, 2) what shear adds, ``multiaxial.found``; (0, 2) where the case wants none of it
    checks : rows of the other checks of these welds, ``checks.rows``; none unless the case asks for them
    sensitivity : (v, w, f) every weld under every variant, ``sensitivity.group``
    """

    event_columns: NDArray[np.float64]
    loop_columns: NDArray[np.float64]
    verdicts: NDArray[np.int8]
    of_mission: NDArray[np.float64]
    governing: NDArray[np.int64]
    verdict: NDArray[np.int8]
    tier: NDArray[np.int8]
    multiaxial: NDArray[Any]
    checks: NDArray[Any]
    sensitivity: NDArray[np.float64]

    @classmethod
    def empty(cls, events: int, stations: int, loops: int = 0) -> Self:
        """Room for the result of so many stations under so many events and loops of them."""
        return cls(
            event_columns=np.empty((events, len(OF_EVENT), stations, 2)),
            loop_columns=np.empty((loops, len(OF_LOOP), stations, 2)),
            verdicts=np.empty((events, stations, 2), np.int8),
            of_mission=np.empty((len(_OF_MISSION), stations, 2)),
            governing=np.empty((stations, 2), np.int64),
            verdict=np.empty((stations, 2), np.int8),
            tier=np.empty(stations, np.int8),
            multiaxial=np.empty((0, 2)),
            checks=np.empty(0),
            sensitivity=np.empty((0, 0, 0)),
        )

    def of_events(self, column: str) -> NDArray[np.float64]:
        """A column of ``OF_EVENT`` for every event: a view, (e, n, 2)."""
        return self.event_columns[:, list(OF_EVENT).index(column)]

    @property
    def mission(self) -> MissionBlock:
        """All events together: views of the arrays."""
        numbers = dict(zip(_OF_MISSION, self.of_mission, strict=True))
        return MissionBlock(**numbers, governing=self.governing, verdict=self.verdict)

    def with_mission(self, **changed: NDArray[np.float64]) -> Self:
        """The same result with other numbers (n, 2) in some fields of its mission."""
        of_mission = self.of_mission.copy()
        for name, numbers in changed.items():
            of_mission[_OF_MISSION.index(name)] = numbers
        return replace(self, of_mission=of_mission)

    def put(self, settled: Settled, rows: NDArray[np.intp]) -> None:
        """Write what was settled to its rows."""
        for e, event in enumerate(settled.events):
            for c, column in enumerate(OF_EVENT.values()):
                self.event_columns[e, c, rows] = column(event)
            self.verdicts[e, rows] = event.verdict
        for number, loop in enumerate(settled.loops):
            for c, of_loop in enumerate(OF_LOOP.values()):
                self.loop_columns[number, c, rows] = of_loop(loop)
        for f, name in enumerate(_OF_MISSION):
            self.of_mission[f, rows] = getattr(settled.mission, name)
        self.governing[rows], self.verdict[rows] = settled.mission.governing, settled.mission.verdict
        self.tier[rows] = settled.tier


def arrays_of(result: GroupResult) -> dict[str, NDArray[Any]]:
    """Arrays of a result by name; ``GroupResult(**arrays)`` makes the result again."""
    return {field.name: getattr(result, field.name) for field in fields(GroupResult)}
