"""The tables of the page: what a cell says, and the value it is sorted by."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from fatigue.report.wording import NOT_AVAILABLE, number, share, size, whole

_BEYOND = 1e300  # sorts after every number; what is not available sorts last


@dataclass(frozen=True, slots=True)
class Heading:
    """Head of a column: what it holds, its unit, and whether it holds numbers."""

    text: str
    unit: str = ""
    numeric: bool = True


@dataclass(frozen=True, slots=True)
class Cell:
    """One cell: its text, the number it is sorted by (None: its text), a link within the page, a mark for the style."""

    text: str
    value: float | None = None
    link: str = ""
    mark: str = ""


@dataclass(frozen=True, slots=True)
class Table:
    """A table of the page; one with a ``label`` gets a filter above it."""

    id: str
    headings: tuple[Heading, ...]
    rows: tuple[tuple[Cell, ...], ...]
    label: str = ""


WELD, FACE, EVENT = (
    Heading("weld", numeric=False),
    Heading("face", numeric=False),
    Heading("governing event", numeric=False),
)
LIFE = (Heading("life", "km"), Heading("life", "years"), Heading("utilisation", "-"), Heading("load factor", "-"))
LIFE_COLUMNS = ("life_km", "life_years", "utilisation", "load_factor")


def text(value: Any) -> Cell:
    """Cell with a name; a dash where there is none."""
    return Cell(NOT_AVAILABLE if value is None or value != value or value == "" else str(value))  # noqa: PLR0124


def num(value: Any) -> Cell:
    """Cell with a number of four digits."""
    missing = value is None or value != value  # noqa: PLR0124
    return Cell(number(value), 2 * _BEYOND if missing else float(np.clip(float(value), -_BEYOND, _BEYOND)))


def integer(value: Any, *, grouped: bool = False) -> Cell:
    """Cell with a count (grouped) or an id; a dash where there is none."""
    if pd.isna(value):
        return num(None)
    return Cell(whole(int(value)) if grouped else str(int(value)), float(value))


def percent(value: Any) -> Cell:
    """Cell with a share."""
    return Cell(share(value), -_BEYOND if value != value else float(value))  # noqa: PLR0124


def verdict(fulfilled: Any) -> Cell:
    """Cell that says whether a target is met: in words and a sign, not in colour alone."""
    return Cell("✓ met", 1.0, mark="met") if fulfilled else Cell("✕ missed", 0.0, mark="missed")


def lives(row: Mapping[str, Any] | pd.Series) -> list[Cell]:
    """Cells of life in km and years, utilisation and load factor."""
    return [num(row[name]) for name in LIFE_COLUMNS]


def weld_table(welds: pd.DataFrame, links: Mapping[str, str], most: int = 10) -> Table:
    """Worst welds with their worst points."""
    rows = tuple(
        (
            _linked(row.weld, links),
            verdict(row.fulfilled),
            *(num(getattr(row, name)) for name in LIFE_COLUMNS),
            integer(row.worst_node),
            text(row.worst_surface),
            num(row.worst_arc_length_mm),
            text(row.governing_event),
        )
        for row in welds[welds["status"] == "assessed"].head(most).itertuples()
    )
    headings = (
        WELD,
        Heading("target", numeric=False),
        *LIFE,
        Heading("worst node"),
        FACE,
        Heading("arc length", "mm"),
        EVENT,
    )
    return Table("worst-welds", headings, rows)


def point_table(nodes: pd.DataFrame, links: Mapping[str, str], most: int, id_: str, label: str = "") -> Table:
    """Worst toe points of all welds, those that a bound has settled left out."""
    worst = (
        nodes[nodes["toe"] & (nodes["screened"] == "")]
        .sort_values("utilisation", ascending=False, kind="stable")
        .head(most)
    )
    rows = tuple(
        (
            integer(rank),
            _linked(row.weld, links),
            integer(row.node),
            text(row.surface),
            num(row.arc_length_mm),
            *(num(getattr(row, name)) for name in LIFE_COLUMNS),
            num(row.life_km_dirlik),
            num(row.dirlik_ratio),
            num(row.max_range_MPa),
            num(row.equivalent_range_2e6_MPa),
            text(row.governing_event),
            text(", ".join(w for w, flag in (("end", row.at_end), ("corner", row.at_corner)) if flag)),
        )
        for rank, row in enumerate(worst.itertuples(), start=1)
    )
    headings = (
        Heading("rank"),
        WELD,
        Heading("node"),
        FACE,
        Heading("arc length", "mm"),
        *LIFE,
        Heading("Dirlik life", "km"),
        Heading("Dirlik / rainflow damage", "-"),
        Heading("largest range", "MPa"),
        Heading("equiv. range at 2e6", "MPa"),
        EVENT,
        Heading("place", numeric=False),
    )
    return Table(id_, headings, rows, label)


def register_table(welds: pd.DataFrame, links: Mapping[str, str]) -> Table:
    """Every weld of the case: assessed, or not and why."""
    rows = tuple(_register_row(row, links) for row in welds.itertuples())
    headings = (
        WELD,
        Heading("description", numeric=False),
        Heading("status", numeric=False),
        Heading("target", numeric=False),
        Heading("length", "mm"),
        Heading("nodes"),
        Heading("parts"),
        Heading("line", numeric=False),
        Heading("thickness", "mm"),
        Heading("toe on face", numeric=False),
        Heading("curve", numeric=False),
        Heading("survival", numeric=False),
        Heading("end length", "mm"),
        *LIFE,
    )
    return Table("weld-register", headings, rows, "Find a weld")


def _status(row: Any) -> str:
    """Status of a weld, with the reason where it is not assessed; that of a candidate says so itself."""
    if row.reason in ("", row.status) or pd.isna(row.reason):
        return str(row.status)
    return str(row.reason) if is_candidate(row.reason) else f"{row.status}: {row.reason}"


def is_candidate(reason: Any) -> bool:
    """Whether a weld is left out because nobody has decided about it yet."""
    return isinstance(reason, str) and (reason == "candidate" or reason.startswith("candidate: "))


def _register_row(row: Any, links: Mapping[str, str]) -> tuple[Cell, ...]:
    """Cells of a weld; one that is not assessed has a name, a reason and perhaps a length, and dashes."""
    is_assessed = row.status == "assessed"
    return (
        _linked(row.weld, links),
        text(row.description),
        text(_status(row)),
        verdict(row.fulfilled) if is_assessed else text(None),
        num(row.length_mm),
        integer(row.nodes, grouped=True),
        integer(row.parts),
        text(None if pd.isna(row.closed) else "closed" if row.closed else "open"),
        Cell(_span(row.thickness_min_mm, row.thickness_max_mm), num(row.thickness_min_mm).value),
        text(row.surface),
        text(row.curve),
        text(row.survival),
        Cell("plate thickness", 0.0) if is_assessed and pd.isna(row.end_length_mm) else num(row.end_length_mm),
        *(num(getattr(row, name)) for name in LIFE_COLUMNS),
    )


def event_table(events: Sequence[Mapping[str, Any]], residues: Mapping[str, str], steps: Mapping[str, float]) -> Table:
    """Load definition: the events of the mission; ``steps`` [s] where the records were found."""
    rows = []
    for event in events:
        name, length = event["event"], event["length"]
        duration = steps[name] * event["samples"] if name in steps else None
        rows.append(
            (
                text(name),
                text(None) if event["share"] is None else percent(event["share"]),
                num(event["per_1000_km"]),
                num(length),
                num(event["passes_per_km"]),
                integer(event["samples"], grouped=True),
                num(duration),
                num(3600.0 * length / duration if duration and length else None),
                num(event["start_s"]),
                num(event["stress_factor"]),
                text(residues[name].split(":")[0]),
            )
        )
    headings = (
        Heading("event", numeric=False),
        Heading("share of mileage", "%"),
        Heading("number in 1000 km", "-"),
        Heading("length of a pass", "km"),
        Heading("passes per km", "1/km"),
        Heading("samples"),
        Heading("duration", "s"),
        Heading("speed", "km/h"),
        Heading("start-up cut", "s"),
        Heading("stress factor", "-"),
        Heading("residue", numeric=False),
    )
    return Table("events", headings, tuple(rows))


def mode_table(modes: Mapping[str, Any]) -> Table:
    """List the modes used."""
    rows = tuple(
        (integer(mode), num(frequency), text(kind))
        for mode, frequency, kind in zip(modes["used"], modes["frequency_hz"], modes["kind"], strict=True)
    )
    return Table(
        "modes", (Heading("mode"), Heading("frequency", "Hz"), Heading("kind", numeric=False)), rows, "Find a mode"
    )


def input_table(inputs: Sequence[Mapping[str, Any]]) -> Table:
    """List the input files with their hashes."""
    rows = tuple(
        (Cell(i["file"]), Cell(size(i["bytes"]), float(i["bytes"])), Cell(i["sha256"], mark="hash")) for i in inputs
    )
    return Table("inputs", (Heading("file", numeric=False), Heading("size"), Heading("SHA-256", numeric=False)), rows)


def audit_table(conversion: Mapping[str, Any] | None) -> Table | None:
    """List what the conversion of foreign files found of signs, balance and completeness; None without a conversion."""
    if conversion is None:
        return None
    rows = tuple(
        (text(row["check"]), text(row["light"]), num(row["value"]), text(row["finding"]), text(row["remedy"]))
        for row in conversion["audit"]
    )
    words = tuple(Heading(name, numeric=name == "value") for name in ("check", "light", "value", "finding", "remedy"))
    return Table("audit", words, rows)


def verification_table(checks: Sequence[Mapping[str, Any]]) -> Table | None:
    """List the checks of the installed program against known answers; None where none was made."""
    if not checks:
        return None
    rows = tuple(
        (
            text(check["topic"]),
            text(check["case"]),
            text(check["quantity"]),
            Cell(f"{number(check['expected'])} {check['unit'].strip('-')}".strip(), float(check["expected"])),
            num(check["found"]),
            Cell(f"{check['difference']:.1e}", float(check["difference"])),
            Cell(f"{check['tolerance']:.0e}", float(check["tolerance"])),
            Cell("✓", 1.0) if check["passed"] else Cell("✕ wrong", 0.0, mark="missed"),
            text(check["source"]),
        )
        for check in checks
    )
    headings = (
        Heading("topic", numeric=False),
        Heading("case", numeric=False),
        Heading("quantity", numeric=False),
        Heading("expected"),
        Heading("found"),
        Heading("difference"),
        Heading("allowed"),
        Heading("passed", numeric=False),
        Heading("source", numeric=False),
    )
    return Table("verification", headings, rows, "Find a check")


def _linked(weld: str, links: Mapping[str, str]) -> Cell:
    return Cell(weld, link=links.get(weld, ""))


def _span(low: float, high: float) -> str:
    return number(low) if low == high or pd.isna(low) else f"{number(low)} to {number(high)}"
