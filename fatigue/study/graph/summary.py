"""What is said of an analysis graph: critical values of every vehicle, for people and for machines."""

from dataclasses import asdict, dataclass
from typing import Any

from fatigue.shown import visible
from fatigue.study.graph.converter import converter_line
from fatigue.study.graph.line import Line
from fatigue.study.graph.numbers import Value
from fatigue.study.graph.vehicle_graph import VehicleGraph, critical_rows
from fatigue.study.vehicle_file import keys_of

NO_TRAIN = "The vehicle is invented; no number here is a property of a real train, and nothing is a validation."


@dataclass(frozen=True, slots=True, eq=False)
class Graph:
    """Analysis graphs of some vehicles, their ``numbers`` by vehicle and name; ``written`` are its files."""

    vehicles: tuple[VehicleGraph, ...]
    numbers: dict[str, dict[str, Value]]
    written: tuple[str, ...] = ()

    def as_record(self) -> dict[str, Any]:
        """Record for machines: values, stable ranges and crossings of each vehicle by its name."""
        return {
            "vehicles": {
                of.name: {
                    "vehicle": dict(keys_of(of.vehicle)),
                    "numbers": {
                        name: {"value": value, "unit": unit, "reason": reason}
                        for name, (value, unit, reason) in self.numbers[of.name].items()
                    },
                    "stable": [
                        {"along": line.along, "at": line.at, "ranges": [list(ends) for ends in line.stable]}
                        for line in of.lines
                    ],
                    "critical": [asdict(row) for row in critical_rows(of)],
                }
                for of in self.vehicles
            },
            "written": list(self.written),
        }

    def as_text(self) -> str:
        """Text for people: a block for each vehicle."""
        parts = [_block(of, self.numbers[of.name]) for of in self.vehicles]
        parts.append(NO_TRAIN)
        if self.written:
            parts.append(f"written: {', '.join(self.written)}")
        return "\n\n".join(parts)


def _block(of: VehicleGraph, numbers: dict[str, Value]) -> str:
    """Stable ranges of one vehicle, line by line, with the root that changes at either end; its converter."""
    setting = of.vehicle.suspension.setting
    title = visible(of.name) if of.name == setting else f"{visible(of.name)} ({setting})"
    width = max(len(at_of(line)) for line in of.lines)
    lines = [f"  {at_of(line).ljust(width)}  {ranges_of(line, with_hz=True)}" for line in of.lines]
    lines.append(f"  {converter_line(of.vehicle.converter.fe_hz, numbers)}")
    return "\n".join([f"{title} is stable for", *lines])


def at_of(line: Line) -> str:
    """What stays along a line, in words."""
    return f"at {line.at:g} km/h" if line.along == "conicity" else f"at conicity {line.at:g}"


def ranges_of(line: Line, *, with_hz: bool = False) -> str:
    """Stable ranges of a line in words, with the frequency of the root that changes where one ends.

    >>> from types import SimpleNamespace as L
    >>> ranges_of(L(stable=((0.08252, 0.7088),), ends=(0.01, 1.2), along="conicity", crossings=()))
    'conicities 0.0825 to 0.709'
    """
    if not line.stable:
        return "nothing that was looked at"
    hz = {crossing.at: f" ({crossing.root.frequency_hz:.2f} Hz)" for crossing in line.crossings} if with_hz else {}
    low, high = line.ends
    unit = "" if line.along == "conicity" else " km/h"
    said = []
    for a, b in line.stable:
        first, last = (f"{value_of(line, end)}{unit}{hz.get(end, '')}" for end in (a, b))
        if a == low and b < high:
            said.append(f"up to {last}")
        elif b == high and a > low:
            said.append(f"from {first} on")
        else:
            every = ", all that were looked at" if (a, b) == (low, high) else ""
            said.append(f"{first.removesuffix(unit)} to {last}{every}")
    return f"{'conicities' if line.along == 'conicity' else 'speeds'} {' and '.join(said)}"


def value_of(line: Line, value: float) -> str:
    """A value along a line: conicities with three digits, speeds to the km/h."""
    return f"{value:.3g}" if line.along == "conicity" else f"{value:.0f}"
