"""What a diagnosis says in words: at each weld's worst point event, band, modes, place and lever."""

import textwrap
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.life.mission import life_km
from fatigue.pipeline.solve.body import Body
from fatigue.pipeline.tables.rows import FACES
from fatigue.shown import shortened, visible
from fatigue.why.attribute import Attribution
from fatigue.why.evidence import Evidence, ids
from fatigue.why.formation.told import ModesFinding, WatchFinding, modes_findings, watch_findings, watch_text
from fatigue.why.formation.told import notes as formation_notes
from fatigue.why.levers import SMALLER

LONGEST_LIFE_KM = 1e12
WIDTH = 110
NAMED = 3  # modes and bands, the second and third only if they have
WORTH_NAMING = 0.01  # of the damage
FAR_ABOVE = 3.0  # a mode at three times the frequency answers by 1 / (1 - 1/9), 12 % more than at 0 Hz
HALF = 0.5


@dataclass(frozen=True, slots=True)
class ModeFinding:
    """A mode or unit load and what it has to do with the damage of a point; see ``fatigue.why.attribute.Attribution``.

    ``mode`` and ``frequency_hz`` are None of a unit load, ``unit_load`` is its name and ``kind`` says so.
    """

    mode: int | None
    unit_load: str
    kind: str
    frequency_hz: float | None
    share: float
    resonant_share: float | None
    life_exponent: float


@dataclass(frozen=True, slots=True)
class BandFinding:
    """A frequency band and its share of the damage; no upper edge: None."""

    low_hz: float
    high_hz: float | None
    share: float


@dataclass(frozen=True, slots=True)
class LeverFinding:
    """What a mode or a unit load buys if it is 10 % smaller: life by its exponent, and counted again [km]."""

    mode: int | None
    unit_load: str
    life_km_estimated: float
    life_km_counted: float


@dataclass(frozen=True, slots=True)
class Finding:
    """What makes the damage at the worst point of a weld.

    ``modes`` (unit loads among them) and ``bands`` are those with the largest shares, no bands where no record is long
    enough for a spectrum; ``relieving_share`` is what all relieving ones take off; ``half_damage_part`` is the smallest
    part of the governing event that holds half of its damage, and its worst bin begins at ``place_km`` (None for an
    event counted by number) and ``place_s``; ``verdict`` and the split of the Dirlik ratio into errors of formula and
    process, None where it was not made, belong to the governing event, as does ``dominant_hz`` of the stress.
    ``watch`` are the costliest swings of modes, ``watch_text`` says the first of them, or why there is none.
    ``with_loads``: whether the body has unit loads.
    """

    weld: str
    part: int
    order: int
    node: int
    surface: str
    life_km: float
    event: str
    event_share: float
    sequence_share: float
    modes: tuple[ModeFinding, ...]
    relieving_share: float
    bands: tuple[BandFinding, ...]
    half_damage_part: float
    place_km: float | None
    place_s: float
    place_intensity: float
    levers: tuple[LeverFinding, ...]
    with_loads: bool
    verdict: str
    reason: str
    formula_error: float | None
    process_error: float | None
    dominant_hz: float | None
    watch: tuple[WatchFinding, ...]
    watch_text: str

    def as_text(self) -> str:
        """Text for people: a heading and a line for each question."""
        modes = ", ".join(f"{self._mode(m)} {_percent(m.share)}" for m in self.modes)
        bands = ", ".join(f"{_band(b)} {_percent(b.share)}" for b in self.bands)
        place = f"km {self.place_km:.1f} of the record" if self.place_km is not None else f"{self.place_s:.1f} s"
        weld, event = shortened(visible(self.weld)), shortened(visible(self.event))
        best = self.levers[0]
        gain = 100.0 * (best.life_km_counted / self.life_km - 1.0)
        relieving = "relieving modes and loads" if self.with_loads else "relieving modes"
        lines = {
            "event": f"{event} {_percent(self.event_share)}{self._across_events()}",
            "bands": bands or "not available: no record is long enough for a spectrum",
            "loads" if self.with_loads else "modes": f"{modes}; {relieving} {_percent(self.relieving_share)}",
            "place": f"half of the damage of {event} on {_percent(self.half_damage_part)} of it, most at {place}, "
            f"{self.place_intensity:.1f} times the average",
            "lever": f"{called(best)} {_percent(1 - SMALLER)} smaller: {_km(best.life_km_counted)} ({gain:+.0f} %)",
            "watch": self.watch_text,
            "Dirlik": f"{self.verdict}: {self.reason}",
        }
        if self.formula_error is not None and self.process_error is not None:
            lines["Dirlik"] += f" Ratio = {self.formula_error:.2f} (formula) x {self.process_error:.2f} (process)."
        heading = f"{weld}, node {self.node} {self.surface}: {_km(self.life_km)}"
        return "\n".join([heading, *(_wrapped(f"  {name:8}", text) for name, text in lines.items())])

    def _across_events(self) -> str:
        """Say what cycles across the events of sequences make; nothing where there are none."""
        return f"; cycles across events {_percent(self.sequence_share)}" if self.sequence_share else ""

    def _mode(self, mode: ModeFinding) -> str:
        """Name of a mode or load; a mode far above the band it damages in follows its load and does not swing."""
        if mode.frequency_hz is None:
            return called(mode)
        high = self.bands[0].high_hz if self.bands else None
        follows = high is not None and mode.frequency_hz > FAR_ABOVE * high
        return f"{mode.mode} ({mode.kind}, {mode.frequency_hz:.4g} Hz{', quasi-static' if follows else ''})"


@dataclass(frozen=True, slots=True)
class Diagnosis:
    """What makes the damage of a result: a finding per damaged weld, worst first, and what could not be had.

    ``modes`` are classes of the modes, event by event.
    """

    title: str
    points: str
    findings: tuple[Finding, ...]
    notes: tuple[str, ...]
    modes: tuple[ModesFinding, ...]

    def as_record(self) -> dict[str, Any]:
        """Record for machines."""
        return asdict(self)

    def as_text(self) -> str:
        """Text for people."""
        notes = [_wrapped("  ", note) for note in self.notes]
        modes = [_wrapped("  ", event.as_text()) for event in self.modes]
        return "\n\n".join(
            [
                f"{visible(self.title)}: what makes the damage, of {self.points}",
                *(finding.as_text() for finding in self.findings),
                "\n".join(["Which modes swing, which follow their loads:", *modes]),
                *(["\n".join(["Not available, or to be read with care:", *notes])] if notes else []),
            ]
        )


def findings(evidence: Evidence, points: str) -> Diagnosis:
    """Summary of a diagnosis, with a finding for every point the levers were sought at; ``points`` says which."""
    found = [_finding(evidence, row) for row in range(len(evidence.levers.point))]
    modes = evidence.body.modes
    return Diagnosis(
        title=evidence.body.case.title,
        points=points,
        findings=tuple(sorted(found, key=lambda finding: finding.life_km)),
        notes=(
            *_notes(evidence.body, evidence.attribution, evidence.formation.damping.ratio),
            *formation_notes(evidence.formation, modes),
        ),
        modes=modes_findings(evidence.formation, modes),
    )


def _finding(evidence: Evidence, row: int) -> Finding:
    """Finding at the point of one row of the levers."""
    coordinates, levers = evidence.body.coordinates, evidence.levers
    mode, unit_load = ids(coordinates)
    point = int(levers.point[row])
    own = evidence.attribution.of(slice(point, point + 1))
    points, event_share, exponent = own.points, own.event_share[0], own.mode_exponent[0]
    governing = int(event_share[: len(evidence.verdicts)].argmax())
    event, verdict = own.events[governing], evidence.verdicts[governing]
    share, resonant = own.mode_share[0], own.resonant_share[0]
    damage = event.damage[0]  # none where a sequence has all of it
    intensity = event.place[0] / damage / event.place_length if damage > 0.0 else np.zeros_like(event.place[0])
    hottest = int(intensity.argmax())
    watch = watch_findings(evidence.formation, row, coordinates.modes, evidence.attribution)
    return Finding(
        weld=str(points.weld[0]),
        part=int(points.part[0]),
        order=int(points.order[0]),
        node=int(points.node[0]),
        surface=FACES[points.face[0]],
        life_km=float(life_km(own.damage, points.damage_limit)[0]),
        event=event.event,
        event_share=float(event_share[governing]),
        sequence_share=float(event_share[len(evidence.verdicts) :].sum()),
        modes=tuple(
            ModeFinding(
                mode=mode[k],
                unit_load=unit_load[k] or "",
                kind=coordinates.kind[k],
                frequency_hz=float(coordinates.modes.frequency[k]) if coordinates.is_mode[k] else None,
                share=float(share[k]),
                resonant_share=_or_none(resonant[k]),
                life_exponent=float(exponent[k]),
            )
            for k in _largest(share)
        ),
        relieving_share=float(share[share < 0.0].sum()),
        bands=_largest_bands(own),
        half_damage_part=_part_that_holds(HALF, intensity, event.place_length),
        place_km=_or_none(event.place_km[hottest]),
        place_s=float(event.place_s[hottest]),
        place_intensity=float(intensity[hottest]),
        levers=tuple(
            LeverFinding(mode[k], unit_load[k] or "", float(estimated), float(counted))
            for k, estimated, counted in zip(
                levers.mode[row], levers.life_estimated[row], levers.life_counted[row], strict=True
            )
        ),
        with_loads=len(coordinates.unit_loads) > 0,
        verdict=str(verdict.verdict[point]),
        reason=str(verdict.reason[point]),
        formula_error=_or_none(verdict.formula[point]),
        process_error=_or_none(verdict.process[point]),
        dominant_hz=_or_none(evidence.formation.welds[governing].dominant_hz[row]),
        watch=watch,
        watch_text=watch_text(watch, evidence.formation, row, governing),
    )


def called(found: ModeFinding | LeverFinding) -> str:
    """Name of a mode or a unit load in a sentence."""
    return f"unit load {found.unit_load}" if found.mode is None else f"mode {found.mode}"


def _largest_bands(own: Attribution) -> tuple[BandFinding, ...]:
    """Bands with the largest shares at the only point; none where no event is long enough for bands."""
    edges = next((event.edges_hz for event in own.events if event.has_bands), None)
    if edges is None:
        return ()
    share = own.band_share[0, :-1]
    return tuple(BandFinding(float(edges[b]), _or_none(edges[b + 1]), float(share[b])) for b in _largest(share))


def _largest(share: NDArray[np.float64]) -> NDArray[np.int64]:
    """Index of the largest shares, first the largest, leaving out what is not worth naming."""
    order = np.argsort(-share, kind="stable")[:NAMED]
    return np.asarray(order[(share[order] >= WORTH_NAMING) | (order == order[0])])


def _part_that_holds(share: float, intensity: NDArray[np.float64], length: NDArray[np.float64]) -> float:
    """Smallest part of an event that holds a share of its damage, its bins cut where needed."""
    order = np.argsort(-intensity, kind="stable")
    held, covered = np.cumsum((intensity * length)[order]), np.cumsum(length[order])
    return float(np.interp(share, np.append(0.0, held), np.append(0.0, covered)))


def _notes(body: Body, attribution: Attribution, damping: NDArray[np.float64]) -> Iterator[str]:
    if np.isnan(damping).any():
        without = (
            "no mode has" if np.isnan(damping).all() else f"{np.count_nonzero(np.isnan(damping))} modes do not have"
        )
        yield f"{without} a damping ratio, so it is not said what such a mode does in resonance"
    static = {event.name for event in body.case.mission.event if event.history is None}
    for event in attribution.events:
        if event.is_sequence:
            yield (
                f"{event.event}: its damage is that of cycles between two events, which have no frequency and no place "
                "on the track"
            )
            continue
        if event.event in static:
            yield (
                f"event '{event.event}' is a static load case, so its damage is that of its values one after another, "
                "with no frequency and no place on the track"
            )
            continue
        if not event.has_bands:
            yield (
                f"event '{event.event}': the record is shorter than one spectral segment, so its damage is not shared "
                "out to frequency bands; it is one band from 0 Hz up"
            )
        if np.isnan(event.place_km).any():
            yield f"event '{event.event}' is counted by number, so its damage has an instant but no place on the track"
    if any(rated.rule.law.cutoff > 0.0 for rated in body.curves.values()):
        yield (
            "a curve with a cut-off: damage jumps there, and life exponents do not see cycles that cross it; the lives "
            "counted again do"
        )


def _band(band: BandFinding) -> str:
    return f"above {band.low_hz:.3g} Hz" if band.high_hz is None else f"{band.low_hz:.3g}-{band.high_hz:.3g} Hz"


def _or_none(value: float) -> float | None:
    """Value as a float; None where it is infinite or not a number."""
    return float(value) if np.isfinite(value) else None


def _wrapped(first: str, text: str) -> str:
    return textwrap.fill(text, WIDTH, initial_indent=first, subsequent_indent=" " * len(first))


def _percent(share: float) -> str:
    return f"{100.0 * share:.3g} %"


def _km(value: float) -> str:
    return "> 1e12 km" if value > LONGEST_LIFE_KM else f"{value:.3g} km"
