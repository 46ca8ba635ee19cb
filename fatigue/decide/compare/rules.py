"""What else differs between two results than their lives: curves, rules, target, mission, what they read."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import PurePosixPath
from typing import Any

import pandas as pd

from fatigue.decide.compare.finished import Finished
from fatigue.decide.compare.matched.welds import MatchedWelds
from fatigue.decide.of_result import loops_of
from fatigue.shown import few

NOT_ON_RECORD = "not on record"
LONGEST = 90  # letters of a value
_COUNTED = ("screening.stations", "multiaxial.toe_points", "upsampled", "survival", "stress_category")
"""Rules of the record that say what was found, or are told elsewhere."""
_MOVE_CURVES = ("survival", "extension", "knee_cycles", "mean_stress")
"""Rules that change the numbers of a curve as it is used, and are told themselves."""
_VERDICT = "the verdict only"
_ASIDE = "nothing of the life: what is looked at or kept beside it"
_BESIDE = (
    "histogram",
    "life_band",
    "cycles_kept_from_utilisation",
    "spectrum",
    "reversals",
    "bending_ratio",
    "multiaxial",
    "screening",
)


@dataclass(frozen=True, slots=True)
class Difference:
    """Something that two results have differently; ``sits_in`` is where it shows in the causes."""

    result: str
    what: str
    value: str
    other_value: str
    sits_in: str


def differences(a: Finished, b: Finished, welds: MatchedWelds) -> list[Difference]:
    """Everything on record that differs: curves first, then rules, mission, body and files."""
    found = [*_curves(a, b, welds), *_rules(a, b), *_mission(a, b), *_body(a, b), *_files(a, b)]
    return [Difference(b.letter, *one) for one in found]


_Found = Iterator[tuple[str, str, str, str]]


def _curves(a: Finished, b: Finished, welds: MatchedWelds) -> _Found:
    """Curves that matched welds change, survival levels and limits, and curves of one name with other numbers."""
    first, second = list(welds.other), list(welds.other.values())
    for column, what, sits_in in (
        ("curve", "curve", "per_pass"),
        ("survival", "survival", "per_pass"),
        ("damage_limit", "damage limit", "limit"),
        ("surface", "faces with a toe", "which point is the worst"),
        ("end_length_mm", "end treatment [mm]", "per_pass"),
        ("attachment_mm", "attachment [mm]", "per_pass"),
    ):
        changed: dict[tuple[str, str], list[str]] = {}
        for weld, one, other in zip(first, _of_welds(a, column, first), _of_welds(b, column, second), strict=True):
            if _text(one) != _text(other):
                changed.setdefault((_text(one), _text(other)), []).append(weld)
        for (one, other), some in changed.items():
            every = "" if len(some) == len(first) else f" of {few(some)}"
            yield f"{what}{every}", one, other, sits_in
    curves_a, curves_b = a.record["curves"], b.record["curves"]
    is_told = any(a.record["rules"].get(key) != b.record["rules"].get(key) for key in _MOVE_CURVES)
    for name in (name for name in curves_a if name in curves_b):
        ours, theirs = _flat(curves_a[name]), _flat(curves_b[name])
        for key in (key for key in ours if key in theirs and ours[key] != theirs[key]):
            follows = key.startswith("used.") and (is_told or key in ("used.survival", "used.damage_limit"))
            if not follows and key not in ("checked_by", "checked_on"):
                yield f"curve {name}: {key}", _text(ours[key]), _text(theirs[key]), "per_pass"


def _of_welds(of: Finished, column: str, welds: list[str]) -> list[Any]:
    """Values of a column of some welds; the limit of results of older versions is that of the mission."""
    values = of.welds[column] if column != "damage_limit" else pd.Series(of.limit, of.points.names)
    found: list[Any] = values.reindex(welds).tolist()
    return found


def _rules(a: Finished, b: Finished) -> _Found:
    ours, theirs = _flat(a.record["rules"]), _flat(b.record["rules"])
    events = set(a.passes) & set(b.passes)
    for key in dict.fromkeys([*ours, *theirs]):
        rule, _, event = key.partition(".")
        if key.startswith(_COUNTED) or (rule in ("residue", "mean_of_q") and event not in events):
            continue
        if rule == "knee_cycles" and {a.record["rules"].get("extension"), b.record["rules"].get("extension")} == {
            "none"
        }:
            continue
        one, other = ours.get(key, NOT_ON_RECORD), theirs.get(key, NOT_ON_RECORD)
        if one != other and NOT_ON_RECORD not in (one, other):
            sits_in = _ASIDE if rule in _BESIDE else "sequence" if rule == "events" else "per_pass"
            yield _named(rule, event), _text(one), _text(other), sits_in
    upsampled_a, upsampled_b = (one.record["rules"].get("upsampled", {}) for one in (a, b))
    for event in (event for event in upsampled_a if event in upsampled_b):
        if upsampled_a[event] != upsampled_b[event]:
            yield f"upsampled, {event}", str(upsampled_a[event]), str(upsampled_b[event]), "per_pass"


def _mission(a: Finished, b: Finished) -> _Found:
    ours, theirs = a.record["mission"], b.record["mission"]
    for key, sits_in in (("target_km", _VERDICT), ("km_per_year", "years only")):
        if ours[key] != theirs[key]:
            yield key, _text(ours[key]), _text(theirs[key]), sits_in
    events = [{event["event"]: event for event in mission["events"]} for mission in (ours, theirs)]
    for name in (name for name in events[0] if name in events[1]):
        one, other = events[0][name], events[1][name]
        for key, sits_in in (
            ("share", "mission"), ("length", "mission"), ("per_1000_km", "mission"), ("stress_factor", "per_pass"),
            ("start_s", "per_pass"), ("samples", "per_pass"),
        ):  # fmt: skip
            if one.get(key) != other.get(key):
                told = "length of a pass [km]" if key == "length" else key
                yield f"{told}, {name}", _text(one.get(key)), _text(other.get(key)), sits_in
    for mine, there, letter in ((events[0], events[1], a.letter), (events[1], events[0], b.letter)):
        if only := [name for name in mine if name not in there]:
            is_first = letter == a.letter
            yield f"events of {letter} only", few(only) if is_first else "–", "–" if is_first else few(only), "event"
    loops = [{loop["name"]: loop for loop in loops_of(one.record)} for one in (a, b)]
    for name in dict.fromkeys([*loops[0], *loops[1]]):
        orders = [" > ".join(one[name]["order"]) if name in one else "–" for one in loops]
        if orders[0] != orders[1]:
            yield name, orders[0], orders[1], "sequence"


def _body(a: Finished, b: Finished) -> _Found:
    if a.frequency_hz != b.frequency_hz:
        ids = sorted({*a.frequency_hz, *b.frequency_hz})
        changed = [mode for mode in ids if a.frequency_hz.get(mode) != b.frequency_hz.get(mode)]
        hz = [few([f"mode {mode}: {_hz(one.frequency_hz.get(mode))}" for mode in changed]) for one in (a, b)]
        yield "modes, matched by their numbers", hz[0], hz[1], "per_pass and modes"
    if a.record.get("force_convention") != b.record.get("force_convention"):
        both = [_text(one.record.get("force_convention")) for one in (a, b)]
        yield "force_convention", both[0], both[1], "per_pass"
    versions = [_text(one.record.get("software", {}).get("fatigue")) for one in (a, b)]
    if versions[0] != versions[1]:
        yield "version of fatigue", versions[0], versions[1], "per_pass, if a rule of the program changed"


def _files(a: Finished, b: Finished) -> _Found:
    """Tables of the body, and records of events, that both cases name and that have another content."""
    ours, theirs = _read(a), _read(b)
    changed = [key for key in ours if key in theirs and ours[key][1] != theirs[key][1]]
    for key in changed:
        names = ours[key][0], theirs[key][0]
        yield key, names[0], names[1] if names[0] != names[1] else f"{names[1]}, another content", "per_pass"


def _read(of: Finished) -> dict[str, tuple[str, str]]:
    """Name and SHA-256 of the files that make stress, by what they are in the case."""
    known = {entry["file"]: entry["sha256"] for entry in of.record["inputs"]}
    case = of.case_keys
    names = {f"content of {key}": case["body"].get(key) for key in _OF_STRESS}
    names |= {f"record, {event.get('name')}": event.get("history") for event in case["mission"].get("event", [])}
    there = {key: PurePosixPath(name).as_posix() for key, name in names.items() if isinstance(name, str)}
    return {key: (name, known[name]) for key, name in there.items() if name in known}


_OF_STRESS = ("modes", "weld_nodes", "nodal_forces", "element_forces", "weld_elements", "weld_columns")


def _named(rule: str, event: str) -> str:
    if rule in ("residue", "mean_of_q"):
        return f"{rule}, {event}"
    return f"{rule}.{event}" if event else rule


def _hz(value: float | None) -> str:
    return "–" if value is None else f"{value:.4g} Hz"


def _text(value: Any) -> str:
    """A value as the page shows it."""
    if value is None or value != value or value == "":  # noqa: PLR0124 (NaN differs from itself)
        return "–"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, int | float):
        return f"{value:.10g}"
    text = str(value)
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 1]}…"


def _flat(table: Mapping[str, Any], before: str = "") -> dict[str, Any]:
    """Values of nested tables by dotted keys."""
    found: dict[str, Any] = {}
    for key, value in table.items():
        found |= _flat(value, f"{before}{key}.") if isinstance(value, Mapping) else {f"{before}{key}": value}
    return found
