"""Points of whose stress the spectra miss so much that they say nothing of the life, and the warning of it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import Problem
from fatigue.life.mission import Plan
from fatigue.pipeline.count.result import GroupResult
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.solve.stations import Stations
from fatigue.spectrum.outside import in_percent, missed_damage
from fatigue.spectrum.trust import VERDICTS

NAMED = 3  # events


@dataclass(frozen=True, slots=True, eq=False)
class Spectral:
    """What the spectrum of an event says of some stations: its passes per km, and arrays (n, 2).

    ``band`` and ``whole`` are damages of a pass by Tovo-Benasciutti of the band and of all of the spectrum, ``share``
    is the share of the variance above the band.
    """

    weight: float
    band: NDArray[np.float64]
    whole: NDArray[np.float64]
    share: NDArray[np.float64]


@dataclass(slots=True)
class _Worst:
    """An event at the points where it makes most of what the bands miss: how many, and the one with most outside."""

    points: int = 0
    share: float = -1.0
    missed: float = 0.0
    place: str = ""


@dataclass(slots=True, eq=False)
class OutsideBand:
    """Toe points of whose damage the bands of the spectra miss too much.

    ``toes`` are all toe points, ``events`` those to blame.
    """

    toes: int = 0
    events: dict[str, _Worst] = field(default_factory=dict)

    def add(self, stations: Stations, outside: NDArray[np.bool_], spectra: Mapping[str, Spectral]) -> None:
        """Take some stations in, which of their points are ``outside``, (n, 2), and the ``spectra`` of each event."""
        self.toes += int(np.count_nonzero(stations.toe))
        station, face = np.nonzero(outside & stations.toe)
        if not station.size:
            return
        missed = [np.nan_to_num(of.weight * (of.whole - of.band)[station, face]) for of in spectra.values()]
        blamed = np.argmax(missed, axis=0)
        for number, (event, of) in enumerate(spectra.items()):
            at = np.flatnonzero(blamed == number)
            if not at.size:
                continue
            share = of.share[station[at], face[at]]
            s, f = station[at[np.argmax(share)]], face[at[np.argmax(share)]]
            worst = self.events.setdefault(event, _Worst())
            worst.points += len(at)
            if share.max() > worst.share:
                worst.share = float(share.max())
                worst.missed = float(missed_damage(of.band[s, f], of.whole[s, f]))
                worst.place = f"weld '{stations.names[stations.weld[s]]}', node {stations.node[s]}"

    def warnings(self, upper_hz: Mapping[str, float], looked_at: str = "toe points") -> list[Problem]:
        """One warning for all events: what the worst one has above the band, and what to do; none where all is well.

        ``upper_hz`` of each event [Hz]; ``looked_at`` says which points were.
        """
        if not self.events:
            return []
        worst_first = sorted(self.events.items(), key=lambda item: -item[1].points)
        event, worst = worst_first[0]
        points = sum(of_event.points for of_event in self.events.values())
        others = [f"'{other}'" for other, _ in worst_first[1 : 1 + NAMED]]
        more = len(worst_first) - 1 - len(others)
        also = f"; also {', '.join(others)}{f' and {more} more' * (more > 0)}" if others else ""
        return [
            Problem(
                "outside_band",
                f"event '{event}'{also}",
                f"stress above upper_hz ({upper_hz[event]:g} Hz) is counted, but in no spectrum: up to "
                f"{in_percent(worst.share)} % of the variance and {in_percent(worst.missed)} % of the damage there "
                f"({worst.place}); at {points} of {self.toes} {looked_at} the life by Dirlik is too long for that, "
                "or left out",
                "Raise upper_hz in [spectrum] if this stress is real, keep it out of the simulation if it is noise, or "
                "trust the counted lives only, which contain it either way",
                count=len(self.events),
            )
        ]


def spectra_of(result: GroupResult, plan: Plan) -> dict[str, Spectral]:
    """What the spectra of each event say of the stations of a result."""
    columns = ("damage_tb_per_pass", "damage_tb_whole_per_pass", "outside_share")
    of_events = zip(plan.passes, *(result.of_events(name) for name in columns), strict=True)
    return {one.event: Spectral(one.passes_per_km, *arrays) for one, *arrays in of_events}


def outside_of(result: GroupResult) -> NDArray[np.bool_]:
    """Points whose spectra miss too much by their verdict, or nearly all if they are bounded, (n, 2)."""
    has_spectrum = ~np.isnan(result.of_events("damage_dirlik_per_pass")).all(axis=0)
    no_life = np.isnan(result.mission.life_km_dirlik) & has_spectrum
    return np.asarray(no_life | (result.mission.verdict == VERDICTS.index("outside_band")))


def bands_of(loads: Sequence[EventLoad]) -> dict[str, float]:
    """Upper frequency of the band of each event that has a spectrum [Hz]."""
    return {load.counted.event: load.moments.upper_hz for load in loads if load.moments is not None}
