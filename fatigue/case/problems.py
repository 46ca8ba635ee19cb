"""What is wrong with a case file, in the words of that file: place, value and remedy instead of a validator's terms."""

import difflib
import json
import math
import re
import tomllib
from collections.abc import Collection, Iterator, Mapping
from dataclasses import replace
from typing import Any, TypeAlias

from pydantic import BaseModel
from pydantic_core import ErrorDetails

from fatigue.errors import Problem
from fatigue.files.naming import composed, control_characters

SHARE_TOLERANCE = 1e-6  # of the sum of all shares

Place: TypeAlias = tuple[int | str, ...]
Models: TypeAlias = Mapping[tuple[str, ...], type[BaseModel]]


class Contradictions(ValueError):
    """Keys of one table that do not fit together; ``where`` of each problem is the key inside that table."""

    def __init__(self, problems: list[Problem]) -> None:
        super().__init__()
        self.problems = problems


def clash(key: str, what: str, remedy: str) -> Problem:
    """Refusal of values of one table that do not fit together."""
    return Problem("contradiction", key, what, remedy)


def absent(key: str, what: str, remedy: str) -> Problem:
    """Refusal of a table without a key that its other keys call for."""
    return Problem("missing_key", key, what, remedy)


def syntax_problem(text: str, error: tomllib.TOMLDecodeError) -> Problem:
    """Refusal of a text that is not TOML, with line and column."""
    lines = text.splitlines()
    found = re.fullmatch(r"(.*) \(at (?:line (\d+), column (\d+)|end of document)\)", str(error), re.DOTALL)
    what, line, column = found.groups() if found else (str(error), None, None)
    place = f"line {line}, column {column}" if line else f"line {max(1, len(lines))}"
    remedy = "Correct the line"
    if line and re.search(r'"[^"\n]*\\', lines[int(line) - 1]):
        remedy = "Write / between the folders of a path, or put the path into single quotes"
    elif line and re.search(r"=\s*[-+]?\d+,\d", lines[int(line) - 1]):
        remedy = "Write numbers with a decimal point, and without thousands separators"
    elif line and re.search(r"=\s*[-+]?\d+[ '\u00a0\u202f]\d", lines[int(line) - 1]):
        remedy = "Write numbers without thousands separators"
    elif line and re.search("[\u2018\u2019\u201a\u201c\u201d\u201e\u00ab\u00bb]", lines[int(line) - 1]):
        remedy = "Write straight quotation marks, as a plain text editor does"
    elif line and re.search(r"=\s*[^\s\"'\[{#][^\"'=]*\.(?:csv|parquet)\b", lines[int(line) - 1]):
        remedy = "Put the path into quotation marks"
    return Problem("toml_syntax", place, f"not valid TOML: {what}", remedy)


def path_problems(files: Mapping[str, str | None]) -> Iterator[Problem]:
    """Refusal of every path in which a backslash of Windows and the letter after it became one character."""
    for key, file in files.items():
        if file is not None and (control := control_characters(file)):
            what = f"the path {_shown(file)} holds {control}, as \\ begins an escape between double quotes"
            yield Problem("bad_path", key, what, "Write / between the folders, or put the path into single quotes")


def model_problems(details: ErrorDetails, models: Models, raw: dict[str, Any]) -> Iterator[Problem]:
    """Refusals that one finding of the models stands for; ``models`` holds the model of every table by its keys."""
    place, value = details["loc"], details["input"]
    where = _named(place, raw)
    *table, key = _keys(place)
    fields = {field.alias or name: field for name, field in models[tuple(table)].model_fields.items()}
    remedy = f"Give {fields[key].description}" if key in fields else ""
    match details["type"]:
        case "missing":
            yield Problem("missing_key", where, "the key is missing", remedy)
        case "extra_forbidden":
            near = difflib.get_close_matches(key, fields, n=1)
            remedy = f"Write {near[0]!r}" if near else f"Remove it; the keys are {', '.join(fields)}"
            yield Problem("unknown_key", where, f"unknown key with the value {_shown(value)}", remedy)
        case "too_short" if value and details["ctx"]["actual_length"] < len(value):
            return  # an item of the list is wrong, and that is reported by itself
        case ("too_short" | "too_long") as is_unlike if value:
            most, least = (details["ctx"].get(f"{end}_length") for end in ("max", "min"))
            wanted = f"at most {most}" if is_unlike == "too_long" else f"at least {least}"
            yield Problem(
                "bad_value",
                where,
                f"{_shown(value)} has {len(value)} item{'s' * (len(value) > 1)}, {wanted} are wanted",
                remedy,
            )
        case "too_short" | "string_too_short":
            yield Problem("bad_value", where, f"{_shown(value)} is empty", remedy)
        case "value_error" if isinstance(cause := details["ctx"]["error"], Contradictions):
            for problem in cause.problems:
                yield replace(problem, where=_named((*place, problem.where), raw))
        case "value_error":
            yield Problem("bad_value", where, str(details["ctx"]["error"]), remedy)
        case _:
            finding = details["msg"].removeprefix("Input ").replace("tuple", "list")
            finding = re.sub(r"a valid dictionary.*", "a table", finding)
            yield Problem("bad_value", where, f"{_shown(value)} {finding}", remedy)


def curve_problems(raw: dict[str, Any], catalogue: Collection[str]) -> Iterator[Problem]:
    """Refusal of a chosen curve that is not there, and of a name of a user's own that is not written as it reads."""
    own, chosen = raw.get("curves"), raw.get("curve")
    own = own if isinstance(own, dict) else {}
    for name in own:
        if name != composed(name):
            what = f"the name {name!r} has blanks around it or accents as characters of their own (NFD)"
            yield Problem("bad_name", f"curves.{name}", what, f"Write {composed(name)!r}")
    name = chosen.get("name") if isinstance(chosen, dict) else None
    if isinstance(name, str) and name and name not in (known := sorted({*catalogue, *own})):
        near = difflib.get_close_matches(name, known, n=1)
        remedy = f"Write {near[0]!r}" if near else f"Add it under [curves], or use one of {', '.join(known)}"
        if composed(name) in map(composed, known):
            remedy = "Copy the name from [curves]: there an accent is a character of its own, or here"
        yield Problem("unknown_curve", "curve.name", f"there is no curve {name!r}", remedy)


def mission_problems(raw: dict[str, Any]) -> Iterator[Problem]:
    """Refusals about the events together, on the file's own values, so that a mistake elsewhere does not hide them."""
    mission = raw.get("mission")
    events = mission.get("event") if isinstance(mission, dict) else None
    if not isinstance(events, list) or not all(isinstance(event, dict) for event in events):
        return
    first: dict[str, int] = {}
    for position, event in enumerate(events, 1):
        name = event.get("name")
        if isinstance(name, str) and first.setdefault(composed(name), position) < position:
            yield Problem(
                "duplicate",
                f"mission.event[{position}].name",
                f"{name!r} is already the name of mission.event[{first[composed(name)]}]",
                "Give every event its own name",
            )
    shares = [event["share"] for event in events if "share" in event]
    if not shares or not all("share" in event or "per_1000_km" in event for event in events):
        return
    if not all(isinstance(share, int | float) and not isinstance(share, bool) and 0 <= share <= 1 for share in shares):
        return  # one of them is wrong by itself, and that is reported
    total = math.fsum(shares)
    if abs(total - 1) > SHARE_TOLERANCE:
        yield Problem(
            "shares",
            "mission.event.share",
            f"the shares {' + '.join(f'{share:g}' for share in shares)} sum to {total:.9g}, not to 1",
            "Correct them, they are not rescaled",
        )


def _keys(place: Place) -> list[str]:
    """List the keys of a place, without list positions and without the names of the user's own curves."""
    keys = [part for part in place if isinstance(part, str)]
    return keys[:1] + keys[2:] if keys[0] == "curves" else keys


def _named(place: Place, raw: dict[str, Any]) -> str:
    """Spell a place as the file does, with the name of its event: ``mission.event[2].share ('worn')``."""
    text = "".join(f"[{part + 1}]" if isinstance(part, int) else f".{part}" for part in place)[1:]
    if place[:2] == ("mission", "event") and len(place) > 3 and place[3] != "name":
        name = raw["mission"]["event"][place[2]].get("name")
        return f"{text} ({name!r})" if isinstance(name, str) else text
    return text


def _shown(value: object) -> str:
    """Spell a value as TOML does, cut where it is long."""
    text = json.dumps(value, ensure_ascii=False) if isinstance(value, bool | str) else str(value)
    return text if len(text) <= 60 else text[:57] + "..."
