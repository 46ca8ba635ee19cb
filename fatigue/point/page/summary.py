"""What is printed of a point: its numbers, its worst cycles, where its damage comes from."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import pandas as pd

from fatigue.point.page.checked import checks_of
from fatigue.point.page.gathered import Gathered
from fatigue.point.page.notes import facts_of_band, notes_of
from fatigue.point.page.tables import worst_cycles
from fatigue.report.of_record import target_of, weights_of
from fatigue.report.sections import weld_tables
from fatigue.report.sections.beside.shear import shear_facts
from fatigue.report.sections.checks import Recomputed
from fatigue.report.sections.curves import curve_words
from fatigue.report.wording import km, number, share
from fatigue.results.beside.life_band import BandOfPoint
from fatigue.shown import shortened, visible
from fatigue.why.findings import Finding, findings

CYCLES_PRINTED = 5


@dataclass(frozen=True, slots=True, eq=False)
class PointSummary:
    """A point of a result, counted again.

    Attributes
    ----------
    title : of the case
    weld, part, order, node, surface : where it is
    stored, counted : its row of ``nodes.parquet``, and the same counted again without the columns about shear
    notes : what is to be known before the numbers
    facts : the numbers in words
    events : its rows of ``damage.parquet``, counted again, with ``share`` of the damage
    cycles : the most damaging cycles with ``share`` of the damage
    cycle_count : how many cycles and half cycles one pass of every event has
    finding : what makes the damage; None where nothing does
    beside : rows of ``checks.parquet`` at its place, as the assessment made them
    verdicts : event, verdict on the frequency domain, reason
    band : of its life; None where it has none
    checks : what was compared with the result
    target_km : mileage to be reached
    file : page or picture that was written
    """

    title: str
    weld: str
    part: int
    order: int
    node: int
    surface: str
    stored: Mapping[str, Any]
    counted: Mapping[str, Any]
    notes: tuple[str, ...]
    facts: tuple[tuple[str, str], ...]
    events: pd.DataFrame
    cycles: pd.DataFrame
    cycle_count: int
    finding: Finding | None
    beside: pd.DataFrame
    verdicts: tuple[tuple[str, str, str], ...]
    band: BandOfPoint | None
    checks: tuple[Recomputed, ...]
    target_km: float
    file: Path | None = None

    @property
    def agrees(self) -> bool:
        """Whether everything that was counted again agrees with the result."""
        return all(check.agrees for check in self.checks)

    def as_record(self) -> dict[str, Any]:
        """Record for machines."""
        names = ("title", "weld", "part", "order", "node", "surface", "stored", "counted", "notes")
        said = {name: getattr(self, name) for name in names}
        return said | {
            "target_km": self.target_km,
            "band": None if self.band is None else self.band.as_record(),
            "events": self.events.to_dict("records"),
            "cycle_count": self.cycle_count,
            "worst_cycles": self.cycles.to_dict("records"),
            "finding": None if self.finding is None else asdict(self.finding),
            "frequency_domain": [
                {"event": event, "verdict": verdict, "reason": reason} for event, verdict, reason in self.verdicts
            ],
            "checks_beside": self.beside.to_dict("records"),
            "checks": [asdict(check) | {"agrees": check.agrees} for check in self.checks],
            "agrees": self.agrees,
            "file": None if self.file is None else str(self.file),
        }

    def as_text(self) -> str:
        """Text for people."""
        weld = visible(shortened(self.weld))
        place = f"{weld}, part {self.part}, order {self.order}, node {self.node}, {self.surface} face"
        width = max(len(name) for name, _ in self.facts)
        lines = [f"{visible(self.title)}: {place}", *(f"  {note}." for note in self.notes), ""]
        lines += [f"  {name:{width}}  {value}" for name, value in self.facts]
        lines += ["", *self._cycles(), "", *self._why(), *self._checks()]
        return "\n".join([*lines, *([] if self.file is None else ["", str(self.file)])])

    def _cycles(self) -> list[str]:
        """The most damaging cycles."""
        head = ("event", "from_s", "to_s", "range_MPa", "mean_MPa", "bending_ratio", "dS", "share")
        rows = [
            (
                visible(shortened(str(row["event"]))),
                *(number(row[name]) for name in ("start_s", "end_s", "range_MPa", "mean_MPa", "bending_ratio")),
                number(row["equivalent_range_dS"]),
                share(row["share"]),
            )
            for row in self.cycles.head(CYCLES_PRINTED).to_dict("records")
        ]
        if not rows:
            return ["No cycles: nothing changes the stress of this point."]
        widths = [max(len(row[i]) for row in (head, *rows)) for i in range(len(head))]
        lines = [
            "  ".join([row[0].ljust(widths[0]), *(cell.rjust(w) for cell, w in zip(row[1:], widths[1:], strict=True))])
            for row in (head, *rows)
        ]
        return [f"Most damaging of {self.cycle_count} cycles and half cycles", *(f"  {line}" for line in lines)]

    def _why(self) -> list[str]:
        """Where the damage comes from."""
        if self.finding is None:
            return ["Nothing damages this point."]
        return ["Where the damage comes from", *self.finding.as_text().splitlines()[1:]]

    def _checks(self) -> list[str]:
        """Whether what was counted agrees with the result, or what does not."""
        off = [f"{check.what}: {check.difference:.1e}" for check in self.checks if not check.agrees]
        if off:
            return ["", "Counted again, and it DIFFERS from the result (largest relative differences):", *off]
        largest = max((check.difference for check in self.checks), default=0.0)
        return ["", f"Counted again: agrees with the result, largest relative difference {largest:.0e}"]


def summary_of(found: Gathered) -> PointSummary:
    """Summary of a point."""
    at, row = found.station, found.row
    weights = found.damage["event"].map(weights_of(found.record)).astype(float)
    damage, total = found.damage["damage_per_pass"] * weights, float(found.counted["damage_per_km"])
    said = findings(found.evidence, "this point").findings
    facts = weld_tables.facts(row, found.weld, curve_words(found.weld["curve"], found.record))
    target = target_of(found.record)
    return PointSummary(
        title=str(found.record["title"]),
        weld=at.weld,
        part=at.part,
        order=at.order,
        node=at.node,
        surface=found.surface,
        stored=found.stored.to_dict(),
        counted=found.counted.to_dict(),
        notes=notes_of(found),
        facts=(*facts, *facts_of_band(found), *shear_facts(row), ("Target", _target(row, target))),
        events=found.damage.assign(share=damage / total if total > 0.0 else 0.0),
        cycles=worst_cycles(found),
        cycle_count=found.cycle_rows,
        finding=said[0] if said else None,
        beside=found.beside.rows,
        verdicts=tuple(found.why.reasons()),
        band=found.band,
        checks=tuple(checks_of(found)),
        target_km=target,
    )


def _target(row: pd.Series, target_km: float) -> str:
    """Whether the target is met."""
    met = "no verdict without a weld toe" if not row["toe"] else "met" if row["fulfilled"] else "missed"
    return f"{km(target_km)}: {met}"
