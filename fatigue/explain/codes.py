"""The page of a code, made of what is told of warnings by hand and of refusals where they are made."""

import json
import tomllib
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from difflib import get_close_matches
from functools import cache
from importlib.resources import files
from textwrap import fill
from typing import Any

REFUSAL_WHY = (
    "Nothing was computed from it: a refusal comes before any number that could be wrong without being seen. "
    "Exit code 3; 4 where the numbers themselves lost their footing."
)
WIDTH = 100


@dataclass(frozen=True, slots=True)
class Place:
    """Where a code arises: the module of the package, what it says there and what it advises, ``…`` for each value."""

    module: str
    what: str
    remedy: str


@dataclass(frozen=True, slots=True)
class Explanation:
    """The page of one code; ``kind`` is warning of a result, warning of a command, or refusal.

    ``says`` and ``do`` are empty for a refusal that says all of it where it arises.
    """

    code: str
    kind: str
    family: str
    says: str
    why: str
    do: str
    places: tuple[Place, ...]

    def as_record(self) -> dict[str, Any]:
        """All of it, for JSON."""
        return asdict(self)

    def as_text(self) -> str:
        """All of it, for a terminal."""
        head = f"{self.code} ({self.kind}{f': {self.family}' if self.family else ''})"
        arises = "Where it arises:" if self.says else "What it says and what to do, where it arises (… is a value):"
        parts = [head, *self._paragraphs(), arises]
        return "\n\n".join(parts) + "\n" + "\n".join(self._places())

    def _paragraphs(self) -> Iterator[str]:
        for title, text in (("What it means", self.says), ("Why it matters", self.why), ("What to do", self.do)):
            if text:
                yield fill(f"{title}: {text}.".replace("..", "."), WIDTH)

    def _places(self) -> Iterator[str]:
        for module in sorted({place.module for place in self.places}):
            yield f"  fatigue/{module}"
            for place in (place for place in self.places if place.module == module and (place.what or place.remedy)):
                said = ". ".join(text for text in (place.what, place.remedy) if text)
                yield fill(said, WIDTH, initial_indent="    - ", subsequent_indent="      ")


def all_codes() -> dict[str, Explanation]:
    """Every code that the program can tell with its page: warnings of results, of commands, then refusals."""
    return dict(_pages())


def explanation(code: str) -> Explanation:
    """Page of a code; letter case, blanks and hyphens are forgiven.

    Raises
    ------
    KeyError : there is no such code
    """
    return _pages()[_plain(code)]


def near(code: str, most: int = 5) -> list[str]:
    """Codes whose names are like one that there is not: spelt nearly so, or with one of its words."""
    given, names = _plain(code), list(_pages())
    words = {word for word in given.split("_") if len(word) > 2}
    alike = get_close_matches(given, names, n=most, cutoff=0.6)
    return list(dict.fromkeys([*alike, *(name for name in names if words & set(name.split("_")))]))[:most]


def _plain(code: str) -> str:
    return code.strip().strip("`[]").lower().replace("-", "_").replace(" ", "_")


@cache
def _pages() -> dict[str, Explanation]:
    room = files("fatigue.explain")
    told = json.loads(room.joinpath("told.json").read_text(encoding="utf-8"))
    places = {code: tuple(Place(**row) for row in rows) for code, rows in told.items()}
    pages = {}
    for family in tomllib.loads(room.joinpath("warnings.toml").read_text(encoding="utf-8"))["family"]:
        kind = f"warning of a {family['of']}"
        for code, row in family["codes"].items():
            pages[code] = Explanation(
                code, kind, family["name"], row["says"], family["why"], row["do"], places.get(code, ())
            )
    composed = tomllib.loads(room.joinpath("refusals.toml").read_text(encoding="utf-8"))
    for code in sorted(places.keys() - pages.keys()):
        row = composed.get(code, {"says": "", "do": ""})
        pages[code] = Explanation(code, "refusal", "", row["says"], REFUSAL_WHY, row["do"], places[code])
    return pages
