"""What is said of a measurement beside the simulation: for people and for machines."""

import math
import textwrap
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

from fatigue.errors import Problem
from fatigue.gauges.correlated.compared import Comparison
from fatigue.gauges.correlated.flag_rows import flag_counts
from fatigue.gauges.correlated.verdict import JUDGED, SUSPECT, YARDSTICK, CaseLine, case_line
from fatigue.shown import shortened, visible

WIDTH = 110
MEAN_NOTE = "Always measured over simulated. Means are not compared: a gauge has no zero."


@dataclass(frozen=True, slots=True, eq=False)
class Correlation:
    """Measured strain beside the simulated one in one event.

    Attributes
    ----------
    title, event : of the case
    comparisons : of every channel of strain, in the order of their table
    band_hz : lower and upper end of the band of both sides
    rate_hz : of the simulation, at which both are compared
    k, k_source : exponent of the pseudo-damage, and where it is from
    distance : where the measured distance is from
    km_simulated : distance of a pass of the event [km]
    is_aligned : whether the record replays the simulation
    warnings : doubts that a reader has to see
    written : files
    """

    title: str
    event: str
    comparisons: tuple[Comparison, ...]
    band_hz: tuple[float, float]
    rate_hz: float
    k: float
    k_source: str
    distance: str
    km_simulated: float
    is_aligned: bool
    warnings: tuple[Problem, ...]
    written: tuple[str, ...] = ()

    @property
    def judged(self) -> tuple[Comparison, ...]:
        """Channels whose ratio can be trusted."""
        return tuple(one for one in self.comparisons if one.verdict in JUDGED)

    @property
    def line(self) -> CaseLine:
        """Damage ratio over the gauges that were judged."""
        return case_line([one.numbers.damage_ratio for one in self.judged])

    @property
    def agrees(self) -> bool:
        """Whether at least one gauge was judged, none is poor, and none has the wrong sign."""
        return bool(self.judged) and not any(one.verdict in SUSPECT for one in self.comparisons)

    def basis(self) -> tuple[str, ...]:
        """Sentences on what is compared and how."""
        low, high = self.band_hz
        sides = f"Event '{self.event}': {self.km_simulated:.4g} km of simulation, both sides from {low:g} to below "
        sides += f"{high:g} Hz at {self.rate_hz:g} Hz; measured distance from {self.distance}."
        damage = f"Pseudo-damage: sum of n range^k per km with k = {self.k:.5g} ({self.k_source})."
        return sides, f"{damage} Damage ratios hold for this k.", MEAN_NOTE

    def line_in_words(self) -> str:
        """The case line as a sentence."""
        line = self.line
        if not line.gauges:
            return "No gauge could be judged."
        if math.isnan(line.log_sd):
            return f"Damage ratio of the one gauge that was judged: {line.damage_ratio:.3g}."
        return (
            f"Damage ratio over {line.gauges} judged gauges: geometric mean {line.damage_ratio:.3g}, "
            f"log-sd {line.log_sd:.3f} (a factor of {math.exp(line.log_sd):.3g})."
        )

    def as_record(self) -> dict[str, Any]:
        """Record for machines."""
        return {
            "title": self.title,
            **self.settings(),
            "agrees": self.agrees,
            "case_line": asdict(self.line),
            "gauges": [_of_gauge(one) for one in self.comparisons],
            "warnings": [asdict(problem) for problem in self.warnings],
            "written": list(self.written),
        }

    def settings(self) -> dict[str, Any]:
        """How it was compared."""
        return {
            "event": self.event,
            "band_hz": list(self.band_hz),
            "rate_hz": self.rate_hz,
            "k": self.k,
            "k_source": self.k_source,
            "distance": self.distance,
            "km_simulated": self.km_simulated,
            "aligned": self.is_aligned,
        }

    def as_text(self) -> str:
        """Text for people: the verdicts, the case line, what it rests on."""
        parts = [f"{visible(self.title)}: measured beside simulated", "\n".join(_table(self))]
        said = (self.line_in_words(), *self.basis(), YARDSTICK)
        parts.append("\n".join(textwrap.fill(visible(one), WIDTH, subsequent_indent="  ") for one in said))
        if self.written:
            parts.append(f"written: {', '.join(self.written)}")
        return "\n\n".join(parts)


def _table(found: Correlation) -> list[str]:
    """One line for each channel, in columns."""
    names = ["gauge", "channel", "verdict", "range ratio", "damage ratio", "rms ratio", "kept", "flags"]
    names += ["lag [s]", "correlation"] if found.is_aligned else []
    rows = [names]
    for one in found.comparisons:
        numbers = one.numbers
        row = [shortened(visible(one.channel.gauge), 28), shortened(visible(one.channel.name), 20), one.verdict]
        row += [_number(n) for n in (numbers.equivalent_range_ratio, numbers.damage_ratio, numbers.rms_ratio)]
        row += [f"{100.0 * one.kept_share:.4g} %", one.said_flags or "none"]
        if one.alignment is not None:
            row += [f"{one.alignment.lag_s:.4f}", _number(one.alignment.correlation)]
        rows.append(row)
    widths = [max(len(row[i]) for row in rows) for i in range(len(names))]
    return ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows]


def _of_gauge(one: Comparison) -> dict[str, Any]:
    """Record of one channel."""
    numbers, alignment = one.numbers, one.alignment
    return {
        "gauge": one.channel.gauge,
        "channel": one.channel.name,
        "verdict": one.verdict,
        "km": one.km,
        "lost_km": one.km_lost,
        "kept_share": one.kept_share,
        "bridged_samples": one.bridged,
        "flags": flag_counts(one.flags),
        "rms_measured_ue": numbers.rms_measured,
        "rms_simulated_ue": numbers.rms_simulated,
        "rms_ratio": numbers.rms_ratio,
        "band_ratios": [{"low_hz": a, "high_hz": b, "ratio": ratio} for (a, b), ratio in numbers.band_ratios.items()],
        "range_ratios_per_km": {str(n): ratio for n, ratio in numbers.range_ratios.items()},
        "pseudo_damage_measured_per_km": numbers.damage_measured,
        "pseudo_damage_simulated_per_km": numbers.damage_simulated,
        "damage_ratio": numbers.damage_ratio,
        "equivalent_range_ratio": numbers.equivalent_range_ratio,
        "lost_share": one.lost_share,
        "lag_s": None if alignment is None else alignment.lag_s,
        "correlation": None if alignment is None else alignment.correlation,
        "coherence_band": one.coherence,
    }


def _number(value: float) -> str:
    return "-" if math.isnan(value) else f"{value:#.3g}"


def verdicts_in_words(comparisons: Sequence[Comparison]) -> str:
    """How many channels have each verdict, as "2 good, 1 poor"."""
    counts: dict[str, int] = {}
    for one in comparisons:
        counts[one.verdict] = counts.get(one.verdict, 0) + 1
    return ", ".join(f"{n} {word.replace('_', ' ')}" for word, n in counts.items())
