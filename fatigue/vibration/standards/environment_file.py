"""Tables of limits of vibration as they are written: the shipped one, and how a user's own is checked."""

import difflib
import itertools
import math
import tomllib
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import Any

from fatigue.errors import DataError, Problem, refuse
from fatigue.vibration.standards.environment import DensityShape, VibrationClass, VibrationTable

DIRECTIONS = ("x", "y", "z")
TOP_KEYS = ("edition", "status", "source", "shape", "class")
SHAPE_KEYS = ("edges_hz", "exponents", "light_kg", "light_hz", "heavy_kg", "heavy_hz")
LEVELS = ("functional_rms_m_s2", "functional_asd_m2_s3", "long_life_rms_m_s2", "shock_m_s2")
CLASS_KEYS = ("what", "shape", *LEVELS)
FORMAT = "The format is that of fatigue/vibration/standards/environment.toml"


@cache
def shipped_table() -> VibrationTable:
    """Table of ``environment.toml``: IEC 61373 as it was recalled, with its edition."""
    text = Path(__file__).with_name("environment.toml").read_text("utf-8")
    return vibration_table(tomllib.loads(text), "environment.toml")


def vibration_table(data: Mapping[str, Any], where: str) -> VibrationTable:
    """Table of limits from the keys and values of its file.

    Raises
    ------
    DataError : every unknown or missing key and every value that is none
    """
    refuse(DataError, _problems(data, where))
    shapes = {name: _shape(given) for name, given in data.get("shape", {}).items()}
    classes = {name: _class(name, given, shapes) for name, given in data["class"].items()}
    return VibrationTable(data["edition"], data["status"], data["source"], classes)


def _shape(given: Mapping[str, Any]) -> DensityShape:
    light, heavy = given["light_hz"], given["heavy_hz"]
    return DensityShape(
        edges_hz=tuple(given["edges_hz"]),
        exponents=tuple(given["exponents"]),
        light_kg=given["light_kg"],
        light_hz=(light[0], light[1]),
        heavy_kg=given["heavy_kg"],
        heavy_hz=(heavy[0], heavy[1]),
    )


def _class(name: str, given: Mapping[str, Any], shapes: Mapping[str, DensityShape]) -> VibrationClass:
    rms, asd, long_life, shock = (given.get(key, {}) for key in LEVELS)
    shape = shapes[given["shape"]] if "shape" in given else None
    return VibrationClass(name, given.get("what", ""), rms, asd, long_life, shock, shape)


def _problems(data: Mapping[str, Any], where: str) -> Iterator[Problem]:
    yield from _unknown(data, TOP_KEYS, where)
    for key in ("edition", "status", "source"):
        if not isinstance(data.get(key), str) or not data[key].strip():
            what = f"{data[key]!r} is no text" if key in data else "the key is missing"
            yield Problem("bad_value", f"{where}: {key}", what, f"Give the {key} of the table, as a text")
    shapes, classes = data.get("shape", {}), data.get("class", {})
    for key, given in (("shape", shapes), ("class", classes)):
        if not isinstance(given, dict) or not all(isinstance(table, dict) for table in given.values()):
            yield Problem("bad_value", f"{where}: {key}", "it is no table of tables", f"Write [{key}.NAME]. {FORMAT}")
            return
    if not classes:
        yield Problem("missing_key", f"{where}: class", "the table has no class", f"Add a [class.NAME]. {FORMAT}")
    for name, given in shapes.items():
        yield from _shape_problems(given, f"{where}: shape.{name}")
    for name, given in classes.items():
        yield from _class_problems(given, shapes, f"{where}: class.{name}")


def _shape_problems(given: Mapping[str, Any], where: str) -> Iterator[Problem]:
    yield from _unknown(given, SHAPE_KEYS, where)
    for key in SHAPE_KEYS:
        if key not in given:
            yield Problem("missing_key", f"{where}.{key}", "the key is missing", FORMAT)
    for key in {"light_kg", "heavy_kg"} & given.keys():
        if not _is_positive(given[key]):
            yield Problem("bad_value", f"{where}.{key}", f"{given[key]!r} is no number above 0", "Give a mass [kg]")
    for key in {"edges_hz", "light_hz", "heavy_hz"} & given.keys():
        two = key != "edges_hz"
        if not _is_ascending(given[key]) or (two and len(given[key]) != 2):
            what = f"{given[key]!r} is no list of {'two ' if two else ''}frequencies above 0, each above the one before"
            yield Problem("bad_value", f"{where}.{key}", what, "Give frequencies [Hz]")
    edges, exponents = given.get("edges_hz"), given.get("exponents")
    if exponents is not None and (
        not isinstance(exponents, list)
        or not all(_is_number(p) for p in exponents)
        or (isinstance(edges, list) and len(exponents) != len(edges) - 1)
    ):
        what = f"{exponents!r} is no list of numbers, one fewer than edges_hz"
        yield Problem("bad_value", f"{where}.exponents", what, "Give a power of frequency for each piece")


def _class_problems(given: Mapping[str, Any], shapes: Mapping[str, Any], where: str) -> Iterator[Problem]:
    yield from _unknown(given, CLASS_KEYS, where)
    if "what" in given and not isinstance(given["what"], str):
        yield Problem("bad_value", f"{where}.what", f"{given['what']!r} is no text", "Give a text")
    if "shape" in given and given["shape"] not in list(shapes):
        known = ", ".join(repr(name) for name in shapes) or "none"
        what = f"there is no shape {given['shape']!r}"
        yield Problem("bad_value", f"{where}.shape", what, f"Give one of the table ({known}), or add a [shape.NAME]")
    if "functional_rms_m_s2" not in given:
        yield Problem("missing_key", f"{where}.functional_rms_m_s2", "the key is missing", FORMAT)
    for key in LEVELS:
        levels = given.get(key, {})
        if not isinstance(levels, dict):
            yield Problem(
                "bad_value", f"{where}.{key}", f"{levels!r} is no table", "Write { x = ..., y = ..., z = ... }"
            )
            continue
        yield from _unknown(levels, DIRECTIONS, f"{where}.{key}")
        for direction in levels.keys() & DIRECTIONS:
            if not _is_positive(levels[direction]):
                what = f"{levels[direction]!r} is no number above 0"
                yield Problem(
                    "bad_value", f"{where}.{key}.{direction}", what, "Give a level, or leave the direction out"
                )


def _unknown(given: Mapping[str, Any], known: tuple[str, ...], where: str) -> Iterator[Problem]:
    for key in given:
        if key not in known:
            near = difflib.get_close_matches(key, known, n=1)
            remedy = f"Write {near[0]!r}" if near else f"Remove it; the keys are {', '.join(known)}"
            yield Problem("unknown_key", f"{where}: {key}", f"unknown key {key!r}", remedy)


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def _is_positive(value: object) -> bool:
    return _is_number(value) and float(value) > 0  # type: ignore[arg-type]


def _is_ascending(value: object) -> bool:
    if not isinstance(value, list) or len(value) < 2 or not all(_is_positive(f) for f in value):
        return False
    return all(a < b for a, b in itertools.pairwise(value))
