"""Causes in words: what an event does now, by which modes, and a weld in one sentence."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

import pandas as pd

from fatigue.decide.compare.split import LIMIT, MISSION, MODE, PER_PASS, SEQUENCE, UNIT_LOAD, WHOLE
from fatigue.report.wording import listed, number, short

SAME = 1.05  # factor on a life up to which it is called as long as before
NAMED = 0.2  # of the log ratio: causes from here on are named
MOST = 2  # causes of either direction in a sentence
MOST_MODES = 3
MOSTLY = 0.6  # of what an event adds: modes are named until they make so much of it


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


def why(causes: pd.DataFrame, log_ratio: float, names: Mapping[int, str]) -> str:
    """What makes the ratio of two lives, in words; ``causes`` are the rows of one pair; empty without any."""
    whole = causes[causes["kind"].isin(WHOLE)]
    if whole.empty or is_same(size := max(abs(log_ratio), whole["log_life_ratio"].abs().max())):
        return ""
    said = whole[whole["log_life_ratio"].abs() >= NAMED * size]
    direction = math.copysign(1.0, log_ratio)
    with_it = said[said["log_life_ratio"] * direction > 0.0]
    against = said[said["log_life_ratio"] * direction < 0.0]
    parts = [_cause(row, causes, names) for row in _largest(with_it)]
    found = listed(parts)
    if back := [_cause(row, causes, names) for row in _largest(against)]:
        found += f"; against it {listed(back)}" if found else f"{listed(back)}, which others make up for"
    return found


def largest_cause(causes: pd.DataFrame) -> pd.Series | None:
    """The row that moves the life most, with the whole of it: a limit, an event, a sequence."""
    whole = causes[causes["kind"].isin(WHOLE)]
    if whole.empty or not whole["log_life_ratio"].abs().max() > 0.0:
        return None
    return whole.loc[whole["log_life_ratio"].abs().idxmax()]


def modes_of(causes: pd.DataFrame, event: str, log_ratio: float, names: Mapping[int, str]) -> list[str]:
    """Modes and unit loads that make most of what an event adds, largest first; none without a diagnosis."""
    parts = causes[causes["kind"].isin((MODE, UNIT_LOAD)) & (causes["event"] == event)]
    parts = parts[parts["log_life_ratio"] * log_ratio > 0.0].sort_values("log_life_ratio", key=abs, ascending=False)
    found, made = [], 0.0
    for row in parts.head(MOST_MODES).to_dict("records"):
        if made >= MOSTLY * abs(log_ratio):
            break
        made += abs(row["log_life_ratio"])
        found.append(coordinate(row["mode"], row["unit_load"], names))
    return found


def coordinate(mode: object, unit_load: object, names: Mapping[int, str]) -> str:
    """A mode by its name, or a unit load, in words."""
    if isinstance(unit_load, str) and unit_load:
        return short(unit_load)
    return names.get(int(str(mode)), f"mode {mode}")


def mode_names(record: Mapping[str, Any]) -> dict[int, str]:
    """Modes of a result in words: with the frequency of a normal mode; that of an interface mode says nothing."""
    modes = record["modes"]
    kinds = modes.get("kind") or ["normal"] * len(modes["used"])
    return {
        mode: f"mode {mode} ({hz:.3g} Hz)" if kind == "normal" else f"{kind} mode {mode}"
        for mode, hz, kind in zip(modes["used"], modes["frequency_hz"], kinds, strict=True)
    }


def _largest(rows: pd.DataFrame) -> Sequence[Mapping[str, object]]:
    ordered = rows.sort_values("log_life_ratio", key=abs, ascending=False)
    found: Sequence[Mapping[str, object]] = ordered.head(MOST).to_dict("records")
    return found


def _cause(row: Mapping[str, object], causes: pd.DataFrame, names: Mapping[int, str]) -> str:
    """One cause in words."""
    value, other, log = (float(str(row[name])) for name in ("value", "other_value", "log_life_ratio"))
    if row["kind"] == LIMIT:
        return f"the damage limit is {number(other)} instead of {number(value)}"
    event, name = str(row["event"]), short(str(row["event"]))
    if value == 0.0 or other == 0.0:
        said = f"{name} comes in" if value == 0.0 else f"{name} is gone"
        if row["kind"] == SEQUENCE:
            said = f"cycles across events {said.removeprefix(name).strip()}, {name}"
    else:
        said = f"{name} {_changed(causes[causes['event'] == event])}"
    modes = modes_of(causes, event, log, names)
    return f"{said}, most of it by {listed(modes)}" if modes else said


def _changed(rows: pd.DataFrame) -> str:
    """How an event that both results have differs: how often it occurs, the damage of a pass, or both."""
    parts = {str(row["kind"]): row for row in rows.to_dict("records") if row["kind"] in (MISSION, PER_PASS)}
    if len(parts) < 2:
        return "relieves in one result and damages in the other"
    often, damage = parts[MISSION], parts[PER_PASS]
    both = abs(often["log_life_ratio"]) + abs(damage["log_life_ratio"])
    said = []
    if abs(damage["log_life_ratio"]) >= NAMED * both:
        said.append(f"does {_of(damage['other_value'] / damage['value'])} the damage per pass")
    if abs(often["log_life_ratio"]) >= NAMED * both:
        said.append(f"occurs {times(often['other_value'] / often['value'])} as often")
    return listed(said)


def _of(factor: float) -> str:
    """A factor on a damage in words: a percentage below 1."""
    return times(factor) if factor >= 1.0 else f"{100.0 * factor:.3g} % of"
