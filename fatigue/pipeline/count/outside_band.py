"""Points of whose stress the spectra miss so much that they say nothing of the life, and the warning of it."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from fatigue.errors import Problem
from fatigue.life.mission import Plan
from fatigue.pipeline.count.result import GroupResult
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.solve.stations import Stations
from fatigue.spectrum.outside import missed_damage

NAMED = 3  # events


@dataclass(slots=True)
class _Worst:
    """An event at the points where it makes most of what the bands miss: how many, and the one with most outside."""

    points: int = 0
    share: float = -1.0
    missed: float = 0.0
    place: str = ""


@dataclass(slots=True, eq=False)
class OutsideBand:
    """Toe points without a life by Dirlik because the bands of the spectra miss too much of their damage.

    ``toes`` are all toe points, ``events`` those to blame.
    """

    toes: int = 0
    events: dict[str, _Worst] = field(default_factory=dict)

    def add(self, stations: Stations, result: GroupResult, plan: Plan) -> None:
        """Take the points of a group of welds in, counted or bounded."""
        self.toes += int(np.count_nonzero(stations.toe))
        has_spectrum = ~np.isnan(result.of_events("damage_dirlik_per_pass")).all(axis=0)
        outside = np.isnan(result.mission.life_km_dirlik) & has_spectrum & stations.toe
        if not outside.any():
            return
        station, face = np.nonzero(outside)
        band, whole, share = (
            np.nan_to_num(result.of_events(name)[:, station, face])
            for name in ("damage_tb_per_pass", "damage_tb_whole_per_pass", "outside_share")
        )
        weights = np.array([one.passes_per_km for one in plan.passes])[:, None]
        blamed = np.argmax(weights * (whole - band), axis=0)
        for event in np.unique(blamed).tolist():
            at = np.flatnonzero(blamed == event)
            most = int(at[np.argmax(share[event, at])])
            worst = self.events.setdefault(plan.passes[event].event, _Worst())
            worst.points += len(at)
            if share[event, most] > worst.share:
                worst.share = float(share[event, most])
                worst.missed = float(missed_damage(band[event, most], whole[event, most]))
                s = station[most]
                worst.place = f"weld '{stations.names[stations.weld[s]]}', node {stations.node[s]}"

    def warnings(self, loads: Sequence[EventLoad]) -> list[Problem]:
        """One warning for all events: what the worst one has above the band, and what to do; none where all is well."""
        if not self.events:
            return []
        worst_first = sorted(self.events.items(), key=lambda item: -item[1].points)
        name, worst = worst_first[0]
        of_load = {load.counted.event: load for load in loads}
        moments = of_load[name].moments
        assert moments is not None
        points = sum(of_event.points for of_event in self.events.values())
        others = [f"'{event}'" for event, _ in worst_first[1 : 1 + NAMED]]
        more = len(worst_first) - 1 - len(others)
        also = f"; also {', '.join(others)}{f' and {more} more' * (more > 0)}" if others else ""
        return [
            Problem(
                "outside_band",
                f"event '{name}'{also}",
                f"stress above upper_hz ({moments.upper_hz:g} Hz) is counted, but in no spectrum: up to "
                f"{100 * worst.share:.2g} % of the variance and {100 * worst.missed:.2g} % of the damage "
                f"({worst.place}); {points} of {self.toes} toe points have no life by Dirlik for that",
                "Raise upper_hz in [spectrum] if this stress is real, keep it out of the simulation if it is noise, or "
                "trust the counted lives only, which contain it either way",
                count=len(self.events),
            )
        ]
