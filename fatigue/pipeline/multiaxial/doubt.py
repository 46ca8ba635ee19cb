"""What settled the shear at all toes, and the welds that pass or fail as it is counted one way or another."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from fatigue.errors import Problem
from fatigue.pipeline.count.result import GroupResult
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.multiaxial.counted import LONGEST_PATH
from fatigue.pipeline.multiaxial.found import FACES, NULL, STATUSES, VERDICTS, Found
from fatigue.pipeline.solve.stations import Stations
from fatigue.shown import few, shortened

NAMED = 3  # welds
SUMS = ("range", "length", "mlp", "asme")
NOT_COUNTED = "not_counted"


@dataclass(slots=True, eq=False)
class ShearTally:
    """What adds up about shear while groups of welds stream by.

    ``statuses`` counts toe points by what settled them. ``points`` is the number of toe points that fail by some model
    of shear and not by range, in welds that meet their target everywhere; ``welds`` has the largest sum by any model of
    each of these welds, ``places`` where it is, with all sums there.
    """

    statuses: Counter[str] = field(default_factory=Counter)
    points: int = 0
    welds: dict[str, float] = field(default_factory=dict)
    places: dict[str, str] = field(default_factory=dict)

    def add(self, stations: Stations, result: GroupResult) -> None:
        """Take a group of welds in."""
        found, toe = result.multiaxial, stations.toe
        if not found.size:
            return
        for code, name in ((NULL, NOT_COUNTED), *enumerate(STATUSES)):
            if points := int(np.count_nonzero(toe & (found["status"] == code))):
                self.statuses[name] += points
        verdict = found["verdict"]
        fails = toe & ((result.mission.utilisation > 1.0) | (verdict == VERDICTS.index("fails")))
        failing = stations.weld[fails.any(axis=1)]
        doubtful = (verdict == VERDICTS.index("model_dependent")) & ~np.isin(stations.weld, failing)[:, None]
        for station, face in np.argwhere(doubtful).tolist():
            self.points += 1
            self._keep_worst(stations, station, face, found[station, face])

    def _keep_worst(self, stations: Stations, station: int, face: int, point: Found) -> None:
        weld = stations.names[stations.weld[station]]
        sums = {name: float(point[name]) for name in SUMS if not np.isnan(point[name])}
        if max(sums.values()) > self.welds.get(weld, 0.0):
            self.welds[weld] = max(sums.values())
            told = ", ".join(f"{name} {value:.3g}" for name, value in sums.items())
            self.places[weld] = f"{shortened(weld)} (node {stations.node[station]}, {FACES[face]}: {told})"

    def as_text(self) -> str:
        """Toe points by what settled them, in words."""
        told = ", ".join(f"{self.statuses[name]} {name}" for name in (*STATUSES, NOT_COUNTED) if name in self.statuses)
        return told or "not looked at"

    def warnings(self, loads: Sequence[EventLoad]) -> list[Problem]:
        """One warning of each kind for the whole body, none where there is no doubt."""
        found = []
        if self.welds:
            worst = sorted(self.welds, key=lambda weld: -self.welds[weld])
            what = f"{_welds(len(worst))} met by the range of the path of normal stress and shear, and not by its "
            what += f"length, its moment or the ASME factor, at {_toes(self.points)} (Miner sums over the limit): "
            what += "; ".join(self.places[weld] for weld in worst[:NAMED])
            what += f"; and {len(worst) - NAMED} more" if len(worst) > NAMED else ""
            remedy = "Name the method that your standard asks for in [multiaxial]; docs/shear.md tells them apart"
            found.append(Problem("model_dependent", "nodes: multiaxial_verdict", what, remedy, len(worst)))
        if points := self.statuses[NOT_COUNTED]:
            events = [load.counted.event for load in loads if load.counted.q.shape[1] > LONGEST_PATH]
            what = f"at {_toes(points)} a bound leaves open whether shear makes them fail, and their paths were not "
            what += f"counted: records of more than {LONGEST_PATH} samples as they are counted ({few(events)})"
            remedy = "Divide the record into events, or upsample less"
            found.append(Problem("path_too_long", "nodes: multiaxial_status", what, remedy, points))
        return found


def _welds(number: int) -> str:
    return "the target of 1 weld is" if number == 1 else f"the targets of {number} welds are"


def _toes(number: int) -> str:
    return f"{number} toe point{'s' * (number != 1)}"
