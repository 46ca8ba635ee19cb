"""Welds that pass or fail as shear is counted one way or another, and the warning of them."""

from dataclasses import dataclass, field

import numpy as np

from fatigue.errors import Problem
from fatigue.pipeline.count.result import GroupResult
from fatigue.pipeline.multiaxial.found import FACES, VERDICTS
from fatigue.pipeline.solve.stations import Stations
from fatigue.shown import shortened

NAMED = 3  # welds
SUMS = ("range", "length", "mlp", "asme")


@dataclass(slots=True, eq=False)
class ModelDoubt:
    """Welds that meet their target everywhere, and at a toe do not by another model of shear.

    ``welds`` has the largest sum by any model of each; ``places`` says where it is, and all sums there; ``points`` is
    the number of such toe points.
    """

    points: int = 0
    welds: dict[str, float] = field(default_factory=dict)
    places: dict[str, str] = field(default_factory=dict)

    def add(self, stations: Stations, result: GroupResult) -> None:
        """Take a group of welds in."""
        found = result.multiaxial
        if not found.size:
            return
        fails = (
            stations.toe & ((result.mission.utilisation > 1.0) | (found["verdict"] == VERDICTS.index("fails")))
        ).any(axis=1)
        failing = np.unique(stations.weld[fails])
        doubtful = (found["verdict"] == VERDICTS.index("model_dependent")) & ~np.isin(stations.weld, failing)[:, None]
        for s, f in np.argwhere(doubtful).tolist():
            self.points += 1
            point, weld = found[s, f], stations.names[stations.weld[s]]
            sums = {name: float(point[name]) for name in SUMS if not np.isnan(point[name])}
            if max(sums.values()) > self.welds.get(weld, 0.0):
                self.welds[weld] = max(sums.values())
                told = ", ".join(f"{name} {value:.3g}" for name, value in sums.items())
                self.places[weld] = f"{shortened(weld)} (node {stations.node[s]}, {FACES[f]}: {told})"

    def warnings(self) -> list[Problem]:
        """One warning for the whole body; none where no weld is in doubt."""
        if not self.welds:
            return []
        worst = sorted(self.welds, key=lambda weld: -self.welds[weld])
        what = f"{len(worst)} weld{'s' * (len(worst) > 1)} ({self.points} toe points) meet the target by the range of "
        what += "the path of normal stress and shear, and not by its length, its moment or the ASME factor (Miner sums "
        what += f"over the limit): {'; '.join(self.places[weld] for weld in worst[:NAMED])}"
        what += f" and {len(worst) - NAMED} more" if len(worst) > NAMED else ""
        remedy = (
            "Decide on the method your standard asks for and name it in [multiaxial]; docs/shear.md tells them apart"
        )
        return [Problem("model_dependent", "nodes.parquet: multiaxial_verdict", what, remedy, len(worst))]
