"""What the tables of a result say, recomputed from other tables of the same result."""

from dataclasses import dataclass

from fatigue.report.result import ShownResult
from fatigue.report.variants import assumptions_of, damage_per_km, how_often

AGREES = 1e-6


@dataclass(frozen=True, slots=True)
class Recomputed:
    """A quantity computed in another way, and the largest relative difference over the points shown in detail."""

    what: str
    difference: float

    @property
    def agrees(self) -> bool:
        """Whether the difference is within rounding of the tables."""
        return self.difference <= AGREES


def recomputed(result: ShownResult) -> list[Recomputed]:
    """Damage of every detailed weld's worst point, recomputed from its cycles and from the damage of its events."""
    from_cycles, from_events = [0.0], [0.0]
    welds = result.assessed.set_index("weld")
    for weld in result.detailed:
        known = result.worst(weld)["damage_per_km"]
        cycles = result.cycles(weld)
        used = assumptions_of(result.record, welds.loc[weld, "curve"])
        if weld in result.merged:  # from its cycles one by one all the same
            again = result.merged[weld].damage_per_km
        else:
            again = damage_per_km(
                cycles["equivalent_range_dS"].to_numpy(), how_often(cycles, result.passes_per_km), used
            )
        of_weld = result.damage[result.damage["weld"] == weld]
        summed = float((of_weld["damage_per_pass"] * of_weld["event"].map(result.passes_per_km)).sum())
        if len(cycles) or known == 0.0:  # of a screened job, not every weld's cycles are kept
            from_cycles.append(_difference(again, known))
        from_events.append(_difference(summed, known))
    return [
        Recomputed("damage per km of the worst points from their listed cycles and the S-N curve", max(from_cycles)),
        Recomputed("damage per km of the worst points from the damage of every event", max(from_events)),
    ]


def _difference(found: float, known: float) -> float:
    return abs(found - known) / (known or 1.0)
