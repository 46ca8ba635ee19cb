"""What is said of a what-if: for people, for machines, and the rows of its tables."""

from collections.abc import Iterator
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np
import pandas as pd

from fatigue.decide.text_lines import aligned
from fatigue.decide.whatif.forward import BASES
from fatigue.decide.whatif.verdicts import MISSES, NOT_PROVEN
from fatigue.errors import Problem
from fatigue.report.wording import life
from fatigue.shown import shortened, visible

MOST_TOLD = 40  # welds in the text
NAME = 34  # letters of a weld
MEANING = {
    "exact": "every cycle does a known multiple of what it did: sums of stored damages",
    "histogram": "stored ranges, in classes, entered into the new curve: between two proven bounds",
    "bound": "damage at most, life at least this: a multiple that no cycle exceeds, of a point that was not counted or "
    "has no stored ranges",
    "recount": "nothing stored says enough: no number is given",
    "counted": "counted again from the input files",
}
HELD = (
    "All else is as it was assessed. From .. to bounds what the stored numbers cannot tell; "
    "it is no scatter of load or strength."
)


@dataclass(frozen=True, slots=True, eq=False)
class WhatIf:
    """A result under a change.

    Attributes
    ----------
    title : of the result
    changes : knob by knob, in words
    reasons : why points have to be counted again, empty where nothing asks for it
    target_km, target_km_before : after and before
    points : rows of the table ``whatif``
    welds : rows of the table ``whatif_welds``
    warnings : what the what-if does not follow
    written : files
    """

    title: str
    changes: tuple[str, ...]
    reasons: tuple[str, ...]
    target_km: float
    target_km_before: float
    points: pd.DataFrame
    welds: pd.DataFrame
    warnings: tuple[Problem, ...]
    written: tuple[str, ...] = ()

    @property
    def fulfilled(self) -> bool:
        """Whether no weld misses its target, as far as that is known."""
        return not (self.welds["verdict"] == MISSES).any()

    @property
    def of_basis(self) -> dict[str, int]:
        """How many points rest on what."""
        codes = self.points["basis"]
        return {basis: int(n) for basis in BASES if (n := np.count_nonzero(codes == basis))}

    @property
    def flips(self) -> pd.DataFrame:
        """Welds whose verdict is another one."""
        return self.welds[self.welds["flips"]]

    def with_files(self, written: tuple[str, ...]) -> "WhatIf":
        """The same with the names of its files."""
        return replace(self, written=written)

    def as_record(self) -> dict[str, Any]:
        """Record for machines; the points are in the table ``whatif``."""
        return {
            "title": self.title,
            "changes": list(self.changes),
            "recount_because": list(self.reasons),
            "target_km": self.target_km,
            "target_km_before": self.target_km_before,
            "fulfilled": self.fulfilled,
            "not_proven": int((self.welds["verdict"] == NOT_PROVEN).sum()),
            "points": len(self.points),
            "points_by_basis": self.of_basis,
            "welds": [
                {name: None if pd.isna(value) else value for name, value in row.items()}
                for row in self.welds.to_dict("records")
            ],
            "warnings": [asdict(problem) for problem in self.warnings],
            "written": list(self.written),
        }

    def as_text(self) -> str:
        """Text for people."""
        parts = [f"{visible(self.title)}: what if", *(f"  {visible(one)}" for one in self.changes), "", *self._said()]
        parts += ["", *self._table(), "", *self._meanings()]
        if self.written:
            parts += ["", f"written: {', '.join(self.written)}"]
        return "\n".join(parts)

    def _said(self) -> Iterator[str]:
        shown = ", ".join(f"{n} {basis}" for basis, n in self.of_basis.items())
        yield f"{len(self.points)} points: {shown}"
        if self.reasons:
            yield f"Nothing stored says what comes of: {'; '.join(map(visible, self.reasons))}"
        missing, flips = self.points["basis"].eq(BASES[3]).sum(), self.flips
        if missing:
            yield f"{missing} points have no number: --recount worst or --recount all counts them again"
        if not len(flips):
            yield "No verdict changes"
        for row in flips.head(MOST_TOLD).itertuples():
            yield f"{visible(row.weld)}: {_words(row.verdict_before)} before, now {_words(row.verdict)}"

    def _table(self) -> Iterator[str]:
        lines = [("weld", "before [km]", "life [km]", "from .. to", "ratio", "verdict", "basis")]
        for row in self.welds.head(MOST_TOLD).itertuples():
            ends = life(row.life_km_low), life(row.life_km_high)
            band = "" if ends[0] == ends[1] else " .. ".join(ends)
            lives = life(row.life_km_before), life(row.life_km), band, _three(row.life_ratio)
            lines.append((shortened(visible(row.weld), NAME), *lives, _words(row.verdict), row.basis))
        yield from aligned(lines, right=range(1, 5))
        if (more := len(self.welds) - MOST_TOLD) > 0:
            yield f"  and {more} more, which do not miss their target or are further from it"

    def _meanings(self) -> Iterator[str]:
        """What the bases mean that the numbers rest on, and what is held."""
        yield from (f"{basis}: {MEANING[basis]}" for basis in self.of_basis)
        yield HELD


def _words(verdict: str) -> str:
    return verdict.replace("_", " ")


def _three(ratio: float) -> str:
    return "-" if np.isnan(ratio) else f"{ratio:.3g}"
