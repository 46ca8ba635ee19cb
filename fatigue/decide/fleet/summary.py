"""What is said of a fleet: its units by their lives, percentiles over them, and what makes the difference."""

from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from fatigue.decide.fleet.rows import PercentileRow, UnitRow, VarianceRow
from fatigue.decide.text_lines import aligned
from fatigue.errors import Problem
from fatigue.report.wording import life, number, share, whole
from fatigue.shown import few, shortened, visible

UNITS_TOLD, WELDS_TOLD, SHARES_TOLD = 20, 10, 4
LONGEST_YEARS = 1e6  # beyond, a life says nothing


@dataclass(frozen=True, slots=True)
class FleetFound:
    """A fleet: the rows of its tables but those of single welds and points, and what was written.

    Attributes
    ----------
    title : of the fleet
    conditions, welds, points : how many there are, points of one unit
    target_years : that every weld has to live; None: no verdict
    units : shortest life first
    percentiles : of the worst weld of each unit, then weld by weld, shortest lives first
    variance : of the distances over the units, then of single units
    counted_as_exact : conditions of which nothing says how sure their damage is
    every_point : whether the table of points was written: its rule is in ``points_rule``
    """

    title: str
    conditions: tuple[str, ...]
    welds: int
    points: int
    target_years: float | None
    units: tuple[UnitRow, ...]
    percentiles: tuple[PercentileRow, ...]
    variance: tuple[VarianceRow, ...]
    counted_as_exact: tuple[str, ...]
    every_point: bool
    points_rule: str
    warnings: tuple[Problem, ...]
    written: tuple[str, ...] = ()

    @property
    def missed(self) -> tuple[UnitRow, ...]:
        """Units of which a weld misses the target."""
        return tuple(row for row in self.units if row.fulfilled is False)

    @property
    def fulfilled(self) -> bool:
        """Whether every weld of every unit meets the target; without a target it does."""
        return not self.missed

    @property
    def verdict(self) -> str:
        """The fleet in one sentence."""
        if self.target_years is None:
            first = self.units[0]
            return f"the shortest life is that of {visible(first.unit)}, {years(first.life_years, first.is_bound)}"
        target = f"their target of {self.target_years:g} years"
        if self.fulfilled:
            return f"all {len(self.units)} units meet {target}"
        return f"{len(self.missed)} of {len(self.units)} units miss {target}"

    @property
    def facts(self) -> str:
        """How much there is."""
        counts = {
            "unit": len(self.units),
            "condition": len(self.conditions),
            "weld": self.welds,
            "point": self.points,
        }
        return ", ".join(f"{whole(n)} {of}{'s' * (n != 1)}" for of, n in counts.items())

    @property
    def doubt(self) -> str:
        """What the standard deviations of the damage leave out; empty where there are none, or nothing is left out."""
        if not self.counted_as_exact or not any(row.of == "unit" for row in self.variance):
            return ""
        names = few([visible(name) for name in self.counted_as_exact])
        return f"Nothing says how sure the damage of {names} is: it counts as exact. State damage_cv."

    def as_record(self) -> dict[str, Any]:
        """Record for machines."""
        return asdict(self) | {"fulfilled": self.fulfilled, "verdict": self.verdict}

    def as_text(self) -> str:
        """Text for people: ranking, percentiles, shares."""
        lines = [
            f"{visible(self.title)}: {self.verdict}",
            self.facts,
            "",
            *self._units(),
            "",
            *self._percentiles(),
        ]
        shares = list(self._shares())
        lines += ["", *shares] if shares else []
        lines += ["", self.points_rule, f"written: {', '.join(self.written)}"] if self.written else []
        return "\n".join(lines)

    def _units(self) -> Iterator[str]:
        heads = ("unit", "life [years]", "km per year", "weld", "node", "face", "most of it by")
        shown = self.units[:UNITS_TOLD]
        rows = [
            (
                shortened(visible(row.unit), 24),
                years(row.life_years, row.is_bound, unit=""),
                number(row.km_per_year),
                shortened(visible(row.weld), 30),
                str(row.node),
                row.surface,
                f"{shortened(visible(row.governing_condition), 30)} {share(row.governing_share)}"
                if row.governing_condition
                else "-",
            )
            for row in shown
        ]
        yield from aligned([heads, *rows], right=(1, 2, 4))
        if len(self.units) > len(shown):
            yield f"and {len(self.units) - len(shown)} units that live longer, see fleet_units.parquet"

    def _percentiles(self) -> Iterator[str]:
        percent = list(dict.fromkeys(row.percentile for row in self.percentiles))
        yield "Percentiles of the life over the units [years]"
        names = list(dict.fromkeys(row.weld for row in self.percentiles))
        of = {(row.weld, row.percentile): row for row in self.percentiles}
        rows = [
            (
                shortened(visible(name), 40) or "worst weld of each unit",
                *(years(of[name, p].life_years, of[name, p].units_with_bound > 0, unit="") for p in percent),
            )
            for name in names[: WELDS_TOLD + 1]
        ]
        yield from aligned([("weld", *(f"P{p:g}" for p in percent)), *rows], right=range(1, len(percent) + 1))
        if (more := len(names) - 1 - WELDS_TOLD) > 0:
            yield f"and {more} welds that live longer, see fleet_percentiles.parquet"

    def _shares(self) -> Iterator[str]:
        """What makes units differ at the worst weld, and what makes the damage of the worst unit uncertain."""
        units = [row for row in self.variance if row.of == "units"]
        if units:
            worst = [row for row in units if row.weld == units[0].weld]
            yield f"What makes units differ at {visible(worst[0].weld)}: {_largest(worst)}"
        if of_units := [row for row in self.variance if row.of == "unit"]:
            own = [row for row in of_units if row.unit == of_units[0].unit]
            unit = next(row for row in self.units if row.unit == own[0].unit)
            told = (
                f"What makes the damage of {visible(unit.unit)} uncertain, {share(unit.damage_cv)} standard deviation"
            )
            yield f"{told}: {_largest(own)}"
        if self.doubt:
            yield self.doubt


def _largest(rows: Sequence[VarianceRow]) -> str:
    """The largest shares of a variance in words."""
    ordered = sorted(rows, key=lambda row: -abs(row.share))[:SHARES_TOLD]
    names = [
        f"{shortened(visible(row.condition), 30)}{'' if row.source == 'distance' else f' ({row.source})'} "
        f"{share(row.share)}"
        for row in ordered
    ]
    return few(names, SHARES_TOLD) + (f" and {len(rows) - len(ordered)} more" if len(rows) > len(ordered) else "")


def years(value: float, is_bound: bool, unit: str = " years") -> str:
    """A life in years: at least this where a bound stands for the damage.

    >>> years(12.345, False), years(np.inf, False, unit=""), years(40.0, True)
    ('12.3 years', '> 1e6', '>= 40.0 years')
    """
    if value > LONGEST_YEARS or not np.isfinite(value):
        return f"> 1e6{unit}"
    return f"{'>= ' if is_bound else ''}{life(value)}{unit}"
