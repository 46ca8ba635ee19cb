"""What is said of load spectra: at each point the mission and its events in equivalent ranges; the doubts."""

import textwrap
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import Problem
from fatigue.load_spectra.gathered import MISSION, PointSpectra
from fatigue.load_spectra.measured import MEASURED
from fatigue.load_spectra.rows import FACES, equivalents
from fatigue.load_spectra.signals import SignalSpectra
from fatigue.shown import shortened, visible
from fatigue.why.points import Points

Floats = NDArray[np.float64]

POINTS_TOLD = 20
WIDTH = 110


@dataclass(frozen=True, slots=True)
class EquivalentRange:
    """Equivalent ranges of an event for one exponent [MPa]; None where a sequence takes away more than it adds."""

    exponent: float
    equivalent_range_2e6_MPa: float | None  # noqa: N815
    del_MPa: float | None  # noqa: N815
    del_reference: str


@dataclass(frozen=True, slots=True)
class EventLine:
    """One event at one point, per km of the mission; a largest range is None where nothing varies."""

    event: str
    cycles_per_km: float
    max_range_MPa: float | None  # noqa: N815
    damage_per_km: float
    bending_ratio: float | None
    equivalent: tuple[EquivalentRange, ...]


@dataclass(frozen=True, slots=True)
class PointLine:
    """One point with its events, the mission behind them, and what was measured last."""

    weld: str
    part: int
    order: int
    node: int
    surface: str
    events: tuple[EventLine, ...]

    @property
    def damage_per_km(self) -> float:
        """Miner sum of the mission [1/km]."""
        return next(event.damage_per_km for event in self.events if event.event == MISSION)


@dataclass(frozen=True, slots=True)
class SignalLine:
    """One coordinate of the body under the whole mission, in its own unit; ``unit_load`` is empty for a mode."""

    signal: str
    unit_load: str
    unit: str
    cycles_per_km: float
    largest: float | None
    power_sum_per_km: tuple[float, ...]
    del_per_km: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class LoadSpectra:
    """The load spectra of a result in short, worst point first; all numbers are in the tables of its folder.

    ``points`` says which points were chosen, ``exponents`` are those given, none: the first slope of each curve.
    """

    title: str
    points: str
    classes: int
    exponents: tuple[float, ...]
    target_km: float
    at_points: tuple[PointLine, ...]
    signals: tuple[SignalLine, ...]
    warnings: tuple[Problem, ...]

    def as_record(self) -> dict[str, Any]:
        """Record for machines."""
        return asdict(self)

    def as_text(self) -> str:
        """Text for people: a table for each point, of many points for the first."""
        given = ", ".join(f"{m:g}" for m in self.exponents) or "the first slope of the curve of each point"
        said = (
            f"Exponent m: {given}. Equivalent range: (target x sum n S^m / 2e6)^(1/m), target {self.target_km:.4g} km. "
            "DEL: (sum n S^m / N)^(1/m), N = duration x 1 Hz of an event, 1 a km of (mission)."
        )
        parts = [
            f"{visible(self.title)}: load spectra of {self.points}, {self.classes} classes",
            textwrap.fill(said, WIDTH),
            *(_point_text(point) for point in self.at_points[:POINTS_TOLD]),
        ]
        parts += _signals_text([line for line in self.signals if line.unit_load])
        if (more := len(self.at_points) - POINTS_TOLD) > 0:
            parts.append(f"{more} more points are in the tables.")
        return "\n\n".join(parts)


_HEADING = ("event", "cycles/km", "largest", "m", "S_eq 2e6", "amplitude", "DEL", "damage/km")


def _point_text(point: PointLine) -> str:
    """A heading and a line for each event and exponent [MPa]."""
    weld = shortened(visible(point.weld))
    lines = [f"{weld}, node {point.node} {point.surface} [MPa]", _columns(_HEADING)]
    for event in point.events:
        name = shortened(visible(event.event))
        for i, of in enumerate(event.equivalent):
            own = (name, _number(event.cycles_per_km), _number(event.max_range_MPa)) if i == 0 else ("", "", "")
            half = None if of.equivalent_range_2e6_MPa is None else 0.5 * of.equivalent_range_2e6_MPa
            S_eq, alone = of.equivalent_range_2e6_MPa, of.del_MPa
            equivalent = (f"{of.exponent:.4g}", _number(S_eq), _number(half), _number(alone))
            lines.append(_columns((*own, *equivalent, _number(event.damage_per_km) if i == 0 else "")))
    by_name = {event.event: event.damage_per_km for event in point.events}
    if MEASURED in by_name and by_name[MISSION] > 0.0:
        lines.append(f"  damage of (measured) / (mission): {_number(by_name[MEASURED] / by_name[MISSION])}")
    return "\n".join(lines)


def _signals_text(signals: Sequence[SignalLine]) -> list[str]:
    """A table of the unit loads under the mission; modes are in the tables only."""
    if not signals:
        return []
    lines = ["Unit loads under the mission, each in its own unit", _columns(("load", "cycles/km", "largest", "DEL"))]
    for line in signals:
        name = shortened(visible(f"{line.unit_load} [{line.unit}]"))
        equivalent = ", ".join(_number(value) for value in line.del_per_km)
        lines.append(_columns((name, _number(line.cycles_per_km), _number(line.largest), equivalent)))
    return ["\n".join(lines)]


def _columns(cells: Sequence[str]) -> str:
    name, *numbers = cells
    return (f"  {name:36}" + "".join(f"{cell:>10}" for cell in numbers)).rstrip()


def _number(value: float | None) -> str:
    return "-" if value is None else f"{value:.4g}"


def point_lines(
    points: Points, spectra: Sequence[Sequence[PointSpectra]], exponents: Sequence[Floats], target_km: float
) -> list[PointLine]:
    """What is said of some points."""
    return [
        PointLine(
            weld=str(points.weld[i]),
            part=int(points.part[i]),
            order=int(points.order[i]),
            node=int(points.node[i]),
            surface=FACES[points.face[i]],
            events=tuple(_event_line(of, exponents[i], target_km) for of in spectra[i]),
        )
        for i in range(len(points))
    ]


def _event_line(of: PointSpectra, exponents: Floats, target_km: float) -> EventLine:
    found = zip(exponents, equivalents(of, exponents, target_km), of.del_MPa, strict=True)
    return EventLine(
        event=of.event,
        cycles_per_km=of.cycles,
        max_range_MPa=_or_none(of.max_range),
        damage_per_km=of.damage,
        bending_ratio=_or_none(of.bending_ratio),
        equivalent=tuple(
            EquivalentRange(float(m), _or_none(S), _or_none(alone), of.del_reference) for m, S, alone in found
        ),
    )


def signal_line(spectra: SignalSpectra) -> SignalLine:
    """What is said of one coordinate under the mission."""
    largest = float(np.fmax.reduce(spectra.ranges[-1].largest, initial=np.nan))
    return SignalLine(
        signal=spectra.signal.column,
        unit_load=spectra.signal.unit_load,
        unit=spectra.signal.unit,
        cycles_per_km=float(spectra.cycles[-1]),
        largest=_or_none(largest),
        power_sum_per_km=tuple(spectra.power_sum[-1].tolist()),
        del_per_km=tuple(spectra.equivalent[-1].tolist()),
    )


def _or_none(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None
