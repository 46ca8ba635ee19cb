"""What is said of a history that was written: of which station, to which file, what it spans in every event."""

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from fatigue.errors import Problem
from fatigue.point.found import FACES, Station
from fatigue.point.history import Instants
from fatigue.shown import shortened, visible

INSTANTS: dict[Instants, str] = {"counted": "the instants that were counted", "file": "the samples of the file"}
_SHOWN = ("min", "max", "range")


@dataclass(frozen=True, slots=True)
class EventExtent:
    """What is said of the history of a station in one event.

    Attributes
    ----------
    event : name
    is_static : a static load case: its values have numbers for times
    samples, step_s, start_s, end_s : instants [s]
    upsample : how many there are for one sample of the file
    residue : whether the record recurs (``repeat``) or is passed once (``half``)
    stress_factor : on all stresses, included
    constant_top_MPa, constant_bottom_MPa : constants of unit loads and means that were removed, included [MPa]
    min_top_MPa ... range_bottom_MPa : extremes of what is counted, and the range between them [MPa]
    """

    event: str
    is_static: bool
    samples: int
    step_s: float
    start_s: float
    end_s: float
    upsample: int
    residue: str
    stress_factor: float
    constant_top_MPa: float  # noqa: N815
    constant_bottom_MPa: float  # noqa: N815
    min_top_MPa: float  # noqa: N815
    max_top_MPa: float  # noqa: N815
    range_top_MPa: float  # noqa: N815
    min_bottom_MPa: float  # noqa: N815
    max_bottom_MPa: float  # noqa: N815
    range_bottom_MPa: float  # noqa: N815


@dataclass(frozen=True, slots=True)
class WrittenHistory:
    """A history that was written: of which station, to which file, and what it spans in every event."""

    title: str
    file: Path
    station: Station
    instants: Instants
    columns: tuple[str, ...]
    events: tuple[EventExtent, ...]
    warnings: tuple[Problem, ...]

    @property
    def samples(self) -> int:
        """Rows of the table."""
        return sum(event.samples for event in self.events)

    def as_record(self) -> dict[str, Any]:
        """Record for machines."""
        at = self.station
        return {
            "title": self.title,
            "file": str(self.file),
            "weld": at.weld,
            "part": at.part,
            "order": at.order,
            "node": at.node,
            "toe": dict(zip(FACES, at.toe, strict=True)),
            "instants": self.instants,
            "samples": self.samples,
            "columns": list(self.columns),
            "events": [asdict(event) for event in self.events],
            "warnings": [asdict(problem) for problem in self.warnings],
        }

    def as_text(self) -> str:
        """Text for people."""
        head = ("event", "samples", "from_s", "to_s", "upsample", *(f"{face}_{q}" for face in FACES for q in _SHOWN))
        rows = [head, *(_cells(event) for event in self.events)]
        widths = [max(len(row[i]) for row in rows) for i in range(len(head))]
        named, *numbers = widths
        events = f"{len(self.events)} event{'s' * (len(self.events) != 1)}"
        toes = zip(FACES, self.station.toe, strict=True)
        bare = "".join(f" (no weld toe on the {face} face)" for face, toe in toes if not toe)
        return "\n".join(
            [
                f"{self.file}: {self.samples} samples of {events} at {INSTANTS[self.instants]}",
                f"W{str(self.station)[1:]}{bare}; stresses in MPa",
                "",
                *("  ".join([row[0].ljust(named), *map(str.rjust, row[1:], numbers)]) for row in rows),
                "",
                "Columns: " + ", ".join(self.columns),
                "Stress factors and constants are included; bending and twist are those of the top face.",
            ]
        )


def _cells(event: EventExtent) -> tuple[str, ...]:
    said = asdict(event)
    stresses = (f"{said[f'{q}_{face}_MPa']:.4g}" for face in FACES for q in _SHOWN)
    factor = "static" if event.is_static else str(event.upsample)
    times = (str(event.samples), f"{event.start_s:.6g}", f"{event.end_s:.6g}", factor)
    return (visible(shortened(event.event)), *times, *stresses)
