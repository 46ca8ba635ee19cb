"""Causes in words: what an event does now, by which modes, and a weld in one sentence."""

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

from fatigue.decide.compare.split import LIMIT, MISSION, MODE, PER_PASS, SEQUENCE, UNIT_LOAD, WHOLE
from fatigue.report.wording import listed, short

SAME = 1.05  # factor on a life up to which it is called as long as before
NAMED = 0.2  # of the log ratio: causes from here on are named
MOST = 2  # causes of either direction in a sentence
MOST_MODES = 3
MOSTLY = 0.6  # of what an event adds: modes are named until they make so much of it


class Cause(NamedTuple):
    """A row of the causes of one pair of points; see the columns of ``compare_causes``."""

    kind: str
    event: str
    mode: Any
    unit_load: str | None
    value: float
    other_value: float
    log_life_ratio: float


def times(factor: float) -> str:
    """A factor in words of three digits.

    >>> times(0.3126), times(9.4), times(1234.0)
    ('0.313 times', '9.4 times', '1230 times')
    """
    if not math.isfinite(factor):
        return "infinitely many times"
    return f"{float(f'{factor:.3g}'):.10g} times"


def is_same(log_ratio: float) -> bool:
    """Whether two lives are the same to a few percent."""
    return abs(log_ratio) <= math.log(SAME)


def why(causes: Sequence[Cause], log_ratio: float, names: Mapping[int, str]) -> str:
    """What makes the ratio of two lives, in words; ``causes`` are those of one pair.

    Empty where nothing changes the life by more than a few percent, be it made up for by something else.
    """
    whole = _whole(causes)
    size = max([abs(log_ratio), *(abs(one.log_life_ratio) for one in whole)])
    if not whole or is_same(size):
        return ""
    said = [one for one in whole if abs(one.log_life_ratio) >= NAMED * size]
    with_it = [_said(one, causes, names) for one in said if one.log_life_ratio * log_ratio > 0.0][:MOST]
    against = [_said(one, causes, names) for one in said if one.log_life_ratio * log_ratio <= 0.0][:MOST]
    if not with_it:
        return f"{listed(against)}, which others make up for"
    return listed(with_it) + (f"; against it {listed(against)}" if against else "")


def largest_cause(causes: Sequence[Cause], log_ratio: float) -> Cause | None:
    """What moves the life most the way it went: a limit, an event, a sequence; None where nothing does.

    An event that has two others in its place gives the more life, and yet a shorter life is not owed to it.
    """
    moving = [one for one in _whole(causes) if one.log_life_ratio != 0.0]
    return next((one for one in moving if one.log_life_ratio * log_ratio > 0.0), next(iter(moving), None))


def modes_of(causes: Sequence[Cause], of: Cause, names: Mapping[int, str]) -> list[str]:
    """Modes and unit loads that make most of what an event adds, largest first; none without a diagnosis."""
    parts = [one for one in causes if one.kind in (MODE, UNIT_LOAD) and one.event == of.event]
    found, made = [], 0.0
    for one in _by_size(part for part in parts if part.log_life_ratio * of.log_life_ratio > 0.0)[:MOST_MODES]:
        if made >= MOSTLY * abs(of.log_life_ratio):
            break
        made += abs(one.log_life_ratio)
        found.append(coordinate(one.mode, one.unit_load, names))
    return found


def coordinate(mode: Any, unit_load: str | None, names: Mapping[int, str]) -> str:
    """A mode by its name, or a unit load, in words."""
    if isinstance(unit_load, str) and unit_load:
        return short(unit_load)
    return names.get(int(mode), f"mode {mode}")


def mode_names(record: Mapping[str, Any]) -> dict[int, str]:
    """Modes of a result in words: with the frequency of a normal mode; that of an interface mode says nothing."""
    modes = record["modes"]
    kinds = modes.get("kind") or ["normal"] * len(modes["used"])
    return {
        mode: f"mode {mode} ({hz:.3g} Hz)" if kind == "normal" else f"{kind} mode {mode}"
        for mode, hz, kind in zip(modes["used"], modes["frequency_hz"], kinds, strict=True)
    }


def _whole(causes: Iterable[Cause]) -> list[Cause]:
    """Causes that add up to the log ratio, the largest first."""
    return _by_size(one for one in causes if one.kind in WHOLE)


def _by_size(causes: Iterable[Cause]) -> list[Cause]:
    return sorted(causes, key=lambda one: -abs(one.log_life_ratio))


def _said(of: Cause, causes: Sequence[Cause], names: Mapping[int, str]) -> str:
    """One cause in words; modes where the damage of a pass changes, as none makes an event more frequent."""
    if of.kind == LIMIT:
        return f"the damage limit is {of.other_value:g} instead of {of.value:g}"
    name = short(of.event)
    often, damage = _shares([one for one in causes if one.event == of.event])
    said = [f"does {_of(damage.other_value / damage.value)} its damage per pass in A"] if damage is not None else []
    said += [f"occurs {times(often.other_value / often.value)} as often"] if often is not None else []
    if of.value == 0.0 or of.other_value == 0.0:
        change = "comes in" if of.value == 0.0 else "is gone"
        event = f"what {name} adds across events {change}" if of.kind == SEQUENCE else f"{name} {change}"
    else:
        event = f"{name} {listed(said) or 'relieves in one of them and damages in the other'}"
    modes = modes_of(causes, of, names) if damage is not None or not said else []
    return f"{event}, most of it by {listed(modes)}" if modes else event


def _shares(causes: Sequence[Cause]) -> tuple[Cause | None, Cause | None]:
    """How often an event occurs, and the damage of a pass, where they are worth naming in what the event adds."""
    parts = {one.kind: one for one in causes if one.kind in (MISSION, PER_PASS)}
    least = NAMED * sum(abs(one.log_life_ratio) for one in parts.values())
    often, damage = (
        one if one and abs(one.log_life_ratio) >= least else None for one in map(parts.get, (MISSION, PER_PASS))
    )
    return often, damage


def _of(factor: float) -> str:
    """A factor on a damage in words: a percentage below 1."""
    return times(factor) if factor >= 1.0 else f"{100.0 * factor:.3g} % of"
