"""Two bases of one body beside each other: lives at the same points of the welds, and what makes them differ.

A strong interface keeps modes of its own for every loaded point, a weak one lets some points follow the others. That is
a choice of what a reduction keeps and no coupling of the structure, so nothing here is a verdict about a design.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.basis.counted import FACES, CountedGroup, OpenCase, counted
from fatigue.basis.finding import Finding
from fatigue.basis.loaded.shapes import loaded_points
from fatigue.basis.truncation import MOVES, life_ratio, moves, times
from fatigue.basis.two_bases.content import content
from fatigue.basis.two_bases.flexibility import flexibilities
from fatigue.basis.two_bases.frequencies import corresponding_modes
from fatigue.basis.two_bases.matched import Match, stations_of, stress_of
from fatigue.readers.neutral.body.modes import Modes
from fatigue.shown import few
from fatigue.stages import stage

Floats = NDArray[np.float64]

HEADING = "Two bases: lives at the same points"
SAME = 1e-6  # of frequencies and stresses: round-off of a file with six digits
A_TRUNCATION = (
    "Strong and weak interface are two choices of what a reduction keeps: how far the result moves is the error of "
    "truncation of one of them or of both. No verdict about a design follows from it."
)
ONE_BASIS = (
    "Both cases have one and the same basis: their modes make the same stress at the welds. What differs comes from "
    "the records and the mission, and says nothing about the basis."
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
    there, shortest = stations_of(others), _shortest(others)
    found = [there.match(*at) for at in worst]
    longer = other.plan.target_km / case.plan.target_km
    rows = tuple(_row(*at, match, longer, shortest) for at, match in zip(worst, found, strict=True))
    stress = stress_of(list(there.matches(groups)))
    is_one = _is_one_basis(case.body.modes, other.body.modes, stress)
    notes = tuple(_notes(case, other, rows, shortest))
    return (
        Finding("bases", HEADING, tuple(_said(rows, is_one)), rows, notes),
        content(case, other, [match for match in found if isinstance(match, Match)]),
        corresponding_modes((case.body.modes, other.body.modes), stress),
        flexibilities(loaded_points(case.body), loaded_points(other.body)),
    )


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
    match: Match | str,
    longer: float,
    shortest: Mapping[str, float],
) -> BasesRow:
    """The worst point of a weld; ``longer`` is the target of the other case over that of the first."""
    weld, part, order = group.place(station)
    u = float(group.utilisation[station, face])
    of_weld = life_ratio(u, shortest[weld])[0] * longer if weld in shortest else np.nan
    key = weld, part, int(group.node[station]), order, FACES[face], u
    if isinstance(match, str):
        return BasesRow(*key, np.nan, np.nan, of_weld, match)
    other = float(match.other_group.utilisation[match.other_station, face])
    ratio, reason = life_ratio(u, other)
    return BasesRow(*key, other, ratio * longer, of_weld, reason)


def _said(rows: Sequence[BasesRow], is_one: bool) -> Iterator[str]:
    yield ONE_BASIS if is_one else A_TRUNCATION
    known = [row for row in rows if moves(row.shortest_life_ratio) is not None]
    moving = [row for row in known if moves(row.shortest_life_ratio)]
    if known and not moving:
        yield f"The {len(known)} welds that both cases have last as long in both, to a factor of {MOVES:g}."
    if moving:
        each = few(
            [
                f"{row.weld} {times(row.shortest_life_ratio)}"
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
    yield from _same_records(case, other)


def _is_one_basis(first: Modes, second: Modes, stress: tuple[Floats, Floats]) -> bool:
    """Whether two cases have the same modes, which make the same stress at the points they share."""
    if first.kind != second.kind or not np.allclose(first.frequency, second.frequency, rtol=SAME, atol=0.0):
        return False
    mine, theirs = (one[:, : len(first.mode)] for one in stress)
    return bool(np.allclose(np.abs(mine), np.abs(theirs), rtol=SAME, atol=SAME * np.abs(mine).max(initial=0.0)))


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
