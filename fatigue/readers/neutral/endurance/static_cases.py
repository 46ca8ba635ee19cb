"""The file of static load cases: amounts of the coordinates of a body, or stresses at points as they are.

Cases of a group are compared with each other, either **states**, every one with every other, or **alternating** loads
of either sign, each independent of the others, about the sum of the **static** ones.
"""

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, cast

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import Problem
from fatigue.readers.neutral.body.coordinates import Coordinates
from fatigue.readers.neutral.tables import Table, open_table

KINDS = ("static", "alternating", "state")
STRESSES = ("sx_MPa", "sy_MPa", "txy_MPa")  # across the weld, along it, shear
_OPTIONAL = ("factor", "note")

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class CaseGroup:
    """Static load cases that are compared with each other.

    Attributes
    ----------
    name : of the group
    kind : state, or alternating
    cases : (s,) names of the states, or of the alternating loads
    static : sum of the static cases, (c,) amounts of the coordinates or (p, 3) stresses; 0 without any
    loads : the states or alternating loads, (s, c) amounts or (s, p, 3) stresses
    points : (p,) names of the points that the stresses are at; empty: the group has amounts
    """

    name: str
    kind: Literal["alternating", "state"]
    cases: tuple[str, ...]
    static: Floats
    loads: Floats
    points: tuple[str, ...]

    def static_of(self, modal: Floats) -> Floats:
        """Stress (n, ...) of the static cases together, from a stress (n, c, ...) per unit of the coordinates."""
        return np.asarray(np.tensordot(modal, self.static, axes=(1, 0)))

    def loads_of(self, modal: Floats) -> Floats:
        """Stress (n, s, ...) of the states or alternating loads, from a stress (n, c, ...) per unit."""
        return np.asarray(np.einsum("sc,nc...->ns...", self.loads, modal))

    def stress_at(self, points: Sequence[str]) -> tuple[Floats, Floats]:
        """Stress of the static cases (n, 3) and of the loads (n, s, 3) at some of its points."""
        at = [self.points.index(point) for point in points]
        return self.static[at], np.moveaxis(self.loads[:, at], 1, 0)


def read_static_cases(
    path: Path, coordinates: Coordinates, ignore_modes: Collection[int]
) -> tuple[Mapping[str, CaseGroup], list[Problem]]:
    """Read ``case, kind, group`` and, by default 1, ``factor``: the groups by name, and warnings.

    A row is a case with the amounts of its coordinates in columns ``q_<mode>`` and ``u_<name>``, 0 where absent. Or,
    with a column ``point``, it has the stress of the case at this point in ``sx_MPa, sy_MPa, txy_MPa``, 0 where absent.

    Raises
    ------
    DataError
        an unknown column, mode or unit load; a case twice; a point without stress of a case; a group in which nothing
        is compared
    """
    table = open_table(path, texts=("case", "kind", "group", "point", "note"))
    at_points = "point" in table.position
    amounts = _stress_columns(table) if at_points else _amount_columns(table, coordinates, ignore_modes)
    looked_at = [] if at_points else [name for name in table.position if _is_amount(name)]
    wanted = ("case", "kind", "group", *(("point",) if at_points else ()))
    table.expect(wanted, (*_OPTIONAL, *amounts, *looked_at), strict=True)
    table.refuse()
    names, code = table.groups("case")
    kinds = table.texts("kind")
    table.choices("kind", kinds, KINDS)
    groups, group = table.groups("group")
    points, point = table.groups("point", default=None if at_points else "")
    keys, labels = {"group": group, "case": code}, {"group": groups, "case": names}
    if at_points:
        keys, labels = keys | {"point": point}, labels | {"point": points}
    table.unique(keys, labels)
    factor = table.numbers("factor", default=1.0).astype(np.float64)
    table.report(factor == 0.0, "bad_value", "factor", "0 takes the case out", "Remove the case instead")
    values = np.zeros((table.rows, len(coordinates) if not at_points else len(STRESSES)))
    for name, place in amounts.items():
        values[:, place] = factor * table.numbers(name, default=0.0)
    table.refuse()
    found: dict[str, CaseGroup] = {}
    for i, name in enumerate(groups):
        rows = np.flatnonzero(group == i)
        of_points = _Points(points, point, values) if at_points else None
        table.problems.extend(_of_group(table, name, rows, names, code, kinds, of_points))
        if not table.problems:
            found[name] = _group(name, rows, names, code, kinds, values, of_points)
    table.refuse()
    return found, table.warnings


@dataclass(frozen=True, slots=True, eq=False)
class _Points:
    """Which point each row is at, and its stress."""

    names: tuple[str, ...]
    code: NDArray[np.int32]
    stress: Floats

    def of(self, rows: NDArray[np.intp], cases: NDArray[np.int32], wanted: Sequence[int]) -> Floats:
        """Stress (s, p, 3) of some cases at the points of a group, which has these rows."""
        some = np.unique(self.code[rows])
        stress = np.zeros((len(wanted), len(some), len(STRESSES)))
        place = np.searchsorted(some, self.code[rows])
        for i, case in enumerate(wanted):
            mine = cases[rows] == case
            stress[i, place[mine]] = self.stress[rows[mine]]
        return stress


def _group(
    name: str,
    rows: NDArray[np.intp],
    names: Sequence[str],
    code: NDArray[np.int32],
    kinds: Sequence[str],
    values: Floats,
    points: _Points | None,
) -> CaseGroup:
    """One group, of rows that have been checked; its cases stand in the order of the file."""
    kind_of = {int(code[row]): kinds[row] for row in rows}
    still = [case for case, kind in kind_of.items() if kind == "static"]
    moving = [case for case, kind in kind_of.items() if kind != "static"]
    if points is None:
        row_of = {int(code[row]): row for row in rows}
        static = values[[row_of[case] for case in still]].sum(axis=0)
        loads = values[[row_of[case] for case in moving]]
    else:
        static, loads = points.of(rows, code, still).sum(axis=0), points.of(rows, code, moving)
    return CaseGroup(
        name=name,
        kind=cast(Literal["alternating", "state"], kind_of[moving[0]]),
        cases=tuple(names[case] for case in moving),
        static=static,
        loads=loads,
        points=() if points is None else tuple(points.names[i] for i in np.unique(points.code[rows])),
    )


def _of_group(
    table: Table,
    name: str,
    rows: NDArray[np.intp],
    names: Sequence[str],
    code: NDArray[np.int32],
    kinds: Sequence[str],
    points: _Points | None,
) -> Iterator[Problem]:
    """Refusals of what the rows of a group make together."""
    first: dict[int, int] = {}
    for row in rows.tolist():
        before = first.setdefault(int(code[row]), row)
        if kinds[row] != kinds[before]:
            what = f"case '{names[code[row]]}' is {kinds[row]} here and {kinds[before]} in {table.row_name(before)}"
            yield Problem("contradiction", table.where("kind", row), what, "Give a case of a group one kind")
    where = table.where("kind", int(rows[0]))
    of_kind = [kinds[row] for row in first.values()]
    states, alternating, static = (of_kind.count(kind) for kind in ("state", "alternating", "static"))
    if states and (alternating or static):
        what = f"group '{name}' has {states} state and {alternating + static} other cases"
        remedy = "Add what is static to each state, or give the states a group of their own"
        yield Problem("contradiction", where, what, remedy)
    elif states == 1:
        remedy = "Give a second state of the group"
        yield Problem("few_rows", where, f"group '{name}' has one state, which makes no pair", remedy)
    elif not states and not alternating:
        remedy = "Give alternating cases, or call the cases states"
        yield Problem("few_rows", where, f"in group '{name}' all {static} cases are static", remedy)
    if points is not None:
        yield from _missing(table, name, rows, first, names, code, points)


def _missing(
    table: Table,
    name: str,
    rows: NDArray[np.intp],
    cases: Collection[int],
    names: Sequence[str],
    code: NDArray[np.int32],
    points: _Points,
) -> Iterator[Problem]:
    """Refusal of a group in which a case has no stress at a point that others have."""
    wanted = np.unique(points.code[rows])
    for case in cases:
        mine = points.code[rows[code[rows] == case]]
        absent = np.setdiff1d(wanted, mine)
        if absent.size:
            some = ", ".join(f"'{points.names[i]}'" for i in absent[:3])
            what = f"case '{names[case]}' of group '{name}' has no stress at {absent.size} points, {some}"
            yield Problem("missing_id", table.where("point"), what, "Add its rows, with 0 where it makes no stress")
            return


def _stress_columns(table: Table) -> dict[str, int]:
    """Columns of stresses and their places; that there are none, or amounts beside them, is noted."""
    present = {name: i for i, name in enumerate(STRESSES) if name in table.position}
    if not present:
        remedy = f"Give {', '.join(STRESSES)}, or take the column point out and give amounts of coordinates"
        table.problems.append(Problem("missing_column", table.where("point"), "the points have no stresses", remedy))
    return present


def _amount_columns(table: Table, coordinates: Coordinates, ignore_modes: Collection[int]) -> dict[str, int]:
    """Columns of amounts and the places of their coordinates; those of unknown coordinates are noted."""
    place = {name: i for i, name in enumerate(coordinates.column)}
    found: dict[str, int] = {}
    for name in table.position:
        mode = _mode_of(name)
        known = name if mode is None else f"q_{mode}"
        if known in place:
            if place[known] in found.values():
                what = f"mode {mode} has another column already"
                table.problems.append(Problem("duplicate_column", table.where(name), what, "Remove one of them"))
            found[name] = place[known]
        elif mode is not None and mode not in ignore_modes:
            remedy = "Remove the column, or add the mode to the table of modes"
            table.problems.append(Problem("unknown_id", table.where(name), f"the body has no mode {mode}", remedy))
        elif name.startswith("u_"):
            known = ", ".join(coordinates.unit_loads) or "none"
            what = f"the body has no unit load '{name[2:]}', it has {known}"
            table.problems.append(
                Problem("unknown_id", table.where(name), what, "Remove the column, or add [[body.unit_load]]")
            )
    if not found and not table.problems:
        remedy = "Give columns q_<mode> and u_<name>, or a column point with stresses"
        what = "no column is an amount of a mode or unit load"
        table.problems.append(Problem("missing_column", table.path.name, what, remedy))
    return found


def _is_amount(column: str) -> bool:
    return _mode_of(column) is not None or column.startswith("u_")


def _mode_of(column: str) -> int | None:
    """Mode id of a column ``q_<mode>``; None of any other column."""
    return int(column[2:]) if re.fullmatch(r"q_-?\d+", column) else None
