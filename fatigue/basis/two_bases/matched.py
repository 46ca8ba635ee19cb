"""Points of the welds of one case that another case has at the same place, and why it does not have the others."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.basis.counted import FACES, CountedGroup, Place

Floats = NDArray[np.float64]

SAME_MM = 1.0  # between points of the same part and order in both meshes


@dataclass(frozen=True, slots=True, eq=False)
class Match:
    """A point of the first case, and the station at the same place in the other case."""

    group: CountedGroup
    station: int
    face: int
    other_group: CountedGroup
    other_station: int


@dataclass(frozen=True, slots=True, eq=False)
class Stations:
    """Counted stations of a case by weld, part and order."""

    at: dict[Place, tuple[CountedGroup, int]]
    welds: frozenset[str]

    def match(self, group: CountedGroup, station: int, face: int) -> Match | str:
        """The station here at the place of a point of another case, or why there is none."""
        place = group.place(station)
        if place[0] not in self.welds:
            return "the other case does not have this weld"
        if place not in self.at:
            return f"the other case has no station of part {place[1]} and order {place[2]} on this weld: another mesh"
        found, at = self.at[place]
        apart = float(np.linalg.norm(group.xyz[station] - found.xyz[at]))
        if apart > SAME_MM:
            return f"the station of this part and order lies {apart:.3g} mm away in the other case: another mesh"
        if not found.toe[at, face]:
            return f"the weld has no toe on its {FACES[face]} face in the other case"
        return Match(group, station, face, found, at)

    def matches(self, groups: Sequence[CountedGroup]) -> Iterator[Match]:
        """All toe points of another case that have a partner here."""
        for group in groups:
            for station, face in np.argwhere(group.toe).tolist():
                found = self.match(group, station, face)
                if isinstance(found, Match):
                    yield found


def stations_of(groups: Sequence[CountedGroup]) -> Stations:
    """Counted stations of a case, ready to be looked up."""
    at = {group.place(i): (group, i) for group in groups for i in range(len(group.node))}
    return Stations(at, frozenset(weld for weld, _, _ in at))


def stress_of(matches: Sequence[Match]) -> tuple[Floats, Floats]:
    """Modal stress of both cases at some points (p, c), coordinates of each; nothing (0, 0) without points."""
    if not matches:
        return np.zeros((0, 0)), np.zeros((0, 0))
    return (
        np.stack([one.group.stress[one.station, one.face] for one in matches]),
        np.stack([one.other_group.stress[one.other_station, one.face] for one in matches]),
    )
