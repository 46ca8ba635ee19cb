"""The weld register as a CSV file, read and written; a cell edited by hand is told with its row and what is wrong."""

import csv
import difflib
from collections.abc import Iterable, Mapping
from io import StringIO
from pathlib import Path

import numpy as np

from fatigue.errors import DataError, Problem, refuse
from fatigue.readers.neutral.body.welds import QUALITY, SURFACES
from fatigue.readers.neutral.register.weld_register import STATUSES, Register, RegisterRow
from fatigue.readers.text.flags import WORDS_BY_HAND, flag_of
from fatigue.readers.text.rows import read_rows

_COLUMNS = [
    *("weld", "line", "status", "reason", "kind", "pids", "pid", "nodes", "length_mm"),
    *("thickness_mm", "confirmed", "surface", "curve", "end_length_mm", "description"),
]

_KNOWN = [*_COLUMNS, *QUALITY]  # the columns of quality data are written where a weld has some


def register_text(rows: Iterable[RegisterRow]) -> str:
    """Text of the register as CSV, rows to assess first."""
    text = StringIO()
    writer = csv.writer(text, lineterminator="\n")
    rows = list(rows)
    quality = [name for name in QUALITY if any(getattr(row, name) for row in rows)]
    others = list(dict.fromkeys(name for row in rows for name in row.others))
    writer.writerow([*_COLUMNS, *quality, *others])
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
                *(getattr(row, name) for name in quality),
                *(row.others.get(name, "") for name in others),
            ]
        )
    return text.getvalue()


def open_register(path: Path, *, strict: bool) -> Register:
    """Read a register; an unknown column is a warning, or a mistake where strict.

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
    problems, warnings = [], list(_unknown_columns(path, names))
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
    refuse(DataError, [*problems, *(warnings if strict else ())])
    return Register(path, tuple(found.values()), tuple(warnings))


def _unknown_columns(path: Path, names: Iterable[str]) -> Iterable[Problem]:
    """Name the columns that nothing reads."""
    for name in names:
        if name and name not in _KNOWN:
            near = difflib.get_close_matches(name, _KNOWN, n=1)
            remedy = f"Rename it to {near[0]!r}" if near else "Remove it if it is not for yourself"
            what = "the column is unknown and not read"
            yield Problem("unknown_column", f"{path.name}: column {name}", what, remedy)


def _row(cells: Mapping[str, str], number: int) -> RegisterRow:
    """Row of checked cells; a ValueError says what is wrong."""
    for name, allowed in (("status", STATUSES), ("surface", SURFACES)):
        if (value := cells.get(name, "").lower()) and value not in allowed:
            raise ValueError(f"{name} is {value!r}, not one of {', '.join(allowed)}")
    flag = cells.get("confirmed", "").lower()
    if (confirmed := flag_of(flag, WORDS_BY_HAND)) is None:
        raise ValueError(f"confirmed is {flag!r}, not true or false")
    end_length = _number(cells, "end_length_mm")
    if end_length < 0:
        raise ValueError(f"end_length_mm is {cells['end_length_mm']}")
    thickness = _number(cells, "thickness_mm")
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
        **{name: cells.get(name, "") for name in QUALITY},
        number=number,
        others={name: value for name, value in cells.items() if name and name not in _KNOWN},
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
