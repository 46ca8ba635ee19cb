"""The page of a fleet: one HTML file that needs nothing but itself, in the look of the report."""

from typing import Any

from fatigue.decide.fleet.figures import MOST_UNITS, MOST_WELDS, ranking, shares, spread
from fatigue.decide.fleet.page_tables import percentiles_table, units_table
from fatigue.decide.fleet.summary import FleetFound
from fatigue.report.page_text import page_text
from fatigue.report.rows_table import MOST_ROWS, rows_table
from fatigue.report.sections.cells import PageTable
from fatigue.report.sections.embed import Figures, Shown
from fatigue.results.dictionary.decided.fleet import FLEET

PAGE = "fleet.html"
FOLDED_FROM = 40  # rows: the page shows them when asked
_OF_SHARES = (
    ("units", "What makes the units differ: share of the variance of the damage over the units, weld by weld."),
    ("unit", "What makes the damage of a unit uncertain: share of its variance, unit by unit."),
)


def fleet_page(found: FleetFound) -> str:
    """Return the page as text: the verdict, units by their lives, percentiles of welds, variance shares."""
    figs = Figures()
    context = {
        "title": found.title,
        "verdict": found.verdict,
        "missed": not found.fulfilled,
        "facts": f"{found.facts}.",
        "ranking": figs.add("ranking", ranking(found.units, found.target_years), _ranked(found), wide=True),
        "units": _table("fleet_units", units_table(found.units), len(found.units)),
        "spread": figs.add("spread", spread(found.percentiles, found.target_years), _spread(found), wide=True),
        "percentiles": _table("fleet_percentiles", percentiles_table(found.percentiles), found.welds + 1),
        "shares": _shares(found, figs),
        "variance": _table("fleet_variance", _variance(found), len(found.variance)) if found.variance else None,
        "points_rule": found.points_rule,
        "doubt": found.doubt,
        "warnings": found.warnings,
    }
    return page_text("fatigue.decide.fleet", "fleet.html", context, figs)


def _table(name: str, shown: PageTable, rows: int) -> dict[str, Any]:
    """A table with what the page says of it: how many rows it folds, how many it leaves to the file."""
    return {
        "table": shown,
        "folded": rows if rows >= FOLDED_FROM else 0,
        "left_out": max(0, rows - MOST_ROWS),
        "file": f"{name}.parquet",
    }


def _variance(found: FleetFound) -> PageTable:
    return rows_table("fleet_variance", FLEET["fleet_variance"], found.variance)


def _shares(found: FleetFound, figs: Figures) -> list[Shown]:
    drawn = [(of, shares(found.variance, of), caption) for of, caption in _OF_SHARES]
    return [figs.add(f"shares-of-{of}", fig, caption, wide=True) for of, fig, caption in drawn if fig is not None]


def _ranked(found: FleetFound) -> str:
    caption = "Life of the worst weld of each unit."
    if len(found.units) > MOST_UNITS:
        caption = f"Life of the worst weld of the {MOST_UNITS} units with the shortest lives."
    if any(row.is_bound for row in found.units[:MOST_UNITS]):
        caption += " Triangle: at least so long, an upper bound stands for the damage."
    return caption + ("" if found.target_years is None else " Upright line: the target.")


def _spread(found: FleetFound) -> str:
    welds = found.welds if found.welds <= MOST_WELDS else MOST_WELDS
    which = "every weld" if welds == found.welds else f"the {welds} welds with the shortest lives"
    return f"Percentiles of the life over the units, of {which}: so many percent of the units live no longer."
