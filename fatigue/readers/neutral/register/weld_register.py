"""The editable register of weld lines: what is assessed, what is not and why. It wins over detection in the next run.

Every cut that was found keeps one row. The column ``line`` is the name detection gives and must stay; the rest is the
user's: ``weld`` (the name in the results), ``status`` (assess, candidate or excluded), ``reason``, ``surface``,
``curve``, ``end_length_mm``, ``description``, and ``thickness_mm`` with ``confirmed``, which together settle a layered
or otherwise doubtful section. Lines to assess that have one name are one weld and have to join end to end. For tables
written by hand ``line`` is the name of the weld in these, and may be empty where it is the same as ``weld``.
"""

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from fatigue.errors import Problem
from fatigue.readers.neutral.body.welds import QUALITY
from fatigue.weld.cuts import WeldCut
from fatigue.weld.line_geometry import length

REGISTER = "welds_register.csv"
STATUSES = ("assess", "candidate", "excluded")


@dataclass(frozen=True, slots=True)
class RegisterRow:
    """One cut in the register; ``thickness`` NaN where the model gives none [mm].

    ``surface`` is empty where the register leaves it open. ``number`` counts the rows of the file from 1. ``others``
    are the cells of columns that nothing reads, kept for the user.
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
    joint_type: str = ""
    performance_class: str = ""
    inspection_class: str = ""
    number: int = field(default=0, compare=False)
    others: Mapping[str, str] = field(default_factory=dict, compare=False)

    @property
    def key(self) -> str:
        """What the row is found by: its line, or its weld where it names none."""
        return self.line or self.weld


@dataclass(frozen=True, slots=True)
class Register:
    """A register as it was read: the file, its rows, and the warnings about it."""

    path: Path
    rows: tuple[RegisterRow, ...]
    warnings: tuple[Problem, ...] = ()

    def where(self, row: RegisterRow, column: str = "") -> str:
        """Name a place in the file."""
        return f"{self.path.name}: row {row.number} ({row.weld})" + (f", column {column}" if column else "")


def description_of(rows: Iterable[RegisterRow]) -> str:
    """Description of a weld: the user's words for its lines, else their kinds and the properties that meet there."""
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
    for column in QUALITY:
        given = {getattr(row, column): row for row in reversed(rows) if getattr(row, column)}
        if len(given) > 1:
            values = " and ".join(f"{value} (line {row.key})" for value, row in sorted(given.items()))
            what = f"its lines have different {column}: {values}"
            yield Problem("contradiction", where, what, "Give them one, or give the lines two names")


def kind_of(reason: str) -> str:
    """Kind of a reason: the reason with every number written as 0."""
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
    """Fresh rows with the user's columns of an earlier register, and warnings; a row whose line is gone is excluded."""
    fresh = {row.line: row for row in rows}
    edited = {row.key: row for row in register.rows}
    result, warnings = [], list(register.warnings)
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
                **{name: getattr(old, name) for name in QUALITY},
            )
        )
    for line, old in edited.items():
        if line not in fresh:
            result.append(replace(old, line=line, status="excluded", reason="the mesh has this line no more"))
            if old.status == "assess":
                warnings.append(
                    Problem(
                        "line_gone",
                        f"weld register, line {line}",
                        f"weld {old.weld} is registered, but the mesh does not have its line any more",
                        "Register the line that replaces it",
                    )
                )
    return result, warnings
