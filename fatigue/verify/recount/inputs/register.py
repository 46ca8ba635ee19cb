"""The weld register read anew: which welds of the tables are recounted, under which names, and which are one."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any
from unicodedata import normalize

import numpy as np
import pandas as pd

from fatigue.verify.recount.inputs.dialect import read_texts

QUALITY = ("joint_type", "performance_class", "inspection_class")
TEXTS = ("weld", "line", "status", "reason", "confirmed", "surface", "curve", "description", *QUALITY)
YES = ("true", "1", "yes", "wahr", "ja", "vrai", "oui")


@dataclass(frozen=True, slots=True)
class WeldEntry:
    """One weld as it is to be assessed.

    ``attachment`` [mm] is the length of what it attaches, NaN where nothing is said; ``curve_shear`` that of its shear,
    ``quality`` what is given of its quality, by column.
    ``sources`` are its names in the tables, more than one where lines were joined; ``surface`` and ``curve`` are empty
    and ``end_length`` [mm] is NaN where nothing is said; ``thickness`` [mm] by source, where the user has confirmed it.
    """

    name: str
    sources: tuple[str, ...]
    closed: bool
    surface: str
    curve: str
    end_length: float
    thickness: Mapping[str, float]
    curve_shear: str = ""
    attachment: float = np.nan
    quality: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class WeldEntries:
    """The welds to assess, by name in the order of the tables, and why each of the lines is not that is listed only."""

    welds: Mapping[str, WeldEntry]
    left_out: tuple[str, ...]


def weld_entries(case: Mapping[str, Any], folder: Path, table: pd.DataFrame) -> WeldEntries:
    """Welds to assess: the register of a case, if it has one, over its table of welds."""
    of_table = {name: _of_table(row) for name, row in zip(table["weld"], table.to_dict("records"), strict=True)}
    beside = (folder / case["body"]["welds"]).parent
    named = case["body"].get("register")
    path = beside / "welds_register.csv" if named is None else folder / named
    if not path.is_file():
        return WeldEntries(of_table, ())
    rows = _rows(path)
    lines = _lines(beside / "convert.json")
    entries: dict[str, WeldEntry] = {}
    used: set[int] = set()
    by_line: dict[str, int] = {}
    for number, row in enumerate(rows):
        by_line.setdefault(row.get("line") or row["weld"], number)
    own_of = {name: [by_line[k] for k in lines.get(name, [name]) if k in by_line] for name in of_table}
    used.update(number for own in own_of.values() for number in own)
    for name, entry in of_table.items():
        own = own_of[name]
        if not own and name not in lines:
            own = [n for n, row in enumerate(rows) if row["weld"] == name and n not in used][:1]
        if not own:
            entries[name] = entry
        elif rows[own[0]]["status"].lower() == "assess":
            new = _registered(entry, [rows[n] for n in own], name in lines)
            old = entries.get(new.name)
            entries[new.name] = new if old is None else _with(old, new)
    return WeldEntries(entries, tuple(_reason(row) for row in rows if row["status"].lower() != "assess"))


def _reason(row: Mapping[str, str]) -> str:
    status, reason = row["status"].lower(), row.get("reason", "")
    return reason or status if status == "excluded" or not reason else f"candidate: {reason}"


def _of_table(row: Mapping[str, Any]) -> WeldEntry:
    def text(name: str) -> str:
        value = row.get(name)
        return "" if value is None or pd.isna(value) else str(value).strip()

    end_length = row.get("end_length_mm", np.nan)
    return WeldEntry(
        name=str(row["weld"]),
        sources=(str(row["weld"]),),
        closed=text("closed").lower() in ("true", "1", "1.0"),
        surface=text("surface"),
        curve=text("curve"),
        end_length=float(end_length),
        thickness={},
        curve_shear=text("curve_shear"),
        attachment=float(row.get("attachment_mm", np.nan)),
        quality={name: text(name) for name in QUALITY},
    )


def _registered(entry: WeldEntry, rows: Sequence[Mapping[str, str]], is_converted: bool) -> WeldEntry:
    """Entry of a weld of the tables as the register has it; of converted tables an empty cell means the default."""
    row = rows[0]
    confirmed = row.get("confirmed", "").lower() in YES
    end_length = row.get("end_length_mm", "")
    one = len({(r.get("confirmed", ""), r.get("thickness_mm", "")) for r in rows}) == 1
    return WeldEntry(
        name=row["weld"],
        sources=entry.sources,
        closed=entry.closed,
        surface=row.get("surface", "").lower() or ("" if is_converted else entry.surface),
        curve=row.get("curve", "") or ("" if is_converted else entry.curve),
        end_length=float(end_length) if end_length else np.nan if is_converted else entry.end_length,
        thickness={entry.name: float(row["thickness_mm"])} if confirmed and one else {},
        curve_shear=entry.curve_shear,
        attachment=entry.attachment,
        quality={name: next(filter(None, (r.get(name, "") for r in rows)), entry.quality[name]) for name in QUALITY},
    )


def _with(a: WeldEntry, b: WeldEntry) -> WeldEntry:
    """One weld of two lines of one name."""
    thickness = {**a.thickness, **b.thickness}
    return replace(a, sources=a.sources + b.sources, closed=False, thickness=thickness)


def _rows(path: Path) -> list[dict[str, str]]:
    """Rows of the register as trimmed texts, however a spreadsheet has saved it."""
    rows = []
    for piece in read_texts(path, TEXTS):
        for cells in piece.fillna("").itertuples(index=False, name=None):
            row = {name: normalize("NFC", cell.strip()) for name, cell in zip(piece.columns, cells, strict=True)}
            rows += [row] if any(row.values()) else []
    return rows


def _lines(path: Path) -> dict[str, list[str]]:
    """Lines of every weld that ``fatigue convert`` wrote; none where the tables are of another hand."""
    if not path.is_file():
        return {}
    record = json.loads(path.read_text(encoding="utf-8"))
    return {weld: list(lines) for weld, lines in record.get("welds", {}).items()}
