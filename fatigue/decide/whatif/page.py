"""The page of a what-if: one HTML file that needs nothing but itself, in the look of the report."""

from collections.abc import Iterator
from typing import Any

from fatigue.decide.whatif.figures import lives_figure
from fatigue.decide.whatif.forward import BASES
from fatigue.decide.whatif.summary import HELD, MEANING, WhatIf
from fatigue.report import wording
from fatigue.report.page_text import page_text
from fatigue.report.rows_table import MOST_ROWS, filter_label
from fatigue.report.sections.cells import Cell, Heading, PageTable, life, num, span, text
from fatigue.report.sections.embed import Figures

PAGE = "whatif.html"
VERDICT = {
    "meets": Cell("✓ meets", 2.0, mark="met"),
    "not_proven": Cell("? not proven", 1.0),
    "misses": Cell("✕ misses", 0.0, mark="missed"),
}
HEADINGS = (
    Heading("weld", numeric=False),
    Heading("before", numeric=False),
    Heading("now", numeric=False),
    Heading("basis", numeric=False),
    Heading("life before", "km"),
    Heading("life", "km"),
    Heading("from .. to", "km"),
    Heading("life ratio"),
    Heading("utilisation"),
    Heading("load factor"),
)


def whatif_page(found: WhatIf) -> str:
    """Return the page as text: what is changed, which verdicts flip, lives before and after, and the basis of it."""
    figs = Figures()
    fig = lives_figure(found.welds, found.target_km, found.target_km_before)
    caption = (
        "Shortest life of each weld: hollow as assessed, full after the change, the bar from low to high. Line: the "
    )
    caption += "target." if found.target_km == found.target_km_before else "target; dotted: that before."
    context: dict[str, Any] = {
        "title": found.title,
        "changes": found.changes,
        "reasons": found.reasons,
        "said": list(_said(found)),
        "flips": _flips(found),
        "lives": None if fig is None else figs.add("lives", fig, caption, wide=True),
        "welds": _weld_table(found),
        "left_out": max(0, len(found.welds) - MOST_ROWS),
        "bases": _bases(found),
        "held": HELD,
        "warnings": found.warnings,
    }
    return page_text("fatigue.decide.whatif", "whatif.html", context, figs)


def _said(found: WhatIf) -> Iterator[str]:
    counts = found.welds["verdict"].value_counts()
    words = {"meets": "meet their target", "misses": "miss it", "not_proven": "are not proven"}
    parts = [f"{counts[verdict]} {said}" for verdict, said in words.items() if counts.get(verdict)]
    yield f"Of {len(found.welds)} welds {', '.join(parts)}."
    flips = len(found.flips)
    yield "No verdict changes." if not flips else f"{flips} verdict{'s' * (flips > 1)} change{'s' * (flips == 1)}."
    missing = found.of_basis.get(BASES[3], 0)
    if missing:
        yield f"{missing} points have no number: nothing stored says enough of them, and no guess is given."


def _flips(found: WhatIf) -> PageTable | None:
    rows = [
        (
            text(row.weld),
            VERDICT[row.verdict_before],
            VERDICT[row.verdict],
            text(row.basis),
            life(row.life_km_before),
            life(row.life_km),
        )
        for row in found.flips.head(MOST_ROWS).itertuples()
    ]
    return PageTable("flips", HEADINGS[:6], tuple(rows)) if rows else None


def _weld_table(found: WhatIf) -> PageTable:
    rows = tuple(
        (
            text(row.weld),
            VERDICT[row.verdict_before],
            VERDICT[row.verdict],
            text(row.basis),
            life(row.life_km_before),
            life(row.life_km),
            span(row.life_km_low, row.life_km_high, wording.life),
            num(row.life_ratio),
            num(row.utilisation),
            num(row.load_factor),
        )
        for row in found.welds.head(MOST_ROWS).itertuples()
    )
    return PageTable("welds-table", HEADINGS, rows, filter_label(len(rows), "weld"))


def _bases(found: WhatIf) -> PageTable:
    rows = tuple((text(basis), Cell(str(n), float(n)), text(MEANING[basis])) for basis, n in found.of_basis.items())
    headings = (Heading("basis", numeric=False), Heading("points"), Heading("what it is", numeric=False))
    return PageTable("bases", headings, rows)
