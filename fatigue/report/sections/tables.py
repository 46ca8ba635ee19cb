"""The tables of the page about the whole body: its worst welds and points, the register, what was given, the checks."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import pandas as pd

from fatigue.report.sections.beside.checks import CHECKS
from fatigue.report.sections.cells import (
    Cell,
    Heading,
    PageTable,
    given,
    integer,
    life,
    linked,
    num,
    percent,
    span,
    text,
    verdict,
)
from fatigue.report.wording import number, size

WELD, FACE, EVENT = (
    Heading("weld", numeric=False),
    Heading("face", numeric=False),
    Heading("governing event", numeric=False),
)
LIFE = (Heading("life", "km"), Heading("life", "years"), Heading("utilisation", "-"), Heading("load factor", "-"))
LIFE_COLUMNS = {"life_km": life, "life_years": life, "utilisation": num, "load_factor": num}


def weld_table(welds: pd.DataFrame, links: Mapping[str, str], most: int = 10) -> PageTable:
    """Worst welds with their worst points."""
    rows = tuple(
        (
            linked(row.weld, links),
            verdict(row.fulfilled),
            *(cell(getattr(row, name)) for name, cell in LIFE_COLUMNS.items()),
            integer(row.worst_node),
            text(row.worst_surface),
            given(row.worst_arc_length_mm),
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
    return PageTable("worst-welds", headings, rows)


def place(row: Any) -> str:
    """What is special about the place of a point, in short."""
    corner = "corner, summed" if row.summed_corner else "corner"
    return ", ".join(words for words, flag in (("end", row.at_end), (corner, row.at_corner)) if flag)


def register_table(welds: pd.DataFrame, links: Mapping[str, str]) -> PageTable:
    """Every weld of the case: assessed, or not and why."""
    more = [column for column in _REGISTER if column in welds and _says_something(welds[column])]
    more = more if {*more} - {*_CATEGORY} else []  # where nothing else was asked for, nobody asked for a category
    rows = tuple(
        (*_register_row(row, links), *(_REGISTER[column][1](getattr(row, column)) for column in more))
        for row in welds.itertuples()
    )
    headings = (
        WELD,
        Heading("target", numeric=False),
        *LIFE,
        Heading("description", numeric=False),
        Heading("status", numeric=False),
        Heading("length", "mm"),
        Heading("nodes"),
        Heading("parts"),
        Heading("line", numeric=False),
        Heading("thickness", "mm"),
        Heading("toe on face", numeric=False),
        Heading("curve", numeric=False),
        Heading("survival", numeric=False),
        Heading("end length", "mm"),
        *(_REGISTER[column][0] for column in more),
    )
    return PageTable("weld-register", headings, rows, "Find a weld")


_REGISTER: dict[str, tuple[Heading, Callable[[Any], Cell]]] = {  # columns that are shown where a case has them
    "worst_check": (Heading("worst check beside the toe", numeric=False), lambda name: text(_check_name(name))),
    "worst_check_utilisation": (Heading("its utilisation, stress", "-"), num),
    "checks_not_assessed": (Heading("checks not assessed"), integer),
    "joint_type": (Heading("joint", numeric=False), text),
    "performance_class": (Heading("performance class", numeric=False), text),
    "inspection_class": (Heading("inspection class", numeric=False), text),
    "stress_utilisation": (Heading("stress utilisation", "-"), num),
    "stress_category": (Heading("stress category", numeric=False), text),
}


_CATEGORY = ("stress_utilisation", "stress_category")


def _says_something(column: "pd.Series[Any]") -> bool:
    """Whether any weld has an entry: a text that is not empty, or a number other than 0."""
    given = column.dropna()
    return bool(((given != "") & (given != 0)).any())


def _check_name(name: Any) -> Any:
    """A check in words."""
    return CHECKS.get(name, name) if isinstance(name, str) else None


def _status(row: Any) -> str:
    """Status of a weld, with the reason where it is not assessed; the reason of a candidate says so itself."""
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
        linked(row.weld, links),
        verdict(row.fulfilled) if is_assessed else text(None),
        *(num(None) if not is_assessed else cell(getattr(row, name)) for name, cell in LIFE_COLUMNS.items()),
        text(row.description),
        text(_status(row)),
        given(row.length_mm),
        integer(row.nodes, grouped=True),
        integer(row.parts),
        text(None if pd.isna(row.closed) else "closed" if row.closed else "open"),
        span(row.thickness_min_mm, row.thickness_max_mm),
        text(row.surface),
        text(row.curve),
        text(row.survival),
        Cell("plate thickness", 0.0) if is_assessed and pd.isna(row.end_length_mm) else given(row.end_length_mm),
    )


def event_table(
    events: Sequence[Mapping[str, Any]], residues: Mapping[str, str], steps: Mapping[str, float]
) -> PageTable:
    """The events of the mission, its load definition; ``steps`` [s] where the records were found."""
    rows = []
    for event in events:
        name, length = event["event"], event["length"]
        duration = steps[name] * event["samples"] if name in steps else None
        rows.append(
            (
                text(name),
                text(None) if event["share"] is None else percent(event["share"]),
                given(event["per_1000_km"]),
                given(length),
                num(event["passes_per_km"]),
                integer(event["samples"], grouped=True),
                given(duration),
                given(3600.0 * length / duration if duration and length else None),
                given(event["start_s"]),
                given(event["stress_factor"]),
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
    return PageTable("events", headings, tuple(rows))


def gravity_table(gravity: Sequence[Mapping[str, Any]]) -> PageTable | None:
    """What the mean of q of every event holds of the dead load; None without a gravity load."""
    if not gravity:
        return None
    rows = [
        (
            text(one["event"]),
            text(one["verdict"]),
            num(one["beta"]),
            num(one["cos"]),
            text("removed" if one["mean_of_q"] == "remove" else "kept"),
            given(one["given"]),
        )
        for one in gravity
    ]
    headings = (
        Heading("event", numeric=False),
        Heading("dead load in the mean of q", numeric=False),
        Heading("times the gravity load", "-"),
        Heading("cosine", "-"),
        Heading("mean of q", numeric=False),
        Heading(f"{gravity[0]['unit_load']} given"),
    )
    return PageTable("gravity", headings, tuple(rows))


def mode_table(modes: Mapping[str, Any]) -> PageTable:
    """The modes used."""
    rows = tuple(
        (integer(mode), given(frequency), text(kind))
        for mode, frequency, kind in zip(modes["used"], modes["frequency_hz"], modes["kind"], strict=True)
    )
    return PageTable(
        "modes", (Heading("mode"), Heading("frequency", "Hz"), Heading("kind", numeric=False)), rows, "Find a mode"
    )


def input_table(inputs: Sequence[Mapping[str, Any]]) -> PageTable:
    """The input files with their hashes."""
    rows = tuple(
        (Cell(i["file"]), Cell(size(i["bytes"]), float(i["bytes"])), Cell(i["sha256"], mark="hash")) for i in inputs
    )
    return PageTable(
        "inputs", (Heading("file", numeric=False), Heading("size"), Heading("SHA-256", numeric=False)), rows
    )


def audit_table(conversion: Mapping[str, Any] | None) -> PageTable | None:
    """What the conversion of foreign files found of signs, balance and completeness; None without a conversion."""
    if conversion is None:
        return None
    rows = tuple(
        (text(row["check"]), text(row["light"]), num(row["value"], ""), text(row["finding"]), text(row["remedy"]))
        for row in conversion["audit"]
    )
    words = tuple(Heading(name, numeric=name == "value") for name in ("check", "light", "value", "finding", "remedy"))
    return PageTable("audit", words, rows)


def verification_table(checks: Sequence[Mapping[str, Any]]) -> PageTable | None:
    """The checks of the installed program against known answers; None where none was made."""
    if not checks:
        return None
    rows = tuple(
        (
            text(check["topic"]),
            text(check["case"]),
            text(check["quantity"]),
            Cell(f"{number(check['expected'])} {check['unit'].strip('-')}".strip(), float(check["expected"])),
            num(check["found"], ""),
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
    return PageTable("verification", headings, rows, "Find a check")
