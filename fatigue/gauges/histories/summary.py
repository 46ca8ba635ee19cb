"""What is said of the readings of gauges: gauge by gauge, for people and for machines."""

import math
import textwrap
from dataclasses import asdict, dataclass, fields
from typing import Any

from fatigue.errors import Problem
from fatigue.gauges.histories.tables import EventRow, GaugeRow
from fatigue.shown import shortened, visible

WIDTH = 110
NO_ZERO = "Only changes are comparable with a measurement, which has no zero of its own: a mean is never compared."
STAND_INS = "Stand-ins at weld toes, for planning only, as a real grid sits beside the toe and sees another strain: {}."


@dataclass(frozen=True, slots=True)
class Histories:
    """What the gauges of a table read in the events of a case.

    Attributes
    ----------
    title, table : of the case; name of the table of gauges
    gauges, events : rows of the tables of these names
    exponent, exponent_source : k of the pseudo-damage, and where it is from
    notes : what the numbers leave out
    warnings : doubts that a reader has to see
    written : files
    """

    title: str
    table: str
    gauges: tuple[GaugeRow, ...]
    events: tuple[EventRow, ...]
    exponent: float
    exponent_source: str
    notes: tuple[str, ...]
    warnings: tuple[Problem, ...]
    written: tuple[str, ...] = ()

    def said(self) -> list[str]:
        """Sentences that sum it up."""
        found = [NO_ZERO]
        stand_ins = [row.gauge for row in self.gauges if row.stand_in]
        if stand_ins:
            names = ", ".join(shortened(visible(name)) for name in stand_ins[:4])
            found.append(STAND_INS.format(names + (f" and {len(stand_ins) - 4} more" if len(stand_ins) > 4 else "")))
        worst = [row for row in self.gauges if row.angle_sensitivity == row.angle_sensitivity]
        if worst:
            row = max(worst, key=lambda one: one.angle_sensitivity)
            found.append(
                f"Most sensitive to its angle is {shortened(visible(row.gauge))}: 5 degrees change its rms by "
                f"{row.angle_sensitivity:.0%}."
            )
        return [*found, *self.notes]

    def as_record(self) -> dict[str, Any]:
        """Record for machines; null of what is not available."""
        return {
            "title": self.title,
            "gauges_file": self.table,
            "exponent": self.exponent,
            "exponent_source": self.exponent_source,
            "said": self.said(),
            "gauges": [_record(row) for row in self.gauges],
            "events": [_record(row) for row in self.events],
            "warnings": [asdict(problem) for problem in self.warnings],
            "written": list(self.written),
        }

    def as_text(self) -> str:
        """Text for people: a table of the gauges, and what is to be known of them."""
        parts = [f"{visible(self.title)}: {len(self.gauges)} gauges of {visible(self.table)}", self._table()]
        parts += [textwrap.fill(sentence, WIDTH) for sentence in self.said()]
        if self.written:
            parts.append(f"written: {', '.join(self.written)}")
        return "\n\n".join(parts)

    def _table(self) -> str:
        head = ("gauge", "kind", "where", "rms [ue]", "rms [MPa]", "largest range [ue]", "5 deg", "beside", "weld [mm]")
        largest: dict[str, float] = {}
        for row in self.events:
            largest[row.gauge] = max(largest.get(row.gauge, 0.0), row.largest_range_ue)
        rows = [head]
        for one in self.gauges:
            kind = f"{one.kind}, stand-in" if one.stand_in and one.kind != "toe" else one.kind
            numbers = (f"{one.rms_ue:.4g}", f"{one.rms_MPa:.4g}", f"{largest[one.gauge]:.4g}")
            changes = (_percent(one.angle_sensitivity), _percent(one.neighbour_sensitivity))
            name = shortened(visible(one.gauge), 32)
            rows.append((name, kind, _where(one), *numbers, *changes, f"{one.distance_to_weld_mm:.4g}"))
        widths = [max(len(cells[i]) for cells in rows) for i in range(len(head))]
        left = 3
        return "\n".join(
            "  ".join(
                cell.ljust(width) if i < left else cell.rjust(width)
                for i, (cell, width) in enumerate(zip(cells, widths, strict=True))
            ).rstrip()
            for cells in rows
        )


def _where(row: GaugeRow) -> str:
    """Where a gauge sits, in a few words."""
    if row.kind == "element":
        at = f"element {row.element}"
    elif row.kind == "table":
        at = f"point {shortened(visible(row.point), 24)}"
    else:
        at = f"{shortened(visible(row.weld), 24)} {row.order}"
    return f"{at}, {row.surface}"


def _percent(value: float) -> str:
    return "-" if math.isnan(value) else f"{value:.1%}"


def _record(row: GaugeRow | EventRow) -> dict[str, Any]:
    found = {field.name: getattr(row, field.name) for field in fields(row)}
    return {name: None if isinstance(value, float) and math.isnan(value) else value for name, value in found.items()}
