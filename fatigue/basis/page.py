"""The page of a basis: one HTML file that needs nothing but itself, in the look of the report."""

import math
from collections.abc import Callable
from typing import Any

import plotly.graph_objects as go
from markupsafe import Markup
from plotly.offline import get_plotlyjs

from fatigue import __version__
from fatigue.basis.figures import dynamic_masses, summed_masses
from fatigue.basis.finding import Finding
from fatigue.basis.lives_figure import lives_without
from fatigue.basis.summary import Basis
from fatigue.report.environment import environment
from fatigue.report.figures import CONFIG, TEMPLATE
from fatigue.report.sections.cells import Cell, Heading, PageTable, num, percent, text
from fatigue.report.sections.embed import Figures, Shown, embedded
from fatigue.results.dictionary.basis import BASIS
from fatigue.results.dictionary.column import Column

PAGE = "basis.html"
MOST_ROWS = 600  # of a table on the page; the files have all
FILTERED_FROM = 25  # rows
FOLDED_FROM = 60  # rows: the page shows them when asked
ONLY_DRAWN = ("dynamic_mass",)  # a thousand frequencies are a curve, no table


def basis_page(found: Basis) -> str:
    """Return the page as text: heading, sentences, figure, table and notes of every finding."""
    figs = Figures()
    context = {
        "title": found.title,
        "version": __version__,
        "sections": [_section(finding, figs, _band_hz(found)) for finding in found.findings],
        "warnings": found.warnings,
        "config": embedded(CONFIG),
        "template": embedded(TEMPLATE.to_plotly_json()),
        "plotly": Markup(get_plotlyjs()) if figs.shown else "",
    }
    return environment("fatigue.basis").get_template("basis.html").render(context)


def _band_hz(found: Basis) -> float:
    """Upper end of the band that has to be complete [Hz]; NaN where there are no masses."""
    sums = next((finding.rows for finding in found.findings if finding.table == "mass_sum"), ())
    return sums[0].band_hz if sums else math.nan


def _section(finding: Finding, figs: Figures, band_hz: float) -> dict[str, Any]:
    is_table = bool(finding.rows) and finding.table not in ONLY_DRAWN
    return {
        "id": finding.table.replace("_", "-"),
        "heading": finding.heading,
        "said": finding.said,
        "notes": finding.notes,
        "figure": _figure(finding, figs, band_hz),
        "table": _page_table(finding) if is_table else None,
        "folded": len(finding.rows) if is_table and len(finding.rows) >= FOLDED_FROM else 0,
        "left_out": max(0, len(finding.rows) - MOST_ROWS) if is_table else 0,
        "file": f"{finding.table}.parquet",
    }


def _figure(finding: Finding, figs: Figures, band_hz: float) -> Shown | None:
    """Figure of a finding that has one."""
    if not finding.rows or finding.table not in _DRAWN:
        return None
    draw, caption = _DRAWN[finding.table]
    drawn = draw(finding.rows, band_hz)
    return None if drawn is None else figs.add(finding.table, drawn, caption, wide=True)


_DRAWN: dict[str, tuple[Callable[[tuple[Any, ...], float], go.Figure | None], str]] = {
    "modal_mass": (
        summed_masses,
        "Effective mass of the modes up to a frequency, over the mass or inertia of the body; dotted: the band ends.",
    ),
    "dynamic_mass": (
        dynamic_masses,
        "Dynamic mass: force (or moment) at the base over its acceleration; dotted: the band ends.",
    ),
    "truncation": (
        lives_without,
        "Shortest life of each weld without some modes over that with all modes; dotted: a life that moves.",
    ),
}


def _page_table(finding: Finding) -> PageTable:
    """Rows as a table of the page, headings and order as in the data dictionary; what no row has is left out."""
    shown = finding.rows[:MOST_ROWS]
    columns = [column for column in BASIS[finding.table] if any(_is_there(getattr(r, column.name)) for r in shown)]
    headings = tuple(_heading(column) for column in columns)
    rows = tuple(tuple(_cell(column, getattr(row, column.name)) for column in columns) for row in shown)
    label = "Find a row" if len(shown) >= FILTERED_FROM else ""
    return PageTable(finding.table.replace("_", "-") + "-table", headings, rows, label)


def _is_there(value: Any) -> bool:
    return value is not None and value != "" and not (isinstance(value, float) and math.isnan(value))


def _heading(column: Column) -> Heading:
    """Name of a column in words; a unit that it ends with stands beside it."""
    name = column.name
    for ending in ("_hz", "_mm_per_N", "_km", "_s", "_MPa"):
        name = name.removesuffix(ending)
    return Heading(
        name.replace("_", " "), "" if _is_share(column) else column.unit, numeric=column.type in ("int", "float")
    )


def _cell(column: Column, value: Any) -> Cell:
    if not _is_there(value):
        return num(None) if column.type in ("int", "float") else text(None)
    if column.type == "flag":
        return text("yes" if value else "no")
    if column.type == "int":
        return Cell(str(value), float(value))
    if column.type == "float":
        return percent(value) if _is_share(column) else num(value)
    return text(value)


def _is_share(column: Column) -> bool:
    return column.unit == "-" and "share" in column.name.split("_")
