"""Words of the page by their English ones: whole texts, and patterns in which ``{}`` stands for a name or a number."""

import re
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from importlib.resources import files
from typing import Any

_ROOM = files("fatigue.report.language")
_HOLE = re.compile(r"\\{\\}")


@dataclass(frozen=True, slots=True)
class Language:
    """A language: its ``tag`` as HTML has it, its words by the English ones, and patterns for composed texts."""

    tag: str
    words: Mapping[str, str] = field(default_factory=dict)
    patterns: tuple[tuple[re.Pattern[str], str], ...] = ()

    def __call__(self, english: str, **given: Any) -> str:
        """Text in this language; ``given`` stands where the text has its name in braces.

        >>> ENGLISH("{n} of {m} welds", n=2, m=14)
        '2 of 14 welds'
        """
        text = self.translated(english)
        english_text = english if text is None else text
        return english_text.format(**given) if given else english_text

    def translated(self, english: str) -> str | None:
        """The text in this language, None where it has none; English has none of its own."""
        if english in self.words:
            return self.words[english]
        for pattern, text in self.patterns:
            if found := pattern.fullmatch(english):
                return text.format(*found.groups())
        return None


ENGLISH = Language("en")


def languages() -> tuple[str, ...]:
    """Codes of all languages that there are words for, English first."""
    return (
        "en",
        *sorted(entry.name.removesuffix(".toml") for entry in _ROOM.iterdir() if entry.name.endswith(".toml")),
    )


@lru_cache
def language_named(code: str | None) -> Language:
    """Language of this code; the code is one of ``languages``."""
    if code in (None, "en"):
        return ENGLISH
    tables = tomllib.loads((_ROOM / f"{code}.toml").read_text(encoding="utf-8"))
    return Language(str(code), dict(tables["words"]), tuple(_compiled(tables["patterns"])))


def _compiled(patterns: Mapping[str, str]) -> Iterator[tuple[re.Pattern[str], str]]:
    """Patterns in which every ``{}`` of the English text stands for what the text in another language has by number."""
    for english, text in patterns.items():
        yield re.compile(_HOLE.sub("(.*?)", re.escape(english)), re.DOTALL), text
