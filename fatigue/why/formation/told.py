"""How resonances form, in words: which modes swing in an event, and at a weld which of them to watch."""

from dataclasses import dataclass

import numpy as np

from fatigue.readers.neutral.body.modes import Modes
from fatigue.shown import shortened, visible
from fatigue.vibration.resonance import AMPLIFIED, CLASSES, DYNAMIC, FAR_ABOVE, HALF_POWER
from fatigue.why.attribute import Attribution
from fatigue.why.formation.formation import Formation, Watched
from fatigue.why.formation.modes import ModesOfEvent
from fatigue.why.formation.watch import WORTH_COUNTING

NAMED = 4  # modes of a class in one event, the others are counted
SAID = {"resonant": "in resonance", "inertial": "held back by inertia, their loads are faster"}
_WHAT_SWINGS = (
    f"a mode is in resonance where the dynamic part of its coordinate has {DYNAMIC:g} of its rms or more (a sine has "
    f"it at 0.7 of the frequency of the mode), and the coordinate {AMPLIFIED:g} of the rms of its quasi-static part or "
    f"{HALF_POWER:g} of its variance within f (1 +- 2 zeta); a mode above {FAR_ABOVE:g} times the highest frequency of "
    "its motion follows"
)


@dataclass(frozen=True, slots=True)
class WatchFinding:
    """A swing at the worst point of a weld and what it costs; see the table ``watch``.

    ``start_km`` and ``end_km`` are None in an event counted by number, ``life_km_without`` and ``cost_km`` where
    nothing would damage the point any more.
    """

    mode: int
    frequency_hz: float
    mode_class: str
    event: str
    start_km: float | None
    end_km: float | None
    start_s: float
    end_s: float
    life_km: float
    life_km_without: float | None
    cost_km: float | None
    utilisation_cost: float

    def as_text(self) -> str:
        """One sentence."""
        where = (
            f"km {self.start_km:.1f} to {self.end_km:.1f}"
            if self.start_km is not None and self.end_km is not None
            else f"{self.start_s:.1f} to {self.end_s:.1f} s"
        )
        swing = f"mode {self.mode} ({self.frequency_hz:.4g} Hz, {self.mode_class.replace('_', '-')}) in "
        swing += f"{shortened(visible(self.event))}, half of it at {where}"
        if self.life_km_without is None or self.cost_km is None:
            return f"{swing}: without its swing the event does no damage here"
        if self.cost_km < 0.0:
            return f"{swing}: its swing relieves, {self.life_km_without:.3g} km if it followed its load"
        return f"{swing}: costs {self.cost_km:.3g} km, {self.life_km_without:.3g} km if it followed its load"


@dataclass(frozen=True, slots=True)
class OneMode:
    """A mode, and its natural frequency."""

    mode: int
    frequency_hz: float


@dataclass(frozen=True, slots=True)
class ModesFinding:
    """Which modes of an event are of which class, those first that swing most; ``reason`` where none is assessed."""

    event: str
    resonant: tuple[OneMode, ...]
    inertial: tuple[OneMode, ...]
    quasi_static: tuple[OneMode, ...]
    not_assessed: tuple[OneMode, ...]
    reason: str

    def as_text(self) -> str:
        """One line."""
        if self.reason:
            return f"{shortened(visible(self.event))}: not available, {self.reason}"
        parts = [
            f"{_named(modes)} {said}"
            for modes, said in ((self.resonant, SAID["resonant"]), (self.inertial, SAID["inertial"]))
            if modes
        ]
        parts += [f"{len(self.quasi_static)} follow their loads"] if self.quasi_static else []
        parts += [f"{len(self.not_assessed)} could not be assessed"] if self.not_assessed else []
        return f"{shortened(visible(self.event))}: {'; '.join(parts)}"


def watch_findings(of: Formation, weld: int, modes: Modes, attribution: Attribution) -> tuple[WatchFinding, ...]:
    """Swings at one of the points, the costliest first."""
    return tuple(_finding(one, of, modes, attribution) for one in of.of_weld(weld))


def watch_text(found: tuple[WatchFinding, ...], of: Formation, weld: int, event: int) -> str:
    """What to watch at one of the points, whose damage is mostly made in ``event``."""
    if found and found[0].utilisation_cost > 0.0:
        return found[0].as_text()
    here = of.welds[event]
    if here.reason:
        return f"not available: {here.reason}"
    hz = here.dominant_hz[weld]
    load = f", mostly at {hz:.3g} Hz" if np.isfinite(hz) else ""
    return f"no mode: none owes {WORTH_COUNTING:.0%} of the damage to its swing, the modes follow their loads{load}"


def modes_findings(of: Formation, modes: Modes) -> tuple[ModesFinding, ...]:
    """Classes of the modes, event by event."""
    return tuple(_classes(event, modes) for event in of.modes)


def notes(of: Formation, modes: Modes) -> list[str]:
    """What the classes rest on, and what could not be had."""
    said = [_WHAT_SWINGS]
    if of.damping.assumed is not None:
        assumed = int(np.count_nonzero(of.damping.source == "assumed"))
        said.append(
            f"a damping ratio of {of.damping.assumed:g} was assumed for {assumed} of {len(modes.mode)} modes, "
            "which have none of their own"
        )
    elif np.isnan(of.damping.ratio).any():
        said.append(
            "without damping ratio a mode is split as if it had none, which leaves 2 zeta of a resonance out of its "
            "quasi-static part; half-power shares, and excitations near resonance, need one: give --damping"
        )
    return said


def _finding(one: Watched, of: Formation, modes: Modes, attribution: Attribution) -> WatchFinding:
    swing = one.swing
    event = attribution.events[swing.event]
    start_km, end_km = (_or_none(event.place_km[at]) for at in (swing.first, swing.last + 1))
    without = _or_none(one.life_without)
    return WatchFinding(
        mode=int(modes.mode[swing.mode]),
        frequency_hz=float(modes.frequency[swing.mode]),
        mode_class=str(of.modes[swing.event].mode_class[swing.mode]),
        event=event.event,
        start_km=start_km,
        end_km=end_km,
        start_s=float(event.place_s[swing.first]),
        end_s=float(event.place_s[swing.last + 1]),
        life_km=one.life,
        life_km_without=without,
        cost_km=None if without is None else without - one.life,
        utilisation_cost=one.utilisation,
    )


def _classes(of: ModesOfEvent, modes: Modes) -> ModesFinding:
    order = np.argsort(-np.nan_to_num(of.rms * of.indicators.dynamic_share), kind="stable")
    by_class = {
        name: tuple(
            OneMode(int(modes.mode[k]), float(modes.frequency[k])) for k in order[of.mode_class[order] == name].tolist()
        )
        for name in CLASSES
    }
    none = len(by_class["not_assessed"]) == len(modes.mode)
    return ModesFinding(of.event, **by_class, reason=str(of.reason[0] or "no mode moves") if none else "")


def _named(modes: tuple[OneMode, ...]) -> str:
    named = ", ".join(f"{one.mode} ({one.frequency_hz:.4g} Hz)" for one in modes[:NAMED])
    others = len(modes) - NAMED
    return f"mode{'s' * (len(modes) > 1)} {named}" + (f" and {others} more" if others > 0 else "")


def _or_none(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None
