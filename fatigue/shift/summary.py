"""What a shift study says: life of every weld against the settings of the mode, longest, shortest, and the doubts."""

import re
import textwrap
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import Problem
from fatigue.shift.settings import LargestShare, ShiftedMode
from fatigue.shown import few, shortened, visible
from fatigue.vibration.shifted import Setting

Floats = NDArray[np.float64]

SCREENING = "screening without feedback"
LIMITS = (
    "Screening without feedback: the modal force stays what it was in the simulation. What hangs on the body, runs "
    "under it or is damped by its motion would answer a moved mode with another force; only a new simulation has that. "
    "At constant modal mass and mode shape; what is slow scales with (f / f')^2."
)
WORST_TOLD, MOVING_TOLD = 2, 2  # welds with the shortest lives, and with those that depend most on the setting
LONGEST_LIFE_KM = 1e12
TURNS = 0.005  # relative change of a life that counts as a change of direction
WIDTH = 110
COLUMN = 19  # letters, four of which stand in a line beside the setting


@dataclass(frozen=True, slots=True)
class SettingLine:
    """One setting of the mode; ``rms_ratio`` is that of its coordinate over that as assessed, event by event."""

    frequency_hz: float
    damping_ratio: float
    is_as_assessed: bool
    rms_ratio: tuple[float | None, ...]

    @property
    def words(self) -> str:
        """Frequency and damping in short."""
        return f"{self.frequency_hz:.5g} Hz, {100.0 * self.damping_ratio:.3g} %"


@dataclass(frozen=True, slots=True)
class WeldCurve:
    """Life of the worst point of a weld at every setting.

    Attributes
    ----------
    weld : name
    life_km : at every setting [km]; None where nothing damages
    node, surface : the worst point at every setting
    longest, shortest : number of the setting with the longest and with the shortest life
    turns : whether the life both rises and falls along the frequencies, at some damping
    """

    weld: str
    life_km: tuple[float | None, ...]
    node: tuple[int, ...]
    surface: tuple[str, ...]
    longest: int
    shortest: int
    turns: bool

    @property
    def spread(self) -> float:
        """Longest life over the shortest, less 1; infinite where at some setting nothing damages, and not at all."""
        longest, shortest = self.life_km[self.longest], self.life_km[self.shortest]
        if shortest is None:
            return 0.0
        return np.inf if longest is None else longest / shortest - 1.0


@dataclass(frozen=True, slots=True)
class ShiftStudy:
    """Life against the frequency or damping of one mode; the numbers of all points are in the table ``shift``.

    Attributes
    ----------
    title : of the case
    method : always ``SCREENING``; ``limits`` say what that means
    mode, frequency_hz, damping_ratio : the mode and its setting as assessed
    damping_is_assumed : whether the modes of the body have no damping for it
    largest_shares : where no mode was named: of the damage at a weld, of the normal mode that is moved, and of any mode
    events : all of the mission; ``moved`` are those in which the mode was moved
    points : which were counted again
    is_static : whether moving it does no more than scale its coordinate, in all events and at all settings
    settings, welds : ascending by frequency; worst first
    """

    title: str
    method: str
    limits: str
    mode: int
    frequency_hz: float
    damping_ratio: float
    damping_is_assumed: bool
    largest_shares: tuple[LargestShare, ...]
    events: tuple[str, ...]
    moved: tuple[str, ...]
    points: str
    is_static: bool
    settings: tuple[SettingLine, ...]
    welds: tuple[WeldCurve, ...]
    warnings: tuple[Problem, ...]

    def as_record(self) -> dict[str, Any]:
        """Record for machines."""
        return asdict(self)

    def as_text(self) -> str:
        """Text for people: the mode, a table of lives against settings, and what is longest and shortest."""
        return "\n\n".join(part for part in (self._heading(), self._table(), self._extremes()) if part)

    def _heading(self) -> str:
        lines = [f"{visible(self.title)}: mode {self.mode} moved, {self.method}"]
        damping = f"damping {100.0 * self.damping_ratio:.3g} %"
        if self.damping_is_assumed:
            damping += " assumed (the modes have none; --damping changes it)"
        said = [f"Mode {self.mode} is at {self.frequency_hz:.5g} Hz, {damping}."]
        said += self._why_this_mode()
        if self.moved != self.events:
            said.append(f"It is moved in {few([visible(name) for name in self.moved])} only.")
        said.append(f"Counted again: {self.points}.")
        if self.is_static:
            said.append("The mode answers quasi-statically: moving it only scales its coordinate by (f / f')^2.")
        return "\n".join([*lines, *(textwrap.fill(part, WIDTH) for part in (" ".join(said), self.limits))])

    def _why_this_mode(self) -> Iterator[str]:
        if self.largest_shares:
            own, any_mode = self.largest_shares
            yield (
                f"Of all normal modes it has the largest share of the damage of a weld, {own.share:.0%} at the worst "
                f"point of {shortened(visible(own.weld))}."
            )
            if any_mode.mode != own.mode:
                yield (
                    f"Mode {any_mode.mode} has more, {any_mode.share:.0%} at {shortened(visible(any_mode.weld))}, but "
                    "is no normal mode: it has no resonance that could be moved."
                )

    @property
    def told(self) -> tuple[WeldCurve, ...]:
        """Welds that are told: those with the shortest lives, and those whose lives depend most on the setting."""
        shortest = self.welds[:WORST_TOLD]
        moving = sorted(self.welds[WORST_TOLD:], key=lambda curve: -curve.spread)[:MOVING_TOLD]
        return (*shortest, *moving)

    def _table(self) -> str:
        told, moved = self.told, [name in self.moved for name in self.events]
        above, names = zip(*(_in_two_lines(curve.weld) for curve in told), strict=True)
        lines = ["Life [km] (* as assessed), q rms over that as assessed"]
        lines += [_columns("", ["", *above]).rstrip()] if any(above) else []
        lines.append(_columns("setting", ["q rms", *names]))
        for number, setting in enumerate(self.settings):
            mark = " *" if setting.is_as_assessed else ""
            lives = [_km(curve.life_km[number]) for curve in told]
            ratios = [ratio for ratio, here in zip(setting.rms_ratio, moved, strict=True) if here]
            lines.append(_columns(f"{setting.words}{mark}", [_ratios(ratios), *lives]))
        return "\n".join(lines)

    def _extremes(self) -> str:
        lines = [self._extremes_of(curve) for curve in self.told]
        if (more := len(self.welds) - len(self.told)) > 0:
            lines.append(f"{more} more welds, whose lives depend less on the setting, are in the table shift.")
        return "\n".join(textwrap.fill(text, WIDTH, subsequent_indent="  ") for text in lines)

    def _extremes_of(self, curve: WeldCurve) -> str:
        weld = shortened(visible(curve.weld))
        if curve.spread < TURNS:
            return f"{weld}: its life does not depend on the setting, within {TURNS:.1%}."
        longest, shortest = (self.settings[i].words for i in (curve.longest, curve.shortest))
        text = f"{weld}: longest {_km(curve.life_km[curve.longest])} km at {longest}, "
        text += f"shortest {_km(curve.life_km[curve.shortest])} km at {shortest}"
        text += "; it rises and falls between: not monotonic" if curve.turns else ""
        moves = len(set(zip(curve.node, curve.surface, strict=True))) > 1
        return text + ("; its worst point moves" if moves else "") + "."


def weld_curve(weld: str, life_km: Floats, nodes: list[int], surfaces: list[str], at: tuple[Setting, ...]) -> WeldCurve:
    """Curve of a weld from the life of its worst point at every setting."""
    same = np.isclose(life_km, life_km[0], rtol=1e-12) | (life_km == life_km[0])
    longest, shortest = (0, 0) if same.all() else (int(life_km.argmax()), int(life_km.argmin()))
    dampings = np.array([setting.damping for setting in at])
    turns = any(_turns(life_km[dampings == z]) for z in np.unique(dampings))
    lives = tuple(float(life) if np.isfinite(life) else None for life in life_km)
    return WeldCurve(weld, lives, tuple(nodes), tuple(surfaces), longest, shortest, turns)


def _turns(life_km: Floats) -> bool:
    """Whether lives both rise and fall, by more than rounding and scatter of the count."""
    with np.errstate(divide="ignore", invalid="ignore"):
        steps = np.diff(np.log(life_km))
    steps = steps[np.abs(steps) > TURNS]
    return bool((steps > 0.0).any() and (steps < 0.0).any())


def setting_line(setting: Setting, mode: ShiftedMode, rms_ratio: list[float]) -> SettingLine:
    """What is said of one setting."""
    ratios = tuple(ratio if np.isfinite(ratio) else None for ratio in rms_ratio)
    return SettingLine(setting.frequency_hz, setting.damping, setting == mode.setting, ratios)


def _ratios(ratios: list[float | None]) -> str:
    """Smallest and largest rms ratio of some events."""
    known = [ratio for ratio in ratios if ratio is not None]
    if not known:
        return "-"
    low, high = f"{min(known):.2f}", f"{max(known):.2f}"
    return low if low == high else f"{low}-{high}"


def _in_two_lines(name: str) -> tuple[str, str]:
    """Name at the head of a column, in a second line above it what does not fit into one.

    >>> _in_two_lines("W3_floor_wall_seam_wall")
    ('W3_floor_wall_', 'seam_wall')
    """
    most = COLUMN - 2
    name = shortened(visible(name), 2 * most)
    if len(name) <= most:
        return "", name
    ends = [found.end() for found in re.finditer(r"[\W_]+", name) if len(name) - most <= found.end() <= most]
    cut = ends[-1] if ends else most
    return name[:cut].rstrip(), name[cut:]


def _columns(name: str, cells: list[str]) -> str:
    first, *others = cells
    return f"  {name:20}{first:>10}" + "".join(f"{cell:>{COLUMN}}" for cell in others)


def _km(life: float | None) -> str:
    return "> 1e12" if life is None or life > LONGEST_LIFE_KM else f"{life:.3g}"
