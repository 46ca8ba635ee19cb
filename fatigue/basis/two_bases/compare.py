"""Two bases of one body beside each other: lives at the same points of the welds, and what makes them differ.

A strong interface keeps modes of its own for every loaded point, a weak one lets some points follow the others. That is
a choice of what a reduction keeps and no coupling of the structure, so nothing here is a verdict about a design.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.basis.counted import FACES, CountedGroup, OpenCase, Place, counted
from fatigue.basis.finding import Finding
from fatigue.basis.truncation import MOVES, life_ratio, moves
from fatigue.basis.two_bases.content import content
from fatigue.basis.two_bases.flexibility import flexibilities
from fatigue.basis.two_bases.frequencies import corresponding_modes
from fatigue.readers.neutral.body.modes import Modes
from fatigue.shown import few
from fatigue.stages import stage

Floats = NDArray[np.float64]

HEADING = "Two bases: lives at the same points"
SAME_MM = 1.0  # between points of the same place in both meshes
A_TRUNCATION = (
    "Strong and weak interface are two choices of what a reduction keeps: how far the result moves is the error of "
    "truncation of one of them or of both. No verdict about a design follows from it."
)


@dataclass(frozen=True, slots=True)
class BasesRow:
    """The worst point of one weld in both cases; see the columns of ``bases``."""

    weld: str
    part: int
    node: int
    order: int
    surface: str
    utilisation: float
    other_utilisation: float
    life_ratio: float
    shortest_life_ratio: float
    reason: str


@dataclass(frozen=True, slots=True, eq=False)
class Matched:
    """A point of the first case and the one at the same place in the other: group and station, and the face."""

    group: CountedGroup
    station: int
    face: int
    other_group: CountedGroup
    other_station: int


def two_bases(case: OpenCase, other: OpenCase) -> tuple[Finding, ...]:
    """Lives, stress above 20 Hz, frequencies and local flexibility of two cases with the welds of one body.

    Raises
    ------
    DataError : shapes or static solutions are wrong; NumericalError : stress or damage exceeds double precision
    """
    stage("counting both bases")
    groups = counted(case)
    worst = [(group, *at) for group in groups for at in group.worst(group.utilisation)]
    others = counted(other, wanted=[group.place(station) for group, station, _ in worst])
    there = {group.place(i): (group, i) for group in others for i in range(len(group.node))}
    longer = other.plan.target_km / case.plan.target_km
    shortest = _shortest(others)
    rows, matched = [], []
    for group, station, face in worst:
        found = _other(group, station, face, there)
        rows.append(_row(group, station, face, found, longer, shortest))
        if not isinstance(found, str):
            matched.append(Matched(group, station, face, *found))
    lives = Finding("bases", HEADING, tuple(_said(rows)), tuple(rows), tuple(_notes(case, other, rows, shortest)))
    shared = _shared(groups, there)
    modes = case.body.modes, other.body.modes
    return (
        lives,
        content(
            case, other, [(one.group, one.station, one.face, one.other_group, one.other_station) for one in matched]
        ),
        corresponding_modes(modes, shared),
        flexibilities(case.body, other.body),
    )


def _other(
    group: CountedGroup, station: int, face: int, there: Mapping[Place, tuple[CountedGroup, int]]
) -> tuple[CountedGroup, int] | str:
    """The same point in the other case, or why there is none."""
    place = group.place(station)
    if not any(weld == place[0] for weld, _, _ in there):
        return "the other case does not have this weld"
    if place not in there:
        return f"the other case has no station of part {place[1]} and order {place[2]} on this weld: another mesh"
    found, at = there[place]
    apart = float(np.linalg.norm(group.xyz[station] - found.xyz[at]))
    if apart > SAME_MM:
        return f"the station of this part and order lies {apart:.3g} mm away in the other case: another mesh"
    if not found.toe[at, face]:
        return f"the weld has no toe on its {FACES[face]} face in the other case"
    return found, at


def _shortest(groups: Sequence[CountedGroup]) -> dict[str, float]:
    """Highest utilisation of every weld."""
    return {
        group.welds[w]: float(group.utilisation[at])
        for group in groups
        for w, at in enumerate(group.worst(group.utilisation))
    }


def _row(
    group: CountedGroup,
    station: int,
    face: int,
    found: tuple[CountedGroup, int] | str,
    longer: float,
    shortest: Mapping[str, float],
) -> BasesRow:
    """The worst point of a weld; ``longer`` is the target of the other case over that of the first."""
    weld, part, order = group.place(station)
    u = float(group.utilisation[station, face])
    of_weld = life_ratio(u, shortest[weld])[0] * longer if weld in shortest else np.nan
    key = weld, part, int(group.node[station]), order, FACES[face], u
    if isinstance(found, str):
        return BasesRow(*key, np.nan, np.nan, of_weld, found)
    at, there = found[1], found[0]
    ratio, reason = life_ratio(u, float(there.utilisation[at, face]))
    return BasesRow(*key, float(there.utilisation[at, face]), ratio * longer, of_weld, reason)


def _shared(groups: Sequence[CountedGroup], there: Mapping[Place, tuple[CountedGroup, int]]) -> tuple[Floats, Floats]:
    """Modal stress of both cases (p, c) at all points they share, coordinates of each."""
    first, second = [], []
    for group in groups:
        for i in range(len(group.node)):
            found = there.get(group.place(i))
            if found is not None and np.linalg.norm(group.xyz[i] - found[0].xyz[found[1]]) <= SAME_MM:
                first.append(group.stress[i])
                second.append(found[0].stress[found[1]])
    if not first:
        return np.zeros((0, 0)), np.zeros((0, 0))
    return np.concatenate(first), np.concatenate(second)


def _said(rows: Sequence[BasesRow]) -> Iterator[str]:
    yield A_TRUNCATION
    known = [row for row in rows if moves(row.shortest_life_ratio) is not None]
    moving = [row for row in known if moves(row.shortest_life_ratio)]
    if known and not moving:
        yield f"The {len(known)} welds that both cases have last as long in both, to a factor of {MOVES:g}."
    if moving:
        each = few(
            [
                f"{row.weld} {row.shortest_life_ratio:.3g} times"
                for row in sorted(moving, key=lambda row: -abs(float(np.log(row.shortest_life_ratio))))
            ]
        )
        yield (
            f"{len(moving)} of {len(known)} welds last longer or shorter in the other case by more than a factor of "
            f"{MOVES:g}: {each}."
        )


def _notes(case: OpenCase, other: OpenCase, rows: Sequence[BasesRow], shortest: Mapping[str, float]) -> Iterator[str]:
    """What cannot be compared, and what else differs than the basis."""
    names = {row.weld for row in rows}
    if apart := [row for row in rows if np.isnan(row.other_utilisation) and row.utilisation > 0.0]:
        yield f"Not compared at its worst point: {few([f'{row.weld} ({row.reason})' for row in apart])}."
    if only := sorted(set(shortest) - names):
        yield f"Only the other case has the welds {few(only)}."
    first, second = case.plan, other.plan
    if [p.event for p in first.passes] != [p.event for p in second.passes] or not np.allclose(
        first.weights, second.weights, rtol=1e-9
    ):
        yield "The missions differ in their events or in how often they occur, so lives differ by more than the basis."
    same_curve = case.body.case.curve == other.body.case.curve
    if not same_curve or case.body.case.counting != other.body.case.counting:
        yield "Curve or counting differ between the cases, so lives differ by more than the basis."
    if _same_modes(case.body.modes, other.body.modes):
        yield "Both cases have modes of the same frequencies and kinds: they may be one basis, under other records."
    else:
        yield from _same_records(case, other)


def _same_modes(first: Modes, second: Modes) -> bool:
    return first.kind == second.kind and np.array_equal(first.frequency, second.frequency)


def _same_records(case: OpenCase, other: OpenCase) -> Iterator[str]:
    """Doubt about a record that both cases read: coordinates belong to one basis."""
    mine, theirs = (
        {one.body.case.resolve(event.history).resolve() for event in one.body.case.mission.event if event.history}
        for one in (case, other)
    )
    ids, i, j = np.intersect1d(case.body.modes.mode, other.body.modes.mode, return_indices=True)
    changed = case.body.modes.frequency[i] != other.body.modes.frequency[j]
    if (shared := sorted(path.name for path in mine & theirs)) and changed.any():
        yield (
            f"Both cases read the record {few(shared)} although the modes {few(ids[changed].tolist())} differ: modal "
            "coordinates belong to one basis, so simulate each with its own."
        )
