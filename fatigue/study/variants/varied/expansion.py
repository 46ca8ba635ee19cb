"""The variants of a study: its base, each value alone or with every other, and those stated by themselves."""

import itertools
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from fatigue.errors import CaseError, Problem, refuse
from fatigue.study.quantities import Variant
from fatigue.study.study_file import GivenVariant, Set, Study, same_value, short_name
from fatigue.study.variants.varied.names import BASE, folder_names, shown

Known = Callable[[str], Any]
Setting = float | int | str | bool


@dataclass(frozen=True, slots=True)
class Level:
    """One value of an aspect: what it is called, and what it sets; nothing is set by the value that the files have."""

    setting: Setting
    changes: Set = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Aspect:
    """One thing that is varied: ``where`` in the study file, its short name, its keys, its base, all its values."""

    where: str
    name: str
    keys: frozenset[str]
    base: Level
    levels: tuple[Level, ...]

    def level_of(self, variant: GivenVariant, known: Known) -> Level:
        """Its value in a variant that is stated by itself, which may set only some of its keys."""
        own = {key: value for key, value in variant.set.items() if key in self.keys}
        if not own:
            return self.base
        changes = _new(own, known)
        found = (level for level in (self.base, *self.levels) if _same_changes(level.changes, changes))
        value = _called(*own.values()) if len(self.keys) == 1 else BASE
        return next(found, Level(variant.name if value == BASE else value, changes))


@dataclass(frozen=True, slots=True)
class Planned:
    """A variant as it is to be run: what it changes of the files by whole keys, and its folder under ``runs``."""

    variant: Variant
    changes: Mapping[str, Any]
    folder: str


@dataclass(frozen=True, slots=True)
class Plan:
    """All variants of a study, the base first, and the aspects that make them."""

    aspects: tuple[Aspect, ...]
    variants: tuple[Planned, ...]


def expanded(study: Study, known: Known) -> Plan:
    """Variants of a study; ``known`` gives the value that vehicle and case have under a whole key.

    Raises
    ------
    CaseError : names that are ambiguous, variants that are there twice
    """
    aspects = list(_aspects(study, known))
    refuse(CaseError, _clashes(study, aspects))
    made = list(_combined(study, aspects))
    made += [_variant(aspects, [a.level_of(one, known) for a in aspects], one.name) for one in study.variant]
    refuse(CaseError, _twice(study, made))
    folders = folder_names([variant.name for variant, _ in made])
    planned = (Planned(*one, folder) for one, folder in zip(made, folders, strict=True))
    return Plan(tuple(aspects), tuple(planned))


def _aspects(study: Study, known: Known) -> Iterator[Aspect]:
    """What [[vary]] tables say, then the keys that only variants stated by themselves set."""
    for number, vary in enumerate(study.vary, 1):
        where = f"vary[{number}]"
        keys = frozenset(key for one in vary.given for key in one)
        levels = []
        for place, changes in enumerate(vary.given):
            setting = vary.labels[place] if vary.labels else next(iter(changes.values()))
            levels.append(Level(setting, _new(changes, known)))
        base = next((level for level in levels if not level.changes), None)
        if (vary.key or "").startswith("own."):
            base = _own_base(vary.key or "", vary.base, levels)
        elif base is None and study.combine == "full":
            base = levels[0]
        elif base is None:
            base = Level(_called(known(vary.key)) if vary.key and not vary.labels else BASE)
        yield Aspect(where, vary.short_name, keys, base, tuple(levels))
    there = {key for vary in study.vary for one in vary.given for key in one}
    others = [(f"variant[{n}]", key) for n, one in enumerate(study.variant, 1) for key in one.set if key not in there]
    for where, key in {key: (where, key) for where, key in reversed(others)}.values():
        values = [one.set[key] for one in study.variant if key in one.set]
        levels = [Level(_called(value), _new({key: value}, known)) for value in values]
        base = Level(BASE) if key.startswith("own.") else Level(_called(known(key)))
        yield Aspect(where, short_name(key), frozenset([key]), base, tuple(levels))


def _new(changes: Set, known: Known) -> Set:
    """Of some changes those that differ from what the files have."""
    return {key: value for key, value in changes.items() if key.startswith("own.") or not same_value(value, known(key))}


def _own_base(key: str, given: object, levels: Sequence[Level]) -> Level:
    """The base of a key that no file has: the value given for it, else the first of its values."""
    if given is None:
        return levels[0]
    same = (level for level in levels if same_value(level.changes[key], given))
    return next(same, Level(_called(given), {key: given}))


def _called(value: Any) -> Setting:
    """A value as a setting; a list or a table, and nothing at all, have no name but that of the base."""
    return value if isinstance(value, float | int | str | bool) else BASE


def _combined(study: Study, aspects: Sequence[Aspect]) -> Iterator[tuple[Variant, Set]]:
    """The base, and what [[vary]] tables make of it."""
    varied = aspects[: len(study.vary)]
    base = [aspect.base for aspect in aspects]
    yield _variant(aspects, base)
    others = [[level for level in aspect.levels if level != aspect.base] for aspect in varied]
    if study.combine == "full":
        full = itertools.product(*([aspect.base, *rest] for aspect, rest in zip(varied, others, strict=True)))
        for levels in itertools.islice(full, 1, None):
            yield _variant(aspects, [*levels, *base[len(varied) :]])
        return
    for place, rest in enumerate(others):
        for level in rest:
            yield _variant(aspects, [*base[:place], level, *base[place + 1 :]])


def _variant(aspects: Sequence[Aspect], levels: Sequence[Level], name: str = "") -> tuple[Variant, Set]:
    """A variant with one value of each aspect; named for what differs from the base where it has no name."""
    pairs = list(zip(aspects, levels, strict=True))
    differing = [f"{a.name}={shown(level.setting)}" for a, level in pairs if level != a.base]
    settings = {aspect.name: level.setting for aspect, level in pairs}
    changes = {key: value for _, level in pairs for key, value in level.changes.items()}
    return Variant(name or ", ".join(differing) or BASE, settings), changes


def _clashes(study: Study, aspects: Sequence[Aspect]) -> Iterator[Problem]:
    """Refusals of a short name, or a key, of two aspects."""
    for place, aspect in enumerate(aspects):
        where = f"{study.path.name}: {aspect.where}"
        for other in aspects[:place]:
            if both := sorted(aspect.keys & other.keys):
                what = f"{both[0]!r} is varied by {other.where} already"
                yield Problem("duplicate", where, what, "Vary each key in one place")
            elif aspect.name == other.name:
                keys = " and ".join(map(repr, sorted(aspect.keys)))
                what = f"{keys} would be called {aspect.name!r} as {other.where} is"
                yield Problem("duplicate", f"{where}.name", what, "Give a [[vary]] with a name of its own")


def _twice(study: Study, made: Sequence[tuple[Variant, Set]]) -> Iterator[Problem]:
    """Refusals of variants with one name, and of those that change the same as another one."""
    first = len(made) - len(study.variant)
    for place, (variant, changes) in enumerate(made):
        where = f"{study.path.name}: variant[{place - first + 1}]"
        for other, others in made[:place] if place >= first else ():
            if other.name == variant.name:
                yield Problem("duplicate", f"{where}.name", f"{variant.name!r} is a variant already", "Rename it")
            elif _same_changes(changes, others):
                what = f"{variant.name!r} sets what variant {other.name!r} has already"
                yield Problem("duplicate", where, what, "Remove one of them")


def _same_changes(one: Set, other: Set) -> bool:
    return one.keys() == other.keys() and all(same_value(one[key], other[key]) for key in one)
