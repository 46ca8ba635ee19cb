"""Warnings by what the reader has to do about them, each with its code."""

import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from importlib.resources import files
from typing import Any

LONGEST_PLACE = 20_000  # letters of the place of a warning: a warning about many welds names them all
UNKNOWN = "judge"  # group of a code that is in none


@dataclass(frozen=True, slots=True)
class Kind:
    """Warnings of one code: how many, the ``entries`` that tell them, and the ``id`` of their place on the page."""

    id: str
    code: str
    count: int
    entries: list[Mapping[str, Any]]

    @property
    def name(self) -> str:
        """The code in words."""
        return self.code.replace("_", " ")

    @property
    def others(self) -> int:
        """How many there are beside the first entry."""
        return self.count - int(self.entries[0].get("count", 1))


@dataclass(frozen=True, slots=True)
class Group:
    """Warnings about which the reader has to do the same, with the meaning of the group."""

    title: str
    meaning: str
    kinds: list[Kind]


@lru_cache
def group_of_code() -> Mapping[str, str]:
    """Group of every warning that a report may show, by its code."""
    return {code: name for name, table in _tables().items() for code in table["codes"]}


def grouped(warnings: Sequence[Mapping[str, Any]]) -> list[Group]:
    """Warnings in their groups, the groups in the order of the file, the codes in the order in which they came."""
    kinds: dict[str, list[Mapping[str, Any]]] = {}
    for warning in warnings:
        kinds.setdefault(warning["code"], []).append({**warning, "where": _shortened(warning["where"])})
    of_group: dict[str, list[Kind]] = {name: [] for name in _tables()}
    for code, entries in kinds.items():
        count = sum(int(entry.get("count", 1)) for entry in entries)
        of_group[group_of_code().get(code, UNKNOWN)].append(Kind(f"warnings-{code}", code, count, entries))
    return [
        Group(_tables()[name]["title"], _tables()[name]["meaning"], kinds) for name, kinds in of_group.items() if kinds
    ]


@lru_cache
def _tables() -> Mapping[str, Any]:
    text = (files("fatigue.report.sections.evidence") / "warning_groups.toml").read_text(encoding="utf-8")
    return tomllib.loads(text)


def _shortened(place: str) -> str:
    """Place of a warning, a long list of welds cut behind one of them."""
    if len(place) <= LONGEST_PLACE:
        return place
    return f"{place[:LONGEST_PLACE].rpartition(', ')[0]} and others, see provenance.json"
