"""Case files beyond all measure: nested without end, or with integers of thousands of digits."""

import re
from collections.abc import Iterator
from typing import Any

from fatigue.errors import Problem

DEEPEST = 30  # tables and lists in one another; a case has four
LARGEST = 2**63  # TOML 1.0: integers are those of 64 bits
MANY_DIGITS = re.compile(r"\d[\d_]{999,}")


def excess(text: str) -> Problem:
    """Refusal of a text that the parser gave up: the line of an endless number, else too many levels."""
    if found := MANY_DIGITS.search(text):
        line = text.count("\n", 0, found.start()) + 1
        return _too_large(f"line {line}", f"an integer of {len(found.group())} digits")
    depth = [max(map(line.count, "[{.")) for line in text.splitlines()]
    return _too_deep(f"line {depth.index(max(depth, default=0)) + 1 if depth else 1}")


def extreme_values(raw: dict[str, Any]) -> Iterator[Problem]:
    """Refusals of values that nothing could even print: too deep, or integers of more than 64 bits."""
    waiting: list[tuple[str, int, Any]] = [(key, 1, value) for key, value in raw.items()]
    while waiting:
        where, depth, value = waiting.pop()
        if isinstance(value, dict | list):
            if depth > DEEPEST:
                yield _too_deep(f"{where[:40]} ...")
                continue
            inside = value.items() if isinstance(value, dict) else enumerate(value, 1)
            waiting += [(_below(where, key), depth + 1, item) for key, item in inside]
        elif isinstance(value, int) and not -LARGEST <= value < LARGEST:
            yield _too_large(where, f"an integer of {value.bit_length()} bits")


def _below(where: str, key: str | int) -> str:
    return f"{where}[{key}]" if isinstance(key, int) else f"{where}.{key}"


def _too_deep(where: str) -> Problem:
    what = "tables or lists lie in one another without end"
    return Problem("bad_value", where, what, "Write the tables of a case, `fatigue schema` lists them")


def _too_large(where: str, what: str) -> Problem:
    return Problem("bad_value", where, f"{what} is none of TOML, which has 64 bits", "Correct the number")
