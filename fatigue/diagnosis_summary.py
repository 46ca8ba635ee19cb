"""What a diagnosis says in words: at each weld's worst point event, band, modes, place and lever."""

from collections.abc import Iterator
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.attribute import Attribution
from fatigue.body import Body
from fatigue.levers import SMALLER, Levers
from fatigue.life.mission import Plan, life_km
from fatigue.readers.body import Modes
from fatigue.tables import FACES

LONGEST_LIFE_KM = 1e12
MODES_NAMED = 3
HALF = 0.5


@dataclass(frozen=True, slots=True)
class ModeFinding:
    """A mode and what it has to do with the damage of a point; see `fatigue.attribute.Attribution`."""

    mode: int
    kind: str
    frequency_hz: float
    share: float
    resonant_share: float | None
    life_exponent: float


@dataclass(frozen=True, slots=True)
class LeverFinding:
    """What a mode buys if it is 10 % smaller: life by its exponent, and counted again [km]."""

    mode: int
    life_km_estimated: float
    life_km_counted: float


@dataclass(frozen=True, slots=True)
class Finding:
    """What makes the damage at the worst point of a weld.

    ``modes`` are those with the largest shares; ``relieving_share`` is what all relieving modes take off; ``low_hz``
    and ``high_hz`` bound the band with the largest share, None where no record is long enough for bands or the band is
    open; ``half_damage_part`` is the smallest part of the governing event that holds half of its damage, and its worst
    bin begins at ``place_km`` (None for an event counted by number) and ``place_s``.
    """

    weld: str
    part: int
    order: int
    node: int
    surface: str
    life_km: float
    event: str
    event_share: float
    modes: tuple[ModeFinding, ...]
    relieving_share: float
    low_hz: float | None
    high_hz: float | None
    band_share: float | None
    half_damage_part: float
    place_km: float | None
    place_s: float
    place_intensity: float
    levers: tuple[LeverFinding, ...]

    def as_text(self) -> str:
        """For people: a heading and a line for each question."""
        modes = ", ".join(f"{_mode(m)} {_percent(m.share)}" for m in self.modes)
        place = f"km {self.place_km:.1f} of the record" if self.place_km is not None else f"{self.place_s:.1f} s"
        best = self.levers[0]
        gain = 100.0 * (best.life_km_counted / self.life_km - 1.0)
        lines = (
            f"{self.weld}, node {self.node} {self.surface}: {_km(self.life_km)}",
            f"  event   {self.event} makes {_percent(self.event_share)} of the damage",
            f"  band    {self._band()}",
            f"  modes   {modes}; relieving modes {_percent(self.relieving_share)}",
            f"  place   half of {self.event} on {_percent(self.half_damage_part)} of its length",
            f"          most at {place}, {self.place_intensity:.1f} times the average",
            f"  lever   mode {best.mode} {100 * (1 - SMALLER):.0f} % smaller: {_km(best.life_km_counted)} ({gain:+.0f} %)",
        )
        return "\n".join(lines)

    def _band(self) -> str:
        if self.band_share is None:
            return "not available: no record is long enough for a spectrum"
        low = 0.0 if self.low_hz is None else self.low_hz
        edges = f"above {low:.3g} Hz" if self.high_hz is None else f"{low:.3g} to {self.high_hz:.3g} Hz"
        return f"{edges} makes {_percent(self.band_share)}"


@dataclass(frozen=True, slots=True)
class Diagnosis:
    """What makes the damage of a result: a finding per damaged weld, worst first, and what could not be had."""

    title: str
    points: str
    findings: tuple[Finding, ...]
    notes: tuple[str, ...]

    def as_record(self) -> dict[str, Any]:
        """For machines."""
        return asdict(self)

    def as_text(self) -> str:
        """For people."""
        return "\n\n".join(
            [
                f"{self.title}: what makes the damage, of {self.points}",
                *(finding.as_text() for finding in self.findings),
                "\n".join(["Not available, or to be read with care:", *(f"  {note}" for note in self.notes)]),
            ]
        )


def findings(body: Body, plan: Plan, attribution: Attribution, levers: Levers, points: str) -> Diagnosis:
    """Sum up a diagnosis; there is a finding for every point the levers were sought at."""
    found = [_finding(body.modes, plan, attribution, levers, row) for row in range(len(levers.point))]
    return Diagnosis(
        title=body.case.title,
        points=points,
        findings=tuple(sorted(found, key=lambda finding: finding.life_km)),
        notes=tuple(_notes(body, attribution)),
    )


def _finding(modes: Modes, plan: Plan, attribution: Attribution, levers: Levers, row: int) -> Finding:
    point, points = int(levers.point[row]), attribution.points
    event_share = attribution.event_share[point]
    event = attribution.events[int(event_share.argmax())]
    share, resonant = attribution.mode_share[point], attribution.resonant_share[point]
    band = attribution.band_share[point]
    edges = next((e.edges_hz for e in attribution.events if e.has_bands), None)
    largest = int(band[:-1].argmax()) if edges is not None else -1
    intensity = event.place[point] / event.damage[point] / event.place_length
    hottest = int(intensity.argmax())
    return Finding(
        weld=str(points.weld[point]),
        part=int(points.part[point]),
        order=int(points.order[point]),
        node=int(points.node[point]),
        surface=FACES[points.face[point]],
        life_km=float(life_km(attribution.damage[[point]], plan.damage_limit)[0]),
        event=event.event,
        event_share=float(event_share.max()),
        modes=tuple(
            ModeFinding(
                mode=int(modes.mode[k]),
                kind=modes.kind[k],
                frequency_hz=float(modes.frequency[k]),
                share=float(share[k]),
                resonant_share=float(resonant[k]) if np.isfinite(resonant[k]) else None,
                life_exponent=float(attribution.mode_exponent[point, k]),
            )
            for k in np.argsort(-share, kind="stable")[:MODES_NAMED]
        ),
        relieving_share=float(share[share < 0.0].sum()),
        low_hz=None if edges is None else float(edges[largest]),
        high_hz=None if edges is None or np.isinf(edges[largest + 1]) else float(edges[largest + 1]),
        band_share=None if edges is None else float(band[largest]),
        half_damage_part=_part_that_holds(HALF, intensity, event.place_length),
        place_km=None if np.isnan(event.place_km[hottest]) else float(event.place_km[hottest]),
        place_s=float(event.place_s[hottest]),
        place_intensity=float(intensity[hottest]),
        levers=tuple(
            LeverFinding(int(modes.mode[k]), float(estimated), float(counted))
            for k, estimated, counted in zip(
                levers.mode[row], levers.life_estimated[row], levers.life_counted[row], strict=True
            )
        ),
    )


def _part_that_holds(share: float, intensity: NDArray[np.float64], length: NDArray[np.float64]) -> float:
    """Smallest part of an event that holds a share of its damage, its bins cut where needed."""
    order = np.argsort(-intensity, kind="stable")
    held, covered = np.cumsum((intensity * length)[order]), np.cumsum(length[order])
    return float(np.interp(share, np.append(0.0, held), np.append(0.0, covered)))


def _notes(body: Body, attribution: Attribution) -> Iterator[str]:
    damping = body.modes.damping_ratio
    if np.isnan(damping).any():
        without = (
            "no mode has" if np.isnan(damping).all() else f"{np.count_nonzero(np.isnan(damping))} modes do not have"
        )
        yield f"{without} a damping ratio, so it is not said what such a mode does in resonance"
    for event in attribution.events:
        if not event.has_bands:
            yield (
                f"event '{event.event}': the record is shorter than one spectral segment, so its damage is not shared "
                "out to frequency bands; it is one band from 0 Hz up"
            )
        if np.isnan(event.place_km).any():
            yield f"event '{event.event}' is counted by number, so its damage has an instant but no place on the track"
    if any(rated.law.cutoff > 0.0 for rated in body.curves.values()):
        yield (
            "a curve with a cut-off: damage jumps there, and life exponents do not see cycles that cross it; the lives "
            "counted again do"
        )


def _mode(mode: ModeFinding) -> str:
    return f"{mode.mode} ({mode.kind}, {mode.frequency_hz:.4g} Hz)"


def _percent(share: float) -> str:
    return f"{100.0 * share:.3g} %"


def _km(value: float) -> str:
    return "> 1e12 km" if value > LONGEST_LIFE_KM else f"{value:.4g} km"
