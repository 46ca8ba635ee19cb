"""What is said of a study: its runs, the means of its variants, their ratios, verdicts, for people and for machines."""

import textwrap
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from math import isinf, isnan
from typing import Any

from fatigue.errors import Problem
from fatigue.shown import few, shortened, visible
from fatigue.study.claims.verdict import Verdict
from fatigue.study.quantities import LIFE, Number, StudyRun, Variant
from fatigue.study.variants.ratios import RatioRow
from fatigue.study.variants.scatter import Key, ScatterRow

WIDTH = 110
MOST_COLUMNS, MOST_WELDS, MOST_LINES = 6, 4, 60
FIRST = ("f_hunt", "bogie_y_rms", "conv_y_rms", "roof_mid_y_rms")  # numbers of a ride that are shown first


@dataclass(frozen=True, slots=True)
class StudyFound:
    """What a study found; ``written`` are its files, ``failures`` why runs have no numbers.

    ``reused`` runs were finished by an earlier command. ``exit_code`` is that of the failures: 4 where a computation
    lost its footing, 3 where data or case are wrong, 0 without any. ``left_over`` are folders of variants that the
    study no longer has.
    """

    title: str
    variants: tuple[Variant, ...]
    runs: tuple[StudyRun, ...]
    numbers: tuple[Number, ...]
    scatter: tuple[ScatterRow, ...]
    ratios: tuple[RatioRow, ...]
    verdicts: tuple[Verdict, ...]
    warnings: tuple[Problem, ...]
    failures: tuple[Problem, ...]
    exit_code: int
    reused: int
    left_over: tuple[str, ...] = ()
    written: tuple[str, ...] = ()

    def as_record(self) -> dict[str, Any]:
        """Record for machines: the rows of every table but the numbers of single runs, which the table has."""
        return {
            "title": self.title,
            "variants": [asdict(variant) for variant in self.variants],
            "runs": [
                {"variant": r.variant, "seed": r.seed, "folder": str(r.folder), "state": r.state, "reason": r.reason}
                for r in self.runs
            ],
            "scatter": [asdict(row) for row in self.scatter],
            "ratios": [asdict(row) for row in self.ratios],
            "verdicts": [{"text": v.claim.text, "verdict": v.verdict, "reason": v.reason} for v in self.verdicts],
            "warnings": [asdict(problem) for problem in self.warnings],
            "failures": [asdict(problem) for problem in self.failures],
            "left_over": list(self.left_over),
            "written": list(self.written),
        }

    def as_text(self) -> str:
        """Text for people: means of a few quantities for each variant, their ratios, verdicts."""
        shown = self._shown()
        blocks = [[self._head()], list(self._means(shown)), list(self._ratios(shown)), list(self._verdicts())]
        if self.left_over:
            what = f"below runs are folders of variants that the study no longer has: {few(self.left_over)}"
            blocks.append([what])
        return "\n\n".join("\n".join(block) for block in blocks if block)

    def _head(self) -> str:
        seeds = len({run.seed for run in self.runs})
        done = sum(run.state == "done" for run in self.runs)
        parts = [f"{done - self.reused} done now", f"{self.reused} there from before"]
        parts += [f"{count} {state}" for state in ("failed", "not run") if (count := self._count(state))]
        variants = f"{len(self.variants)} variant{'s' * (len(self.variants) != 1)}"
        return f"{visible(self.title)}: {variants} under {seeds} seed{'s' * (seeds != 1)}: {', '.join(parts)}"

    def _count(self, state: str) -> int:
        return sum(run.state == state for run in self.runs)

    def _shown(self) -> list[Key]:
        """Quantities that the text shows: the life of all welds and of the worst ones, then numbers of the ride."""
        found: dict[Key, list[ScatterRow]] = {}
        for row in self.scatter:
            if row.n:
                found.setdefault((row.quantity, row.weld), []).append(row)
        lives = sorted((key for key in found if key[0] == LIFE), key=lambda key: min(row.mean for row in found[key]))
        lives = [key for key in lives if key[1] or len(lives) > 2][:MOST_WELDS]
        of_runs = [key for key in found if not key[1] and key not in lives and key[0] not in (LIFE, "utilisation")]
        first = [key for name in FIRST for key in of_runs if key[0].partition("@")[0] == name]
        others = [key for key in of_runs if key not in first and key[0] not in ("load_factor", "stress_utilisation")]
        return [*lives, *first, *others][:MOST_COLUMNS]

    def _means(self, shown: Sequence[Key]) -> Iterator[str]:
        """Means over the seeds, a line for each variant."""
        if not shown:
            return
        at = {(row.variant, row.quantity, row.weld): row for row in self.scatter}
        units = {(row.quantity, row.weld): row.unit for row in self.scatter}
        heads = [" ".join(filter(None, (key[0], shortened(key[1], 24), _unit(units[key])))) for key in shown]
        rows = [["variant, means over the seeds", *map(visible, heads)]]
        for variant in self.variants[:MOST_LINES]:
            cells = [_cell(at.get((variant.name, *key))) for key in shown]
            rows.append([shortened(visible(variant.name)), *cells])
        yield from _aligned(rows)
        if len(self.variants) > MOST_LINES:
            yield f"and {len(self.variants) - MOST_LINES} more variants, see scatter.parquet"

    def _ratios(self, shown: Sequence[Key]) -> Iterator[str]:
        """Ratios between variants that differ in one thing, of the same quantities."""
        rows = [row for row in self.ratios if row.n and (row.quantity, row.weld) in shown and ", " not in row.changed]
        if not rows:
            return
        table = [["ratio", "of", "mean", "range", "seeds that agree"]]
        for row in rows[:MOST_LINES]:
            what = " ".join(filter(None, (row.quantity, shortened(row.weld, 24))))
            label = f"{row.variant} / {row.against}"
            spread = f"{row.min:.3g} to {row.max:.3g}" if row.n > 1 else ""
            cells = [shortened(label), what, f"{row.ratio:.3g}", spread, f"{row.agree} of {row.n}"]
            table.append([visible(cell) for cell in cells])
        yield from _aligned(table, left=2)
        if len(rows) > MOST_LINES:
            yield f"and {len(rows) - MOST_LINES} more, see ratios.parquet"

    def _verdicts(self) -> Iterator[str]:
        for verdict in self.verdicts:
            why = f" ({verdict.reason})" if verdict.reason else ""
            yield textwrap.fill(visible(f"{verdict.verdict}: {verdict.claim.text}{why}"), WIDTH, subsequent_indent="  ")


def _unit(unit: str) -> str:
    return f"[{unit}]" if unit else ""


def _cell(row: ScatterRow | None) -> str:
    """Mean with its scatter: that of the logarithm as a factor, any other as a share."""
    if row is None or isnan(row.mean):
        return "-"
    return "> 1e12" if isinf(row.mean) or row.mean > 1e12 else f"{row.mean:.4g}"


def _aligned(rows: Sequence[Sequence[str]], left: int = 1) -> Iterator[str]:
    """Lines of a table, the first columns to the left, numbers to the right."""
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    for row in rows:
        cells = (c.ljust(w) if i < left else c.rjust(w) for i, (c, w) in enumerate(zip(row, widths, strict=True)))
        yield "  ".join(cells).rstrip()
