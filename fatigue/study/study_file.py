"""The tables of ``study.toml`` as frozen models, and the file read and checked as a whole.

What is varied is checked later, key by key, against the vehicle and the case that it belongs to.
"""

import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, Field, PrivateAttr

from fatigue.case.problems import absent, clash, path_problems
from fatigue.case.table import Positive, Table, Text
from fatigue.case.toml_file import checked_file, read_toml
from fatigue.errors import CaseError, Problem, given_path, refuse
from fatigue.study.vehicle_keys import KEYS

NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
WHAT = "a study (study.toml)"
TAKEN = ("seed", "run", "study", "event", "variant")  # placeholders of every command and pattern
UNIT = re.compile(r"(?<!per_1000)_(?:hz|km_h|kg_m2|t_mm2|Nm_rad|Ns_m|N_m|m_s2|mm|MPa|Nm|kg|km|m|N|s|t)$")

Value = float | int | str | bool | list[Any]
Label = Annotated[str, Field(min_length=1)]


def short_name(key: str) -> str:
    """Last part of a key without its unit; a state is named for what has it.

    >>> short_name("vehicle.converter.fe_hz"), short_name("vehicle.run.speed_km_h"), short_name("case.curve.survival")
    ('fe', 'speed', 'survival')
    >>> short_name("vehicle.contact.state")
    'contact'
    """
    last = key.removesuffix(".state").rsplit(".", 1)[-1]
    return UNIT.sub("", last) or last


def _twice(key: str, values: list[Any]) -> Iterator[Problem]:
    """Refusal of a list that has something twice; 350 and 350.0 are one value, true and 1 are two."""
    for number, value in enumerate(values):
        if any(same_value(value, other) for other in values[:number]):
            yield Problem("duplicate", key, f"{value!r} is there twice", "Give each of them once")


def same_value(one: object, other: object) -> bool:
    """Whether two values of a key are the same: 350 and 350.0 are, 1 and true are not."""
    return isinstance(one, bool) == isinstance(other, bool) and one == other


def flat(tables: Any, above: str = "") -> Any:
    """Tables in one another as one table with dots in its keys; anything else as it is.

    >>> flat({"vehicle": {"converter": {"fe_hz": 14.0}}, "case.curve.survival": "mean"})
    {'vehicle.converter.fe_hz': 14.0, 'case.curve.survival': 'mean'}
    """
    if not isinstance(tables, dict):
        return tables
    found: dict[str, Any] = {}
    for key, value in tables.items():
        found |= flat(value, f"{above}{key}.") if isinstance(value, dict) else {f"{above}{key}": value}
    return found


Set = Annotated[dict[str, Any], BeforeValidator(flat)]


class Base(Table):
    """What is varied: a vehicle, a case, or both."""

    vehicle: Text | None = Field(default=None, description="the file of the vehicle (vehicle.toml)")
    case: Text | None = Field(default=None, description="the case file; left out: runs have numbers and no lives")

    def _contradictions(self) -> Iterator[Problem]:
        yield from path_problems({"vehicle": self.vehicle, "case": self.case})


class Vary(Table):
    """One thing that is varied: a key with its values, or several keys that are set together."""

    key: Text | None = Field(
        default=None,
        description="a key of the vehicle ('vehicle.converter.fe_hz'), of the case ('case.curve.survival', "
        "'case.mission.event.<name>.stress_factor'), 'case' for another case file, or 'own.<name>' for something that "
        "only the source knows",
    )
    values: Annotated[tuple[Value, ...], Field(strict=False, min_length=1)] | None = Field(
        default=None, description="a list of the values of the key"
    )
    set: Annotated[tuple[Set, ...], Field(strict=False, min_length=1)] | None = Field(
        default=None, description="instead of key and values: a list of tables from keys to values, set together"
    )
    name: Text | None = Field(
        default=None,
        description="a short name; left out: the last part of the key without its unit, of a key that ends in '.state' "
        "the part before it",
    )
    labels: Annotated[tuple[Label, ...], Field(strict=False)] | None = Field(
        default=None, description="a list with a name for each of the values"
    )
    base: Value | None = Field(
        default=None, description="the value of the base, of a key 'own.<name>', which no file has; else its first one"
    )

    @property
    def short_name(self) -> str:
        """Its name in claims, placeholders and folders."""
        return self.name or short_name(self.key or "")

    @property
    def given(self) -> tuple[Set, ...]:
        """What each of its values sets."""
        return self.set if self.set is not None else tuple({self.key or "": value} for value in self.values or ())

    def _contradictions(self) -> Iterator[Problem]:
        if (self.set is None) == (self.key is None):
            what = "key and set are both given" if self.key else "neither key nor set is given"
            yield clash("key", what, "Give key with values, or set with a table for each value")
        elif self.set is None and self.values is None:
            yield absent("values", f"the key is missing although key = {self.key!r} is given", "Give a list of values")
        elif self.set is not None and self.values is not None:
            yield clash("values", "values and set are both given", "Keep one of them")
        elif self.set is not None and self.name is None:
            yield absent("name", "the key is missing although several keys are set together", "Give a short name")
        elif self.set is not None and self.labels is None:
            yield absent("labels", "tables of set have no names", "Give a label for each of them")
        elif self.labels is None and any(isinstance(value, list) for value in self.values or ()):
            yield absent("labels", "values that are lists have no names", "Give a label for each of them")
        if self.labels is not None and len(self.labels) != len(self.given):
            what = f"there are {len(self.labels)} labels of {len(self.given)} values"
            yield clash("labels", what, "Give a label for each value")
        yield from _twice("labels", list(self.labels or ()))
        yield from _twice("values", list(self.values or ()))
        if (self.key or self.name) and not NAME.fullmatch(self.short_name):
            what = f"{self.short_name!r} is no name that a placeholder can have"
            yield clash("name", what, "Give one of letters, digits and _ that begins with a letter")
        elif self.short_name in TAKEN:
            yield clash("name", f"{self.short_name!r} has a meaning of its own in every study", "Give another name")
        if self.base is not None and not (self.key or "").startswith("own."):
            remedy = "Remove it, or set it in the file"
            yield clash("base", "the base of this key is what its file has", remedy)


class GivenVariant(Table):
    """A variant that is stated by itself: several keys at once."""

    name: Text = Field(description="its name, unique in the study")
    set: Set = Field(description="a table from keys, as those of [[vary]], to values")


class SourceRun(Table):
    """A run of its own that one event of the case needs."""

    event: Text = Field(description="the event of the case whose history it makes")
    set: Set = Field(default={}, description="a table from keys to values, on top of what the variant sets")


class Source(Table):
    """Where histories come from: a ride of the vehicle, a command, files that are there, or those of the case."""

    builtin: Literal[True] | None = Field(
        default=None,
        description="true: a ride of the vehicle, the default with a vehicle; without a vehicle, a command and files, "
        "histories are those of the case",
    )
    command: Text | None = Field(
        default=None,
        description="a command that is run in the folder of each run and leaves the histories that the case names; "
        "{fe}, {seed}, {event}, {run} and {study} stand for settings, the folder of the run and that of the study",
    )
    files: Text | None = Field(
        default=None,
        description="the file of the history, or a folder with the files that the case names for the event, relative "
        "to the study; {fe}, {seed} and {event} stand for settings",
    )
    rate_hz: Positive | None = Field(
        default=None, description="samples per second of the histories of a ride, above 0; left out: one each step"
    )
    inputs: Annotated[tuple[Text, ...], Field(strict=False)] = Field(
        default=(), description="a list of files that the command reads: if one changes, runs are made anew"
    )
    events: Annotated[tuple[Text, ...], Field(strict=False)] = Field(
        default=(),
        description="a list of the events of the case that get their histories from the source, by default all that "
        "have one",
    )
    run: Annotated[tuple[SourceRun, ...], Field(strict=False)] = Field(
        default=(), description="one [[source.run]] table per event that needs a run of its own"
    )

    def _contradictions(self) -> Iterator[Problem]:
        given = [key for key in ("builtin", "command", "files") if getattr(self, key) is not None]
        if len(given) > 1:
            yield clash(given[1], f"{' and '.join(given)} are all given", "Keep one of them: histories have one source")
        if self.inputs and self.command is None:
            yield clash("inputs", "inputs are those of a command, and none is given", "Remove it, or give a command")
        if self.rate_hz is not None and (self.command or self.files):
            yield clash("rate_hz", "rate_hz is of rides of the vehicle, and these are none", "Remove it")
        if self.events and self.run:
            yield clash("events", "events and [[source.run]] are both given", "Keep one of them")
        yield from _twice("events", list(self.events))
        yield from _twice("run", [run.event for run in self.run])


class Study(Table):
    """The whole of ``study.toml``."""

    title: str = Field(default="Untitled", description="the title of tables and page")
    base: Base = Field(description="a [base] table")
    vary: Annotated[tuple[Vary, ...], Field(strict=False)] = Field(
        default=(), description="one [[vary]] table per thing that is varied"
    )
    combine: Literal["one-at-a-time", "full"] = Field(
        default="one-at-a-time",
        description="'one-at-a-time' (the base, and each value alone) or 'full' (every value with every other)",
    )
    variant: Annotated[tuple[GivenVariant, ...], Field(strict=False)] = Field(
        default=(), description="one [[variant]] table per combination that is stated by itself"
    )
    seeds: Annotated[tuple[Annotated[int, Field(ge=0)], ...], Field(strict=False, min_length=1)] = Field(
        default=(1,), description="a list of seeds, whole numbers of at least 0: every variant is run under each"
    )
    diagnose: bool = Field(default=False, description="whether what makes the damage is looked at in every run, too")
    source: Source = Field(default=Source(), description="a [source] table")
    claim: tuple[dict[str, Any], ...] = Field(default=(), strict=False, description="one [[claim]] table per sentence")
    _path: Path = PrivateAttr(Path())

    def model_post_init(self, context: Path | None) -> None:
        """Remember the file, where the study comes from one."""
        if context is not None:
            self._path = context

    @property
    def path(self) -> Path:
        """The study file."""
        return self._path

    def resolve(self, name: str) -> Path:
        """Path of a file the study names, relative to the folder of the study file."""
        return self._path.parent / name

    @property
    def is_builtin(self) -> bool:
        """Whether histories are rides of the vehicle of this program."""
        return self.base.vehicle is not None and self.source.command is None and self.source.files is None

    def _contradictions(self) -> Iterator[Problem]:
        if self.base.vehicle is None and self.base.case is None:
            yield absent("base.vehicle", "neither vehicle nor case is given", "Give one of them, or both")
        elif self.base.vehicle is None and self.source.builtin:
            yield absent("base.vehicle", "source.builtin = true is a ride, and there is no vehicle", "Give the vehicle")
        elif not self.is_builtin and self.source.command is None and self.source.files is None and self.source.run:
            what = "events have runs of their own, and nothing says where these come from"
            yield absent("source.command", what, "Give command or files under [source], or a vehicle under [base]")
        elif self.base.case is None and (self.source.files is not None or self.source.run or self.source.events):
            what = "source has files or events, and there is no case that names any"
            yield absent("base.case", what, "Give the case file")
        yield from _twice("seeds", list(self.seeds))
        yield from _twice("variant", [variant.name for variant in self.variant])
        first: dict[str, int] = {}
        for number, vary in enumerate(self.vary, 1):
            if first.setdefault(vary.short_name, number) < number:
                what = f"{vary.short_name!r} is already the name of vary[{first[vary.short_name]}]"
                yield Problem("duplicate", f"vary[{number}].name", what, "Give each of them a name of its own")


MODELS: dict[tuple[str, ...], type[BaseModel]] = {
    (): Study,
    ("base",): Base,
    ("vary",): Vary,
    ("variant",): GivenVariant,
    ("source",): Source,
    ("source", "run"): SourceRun,
}


def load_study(path: Path | str) -> Study:
    """Study of a study file, read and checked in itself; the files it names are not opened.

    Raises
    ------
    CaseError : every mistake of the file, not only the first
    """
    path = given_path(path, "study")
    raw = read_toml(path, WHAT)
    refuse(CaseError, _another_file(raw, path))
    return checked_file(Study, raw, path, MODELS)


def _another_file(raw: Mapping[str, Any], path: Path) -> Iterator[Problem]:
    """Refusal of a case or a vehicle that is given instead of a study."""
    if "base" in raw or not raw:
        return
    kinds = {"a case (case.toml)": {"body", "mission"}, "a vehicle (vehicle.toml)": set(KEYS)}
    for kind, tables in kinds.items():
        if tables & raw.keys():
            remedy = (
                f"Give a study.toml that names it under [base], as in {'vehicle' if 'car' in tables else 'case'} = "
            )
            yield Problem("foreign_format", path.name, f"this is {kind}, not a study", f"{remedy}{path.name!r}")
            return
