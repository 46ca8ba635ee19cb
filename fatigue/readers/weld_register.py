"""The editable register of weld lines: what is assessed, what is not and why. It wins over detection in the next run.

Every cut that was found keeps one row. The column ``line`` is the name detection gives and must stay; the rest is the
user's: ``weld`` (the name in the results), ``status`` (assess, candidate or excluded), ``reason``, ``surface``,
``curve``, ``end_length_mm``, ``description``, and ``thickness_mm`` with ``confirmed``, which together settle a layered
or otherwise doubtful section.
"""

import csv
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from io import StringIO
from pathlib import Path

import numpy as np

from fatigue.errors import DataError, Problem, refuse
from fatigue.readers.body import SURFACES
from fatigue.readers.text_rows import read_rows
from fatigue.weld.cuts import WeldCut
from fatigue.weld.line_geometry import length

REGISTER = "welds_register.csv"
STATUSES = ("assess", "candidate", "excluded")
_COLUMNS = [
    *("weld", "line", "status", "reason", "kind", "pids", "pid", "nodes", "length_mm"),
    *("thickness_mm", "confirmed", "surface", "curve", "end_length_mm", "description"),
]


@dataclass(frozen=True, slots=True)
class RegisterRow:
    """One cut in the register; ``thickness`` NaN where the model gives none [mm]."""

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


def merged(rows: Iterable[RegisterRow], edited: Mapping[str, RegisterRow]) -> tuple[list[RegisterRow], list[Problem]]:
    """Put the user's columns of an earlier register over fresh rows; rows whose line is gone are kept, excluded."""
    fresh = {row.line: row for row in rows}
    result, remarks = [], []
    for line, row in fresh.items():
        old = edited.get(line)
        if old is None:
            result.append(row)
            continue
        result.append(
            replace(
                row,
                weld=old.weld,
                status=old.status,
                reason=old.reason,
                thickness=old.thickness if old.confirmed else row.thickness,
                confirmed=old.confirmed,
                surface=old.surface,
                curve=old.curve,
                end_length=old.end_length,
                description=old.description,
            )
        )
    for line, old in edited.items():
        if line not in fresh:
            result.append(replace(old, status="excluded", reason="the mesh has this line no more"))
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
    writer.writerow(_COLUMNS)
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
            ]
        )
    return text.getvalue()


def read_register(path: Path) -> dict[str, RegisterRow]:
    """Read a register, by line.

    Raises
    ------
    DataError : unreadable, columns missing, a line or a weld given twice, an impossible value
    """
    _, table = read_rows(path, numbers=("thickness_mm", "end_length_mm", "length_mm"))
    found: dict[str, RegisterRow] = {}
    problems = []
    welds: set[str] = set()
    for given in table:
        where, clean = f"{path}: row {given.number}", given.cells
        if missing := [name for name in ("weld", "line", "status") if not clean.get(name)]:
            problems.append(Problem("missing_value", where, f"column {missing[0]} is missing or empty", "Fill it in"))
            continue
        try:
            row = _row(clean)
        except ValueError as error:
            problems.append(Problem("bad_value", where, str(error), "Correct the cell"))
            continue
        if row.line in found or (row.weld in welds and row.status == "assess"):
            problems.append(Problem("twice", where, f"line {row.line} or weld {row.weld} is given twice", "Rename one"))
        found[row.line] = row
        if row.status == "assess":
            welds.add(row.weld)
    refuse(DataError, problems)
    return found


def _row(cells: Mapping[str, str]) -> RegisterRow:
    """Row of checked cells; a ValueError says what is wrong."""
    for name, allowed in (("status", STATUSES), ("surface", SURFACES), ("confirmed", ("true", "false", "1", "0"))):
        if (value := cells.get(name, "").lower()) and value not in allowed:
            raise ValueError(f"{name} is {value!r}, not one of {', '.join(allowed)}")
    if cells.get("end_length_mm") and not float(cells["end_length_mm"]) >= 0:
        raise ValueError(f"end_length_mm is {cells['end_length_mm']}")
    thickness = float(cells.get("thickness_mm") or "nan")
    confirmed = cells.get("confirmed", "").lower() in ("true", "1")
    if confirmed and not thickness > 0:
        raise ValueError(f"thickness_mm is {cells.get('thickness_mm')!r}, a confirmed thickness must be above 0")
    return RegisterRow(
        weld=cells["weld"],
        line=cells["line"],
        status=cells["status"].lower(),
        reason=cells.get("reason", ""),
        kind=cells.get("kind", ""),
        pids=cells.get("pids", ""),
        pid=int(cells.get("pid") or 0),
        nodes=int(cells.get("nodes") or 0),
        length=float(cells.get("length_mm") or "nan"),
        thickness=thickness,
        confirmed=confirmed,
        surface=cells.get("surface", "").lower() or "both",
        curve=cells.get("curve", ""),
        end_length=cells.get("end_length_mm", ""),
        description=cells.get("description", ""),
    )
