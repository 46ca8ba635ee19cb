"""Read ``vehicle.toml``: all of it is checked, with what a study changes in it, and all mistakes are told at once.

A key that is left out has the value of the reference trailer, or that of the setting of its suspension. Nothing is
converted: a number written as text is a mistake, and so is a key that there is not.
"""

import difflib
import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any, get_type_hints

from fatigue.case.problems import clash
from fatigue.case.toml_file import read_toml
from fatigue.errors import CaseError, Problem, given_path, refuse
from fatigue.files.misplaced import misplaced
from fatigue.files.naming import control_characters
from fatigue.study.vehicle_keys import KEYS, OF_SETTING, Key
from fatigue.vehicle.definition import Vehicle

FRAME = "frame"
WHAT = "a vehicle (vehicle.toml)"
_PAIRS = "a list of pairs of numbers, [[begin, end], ...]"

Tables = dict[str, dict[str, Any]]


@dataclass(frozen=True, slots=True)
class _Given:
    """One value and the place that gives it, in words; what is in a ``file`` is relative to its folder."""

    value: Any
    where: str
    folder: Path | None = None


def load_vehicle(
    path: Path | str | None, changed: Mapping[str, object] | None = None, changed_in: str = "changed"
) -> Vehicle:
    """Vehicle of a ``vehicle.toml``, read and checked.

    Parameters
    ----------
    path : the file; None: the reference trailer
    changed : values by dotted key that stand instead of those of the file, ``{"converter.fe_hz": 14.0}``; a body
        among them is relative to the working folder
    changed_in : the place that changes them, which their refusals name

    Raises
    ------
    CaseError : every mistake of the file and of what is changed, with place, value and remedy
    """
    problems: list[Problem] = []
    given: dict[str, _Given] = {}
    if path is not None:
        path = given_path(path, "vehicle")
        raw = read_toml(path, WHAT)
        if raw and not any(table in KEYS for table in raw) and (other := misplaced(path, path.name)) is not None:
            raise CaseError(other)
        given, problems = _of_file(raw, path)
    of_file = set(given)
    for key, value in (changed or {}).items():
        where = f"{changed_in}: {key}"
        if problem := _unknown(key, value, where):
            problems.append(problem)
        else:
            given[key] = _Given(value, where)
    problems += _covered(given, of_file, changed or {})
    read: dict[str, Any] = {}
    wrong: list[Problem] = []
    for key, one in given.items():
        table, name = key.split(".")
        read[key], found = _read(name, KEYS[table][name], one)
        wrong += found
    if wrong:  # what contradicts a value that is wrong by itself is not told
        raise CaseError(*problems, *wrong)
    vehicle = _built(read)
    problems += _contradictions(vehicle, given, "" if path is None else f"{Path(path).name}: ")
    refuse(CaseError, problems)
    return vehicle


def keys_of(vehicle: Vehicle) -> Mapping[str, Any]:
    """Every value of a vehicle by its dotted key, in the order of the tables."""
    return {f"{table}.{key}": getattr(getattr(vehicle, table), key) for table, keys in KEYS.items() for key in keys}


def _of_file(raw: dict[str, Any], path: Path) -> tuple[dict[str, _Given], list[Problem]]:
    """Values of a file by dotted key, and what is no key of a vehicle."""
    given, problems = {}, []
    for table, values in raw.items():
        where = f"{path.name}: {table}"
        if table not in KEYS:
            problems.append(_no_table(table, values, where))
        elif not isinstance(values, dict):
            remedy = f"Write [{table}], and its keys below"
            problems.append(Problem("bad_value", where, f"{_shown(values)} should be a table", remedy))
        else:
            for name, value in values.items():
                key = f"{table}.{name}"
                if problem := _unknown(key, value, f"{path.name}: {key}"):
                    problems.append(problem)
                else:
                    given[key] = _Given(value, f"{path.name}: {key}", path.parent)
    return given, problems


def _no_table(table: str, values: object, where: str) -> Problem:
    """Refusal of a table, or of a key outside any, that a vehicle has not."""
    if isinstance(values, dict):
        near = difflib.get_close_matches(table, KEYS, n=1)
        remedy = (
            f"Write [{near[0]}]" if near else f"Remove it; the tables are {', '.join(f'[{name}]' for name in KEYS)}"
        )
        return Problem("unknown_key", where, "there is no such table of a vehicle", remedy)
    near = [name for name in _HOMES if name.startswith(f"{table}_")] or difflib.get_close_matches(
        table, _HOMES, n=1, cutoff=0.75
    )
    remedy = f"Remove it; the tables are {', '.join(f'[{name}]' for name in KEYS)}"
    if near:
        remedy = f"Write {near[0]!r} below [{_HOMES[near[0]]}]"
    return Problem("unknown_key", where, f"unknown key with the value {_shown(values)} outside any table", remedy)


def _unknown(key: str, value: object, where: str) -> Problem | None:
    """Refusal of a dotted key that a vehicle has not."""
    table, _, name = key.partition(".")
    if name in KEYS.get(table, ()):
        return None
    what = f"unknown key with the value {_shown(value)}"
    if table in KEYS:
        near = [other for other in KEYS[table] if other.startswith(f"{name}_")]
        near = near or difflib.get_close_matches(name, KEYS[table], n=1)
        if name in _HOMES:
            remedy = f"Move it to [{_HOMES[name]}], whose key it is"
        elif near:
            remedy = f"Write {near[0]!r}"
        else:
            remedy = f"Remove it; the keys of [{table}] are {', '.join(KEYS[table])}"
        return Problem("unknown_key", where, what, remedy)
    near = difflib.get_close_matches(key, (f"{table}.{name}" for table, keys in KEYS.items() for name in keys), n=1)
    remedy = f"Write {near[0]!r}" if near else f"Write TABLE.KEY; the tables are {', '.join(KEYS)}"
    return Problem("unknown_key", where, what, remedy)


def _covered(given: dict[str, _Given], of_file: set[str], changed: Mapping[str, object]) -> Iterator[Problem]:
    """Refusal of a change of the setting that what the file states would cover."""
    stated = [key for key in OF_SETTING if key in of_file and key not in changed]
    if "suspension.setting" in changed and stated:
        what = f"the setting is changed, but the file states {', '.join(stated)}, which would stay as they are"
        yield clash(given["suspension.setting"].where, what, "Leave them out of the file, or change them as well")


def _read(name: str, key: Key, given: _Given) -> tuple[Any, list[Problem]]:
    """Value as the vehicle keeps it, and what is wrong with it."""
    value, kind = given.value, _KINDS.get(name, "float")
    finding = ""
    if key.none and value == key.none:
        return None, []
    if kind == "text":
        if not isinstance(value, str):
            finding = "should be a text"
        elif key.choices and value not in key.choices:
            near = difflib.get_close_matches(value, key.choices, n=1)
            remedy = f"Write {near[0]!r}" if near else f"Write one of {', '.join(map(repr, key.choices))}"
            return None, [Problem("bad_value", given.where, f"{_shown(value)} is none of the choices", remedy)]
        elif not value.strip():
            finding = "is empty"
        elif name == "body":
            return _body(value, given)
    elif kind == "pairs":
        return _pairs(value, key, given)
    elif isinstance(value, bool) or not isinstance(value, int | float):
        finding = "should be a number"
    elif kind == "int" and not isinstance(value, int):
        finding = "should be a whole number"
    elif not key.range.holds(value):
        finding = "is out of range"
    if finding:
        return None, [Problem("bad_value", given.where, f"{_shown(value)} {finding}", _remedy(key, kind))]
    return (value if kind != "float" else float(value)), []


def _body(value: str, given: _Given) -> tuple[Any, list[Problem]]:
    """The frame, or the folder of a body, which has to be there."""
    if value == FRAME:
        return value, []
    if control := control_characters(value):
        what = f"the path {_shown(value)} holds {control}, as \\ begins an escape between double quotes"
        remedy = "Write / between the folders, or put the path into single quotes"
        return None, [Problem("bad_path", given.where, what, remedy)]
    folder = Path(value) if given.folder is None else given.folder / value
    if folder.is_dir():
        return str(folder), []
    what = f"there is no folder {folder}" if not folder.exists() else f"{folder} is a file, not a folder"
    near = difflib.get_close_matches(value, [FRAME], n=1)
    remedy = "Write 'frame'" if near else "Give the folder that `fatigue reduce` wrote, or 'frame'"
    return None, [Problem("missing_body", given.where, what, remedy)]


def _pairs(value: object, key: Key, given: _Given) -> tuple[Any, list[Problem]]:
    """Stretches of the track, each from its begin to its end."""
    if not isinstance(value, list | tuple):
        return None, [Problem("bad_value", given.where, f"{_shown(value)} should be {_PAIRS}", "Write the brackets")]
    problems, pairs = [], []
    for position, pair in enumerate(value, 1):
        where = f"{given.where}[{position}]"
        if not isinstance(pair, list | tuple) or len(pair) != 2 or not all(map(_is_number, pair)):
            problems.append(Problem("bad_value", where, f"{_shown(pair)} should be [begin, end]", f"Write {_PAIRS}"))
        elif not all(map(key.range.holds, pair)) or pair[1] <= pair[0]:
            what = f"{_shown(list(pair))} is no stretch of track"
            problems.append(Problem("bad_value", where, what, "Give its begin, at least 0 m, then its end"))
        else:
            pairs.append((float(pair[0]), float(pair[1])))
    return tuple(pairs), problems


def _contradictions(vehicle: Vehicle, given: Mapping[str, _Given], file: str) -> Iterator[Problem]:
    """Refusals of values that are fine alone and wrong together."""

    def where(*keys: str) -> str:
        return next((given[key].where for key in keys if key in given), f"{file}{keys[0]}")

    run, track, contact, bogie = vehicle.run, vehicle.track, vehicle.contact, vehicle.bogie
    lasts = track.distance_m / (run.speed_km_h / 3.6)
    if run.dropped_s >= lasts:
        what = f"dropped_s = {run.dropped_s:g} leaves nothing of a run of {lasts:.3g} s"
        yield clash(where("run.dropped_s", "run.speed_km_h", "track.distance_m"), what, "Drop less, or run longer")
    elif run.step_s >= lasts - run.dropped_s:
        what = f"step_s = {run.step_s:g} is as long as the run"
        yield clash(where("run.step_s", "track.distance_m"), what, "Give a smaller step, or run longer")
    if contact.state == "worn" and not any(begin < track.distance_m for begin, _ in contact.worn_sections_m):
        what = f"the contact is worn, but no worn section begins within the {track.distance_m:g} m of the run"
        yield clash(where("contact.worn_sections_m", "contact.state"), what, "Give worn sections, or write 'sound'")
    if bogie.wheelbase_m is not None and bogie.wheelbase_m >= bogie.spacing_m:
        what = f"wheelbase_m = {bogie.wheelbase_m:g} is no less than spacing_m = {bogie.spacing_m:g}"
        yield clash(where("bogie.wheelbase_m", "bogie.spacing_m"), what, "Give the whole wheelbase 2 a of one bogie")
    if track.weakened_below_m > track.longest_m:
        what = f"weakened_below_m = {track.weakened_below_m:g} is above longest_m = {track.longest_m:g}"
        yield clash(where("track.weakened_below_m", "track.longest_m"), what, "Give the longest wavelength the larger")


def _built(read: Mapping[str, Any]) -> Vehicle:
    """The reference trailer with what was read."""
    vehicle = Vehicle()
    tables: Tables = {}
    for key, value in read.items():
        table, name = key.split(".")
        tables.setdefault(table, {})[name] = value
    parts = {table: replace(getattr(vehicle, table), **values) for table, values in tables.items()}
    return replace(vehicle, **parts)


_HOMES = {name: table for table in reversed(list(KEYS)) for name in KEYS[table]}  # the first table that has a key


def _kinds() -> dict[str, str]:
    """What a key holds by its name, where it is no number of any kind: ``text``, ``int``, ``pairs``."""
    found = {}
    for table in fields(Vehicle):
        part = get_type_hints(Vehicle)[table.name]
        for name, hint in get_type_hints(part).items():
            if hint is str:
                found[name] = "text"
            elif hint is int:
                found[name] = "int"
            elif getattr(hint, "__origin__", None) is tuple:
                found[name] = "pairs"
    return found


_KINDS = _kinds()


def _remedy(key: Key, kind: str) -> str:
    kinds = {"int": "a whole number", "text": "a text between quotation marks"}
    kind = f"{kinds.get(kind, 'a number')}{'' if kind == 'text' else f' {key.range}'}"
    return f"Give {kind}: {key.meaning.split(';', maxsplit=1)[0]}"


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _shown(value: object) -> str:
    """Spell a value as TOML does, cut where it is long."""
    text = json.dumps(value, ensure_ascii=False) if isinstance(value, bool | str) else str(value)
    return text if len(text) <= 60 else text[:57] + "..."
