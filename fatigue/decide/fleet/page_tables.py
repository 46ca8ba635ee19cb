"""Tables of the page of a fleet: a row for each unit, and one for each weld with its percentiles side by side."""

from collections.abc import Sequence

from fatigue.decide.fleet.rows import PercentileRow, UnitRow
from fatigue.decide.fleet.summary import LONGEST_YEARS, years
from fatigue.report.rows_table import MOST_ROWS, filter_label
from fatigue.report.sections.cells import Cell, Heading, PageTable, integer, life, num, percent, text, verdict


def units_table(rows: Sequence[UnitRow]) -> PageTable:
    """Units with their worst welds; only what some unit has."""
    shown = rows[:MOST_ROWS]
    has_bound, has_target = any(row.is_bound for row in shown), any(row.fulfilled is not None for row in shown)
    has_error = any(row.damage_cv == row.damage_cv for row in shown)
    headings = [Heading("rank"), Heading("unit", numeric=False), Heading("life", "years")]
    headings += [Heading("at most", "years")] if has_bound else []
    headings += [Heading("life", "km"), Heading("distance", "km per year")]
    headings += [Heading(name, numeric=False) for name in ("weld", "face")] + [Heading("node")]
    headings += [Heading("most of it by", numeric=False), Heading("share")]
    headings += [Heading("standard deviation of the damage")] if has_error else []
    headings += [Heading("target", numeric=False)] if has_target else []
    cells = []
    for row in shown:
        told = [integer(row.rank), text(row.unit), lived(row.life_years, row.is_bound)]
        told += [lived(row.life_years_at_most, False)] if has_bound else []
        told += [life(row.life_km), num(row.km_per_year), text(row.weld), text(row.surface), integer(row.node)]
        told += [text(row.governing_condition), percent(row.governing_share)]
        told += [percent(row.damage_cv)] if has_error else []
        told += [verdict(row.fulfilled)] if has_target else []
        cells.append(tuple(told))
    return PageTable("fleet-units-table", tuple(headings), tuple(cells), filter_label(len(shown), "unit"))


def percentiles_table(rows: Sequence[PercentileRow]) -> PageTable:
    """Percentiles of the life, a row for each weld; the first row is the worst weld of each unit."""
    percents = list(dict.fromkeys(row.percentile for row in rows))
    welds = list(dict.fromkeys(row.weld for row in rows))[:MOST_ROWS]
    of = {(row.weld, row.percentile): row for row in rows}
    cells = tuple(
        (
            text(weld or "worst weld of each unit"),
            *(lived(of[weld, p].life_years, of[weld, p].units_with_bound > 0) for p in percents),
        )
        for weld in welds
    )
    headings = (Heading("weld", numeric=False), *(Heading(f"P{p:g}", "years") for p in percents))
    return PageTable("fleet-percentiles-table", headings, cells, filter_label(len(cells), "weld"))


def lived(value: float, is_bound: bool) -> Cell:
    """Cell with a life in years, at least this where a bound stands for the damage."""
    return Cell(years(value, is_bound, unit="").replace(">=", "≥"), min(value, LONGEST_YEARS))
