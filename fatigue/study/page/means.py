"""Numbers of the variants beside each other: mean, least and greatest over the seeds, a row for each variant."""

from collections.abc import Sequence
from math import isnan

from fatigue.report.sections.cells import Cell, Heading, PageTable, text
from fatigue.report.wording import LONGEST, NOT_AVAILABLE
from fatigue.study.claims.verdict import scatter
from fatigue.study.page.studied import Studied
from fatigue.study.page.words import told
from fatigue.study.quantities import LIFE, Number, is_life
from fatigue.study.variants.summary import FIRST

MOST_COLUMNS = 5  # of the page; scatter.parquet has all
MOST_VARIANTS = 200


def means_table(of: Studied) -> PageTable | None:
    """Numbers of whole runs: the shortest life, what a ride is asked for first, then others; None without any."""
    known = [one for one in of.numbers if not one.weld and not isnan(one.value)]
    columns = _columns([one.quantity for one in known])
    if not columns:
        return None
    units = {one.quantity: one.unit for one in reversed(known)}
    values: dict[tuple[str, str], list[Number]] = {}
    for one in known:
        values.setdefault((one.variant, one.quantity), []).append(one)
    headings = (Heading("variant", numeric=False), *(Heading(name, units[name]) for name in columns))
    rows = tuple(
        (text(one.name), *(_cell(values.get((one.name, name), [])) for name in columns))
        for one in of.variants[:MOST_VARIANTS]
    )
    return PageTable("means-table", headings, rows)


def _columns(quantities: Sequence[str]) -> list[str]:
    """Quantities in the order of the table, events of one beside each other."""
    found = list(dict.fromkeys(quantities))
    first = [name for wanted in (LIFE, *FIRST) for name in found if name.partition("@")[0] == wanted]
    return [*first, *(name for name in found if name not in first)][:MOST_COLUMNS]


def _cell(numbers: Sequence[Number]) -> Cell:
    """Mean of the seeds, least and greatest in brackets; sorted by the mean."""
    if not numbers:
        return Cell(NOT_AVAILABLE)
    life = is_life(numbers[0].quantity)
    side = scatter([min(float(one.value), LONGEST) if life else float(one.value) for one in numbers], logarithmic=life)
    return Cell("> 1e12" if life and side.low >= LONGEST else told(side, ""), side.mean)
