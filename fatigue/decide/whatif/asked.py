"""What is asked: keys of the case that are set, events that are dropped, or another case file; as a case.

A key is written as in TOML, ``mission.event."worn 350".share=0.2``. A shell takes the quotes away, so what is left of
them is read as well, ``mission.event.worn 350.share=0.2`` and ``curve.survival=mean``.
"""

import copy
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from fatigue.case import Case, load_case
from fatigue.case.load import case_of_tables, parsed_case
from fatigue.decide.of_result import case_text
from fatigue.errors import CaseError, Problem, refuse
from fatigue.files.dotted import NoSuchKey, put, value_at
from fatigue.results import case_of

LOAD = "load"  # not a key of the case: the factor on all stresses
OPTION = "--set"


@dataclass(frozen=True, slots=True)
class Asked:
    """What a user asks: ``settings`` as ``KEY=VALUE``, names of ``dropped`` events, or the file of another case."""

    settings: tuple[str, ...] = ()
    dropped: tuple[str, ...] = ()
    case_file: Path | None = None


@dataclass(frozen=True, slots=True)
class TwoCases:
    """The case of a result and the one that is asked about; ``load`` is a factor on all stresses of the latter."""

    base: Case
    changed: Case
    load: float = 1.0


def two_cases(record: Mapping[str, Any], folder: Path, asked: Asked) -> TwoCases:
    """The case of a result, as its provenance has it, and the case that is asked about.

    Raises
    ------
    CaseError : nothing is asked, a setting is none, its key leads nowhere, or the case that it makes is wrong: shares
        that do not sum to 1, an unknown event
    """
    path, text = case_of(record, folder), case_text(record)
    base = parsed_case(path, text)
    if asked.case_file is not None:
        refuse(CaseError, _beside_a_case(asked))
        return TwoCases(base, load_case(asked.case_file))
    if not asked.settings and not asked.dropped:
        what = "nothing is asked: neither a key is set, nor an event dropped, nor another case given"
        raise CaseError(Problem("nothing_asked", OPTION, what, "Give --set KEY=VALUE, --drop EVENT or --case FILE"))
    tables = copy.deepcopy(tomllib.loads(text))
    load = 1.0
    problems: list[Problem] = []
    for setting in asked.settings:
        try:
            key, value = _key_and_value(setting)
            if key == LOAD:
                load = _load_factor(value)
            else:
                put(tables, key, _of_one_kind(value, value_at(tables, key)))
        except CaseError as error:
            problems += error.problems
        except NoSuchKey as error:
            code = "unknown_event" if "mission.event has no table" in error.what else "unknown_key"
            problems.append(Problem(code, f"{OPTION} {setting}", error.what, error.remedy))
    problems += _drop(tables, asked.dropped)
    refuse(CaseError, problems)
    return TwoCases(base, case_of_tables(path, text, tables), load)


def _beside_a_case(asked: Asked) -> Iterator[Problem]:
    if asked.settings or asked.dropped:
        what = "another case is given with --case, and keys of the case of the result with --set or --drop"
        yield Problem("contradiction", "--case", what, "Give one or the other")


def _key_and_value(setting: str) -> tuple[str, Any]:
    """Key with plain dots, and value of a setting.

    >>> _key_and_value('mission.event."worn 350".share=0.2')
    ('mission.event.worn 350.share', 0.2)
    >>> _key_and_value("curve.survival=mean")
    ('curve.survival', 'mean')
    """
    try:
        return _single(tomllib.loads(setting), "")
    except tomllib.TOMLDecodeError:
        pass
    key, equals, text = setting.rpartition("=")
    if not equals or not key.strip():
        what, remedy = "is no setting KEY=VALUE", "Write a key of the case, as mission.target_km=2e7"
        raise CaseError(Problem("bad_setting", f"{OPTION} {setting}", what, remedy))
    try:
        value = tomllib.loads(f"value = {text}")["value"]
    except tomllib.TOMLDecodeError:
        value = text.strip()
    try:
        key, _ = _single(tomllib.loads(f"{key} = 0"), "")
    except tomllib.TOMLDecodeError:
        key = key.strip().replace('"', "")
    return key, value


def _single(tables: Mapping[str, Any], done: str) -> tuple[str, Any]:
    """The one key that nested tables hold, and its value."""
    ((part, value),) = tables.items()
    key = f"{done}.{part}".lstrip(".")
    return _single(value, key) if isinstance(value, Mapping) and value else (key, value)


def _of_one_kind(value: Any, before: Any) -> Any:
    """A whole number in the place of a number of the case is one."""
    return float(value) if type(value) is int and isinstance(before, float) else value


def _load_factor(value: Any) -> float:
    is_number = isinstance(value, int | float) and not isinstance(value, bool)
    if not is_number or not 0.0 < value < float("inf"):
        what, remedy = f"{value!r} is no factor on stresses", "Give a number above 0: 1.1 is 10 % more load"
        raise CaseError(Problem("bad_value", f"{OPTION} {LOAD}", what, remedy))
    return float(value)


def _drop(tables: dict[str, Any], names: Sequence[str]) -> Iterator[Problem]:
    """Take events out of the mission, in place; refusals of what cannot be taken out."""
    mission = tables.get("mission")
    if not names or not isinstance(mission, dict):
        return
    events, sequences = (_of_list(mission, key) for key in ("event", "sequence"))
    there = [event.get("name") for event in events]
    for name in names:
        if name not in there:
            what, known = f"the mission has no event {name!r}", ", ".join(map(repr, there))
            yield Problem("unknown_event", "--drop", what, f"It has {known}")
        elif any(name in sequence.get("order", []) for sequence in sequences):
            what = f"the event {name!r} is in a sequence, which would be another one without it"
            yield Problem("event_in_sequence", "--drop", what, "Give a case without it with --case, and --recount")
    mission["event"] = [event for event in events if event.get("name") not in names]


def _of_list(mission: Mapping[str, Any], key: str) -> list[dict[str, Any]]:
    """Tables of a list of the mission."""
    found = mission.get(key)
    return [table for table in found if isinstance(table, dict)] if isinstance(found, list) else []
