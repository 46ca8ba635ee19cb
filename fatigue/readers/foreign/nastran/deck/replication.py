"""Replicated cards of NASTRAN: ``=`` takes a field of the card before, ``*(x)`` adds x to it, ``=(n)`` repeats that."""

import re
from collections.abc import Sequence

from fatigue.errors import DataError, Problem
from fatigue.readers.foreign.nastran.deck.numbers import integer, real

_REPEAT = re.compile(r"=\(?(\d{1,6})\)?\Z", re.ASCII)
_ROW = 8


def repeats(head: str) -> int | None:
    """How often ``=(n)`` or ``=n`` in the first field repeats the pattern before; None for ``=`` itself."""
    found = _REPEAT.match(head)
    return int(found[1]) if found else None


def replicated(before: Sequence[str], pattern: Sequence[str], where: str) -> list[str]:
    """Fields of the next card, from the fields of the card before and the pattern of the replicating line.

    Raises
    ------
    DataError : a card of several lines, a field that cannot be added to, ``%``
    """
    if any(before[_ROW:]):
        raise _problem(where, "the card before has several lines")
    fields: list[str] = []
    for at, word in enumerate(pattern):
        old = before[at] if at < len(before) else ""
        if word == "==":
            return fields + list(before[at:])
        if word == "=":
            fields.append(old)
        elif word.startswith("*"):
            fields.append(_added(old, word[1:].removeprefix("(").removesuffix(")"), where))
        elif word[:1] in ("=", "%"):
            raise _problem(where, f"{word!r} is not known here")
        else:
            fields.append(word)
    return fields


def _added(old: str, step: str, where: str) -> str:
    """Sum of two whole numbers, or of two real ones."""
    try:
        if (first := integer(old)) is not None and (second := integer(step)) is not None:
            return str(first + second)
        return repr(real(old) + real(step))
    except ValueError:
        raise _problem(where, f"{step!r} cannot be added to {old!r}") from None


def _problem(where: str, what: str) -> DataError:
    return DataError(
        Problem("replication", where, f"the replicated card cannot be read: {what}", "Write the cards out")
    )
