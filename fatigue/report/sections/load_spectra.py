"""What load spectra, where they were made, say of the points shown in detail: figures and equivalent ranges."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import pandas as pd

from fatigue.report import figures, wording
from fatigue.report.result import ShownResult, rows_of_worst_points
from fatigue.report.sections.cells import Cell, Heading, PageTable, num
from fatigue.report.sections.embed import Figures, Shown

TABLES = ("spectrum", "range_mean", "from_to", "level_crossings", "equivalent")
EVENTS_LISTED = 20


@dataclass(frozen=True, slots=True, eq=False)
class LoadSpectra:
    """Rows of the load spectra for the worst points of the detailed welds; ``said`` is how they were made.

    An empty table: the worst point of no detailed weld was among those chosen.
    """

    spectrum: pd.DataFrame
    range_mean: pd.DataFrame
    from_to: pd.DataFrame
    level_crossings: pd.DataFrame
    equivalent: pd.DataFrame
    said: Mapping[str, Any]

    def of_weld(self, weld: str) -> "LoadSpectra":
        """Rows of one weld."""
        tables = {name: getattr(self, name) for name in TABLES}
        return replace(self, **{name: rows[rows["weld"] == weld] for name, rows in tables.items()})


def read_load_spectra(folder: Path, result: ShownResult) -> LoadSpectra | None:
    """Tables of the load spectra, read; None where there are none."""
    if not all((folder / f"{name}.parquet").is_file() for name in TABLES):
        return None
    tables = {name: rows_of_worst_points(folder, name, result.assessed, result.detailed) for name in TABLES}
    return LoadSpectra(**tables, said=result.record.get("load_spectra", {}))


def spectra_figures(own: LoadSpectra, result: ShownResult, figs: Figures) -> list[Shown]:
    """Figures of the load spectra of one weld's worst point; none where it has none or nothing varies there."""
    mission = own.range_mean[own.range_mean["event"] == "(mission)"]
    if not len(mission):
        return []
    events = [event["event"] for event in result.events]
    reversals = own.from_to[own.from_to["event"] == "(mission)"]
    measured = (own.spectrum["event"] == "(measured)").any()
    beside = ", and the measured spectrum beside it" if measured else ""
    return [
        figs.add(
            "load-matrices",
            figures.class_matrices(mission, reversals),
            "Load spectra of the mission: range and mean; first and second reversal in time",
            wide=True,
        ),
        figs.add(
            "load-spectrum", figures.spectrum_exceedance(own.spectrum, events), f"Range spectrum in 1e6 km{beside}"
        ),
        figs.add("crossings", figures.crossings_by_level(own.level_crossings, events), "Level crossings in 1e6 km"),
    ]


def equivalent_table(id_: str, own: LoadSpectra) -> PageTable | None:
    """Equivalent ranges of the events at one point, of many those that damage most; None where there are none."""
    rows = own.equivalent
    if not len(rows):
        return None
    is_event = ~rows["event"].str.startswith("(")
    damage = rows[is_event].groupby("event", sort=False)["damage_per_km"].first()
    listed = set(damage.sort_values(ascending=False, kind="stable").index[:EVENTS_LISTED])
    cells = tuple(
        (
            Cell(str(row.event).strip("()") if str(row.event).startswith("(") else str(row.event)),
            num(row.cycles_per_km),
            num(row.max_range_MPa),
            num(row.exponent),
            num(row.equivalent_range_2e6_MPa),
            num(row.equivalent_amplitude_2e6_MPa),
            num(row.del_MPa),
            Cell(str(row.del_reference)),
            num(row.damage_per_km),
            num(row.bending_ratio),
        )
        for row in rows.itertuples()
        if row.event in listed or str(row.event).startswith("(")
    )
    headings = (
        Heading("event", numeric=False),
        Heading("cycles", "1/km"),
        Heading("largest range", "MPa"),
        Heading("exponent", "-"),
        Heading("equivalent range, 2e6", "MPa"),
        Heading("amplitude", "MPa"),
        Heading("DEL", "MPa"),
        Heading("against cycles at", numeric=False),
        Heading("damage", "1/km"),
        Heading("bending ratio", "-"),
    )
    return PageTable(id_, headings, cells)


def spectra_words(spectra: LoadSpectra | None) -> list[str]:
    """What the page says of all load spectra together: which points have them, and what was measured."""
    if spectra is None:
        return []
    said = spectra.said
    files = said.get("files", {})
    words = [f"Load spectra: {said.get('points', 'chosen points')}, {said.get('classes', 'some')} classes."]
    if "compare" in files:
        of_km = wording.km(said.get("compare_km"))
        words.append(f"Measured: {files['compare'].get('file')}, its counts for {of_km}.")
    return words


def spectra_warnings(spectra: LoadSpectra | None) -> list[Mapping[str, Any]]:
    """Warnings about the load spectra, which stand with those of the assessment."""
    return [] if spectra is None else list(spectra.said.get("warnings", []))
