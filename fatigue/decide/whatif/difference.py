"""Which keys two cases differ in, and what each of them is: a knob, something that must be counted, or refused.

``KNOBS`` is the table: the first row that fits a key says what it moves. A key that no row fits is refused by name, so
that nothing that was changed is left out in silence.
"""

import json
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Literal

from fatigue.case import Case
from fatigue.case.checks import CHECK_FILES
from fatigue.case.tables import BODY_FILES
from fatigue.errors import CaseError, Problem, refuse
from fatigue.files.hashes import sha256
from fatigue.pipeline.solve.body import register_file

Kind = Literal["mission", "load", "curve", "recount", "words"]
Parts = tuple[str, ...]

EVENT = ("mission", "event", "*")
KNOBS: tuple[tuple[Parts, tuple[str, ...], Kind], ...] = (
    (("mission",), ("target_km", "km_per_year", "damage_limit"), "mission"),
    (EVENT, ("share", "per_1000_km", "speed_km_h", "length_km"), "mission"),
    (EVENT, ("stress_factor",), "load"),
    (("mission", "sequence", "*"), ("per_1000_km",), "mission"),
    (("curve",), ("name", "survival", "extension", "knee_cycles", "thickness_rule"), "curve"),
    (("curves", "*"), ("source", "edition", "clause", "status", "checked_by", "checked_on"), "words"),
    (("curves", "*"), ("*",), "curve"),
    ((), ("title",), "words"),
    (("curve",), ("mean_stress", "yield_MPa"), "recount"),
    (("counting",), ("*",), "recount"),
    (EVENT, ("history", "start_s", "residue", "mean_of_q"), "recount"),
    ((*EVENT, "unit_load", "*"), ("*",), "recount"),
    (("mission", "unit_load", "*"), ("*",), "recount"),
    (("mission", "sequence", "*"), ("order",), "recount"),
    (("body",), (*BODY_FILES, "register", "ignore_modes", "force_convention"), "recount"),
    (("body", "unit_load", "*"), ("*",), "recount"),
)
FILES = {*BODY_FILES, *CHECK_FILES, "history", "register"}  # keys whose values are names of files


@dataclass(frozen=True, slots=True)
class Difference:
    """One key that differs: its parts, its value in either case (None: left out), and what it is."""

    key: Parts
    before: Any
    after: Any
    kind: Kind

    @property
    def name(self) -> str:
        """The key as TOML has it."""
        return ".".join(part if part.replace("_", "").isalnum() else json.dumps(part) for part in self.key)

    @property
    def words(self) -> str:
        """What is changed, in words."""
        return f"{self.name} from {_shown(self.before)} to {_shown(self.after)}"


@dataclass(frozen=True, slots=True)
class Differences:
    """Keys that differ, and the names of the events that the changed case has no more."""

    keys: tuple[Difference, ...]
    dropped: tuple[str, ...]

    def of(self, kind: Kind) -> tuple[Difference, ...]:
        """Those of a kind."""
        return tuple(one for one in self.keys if one.kind == kind)

    @property
    def words(self) -> tuple[str, ...]:
        """What is changed, in words."""
        shown = [one.words for one in self.keys if one.kind != "words"]
        return (*shown, *(f"event '{name}' dropped" for name in self.dropped))


def differences(record: Mapping[str, Any], base: Case, changed: Case) -> Differences:
    """Every key that two cases differ in; files are the same where their content is that of the result.

    Raises
    ------
    CaseError : keys that are no knob, by their names; events that the result has not
    """
    before, after = dict(_keys(base)), dict(_keys(changed))
    names, others = ([event.name for event in case.mission.event] for case in (base, changed))
    dropped = tuple(name for name in names if name not in others)
    found, problems = [], [_new_event(changed, name) for name in others if name not in names]
    for key in dict.fromkeys((*before, *after)):
        of_others = key[:2] == EVENT[:2] and (key[2] in dropped or key[2] not in names)
        if of_others or before.get(key) == after.get(key):
            continue
        kind = _kind(key, base, changed)
        if kind is None:
            problems.append(_refused(changed, key, before.get(key), after.get(key)))
        elif not (key[-1] in FILES and _is_same_file(record, base, changed, before.get(key), after.get(key))):
            found.append(Difference(key, before.get(key), after.get(key), kind))
    found += _other_files(record, base, changed, {one.key for one in found})
    refuse(CaseError, problems)
    return Differences(tuple(found), dropped)


def _keys(case: Case) -> Iterator[tuple[Parts, Any]]:
    """Every key of a case with its value; tables of a list have their names, or their numbers from 1."""

    def walk(value: Any, done: Parts) -> Iterator[tuple[Parts, Any]]:
        if isinstance(value, Mapping):
            for key, held in value.items():
                yield from walk(held, (*done, str(key)))
        elif isinstance(value, list | tuple) and value and all(isinstance(one, Mapping) for one in value):
            for number, one in enumerate(value, 1):
                yield from walk(one, (*done, str(one.get("name", number))))
        elif value not in ((), None):
            yield done, value

    yield from walk(case.model_dump(by_alias=True), ())


def _kind(key: Parts, base: Case, changed: Case) -> Kind | None:
    """What a key is, None: no knob."""
    uses_mean_stress = "asme" in (base.curve.mean_stress, changed.curve.mean_stress)
    if key == ("curve", "yield_MPa") and not uses_mean_stress:
        return "words"  # it is in no damage
    if key[:2] == ("mission", "sequence") and key[-1] == "order" and _no_new_loop(base, changed):
        return "mission"
    for tables, names, kind in KNOBS:
        fits = len(key) == len(tables) + 1 and all(a in ("*", b) for a, b in zip(tables, key, strict=False))
        if fits and (key[-1] in names or "*" in names):
            return kind
    return None


def _no_new_loop(base: Case, changed: Case) -> bool:
    """Whether every order of events was counted, each as often as it is asked for."""
    counted, asked = (Counter(one.order for one in case.mission.sequence) for case in (base, changed))
    return asked <= counted


def _is_same_file(record: Mapping[str, Any], base: Case, changed: Case, before: Any, after: Any) -> bool:
    """Whether two names lead to the same file, or to one with the content that the result was computed from."""
    if not isinstance(before, str) or not isinstance(after, str):
        return False
    old, new = base.resolve(before), changed.resolve(after)
    if old == new or (old.exists() and new.exists() and old.samefile(new)):
        return True
    known = {entry["file"]: entry["sha256"] for entry in record["inputs"]}
    return new.is_file() and known.get(before) == sha256(new)


def _other_files(record: Mapping[str, Any], base: Case, changed: Case, told: set[Parts]) -> Iterator[Difference]:
    """Files of the same name that are others, as the changed case lies in another folder."""
    if base.path.parent.resolve() == changed.path.parent.resolve():
        return
    there = dict(_keys(base))
    for key, value in _keys(changed):
        is_asked = key[-1] in FILES and key not in told and isinstance(value, str) and there.get(key) == value
        if is_asked and not _is_same_file(record, base, changed, value, value):
            yield Difference(key, str(base.resolve(value)), str(changed.resolve(value)), "recount")
    of_welds = register_file(changed)
    known = {entry["sha256"] for entry in record["inputs"]}
    key = ("body", "register")
    if of_welds is not None and key not in told and sha256(of_welds) not in known:
        yield Difference(key, None, str(of_welds), "recount")


def _refused(changed: Case, key: Parts, before: Any, after: Any) -> Problem:
    one = Difference(key, before, after, "words")
    what = f"a change from {_shown(before)} to {_shown(after)} is no knob: the result says nothing about it"
    return Problem(
        "no_knob", f"{changed.path.name}: {one.name}", what, "Assess the changed case, or leave it as it was"
    )


def _new_event(changed: Case, name: str) -> Problem:
    what = "is an event that the result does not have: nothing of it was counted"
    return Problem("unknown_event", f"{changed.path.name}: mission.event {name!r}", what, "Assess the changed case")


def _shown(value: Any) -> str:
    if value is None:
        return "not given"
    if isinstance(value, float):
        return f"{value:.10g}"
    return ", ".join(map(_shown, value)) if isinstance(value, tuple) else str(value)
