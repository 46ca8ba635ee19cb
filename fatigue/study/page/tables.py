"""Tables of the page: ratios between variants, numbers of every seed behind a claim, runs that are not done."""

from collections.abc import Sequence

from fatigue.report.sections.cells import Cell, Heading, PageTable, integer, num, text
from fatigue.study.claims.verdict import Verdict
from fatigue.study.page.studied import Studied
from fatigue.study.page.words import spelled
from fatigue.study.quantities import StudyRun
from fatigue.study.variants.ratios import RatioRow
from fatigue.study.variants.varied.names import shown

MOST_ROWS = 600  # of the page; the files have all
MOST_RUNS = 60
SAYS = {"holds": "holds", "reverse": "holds the reverse", "same": "both are equal", "unknown": "–"}


def ratio_table(rows: Sequence[RatioRow]) -> PageTable | None:
    """Ratios of quantities of whole runs; None without any."""
    whole = [row for row in rows if not row.weld]
    if not whole:
        return None
    headings = (
        *(Heading(name, numeric=False) for name in ("quantity", "variant", "over", "changed")),
        *(Heading(name) for name in ("ratio", "sd", "least", "greatest", "seeds", "agree")),
    )
    cells = tuple(
        (
            *(text(value) for value in (row.quantity, row.variant, row.against, row.changed)),
            *(num(value) for value in (row.ratio, row.sd, row.min, row.max)),
            integer(row.n),
            integer(row.agree),
        )
        for row in whole[:MOST_ROWS]
    )
    return PageTable("ratios-table", headings, cells, "Find a quantity or variant")


def whole_ratios(rows: Sequence[RatioRow]) -> int:
    """Number of ratios of whole runs."""
    return sum(not row.weld for row in rows)


def seed_table(number: int, one: Verdict) -> PageTable | None:
    """Both sides of a claim under every seed; None of a claim that was not tried."""
    if not one.of_seeds:
        return None
    unit = one.unit if one.unit != "-" else ""
    why = any(of.reason for of in one.of_seeds)
    headings = (
        Heading("seed"),
        Heading("left", unit),
        Heading("right", unit),
        Heading("left / right"),
        Heading("says", numeric=False),
        *([Heading("why", numeric=False)] if why else []),
    )
    rows = tuple(
        (
            integer(of.seed),
            _value(of.left),
            _value(of.right),
            _value(of.ratio),
            Cell(SAYS[of.says]),
            *([text(of.reason)] if why else []),
        )
        for of in one.of_seeds
    )
    return PageTable(f"claim-{number}-seeds", headings, rows)


def _value(value: float) -> Cell:
    """Cell with a number, above 1e12, too."""
    return Cell(spelled(value), num(value).value)


def variant_table(of: Studied) -> PageTable:
    """Variants with the value of everything that is varied."""
    names = list(dict.fromkeys(name for one in of.variants for name in one.settings))
    headings = (Heading("variant", numeric=False), *(Heading(name, numeric=False) for name in names))
    rows = tuple(
        (text(one.name), *(text(shown(one.settings.get(name, ""))) for name in names))
        for one in of.variants[:MOST_ROWS]
    )
    return PageTable("variants-table", headings, rows)


def undone_table(runs: Sequence[StudyRun]) -> PageTable | None:
    """Runs that are not done, and why; None if all are."""
    undone = [run for run in runs if run.state != "done"][:MOST_RUNS]
    if not undone:
        return None
    headings = (
        Heading("variant", numeric=False),
        Heading("seed"),
        Heading("state", numeric=False),
        Heading("why", numeric=False),
    )
    rows = tuple((text(run.variant), integer(run.seed), text(run.state), text(run.reason)) for run in undone)
    return PageTable("undone-table", headings, rows)
