"""What every event counts, in words: two samples are half a cycle or a whole one, as the residue is closed."""

from dataclasses import dataclass

from fatigue.case import Case
from fatigue.life.mission import Pass, Plan
from fatigue.life.records.history import Residue

FEW = 100  # samples, below which a record is a load case typed in by hand
LISTED = 12  # events that are all listed; of more only those of few samples


@dataclass(frozen=True, slots=True)
class EventCount:
    """What one pass of an event counts at most, and how often it is passed.

    ``cycles`` is the largest number of cycles that so many samples can make, None where there are many samples.
    """

    event: str
    samples: int
    residue: Residue
    is_static: bool
    cycles: float | None
    passes_at_target: float

    @property
    def counts(self) -> str:
        """The cycles in words."""
        if self.cycles is None:
            return "every cycle of the record" + (", repeated" if self.residue == "repeat" else "")
        if self.samples == 2:
            return "half a cycle (load or unload)" if self.residue == "half" else "one cycle (load and unload)"
        return f"at most {self.cycles:g} cycle{'s' * (self.cycles != 1.0)}"

    def as_text(self) -> str:
        """One line for people."""
        kind = "values" if self.is_static else "samples"
        return f"{self.samples} {kind}, {self.residue}: {self.counts}, {self.passes_at_target:.4g} passes at the target"


def event_counts(case: Case, plan: Plan) -> tuple[EventCount, ...]:
    """What every event of a mission counts, in its order."""
    return tuple(
        _count(case.residue(event), event.history is None, one, plan.target_km)
        for event, one in zip(case.mission.event, plan.passes, strict=True)
    )


def listed(counts: tuple[EventCount, ...]) -> list[str]:
    """Lines for people: all events, or those of few samples where there are many."""
    shown = [one for one in counts if len(counts) <= LISTED or one.cycles is not None][: 2 * LISTED]
    lines = [f"'{one.event}': {one.as_text()}" for one in shown]
    return lines + ([f"and {len(counts) - len(shown)} more"] if len(shown) < len(counts) else [])


def _count(residue: Residue, is_static: bool, one: Pass, target_km: float) -> EventCount:
    """``n`` samples have at most ``n - 1`` half cycles, or ``n / 2`` cycles where they repeat."""
    most = (one.samples - 1) / 2 if residue == "half" else one.samples // 2
    cycles = float(most) if one.samples < FEW else None
    return EventCount(one.event, one.samples, residue, is_static, cycles, one.passes_per_km * target_km)
