"""What of the welds and checks goes to paper: details of those near their limit and beyond, a line of every other."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from fatigue.report.result import ShownResult
from fatigue.report.sections.cells import Heading, PageTable, given, integer, text, verdict
from fatigue.report.sections.curves import marked
from fatigue.report.sections.tables import EVENT, FACE, LIFE, LIFE_COLUMNS, WELD
from fatigue.report.wording import whole

HIGH = 0.75  # utilisation from which a weld is printed in detail
MOST_PRINTED = 10
MOST_OTHERS = 400


@dataclass(frozen=True, slots=True)
class OnPaper:
    """The welds printed in detail, worst first, and a table of the others.

    ``high`` welds have a utilisation of ``HIGH`` or more; ``left_out`` of them are in the table; ``unlisted`` welds are
    not even there.
    """

    welds: tuple[str, ...]
    high: int
    left_out: int
    others: PageTable | None
    unlisted: int

    @property
    def detailed(self) -> int:
        """How many are printed in detail."""
        return len(self.welds)


def on_paper(result: ShownResult, unverified: Collection[str]) -> OnPaper:
    """Welds with a utilisation of 0.75 and more, the ten worst of them, or the worst where none has; and the others."""
    high = int(np.count_nonzero(result.assessed["utilisation"] >= HIGH))
    printed = result.detailed[: max(1, min(high, MOST_PRINTED))]
    others = result.assessed.iloc[len(printed) :]
    rows = tuple(
        (
            text(row.weld),
            verdict(row.fulfilled),
            *(cell(getattr(row, name)) for name, cell in LIFE_COLUMNS.items()),
            integer(row.worst_node),
            text(row.worst_surface),
            given(row.worst_arc_length_mm),
            text(row.governing_event),
            text(row.curve),
        )
        for row in others.head(MOST_OTHERS).itertuples()
    )
    headings = (
        WELD,
        Heading("target", numeric=False),
        *LIFE,
        Heading("worst node"),
        FACE,
        Heading("arc length", "mm"),
        EVENT,
        Heading("curve", numeric=False),
    )
    table = marked(PageTable("other-welds", headings, rows), unverified) if rows else None
    return OnPaper(printed, high, max(0, high - len(printed)), table, max(0, len(others) - MOST_OTHERS))


def all_passed(checks: Sequence[Mapping[str, Any]]) -> str:
    """One sentence for paper where all known values agree; nothing where one does not, whose row must be seen."""
    if not checks or not all(check["passed"] for check in checks):
        return ""
    return f"All {whole(len(checks))} known values agree within their tolerances."
