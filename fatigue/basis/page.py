"""The page of a basis: one HTML file that needs nothing but itself, in the look of the report."""

import math
from collections.abc import Callable
from typing import Any

from fatigue.basis.figures import dynamic_masses, summed_masses
from fatigue.basis.finding import Finding
from fatigue.basis.lives_figure import lives_without
from fatigue.basis.summary import Basis
from fatigue.report.figures.drawn import Figure
from fatigue.report.page_text import page_text
from fatigue.report.rows_table import MOST_ROWS, rows_table
from fatigue.report.sections.embed import Figures, Shown
from fatigue.results.dictionary.basis import BASIS

PAGE = "basis.html"
FOLDED_FROM = 60  # rows: the page shows them when asked
ONLY_DRAWN = ("dynamic_mass",)  # a thousand frequencies are a curve, no table


def basis_page(found: Basis) -> str:
    """Return the page as text: heading, sentences, figure, table and notes of every finding."""
    figs = Figures()
    context = {
        "title": found.title,
        "sections": [_section(finding, figs, _band_hz(found)) for finding in found.findings],
        "warnings": found.warnings,
    }
    return page_text("fatigue.basis", "basis.html", context, figs)


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
        "table": rows_table(finding.table, BASIS[finding.table], finding.rows) if is_table else None,
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


_DRAWN: dict[str, tuple[Callable[[tuple[Any, ...], float], Figure | None], str]] = {
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
