"""Texts with settings in braces, as commands and patterns of files have them."""

import string
from collections.abc import Mapping
from pathlib import Path

from fatigue.errors import DataError, Problem
from fatigue.study.variants.source.made import Asked
from fatigue.study.variants.varied.names import shown


def names_in(text: str) -> set[str]:
    """Names of the placeholders of a text."""
    return {name for _, name, _, _ in string.Formatter().parse(text) if name is not None}


def values_of(asked: Asked, study: Path, run: Path | None = None) -> dict[str, object]:
    """What every placeholder stands for: the settings, and those of every study."""
    own: dict[str, object] = {"seed": asked.seed, "event": asked.event, "study": str(study)}
    return dict(asked.settings) | own | ({} if run is None else {"run": str(run)})


def filled(text: str, values: Mapping[str, object]) -> str:
    """Text with its placeholders replaced; a number without a format of its own as names have it.

    Raises
    ------
    DataError : a format that a value does not have

    >>> filled("sim/{contact}_{speed}_{seed:03d}.csv", {"contact": "worn", "speed": 350.0, "seed": 7})
    'sim/worn_350_007.csv'
    """
    try:
        return _Plain().vformat(text, (), values)
    except (ValueError, LookupError, AttributeError, TypeError) as error:
        what = f"{text!r} cannot be filled in ({error})"
        raise DataError(Problem("bad_placeholder", "source", what, "Correct the format behind the colon")) from None


class _Plain(string.Formatter):
    """Formats a value without a format as names show it."""

    def format_field(self, value: object, format_spec: str) -> str:
        return format(value, format_spec) if format_spec else shown(value)
