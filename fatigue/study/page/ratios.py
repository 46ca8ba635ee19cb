"""Ratios of every variant to the base, seed by seed, as a table of the page."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from fatigue.report.sections.cells import Heading, PageTable, integer, num, text
from fatigue.study.claims.verdict import Scatter, scatter
from fatigue.study.page.studied import Studied
from fatigue.study.quantities import Number

MOST_ROWS = 600


@dataclass(frozen=True, slots=True)
class Ratio:
    """A quantity of a variant over that of the base: both, and their ratio seed by seed (its mean is geometric)."""

    quantity: str
    unit: str
    variant: str
    base: Scatter
    value: Scatter
    ratio: Scatter


def ratios(of: Studied) -> list[Ratio]:
    """Ratios of all quantities of the whole run, quantity by quantity, in the order of the variants."""
    by_place = {(n.quantity, n.variant, n.seed): n for n in of.numbers if not n.weld}
    found = []
    for quantity in dict.fromkeys(quantity for quantity, _, _ in by_place):
        for variant in of.variants[1:]:
            base = [by_place.get((quantity, of.variants[0].name, seed)) for seed in of.seeds]
            value = [by_place.get((quantity, variant.name, seed)) for seed in of.seeds]
            if any(one is not None for one in value):
                unit = next((one.unit for one in (*value, *base) if one is not None), "")
                both = [_over(a, b) for a, b in zip(value, base, strict=True)]
                scatters = (scatter(_values(base)), scatter(_values(value)), scatter(both, logarithmic=True))
                found.append(Ratio(quantity, unit, variant.name, *scatters))
    return found


def ratio_table(rows: Sequence[Ratio]) -> PageTable:
    """Ratios as a table of the page."""
    headings = (
        Heading("quantity", numeric=False),
        Heading("unit", numeric=False),
        Heading("variant", numeric=False),
        Heading("base, mean"),
        Heading("variant, mean"),
        Heading("ratio"),
        Heading("least"),
        Heading("greatest"),
        Heading("seeds"),
    )
    cells = tuple(
        (
            text(row.quantity),
            text(row.unit),
            text(row.variant),
            num(row.base.mean),
            num(row.value.mean),
            num(row.ratio.mean),
            num(row.ratio.low),
            num(row.ratio.high),
            integer(row.ratio.known),
        )
        for row in rows[:MOST_ROWS]
    )
    return PageTable("ratios-table", headings, cells, "Find a quantity or variant")


def _values(numbers: Sequence[Number | None]) -> list[float]:
    return [math.nan if one is None else one.value for one in numbers]


def _over(value: Number | None, base: Number | None) -> float:
    """Ratio of two numbers of one seed; NaN where one is missing, infinite, or the lower one 0."""
    if value is None or base is None or base.value == 0.0 or not math.isfinite(base.value):
        return math.nan
    return value.value / base.value if math.isfinite(value.value) else math.nan
