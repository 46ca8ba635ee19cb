"""What the weld register makes of the welds in the tables: which are assessed, under which names, which are one.

A row of the register belongs to the weld that ``fatigue convert`` wrote for its ``line``; the record of the conversion
knows the name it has in the tables. In tables written by hand ``line`` is the name of the weld there, and may be left
empty where ``weld`` is. So a weld can be renamed again and again, and its row is found.
"""

import difflib
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import cast

import numpy as np

from fatigue.errors import DataError, Problem, refuse
from fatigue.readers.neutral.body.welds import Surface, Weld
from fatigue.readers.neutral.register.conversion import ConvertRecord
from fatigue.readers.neutral.register.weld_register import Register, RegisterRow, contradictions, description_of
from fatigue.shown import few


@dataclass(frozen=True, slots=True)
class Registered:
    """The welds of a case under its register.

    Attributes
    ----------
    welds : those to assess, in the order of the tables
    sources : of each, its name in the tables, or the names of those it is joined of
    thickness : thickness the user has confirmed, by name in the tables [mm]
    left_out : rows that are not assessed, each under a name that nothing else has
    warnings : what the user should know
    file : place of the register in messages; empty where there is none
    again : what to do where only another conversion helps
    unconfirmed : thickness in the register that nobody has confirmed, as name in the tables, place and value [mm]
    confirmed : thicknesses that the user has confirmed, by name of the weld to assess [mm]
    """

    welds: tuple[Weld, ...]
    sources: tuple[tuple[str, ...], ...]
    thickness: Mapping[str, float]
    left_out: tuple[RegisterRow, ...]
    warnings: tuple[Problem, ...]
    file: str
    again: str
    unconfirmed: tuple[tuple[str, str, float], ...] = ()
    confirmed: Mapping[str, tuple[float, ...]] = field(default_factory=dict)

    @property
    def names(self) -> dict[str, str]:
        """Name of each weld by its name in the tables; what is not assessed is not there."""
        return {source: weld.name for weld, some in zip(self.welds, self.sources, strict=True) for source in some}


def unregistered(welds: Sequence[Weld]) -> Registered:
    """Take the welds of the tables as they are."""
    return Registered(tuple(welds), tuple((weld.name,) for weld in welds), {}, (), (), "", "")


def registered(
    register: Register, welds: Sequence[Weld], conversion: ConvertRecord, curves: Collection[str]
) -> Registered:
    """Apply a register to the welds of the tables.

    Parameters
    ----------
    welds : as the tables have them
    conversion : which lines they are of, where ``fatigue convert`` wrote them
    curves : names a curve may have

    Raises
    ------
    DataError : a weld to assess is not in the tables, rows of one weld contradict each other, nothing is left to assess
    """
    again = conversion.command(register.path)
    rows = _rows_of_welds(register, welds, conversion)
    of_tables = {row.number for some in rows.values() for row in some}
    problems = list(_absent(register, [row for row in register.rows if row.number not in of_tables], welds, again))
    problems += _unknown_curves(register, curves)
    groups: dict[str, list[tuple[Weld, list[RegisterRow]]]] = {}
    thickness: dict[str, float] = {}
    unconfirmed: list[tuple[str, str, float]] = []
    warnings = list(register.warnings)
    for weld in welds:
        own = rows[weld.name]
        if not own:
            groups.setdefault(weld.name, []).append((weld, own))
            what = "the weld is not in the weld register and is assessed as the tables have it"
            where = f"{register.path.name}: weld {weld.name}"
            warnings.append(Problem("unregistered_weld", where, what, "Add a row for it, or exclude it there"))
        elif len({row.weld if row.status == "assess" else None for row in own}) > 1:
            lines = ", ".join(row.key for row in own)
            what = f"the lines {lines} were converted as one weld and are to be parted"
            problems.append(Problem("one_weld", register.where(own[0]), what, again or "Part them in the tables"))
        elif own[0].status == "assess":
            groups.setdefault(own[0].weld, []).append((weld, own))
            unconfirmed += [
                (weld.name, register.where(row, "thickness_mm"), row.thickness) for row in own if not row.confirmed
            ]
            wanted = _thickness(own, conversion.lines.get(weld.name, {}))
            if wanted is None:
                what = "the tables do not tell the plate thickness that is asked for"
                place = register.where(own[0], "confirmed")
                problems.append(Problem("thickness", place, what, again or "Correct it in the tables"))
            elif wanted > 0:
                thickness[weld.name] = wanted
    found = {name: list(_contradictions(register, name, group)) for name, group in groups.items()}
    refuse(DataError, [*problems, *(problem for some in found.values() for problem in some)])
    left_out = list(_named_apart([row for row in register.rows if row.status != "assess"], set(groups)))
    if not groups:
        counts = [f"{sum(row.status == status for row in left_out)} {status}" for status in ("excluded", "candidate")]
        what = f"no weld is left to assess: {', '.join(counts)}"
        raise DataError(Problem("no_welds", str(register.path), what, "Set the status of some to assess"))
    return Registered(
        welds=tuple(_weld(name, group, conversion) for name, group in groups.items()),
        sources=tuple(tuple(weld.name for weld, _ in group) for group in groups.values()),
        thickness=thickness,
        left_out=tuple(left_out),
        warnings=tuple(warnings),
        file=register.path.name,
        again=again,
        unconfirmed=tuple(unconfirmed),
        confirmed={
            name: tuple(row.thickness for _, own in group for row in own if row.confirmed)
            for name, group in groups.items()
        },
    )


def _rows_of_welds(
    register: Register, welds: Sequence[Weld], conversion: ConvertRecord
) -> dict[str, list[RegisterRow]]:
    """Find the rows of every weld of the tables."""
    by_key = {row.key: row for row in register.rows}
    by_name = {row.weld: row for row in reversed(register.rows)}
    lines = {weld.name: conversion.lines.get(weld.name, (weld.name,)) for weld in welds}
    rows = {name: [by_key[line] for line in some if line in by_key] for name, some in lines.items()}
    taken = {row.number for some in rows.values() for row in some}
    for name, own in rows.items():
        row = by_name.get(name)
        if not own and name not in conversion.lines and row is not None and row.number not in taken:
            own.append(row)
    return rows


def _absent(register: Register, rows: Sequence[RegisterRow], welds: Sequence[Weld], again: str) -> Iterator[Problem]:
    """Name the rows to assess that the tables know nothing of; together where one conversion helps them all."""
    absent = [row for row in rows if row.status == "assess"]
    if again and len(absent) > 1:
        lines = ", ".join(row.key + _why(row) for row in absent)
        what = f"{len(absent)} lines are to be assessed, and the tables have no forces for them: {lines}"
        yield Problem("no_forces", register.path.name, what, again)
        return
    for row in absent:
        what = f"line {row.key} is to be assessed, and the tables have no forces for it{_why(row)}"
        if again:
            yield Problem("no_forces", register.where(row), what, again)
        else:
            near = difflib.get_close_matches(row.key, [weld.name for weld in welds], n=1)
            meant = f"meant is perhaps {near[0]}" if near else f"welds there: {_some(welds)}"
            remedy = f"Add it to the tables of the case ({meant}), or give it another status"
            yield Problem("no_forces", register.where(row), what, remedy)


def _why(row: RegisterRow) -> str:
    """Reason in brackets, which still stands in the row from when the line was left out; empty without one."""
    return f" (reason given: {row.reason})" if row.reason else ""


def _some(welds: Sequence[Weld], most: int = 5) -> str:
    return few([weld.name for weld in welds], most)


def _unknown_curves(register: Register, curves: Collection[str]) -> Iterator[Problem]:
    for row in register.rows:
        if row.status == "assess" and row.curve and row.curve not in curves:
            remedy = f"Choose one of {', '.join(sorted(curves))}, or add [curves.{row.curve}] to the case"
            yield Problem("unknown_curve", register.where(row, "curve"), f"there is no curve {row.curve!r}", remedy)


def _thickness(rows: Sequence[RegisterRow], converted: Mapping[str, float]) -> float | None:
    """Thickness to give a weld, 0: as in the tables; None where the tables do not tell it.

    ``converted`` is the confirmed thickness of each line in the tables, NaN where the tables have the model's.
    """
    wanted = {row.key: row.thickness if row.confirmed else np.nan for row in rows}
    if converted and all(_same(wanted.get(line, of_line), of_line) for line, of_line in converted.items()):
        return 0.0
    values = list(wanted.values())
    if all(value == values[0] for value in values):
        return values[0]
    return 0.0 if not converted and np.isnan(values).all() else None


def _same(a: float, b: float) -> bool:
    return a == b or (np.isnan(a) and np.isnan(b))


def _contradictions(
    register: Register, name: str, group: Sequence[tuple[Weld, list[RegisterRow]]]
) -> Iterator[Problem]:
    """Find what the lines of one weld cannot have different."""
    rows = [row for _, own in group for row in own]
    if not rows:
        return
    if not all(own for _, own in group):
        what = f"weld {name} of the tables is not in the register, and another is to have its name"
        yield Problem("twice", register.where(rows[0]), what, "Register it, or choose another name")
        return
    yield from contradictions(rows, f"{register.path.name}: weld {name}")


def _weld(name: str, group: Sequence[tuple[Weld, list[RegisterRow]]], conversion: ConvertRecord) -> Weld:
    """Weld as registered; an empty cell means the default after ``fatigue convert``, else what the table says."""
    weld, rows = group[0][0], [row for _, own in group for row in own]
    if not rows:
        return weld
    row, is_converted = rows[0], weld.name in conversion.lines
    described = is_converted or any(row.description for row in rows)
    return replace(
        weld,
        name=name,
        surface=cast(Surface, row.surface) or ("both" if is_converted else weld.surface),
        curve=row.curve or (None if is_converted else weld.curve),
        end_length=float(row.end_length) if row.end_length else None if is_converted else weld.end_length,
        description=description_of(rows) if described else weld.description,
        joint_type=_given(rows, "joint_type") or weld.joint_type,
        performance_class=_given(rows, "performance_class") or weld.performance_class,
        inspection_class=_given(rows, "inspection_class") or weld.inspection_class,
    )


def _given(rows: Sequence[RegisterRow], column: str) -> str:
    """What the register gives for a weld; empty where all its lines leave it open."""
    return next((value for row in rows if (value := str(getattr(row, column)))), "")


def _named_apart(rows: Sequence[RegisterRow], taken: set[str]) -> Iterator[RegisterRow]:
    """Rows under names that nothing else has: the name of the weld, else of the line, else one made of both."""
    for row in rows:
        names = (row.weld, row.line, f"{row.weld} ({row.key})")
        free = (f"{row.weld} (row {number})" for number in range(row.number, 2 * row.number + len(taken) + 2))
        name = next(name for name in (*names, *free) if name and name not in taken)
        taken.add(name)
        yield replace(row, weld=name)
