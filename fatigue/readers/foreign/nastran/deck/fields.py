"""One line of NASTRAN bulk data in fields: small, large or free."""

from typing import NamedTuple

from fatigue.readers.foreign.nastran.deck.numbers import is_number

FREE = 10
"""A comma in the first 10 columns makes a line free-field."""
ROW = 8
"""Data fields in a line of small fields."""


class Split(NamedTuple):
    """A line in fields: the data, the mark of field 10, and the number of data fields its form has in a line.

    ``unsure`` is a number such as ``+1.`` in the place of the mark, which is data unless a continuation follows;
    ``flows`` tells that the line ends in a comma; ``unread`` is text behind the data that is no mark.
    """

    data: list[str]
    mark: str
    width: int
    unsure: str = ""
    flows: bool = False
    unread: str = ""


def split_line(line: str) -> Split:
    """Cut a line in fields: 8 of 8 columns, 4 of 16 if its first field has a ``*``, or with commas."""
    if "," in line[:FREE]:
        return split_commas(line.split(","))
    size = 16 if "*" in line[:8] else 8
    data = [line[k : k + size].strip() for k in range(8, min(len(line), 72), size)]
    if len(line) <= 72:
        return Split(data, "", 64 // size)
    mark = line[72:80].strip().upper()
    if mark[:1] in ("+", "*"):
        return Split(data, mark, 64 // size, unread=line[80:].strip())
    return Split(data, "", 64 // size, unread=line[72:].strip())


def split_commas(parts: list[str]) -> Split:
    """Cut a comma line in fields; NASTRAN reads on where it holds more than a line has, without a mark in field 10.

    A mark between them (``..,+A,+A,..``) is field 10 and field 1 of the next line; a comma at the end is none.
    """
    head = parts[0].strip()
    width = 4 if head.startswith("*") or head.endswith("*") else ROW
    body = [part.strip() for part in parts[1:]]
    if head.startswith("="):
        return Split(body, "", width)  # a replicating line, whose * are increments
    flows = bool(body) and not body[-1]
    if flows:
        body.pop()
    mark = unsure = ""
    if body and _is_mark(body[-1]):
        mark, flows = body.pop().upper(), False
    elif len(body) == width + 1 and body[-1][:1] == "+" and not flows:
        mark = body.pop().upper()
        unsure = "" if mark[1:].isdigit() else mark
    at = width
    while at < len(body):
        if at + 1 < len(body) and _is_mark(body[at]) and (not body[at + 1] or _is_mark(body[at + 1])):
            del body[at : at + 2]
        at += width
    return Split(body, mark, width, unsure, flows)


def _is_mark(text: str) -> bool:
    return text[:1] in ("+", "*") and not is_number(text)
