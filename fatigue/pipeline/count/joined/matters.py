"""Points at which an order of events that is not known may matter, and the warning of it."""

from dataclasses import dataclass, field

import numpy as np

from fatigue.errors import Problem
from fatigue.life.mission import Plan
from fatigue.pipeline.count.result import GroupResult
from fatigue.pipeline.solve.stations import Stations
from fatigue.shown import few

MATTERS = 0.05  # of the damage; like events in turn add less than a thousandth, empty and laden ones far more
NAMED = 3  # welds


@dataclass(slots=True, eq=False)
class Transitions:
    """Toe points that were counted, ``toes`` of them, and those where another order may add more than ``MATTERS``.

    ``welds`` has the largest share of the damage at each weld that has such ``points``; ``places`` says where it is.
    """

    toes: int = 0
    points: int = 0
    welds: dict[str, float] = field(default_factory=dict)
    places: dict[str, str] = field(default_factory=dict)

    def add(self, stations: Stations, result: GroupResult) -> None:
        """Take a group of welds in; a point that a bound has settled has no damage to compare with."""
        bound, damage = result.mission.transitions_bound, result.mission.damage_per_km
        looked_at = stations.toe & (result.tier == 0)[:, None] & ~np.isnan(bound)
        self.toes += int(np.count_nonzero(looked_at))
        station, face = np.nonzero(looked_at & (np.nan_to_num(bound) > MATTERS * damage))
        self.points += len(station)
        for s, f in zip(station.tolist(), face.tolist(), strict=True):
            weld = stations.names[stations.weld[s]]
            share = float(bound[s, f] / damage[s, f]) if damage[s, f] > 0.0 else np.inf
            if share > self.welds.get(weld, 0.0):
                self.welds[weld], self.places[weld] = share, f"node {stations.node[s]}"

    def warnings(self, plan: Plan) -> list[Problem]:
        """One warning for the whole body; none where no order of the events can matter."""
        if not self.welds:
            return []
        worst = sorted(self.welds, key=lambda weld: -self.welds[weld])
        listed = [f"{weld} ({self.places[weld]}, {_percent(self.welds[weld])})" for weld in worst]
        events = [one.event for one in plan.passes if one.stints_per_1000_km is not None]
        what = f"the order of {len(events)} events ({few(events)}) is not known, and at {self.points} of {self.toes} "
        what += f"counted toe points cycles across them may add more than {MATTERS:.0%} of the damage, which is not in "
        what += f"the lives: {few(listed, NAMED)}"
        remedy = "Give the order in [[mission.sequence]]; damage_per_km_transitions_bound has the bound of every point"
        return [Problem("transitions_matter", "mission.event: stints_per_1000_km", what, remedy, len(self.welds))]


def _percent(share: float) -> str:
    return f"up to {share:.0%}" if np.isfinite(share) else "no damage otherwise"
