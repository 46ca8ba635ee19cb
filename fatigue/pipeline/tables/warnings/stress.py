"""Stress ranges that no metal bears, and ranges next to nothing everywhere: forces or coordinates in another unit.

The largest range of the body is explained: the two instants it lies between, the mode that makes most of it, and
whether a single sample does.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import Problem
from fatigue.life.records.history import stress_history
from fatigue.pipeline.count.result import GroupResult
from fatigue.pipeline.count.worst import WorstPoint
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.solve.model import Model
from fatigue.pipeline.tables.cycle_rows import KeptPoint, kept_point
from fatigue.pipeline.tables.rows import FACES
from fatigue.readers.neutral.body.coordinates import Coordinates
from fatigue.shown import few, shortened

MOST = 3000.0  # [MPa] twice the yield strength of the strongest steels that are welded, 1500 MPa
LEAST = 0.1  # [MPa] a thousandth of what makes a weld fail within a vehicle's life
SPIKE = 0.5  # of the range: a sample that stands so far from both of its neighbours is alone
FEWEST = 5  # samples, below which a record is a load case typed in by hand


@dataclass(slots=True, eq=False)
class StressExtent:
    """The largest stress range of a body, found while groups of welds stream by.

    Attributes
    ----------
    largest : the largest range of any point in any event [MPa], a bound where a point was not counted
    point, event : the point with the largest range that was counted, and the number of its event; None before the first
    counted : that range [MPa]
    points : number of points with a range above ``MOST``
    welds : their welds
    """

    largest: float = 0.0
    point: KeptPoint | None = None
    event: int = 0
    counted: float = 0.0
    points: int = 0
    welds: dict[str, float] | None = None

    def add(self, model: Model, result: GroupResult) -> None:
        """Take in a group of welds and its result."""
        ranges = np.nan_to_num(result.of_events("max_range_MPa"))  # (e, n, 2)
        self.largest = max(self.largest, float(ranges.max(initial=0.0)))
        ranges = np.where(result.tier[:, np.newaxis] == 0, ranges, 0.0)
        beyond = ranges.max(axis=0) > MOST
        if not beyond.any():
            return
        stations = model.stations
        self.points += int(np.count_nonzero(beyond))
        self.welds = self.welds or {}
        for i in np.unique(stations.weld[beyond.any(axis=1)]).tolist():
            self.welds[stations.names[i]] = float(ranges[:, stations.weld == i].max())
        event, station, face = (int(i) for i in np.unravel_index(int(ranges.argmax()), ranges.shape))
        if ranges[event, station, face] > self.counted:
            self.counted, self.event = float(ranges[event, station, face]), event
            self.point = kept_point(model, WorstPoint(int(stations.weld[station]), station, face))

    def warnings(self, loads: Sequence[EventLoad], coordinates: Coordinates, files: Sequence[str]) -> list[Problem]:
        """Warnings about the stress ranges of the whole body; ``files`` hold the records of the events."""
        if self.point is not None and self.welds is not None:
            ordered = sorted(self.welds, key=lambda name: -(self.welds or {})[name])
            return [_beyond_metal_doubt(self, self.point, ordered, loads[self.event], coordinates, files[self.event])]
        if not 0.0 < self.largest < LEAST:
            return []
        what = f"no stress range of the body is above {self.largest:.2g} MPa, where {LEAST:g} MPa does no damage yet"
        remedy = "Check the units of forces and modal coordinates: N, mm and MPa"
        return [Problem("hardly_any_stress", "max_range_MPa", what, remedy)]


def _beyond_metal_doubt(
    extent: StressExtent, point: KeptPoint, welds: Sequence[str], load: EventLoad, coordinates: Coordinates, file: str
) -> Problem:
    """Warning about the largest range: its point, event, instants and mode."""
    sign = 1.0 if point.face == 0 else -1.0
    modal = load.stress_factor * (point.membrane + sign * point.bending)
    q = load.counted.q
    stress = stress_history(modal[np.newaxis], q)[0]
    high, low = int(stress.argmax()), int(stress.argmin())
    change = modal * (q[:, high : high + 1].astype(np.float64) - q[:, low : low + 1])[:, 0]
    mode = int(np.abs(change).argmax())
    column, name_of_mode = coordinates.column[mode], coordinates.name(int(coordinates.number[mode]))
    at = [load.counted.start + load.counted.step * i for i in (high, low)]
    name = shortened(load.counted.event)
    what = f"the stress range is {extent.counted:.4g} MPa, no metal bears {MOST:g}: node {point.node}, "
    what += f"{FACES[point.face]} face, event '{name}', from {at[1]:.6g} s to {at[0]:.6g} s, {name_of_mode} makes "
    what += f"{change[mode] / change.sum():.0%} of it"
    what += f"; {extent.points} points of {few(welds)} are above" if extent.points > 1 else ""
    alone = [i for i in (high, low) if _stands_alone(stress, i)]
    if alone:
        when = load.counted.start + load.counted.step * alone[0]
        what += f"; the sample at {when:.6g} s stands alone"
        remedy = f"Look at {column} there in {file}: this looks like one damaged value"
    else:
        remedy = "Check the units of forces, coordinates of the modes and thickness (N, mm, MPa), and the mode's scale"
    return Problem("stress_beyond_metal", f"weld {point.weld}", what, remedy, extent.points)


def _stands_alone(stress: NDArray[np.float64], at: int) -> bool:
    """Whether a sample lies far from both of its neighbours."""
    if stress.size < FEWEST:
        return False
    around = stress[[at - 1, (at + 1) % stress.size]]
    return bool(np.abs(stress[at] - around).min() > SPIKE * (stress.max() - stress.min()))
