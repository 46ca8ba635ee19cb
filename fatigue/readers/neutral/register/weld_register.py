"""The editable register of weld lines: what is assessed, what is not and why. It wins over detection in the next run.

Every cut that was found keeps one row. The column ``line`` is the name detection gives and must stay; the rest is the
user's: ``weld`` (the name in the results), ``status`` (assess, candidate or excluded), ``reason``, ``surface``,
``curve``, ``end_length_mm``, ``description``, and ``thickness_mm`` with ``confirmed``, which together settle a layered
or otherwise doubtful section. Lines to assess that have one name are one weld and have to join end to end. For tables
written by hand ``line`` is the name of the weld in these, and may be empty where it is the same as ``weld``.
"""

import csv
import difflib
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from io import StringIO
from pathlib import Path

import numpy as np

from fatigue.errors import DataError, Problem, refuse
from fatigue.readers.neutral.body import SURFACES
from fatigue.readers.text.rows import read_rows
from fatigue.weld.cuts import WeldCut
from fatigue.weld.line_geometry import length

REGISTER = "welds_register.csv"
STATUSES = ("assess", "candidate", "excluded")
FLAGS = {  # as spreadsheets in several languages write them
    **dict.fromkeys(("true", "1", "yes", "wahr", "ja", "vrai", "oui"), True),
    **dict.fromkeys(("", "false", "0", "no", "falsch", "nein", "faux", "non"), False),
}
_COLUMNS = [
    *("weld", "line", "status", "reason", "kind", "pids", "pid", "nodes", "length_mm"),
    *("thickness_mm", "confirmed", "surface", "curve", "end_length_mm", "description"),
]


@dataclass(frozen=True, slots=True)
class RegisterRow:
    """One cut in the register; ``thickness`` NaN where the model gives none [mm].

    ``surface`` is empty where the register leaves it open; ``number`` is that of the row in its file, from 1;
    ``others`` are the cells of columns that nothing reads, kept for the user.
    """

    weld: str
    line: str
    status: str
    reason: str
    kind: str
    pids: str
    pid: int
    nodes: int
    length: float
    thickness: float
    confirmed: bool = False
    surface: str = "both"
    curve: str = ""
    end_length: str = ""
    description: str = ""
    number: int = field(default=0, compare=False)
    others: Mapping[str, str] = field(default_factory=dict, compare=False)

    @property
    def key(self) -> str:
        """What the row is found by: its line, or its weld where it names none."""
        return self.line or self.weld


@dataclass(frozen=True, slots=True)
class Register:
    """A register as it was read: the file, its rows, and the doubts about it."""

    path: Path
    rows: tuple[RegisterRow, ...]
    warnings: tuple[Problem, ...] = ()

    def where(self, row: RegisterRow, column: str = "") -> str:
        """Name a place in the file."""
        return f"{self.path.name}: row {row.number} ({row.weld})" + (f", column {column}" if column else "")


def description_of(rows: Iterable[RegisterRow]) -> str:
    """Describe a weld by the user's words for its lines, else by their kinds and the properties that meet there."""
    rows = list(rows)
    words = [row.description for row in rows if row.description] or [f"{row.kind} {row.pids}".strip() for row in rows]
    return "; ".join(dict.fromkeys(words))


def contradictions(rows: Iterable[RegisterRow], where: str) -> Iterator[Problem]:
    """Find what the lines of one weld cannot have different."""
    rows = list(rows)
    for column, title in (("surface", "surface"), ("curve", "curve"), ("end_length", "end_length_mm")):
        of_row = {getattr(row, column): row for row in reversed(rows)}
        if len(of_row) > 1:
            values = " and ".join(f"{value or 'none'} (line {row.key})" for value, row in sorted(of_row.items()))
            what = f"its lines have different {title}: {values}"
            yield Problem("contradiction", where, what, "Give them one, or give the lines two names")


def kind_of(reason: str) -> str:
    """Leave the numbers out of a reason."""
    return re.sub(r"\d+(\.\d+)?", "0", reason)


def reasons(rows: Iterable[RegisterRow]) -> list[tuple[int, str]]:
    """Count the kinds of reasons why lines are not assessed, most frequent first, each told by its first line.

    Reasons that differ in their numbers are of one kind.
    """
    kinds: dict[str, list[str]] = {}
    for row in rows:
        if row.status != "assess":
            reason = row.reason or row.status
            kinds.setdefault(kind_of(reason), []).append(f"{reason} (line {row.key})")
    return sorted(((len(some), some[0]) for some in kinds.values()), key=lambda kind: -kind[0])


def proposed(cut: WeldCut, status: str, reason: str) -> RegisterRow:
    """Row of a cut as detection proposes it."""
    return RegisterRow(
        weld=cut.name,
        line=cut.name,
        status=status,
        reason=reason,
        kind=cut.kind,
        pids="/".join(str(p) for p in cut.pids),
        pid=cut.pid,
        nodes=cut.line.node.size,
        length=length(cut.line),
        thickness=float(np.mean(cut.line.thickness)),
    )


def merged(rows: Iterable[RegisterRow], register: Register) -> tuple[list[RegisterRow], list[Problem]]:
    """Put the user's columns of an earlier register over fresh rows; rows whose line is gone are kept, excluded."""
    fresh = {row.line: row for row in rows}
    edited = {row.key: row for row in register.rows}
    result, remarks = [], list(register.warnings)
    for line, row in fresh.items():
        old = edited.get(line)
        if old is None:
            result.append(row)
            continue
        result.append(
            replace(
                row,
                number=old.number,
                others=old.others,
                weld=old.weld,
                status=old.status,
                reason=old.reason,
                thickness=old.thickness if old.confirmed else row.thickness,
                confirmed=old.confirmed,
                surface=old.surface or row.surface,
                curve=old.curve,
                end_length=old.end_length,
                description=old.description,
            )
        )
    for line, old in edited.items():
        if line not in fresh:
            result.append(replace(old, line=line, status="excluded", reason="the mesh has this line no more"))
            if old.status == "assess":
                remarks.append(
                    Problem(
                        "line_gone",
                        f"weld register, line {line}",
                        f"weld {old.weld} is registered, but the mesh does not have its line any more",
                        "Register the line that replaces it",
                    )
                )
    return result, remarks


def register_text(rows: Iterable[RegisterRow]) -> str:
    """Register as CSV text."""
    text = StringIO()
    writer = csv.writer(text, lineterminator="\n")
    rows = list(rows)
    others = list(dict.fromkeys(name for row in rows for name in row.others))
    writer.writerow([*_COLUMNS, *others])
    for row in sorted(rows, key=lambda r: (STATUSES.index(r.status), r.weld)):
        writer.writerow(
            [
                row.weld,
                row.line,
                row.status,
                row.reason,
                row.kind,
                row.pids,
                row.pid,
                row.nodes,
                f"{row.length:.6g}",
                "" if np.isnan(row.thickness) else f"{row.thickness:.9g}",
                str(row.confirmed).lower(),
                row.surface,
                row.curve,
                row.end_length,
                row.description,
                *(row.others.get(name, "") for name in others),
            ]
        )
    return text.getvalue()


def open_register(path: Path, *, strict: bool) -> Register:
    """Read a register; an unknown column is a doubt, or a mistake where strict.

    Raises
    ------
    DataError : unreadable, without rows, columns missing, a line given twice, an impossible value
    """
    names, table = read_rows(path, numbers=("thickness_mm", "end_length_mm", "length_mm"))
    remedy = "Let `fatigue welds` write it, or remove it from [body]"
    missing = [name for name in ("weld", "status") if name not in names]
    if missing:
        what = f"the column {missing[0]} is missing; the columns are {', '.join(names)}"
        raise DataError(Problem("missing_column", str(path), what, "Add it; `fatigue welds` writes all"))
    if not table:
        raise DataError(Problem("no_rows", str(path), "the register has no rows", remedy))
    problems, doubts = [], list(_unknown_columns(path, names))
    found: dict[str, RegisterRow] = {}
    for given in table:
        where, cells, number = f"{path}: row {given.number}", given.cells, given.number
        if absent := [name for name in ("weld", "status") if not cells.get(name)]:
            problems.append(Problem("missing_value", where, f"column {absent[0]} is missing or empty", "Fill it in"))
            continue
        try:
            row = _row(cells, number)
        except ValueError as error:
            problems.append(Problem("bad_value", where, str(error), "Correct the cell"))
            continue
        if first := found.get(row.key):
            what = f"line {row.key} is given twice, in row {first.number} already"
            problems.append(Problem("twice", where, what, "Keep one of the rows"))
        found[row.key] = row
    refuse(DataError, [*problems, *(doubts if strict else ())])
    return Register(path, tuple(found.values()), tuple(doubts))


def _unknown_columns(path: Path, names: Iterable[str]) -> Iterable[Problem]:
    """Name the columns that nothing reads."""
    for name in names:
        if name and name not in _COLUMNS:
            near = difflib.get_close_matches(name, _COLUMNS, n=1)
            remedy = f"Rename it to {near[0]!r}" if near else "Remove it if it is not for yourself"
            what = "the column is unknown and not read"
            yield Problem("unknown_column", f"{path.name}: column {name}", what, remedy)


def _row(cells: Mapping[str, str], number: int) -> RegisterRow:
    """Row of checked cells; a ValueError says what is wrong."""
    for name, allowed in (("status", STATUSES), ("surface", SURFACES)):
        if (value := cells.get(name, "").lower()) and value not in allowed:
            raise ValueError(f"{name} is {value!r}, not one of {', '.join(allowed)}")
    if (flag := cells.get("confirmed", "").lower()) not in FLAGS:
        raise ValueError(f"confirmed is {flag!r}, not true or false")
    end_length = _number(cells, "end_length_mm")
    if end_length < 0:
        raise ValueError(f"end_length_mm is {cells['end_length_mm']}")
    thickness, confirmed = _number(cells, "thickness_mm"), FLAGS[flag]
    if confirmed and not thickness > 0:
        raise ValueError(f"thickness_mm is {cells.get('thickness_mm', '')!r}, a confirmed thickness must be above 0")
    return RegisterRow(
        weld=cells["weld"],
        line=cells.get("line", ""),
        status=cells["status"].lower(),
        reason=cells.get("reason", ""),
        kind=cells.get("kind", ""),
        pids=cells.get("pids", ""),
        pid=_whole(cells, "pid"),
        nodes=_whole(cells, "nodes"),
        length=_number(cells, "length_mm"),
        thickness=thickness,
        confirmed=confirmed,
        surface=cells.get("surface", "").lower(),
        curve=cells.get("curve", ""),
        end_length="" if np.isnan(end_length) else f"{end_length:.12g}",
        description=cells.get("description", ""),
        number=number,
        others={name: value for name, value in cells.items() if name and name not in _COLUMNS},
    )


def _number(cells: Mapping[str, str], name: str) -> float:
    """Finite number in a cell, NaN in an empty one."""
    if not (text := cells.get(name, "")):
        return np.nan
    try:
        value = float(text)
    except ValueError:
        raise ValueError(f"{name} is {text!r}, not a number: could not convert it") from None
    if not np.isfinite(value):
        raise ValueError(f"{name} is {text!r}, not a finite number")
    return value


def _whole(cells: Mapping[str, str], name: str) -> int:
    """Whole number in a cell, 0 in an empty one."""
    value = _number(cells, name)
    if value != value // 1 and value == value:  # noqa: PLR0124  (NaN differs from itself)
        raise ValueError(f"{name} is {cells[name]!r}, not a whole number")
    return 0 if np.isnan(value) else int(value)
