"""Which weld of one result is which weld of another: by name, by a map of the user, or by where their lines lie."""

import difflib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from fatigue.decide.compare.finished import Finished
from fatigue.decide.compare.matched.lines import Proposal, proposals
from fatigue.errors import DataError, Problem, refuse
from fatigue.readers.neutral.tables import open_table
from fatigue.shown import few

NAME, MAP, GEOMETRY, PROPOSED = "name", "map", "geometry", "proposed"


@dataclass(frozen=True, slots=True)
class MatchedWelds:
    """Welds of the first result and what they are in the other.

    ``by`` says of each weld of the first how its partner was found. ``proposed`` are lines that lie on each other and
    were not accepted, those that cannot be told apart among them; ``only_first`` and ``only_other`` have no partner.
    """

    other: Mapping[str, str]
    by: Mapping[str, str]
    proposed: tuple[Proposal, ...]
    only_first: tuple[str, ...]
    only_other: tuple[str, ...]
    distance_mm: Mapping[str, float]


@dataclass(frozen=True, slots=True)
class WeldMap:
    """Welds of the reference by the names they have elsewhere, as a table of the user says; ``file`` is its name."""

    file: str = ""
    pairs: tuple[tuple[str, str], ...] = ()


def read_map(path: Path, results: Sequence[Finished]) -> WeldMap:
    """Read a table of welds with the columns ``weld_a`` and ``weld_b``.

    Raises
    ------
    DataError : a weld that the reference or all the others do not have, or that is named twice
    """
    table = open_table(path, texts=("weld_a", "weld_b"))
    table.expect(("weld_a", "weld_b"), (), strict=True)
    pairs = tuple(zip(table.texts("weld_a"), table.texts("weld_b"), strict=True))
    table.refuse()
    known = ((results[0],), tuple(results[1:]))
    for side, column in enumerate(("weld_a", "weld_b")):
        seen: dict[str, int] = {}
        for row, weld in enumerate(pair[side] for pair in pairs):
            where = table.where(column, row)
            if weld in seen:
                what = f"weld {weld!r} stands in {table.row_name(seen[weld])} as well"
                table.problems.append(Problem("duplicate", where, what, "Keep one of the rows"))
            elif not any(weld in one.welds.index for one in known[side]):
                table.problems.append(_unknown(where, weld, known[side]))
            seen.setdefault(weld, row)
    table.refuse()
    return WeldMap(path.name, pairs)


def _unknown(where: str, weld: str, of: Sequence[Finished]) -> Problem:
    names = sorted({name for one in of for name in one.welds.index})
    reason = next((one.left_out[weld] or "no reason is given" for one in of if weld in one.left_out), None)
    if reason is not None:
        what = f"weld {weld!r} was not assessed ({reason})"
        return Problem("unknown_weld", where, what, "Remove the row")
    letters = ", ".join(one.letter for one in of)
    near = difflib.get_close_matches(weld, names, n=1)
    remedy = f"Write {near[0]!r}" if near else f"Name one of its welds: {few(names)}"
    return Problem("unknown_weld", where, f"there is no weld {weld!r} in result {letters}", remedy)


def match_welds(a: Finished, b: Finished, of_map: WeldMap, *, accept_proposed: bool) -> MatchedWelds:
    """Welds by the map, by name, and, where that is accepted, by their lines.

    Raises
    ------
    DataError : the results have no weld in common
    """
    there = set(b.welds.index)
    other = {weld: partner for weld, partner in of_map.pairs if partner in there}
    by = dict.fromkeys(other, MAP)
    taken = set(other.values())
    for weld in a.welds.index:
        if weld not in other and weld in there and weld not in taken:
            other[weld], by[weld] = weld, NAME
    free_a = [weld for weld in a.welds.index if weld not in other]
    named = set(other.values())
    free_b = [weld for weld in b.welds.index if weld not in named]
    proposed = proposals(a, b, free_a, free_b)
    used = [one for one in proposed if accept_proposed and not one.others]
    for one in used:
        other[one.weld], by[one.weld] = one.other_weld, GEOMETRY
    left = tuple(one for one in proposed if one.weld not in other)
    partners = set(other.values())
    if not other:
        refuse(DataError, _nothing_common(a, b, left))
    return MatchedWelds(
        other=other,
        by=by,
        proposed=left,
        only_first=tuple(weld for weld in free_a if weld not in other),
        only_other=tuple(weld for weld in free_b if weld not in partners),
        distance_mm={one.weld: one.distance_mm for one in proposed},
    )


def _nothing_common(a: Finished, b: Finished, proposed: Sequence[Proposal]) -> Iterator[Problem]:
    names = [few(sorted(one.welds.index)) or "none" for one in (a, b)]
    what = f"no weld has its name in {a.letter} ({a.folder}) as well: there {names[0]}, here {names[1]}"
    certain = sum(not one.others for one in proposed)
    remedy = "Name the pairs in a table weld_a,weld_b with --map"
    if certain:
        remedy += f", or take the {certain} whose lines lie on each other with --accept-proposed"
    yield Problem("no_common_weld", str(b.folder), what, remedy)
