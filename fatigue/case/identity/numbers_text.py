"""The text of a case without its table ``[report]``: what the numbers of a result depend on.

A new revision of a report must not make new numbers. A case with that table therefore stands in the hash of its result
as it would without it, to the letter where the table is written as one: lines from ``[report]`` to the next table.
"""

import json
import re
import tomllib

_TABLE = re.compile(r"[ \t]*\[[ \t]*report[ \t]*\][ \t]*(?:#.*)?")
_ANY_TABLE = re.compile(r"[ \t]*\[")


def numbers_text(text: str) -> str:
    r"""Text of a case without ``[report]``; a text without that table as it is.

    Where the table is written in another way (``report.author = ``, ``report = {...}``) keys and values stand for the
    text, in one order.

    >>> numbers_text('title = "A"\n\n[report]\nauthor = "B"\n')
    'title = "A"\n'
    """
    try:
        case = tomllib.loads(text)
    except (ValueError, RecursionError):  # refused elsewhere, with its place
        return text
    if "report" not in case:
        return text
    del case["report"]
    cut = _without_lines(text)
    try:
        if tomllib.loads(cut) == case:
            return cut
    except ValueError:
        pass
    return json.dumps(case, sort_keys=True, default=repr)


def _without_lines(text: str) -> str:
    """The text without the lines of the table, and without the blank one before it where it is the last."""
    lines = text.splitlines(keepends=True)
    first = next((i for i, line in enumerate(lines) if _TABLE.fullmatch(line.rstrip("\r\n"))), len(lines))
    end = next((i for i in range(first + 1, len(lines)) if _ANY_TABLE.match(lines[i])), len(lines))
    if end == len(lines) and first > 0 and not lines[first - 1].strip():
        first -= 1
    return "".join(lines[:first] + lines[end:])
