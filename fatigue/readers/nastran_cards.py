"""Lines of NASTRAN bulk data to cards: small, large and free fields, and continuations in any order."""

import re
from collections.abc import Container, Iterable, Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

from fatigue.errors import DataError, Problem
from fatigue.readers.nastran_lines import Line, place

_REAL = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[ED]?[+-]?\d+)?\Z", re.ASCII)
_EXPONENT = re.compile(r"(?<=[\d.])[ED]?([+-]\d+)\Z|(?<=[\d.])[ED](\d+)\Z", re.ASCII)
_NAME = re.compile(r"[A-Z][A-Z0-9_]*\Z", re.ASCII)
_WORDS = ("THRU", "BY", "EXCEPT", "ENDTHRU", "ALL", "YES", "NO", "SYM")  # may begin a line after one that goes on
_FREE = 10  # a comma in these columns makes a line free-field
_ROW = 8  # data fields in a line of small fields


@dataclass(frozen=True, slots=True)
class Card:
    """One bulk data card: its upper-case name, its data fields (field 2 first), and the file and line it begins in."""

    name: str
    fields: tuple[str, ...]
    source: str
    line: int

    @property
    def where(self) -> str:
        """Its place, for messages."""
        return place(self.source, self.line)

    def text(self, at: int) -> str:
        """Field ``at``, empty if the card ends before."""
        return self.fields[at] if at < len(self.fields) else ""

    def integer(self, at: int, default: int | None = None) -> int:
        """Whole number in field ``at``; an empty field takes the default."""
        text = self.fields[at] if at < len(self.fields) else ""
        digits = text[1:] if text[:1] in ("+", "-") else text
        if digits.isdigit() and digits.isascii() and len(digits) < 17:
            return int(text)
        if not text and default is not None:
            return default
        raise self._bad(at, text, "a whole number")

    def real(self, at: int, default: float | None = None) -> float:
        """Real number in field ``at``, in any NASTRAN spelling such as ``2.9+7``; an empty field takes the default."""
        text = self.text(at)
        if not text and default is not None:
            return default
        try:
            value = float(text)
        except ValueError:
            value = self._nastran_real(at, text.upper())
        if not abs(value) < 1e100 or "_" in text or not text.isascii():
            raise self._bad(at, text, "a number of sensible size")
        return value

    def _nastran_real(self, at: int, text: str) -> float:
        """Read ``2.9+7`` and ``1.D3``, which only FORTRAN understands."""
        if not _REAL.match(text):
            raise self._bad(at, text, "a number")
        return float(_EXPONENT.sub(lambda m: "E" + (m[1] or m[2]), text))

    def no_more_than(self, count: int) -> None:
        """Refuse data in fields that the card does not have.

        Raises
        ------
        DataError : a field after the first ``count`` is not empty
        """
        for at in range(count, len(self.fields)):
            if self.fields[at]:
                raise DataError(
                    Problem(
                        "too_many_fields",
                        self.where,
                        f"{self.name} has {count} data fields, and a further one holds {self.fields[at]!r}",
                        "Correct the card; a comma too many shifts its fields",
                    )
                )

    def _bad(self, at: int, text: str, wanted: str) -> DataError:
        found = (
            f"{self.name} field {at + 2} is {text!r}, not {wanted}" if text else f"{self.name} field {at + 2} is empty"
        )
        remedy = "Correct the card"
        if "," in text:
            remedy += f"; only a comma in the first {_FREE} columns separates fields"
        return DataError(Problem("bad_field", self.where, found, remedy))


@dataclass(slots=True)
class LeftOut:
    """Cards nobody asked for: how many there are of each name, and the place of the first."""

    count: dict[str, int] = field(default_factory=dict)
    first: dict[str, str] = field(default_factory=dict)

    def add(self, name: str, source: str, number: int) -> None:
        """Count one more."""
        if name in self.count:
            self.count[name] += 1
        else:
            self.count[name], self.first[name] = 1, place(source, number)


@dataclass(slots=True)
class _Open:
    """A card that may go on, or stray continuation lines, without a name and kept as ``lines``.

    ``announced`` is the mark of field 10; ``doubtful`` a number such as ``+1.`` in its place, which is data unless a
    continuation follows; ``flows`` tells that the last line ended in a comma, ``start`` and ``width`` where the fields
    of the last line begin and how many its form has.
    """

    name: str
    source: str
    line: int
    wanted: bool
    fields: list[str] = field(default_factory=list)
    announced: str = ""
    doubtful: str = ""
    flows: bool = False
    start: int = 0
    width: int = _ROW
    lines: list["_Split"] = field(default_factory=list)

    def card(self) -> Card:
        """Close the card."""
        data = [*self.fields, self.doubtful] if self.doubtful else self.fields
        return Card(self.name, tuple(data), self.source, self.line)

    def complete(self) -> None:
        """Fill the last line with empty fields, as a continuation begins a line of its own."""
        length = len(self.fields) - self.start
        self.fields += [""] * (max(self.width, -(-length // self.width) * self.width) - length)
        self.doubtful = ""


class _Split(NamedTuple):
    """A line in fields: the data, the mark of field 10, and the number of data fields its form has in a line."""

    data: list[str]
    mark: str
    width: int
    doubtful: str = ""
    flows: bool = False


def cards(lines: Iterable[Line], wanted: Container[str], left_out: LeftOut, problems: list[Problem]) -> Iterator[Card]:
    """Join lines and their continuations to cards; those not wanted are counted, whatever they hold.

    Named continuations may stand anywhere, as NASTRAN allows. What cannot be read goes to ``problems``.
    """
    now: _Open | None = None
    waiting: dict[str, list[_Open]] = {}  # cards whose announced continuation does not follow them
    strays: dict[str, list[tuple[_Open, Problem | None]]] = {}  # continuations that follow another card
    for source, number, text in lines:
        line = text.expandtabs(8) if "\t" in text else text
        head = (line.split(",", 1)[0] if "," in line[:_FREE] else line[:8]).strip().upper()
        if not head or head[0] in "+*":
            if now is None or _is_stray(head[1:], now.announced[1:], waiting):
                problem = _stray(head, now, place(source, number))
                if now:
                    yield from _closed(now, waiting)
                now = _Open("", source, number, wanted=True)
                strays.setdefault(head[1:], []).append((now, problem))
            _go_on(now, _split(line), problems)
            continue
        name = head.rstrip("* ")
        if now is not None and now.flows and (not _NAME.match(name) or name in _WORDS):
            _flow(now, line)
            continue
        if not _NAME.match(name):
            first = name.split()[0] if name else ""
            if first in wanted or not _NAME.match(first):
                if now is not None and not now.wanted and first not in wanted:
                    left_out.add(now.name, source, number)  # another line of a card nobody needs
                else:
                    problems.append(_no_name(head, place(source, number)))
                continue
            name = first
        if now:
            yield from _closed(now, waiting)
        now = _Open(name, source, number, name in wanted)
        if not now.wanted:
            left_out.add(name, source, number)
        _begin(now, _split(line))
    if now:
        yield from _closed(now, waiting)
    yield from _rejoined(waiting, strays, problems)


def _is_stray(name: str, announced: str, waiting: Container[str]) -> bool:
    """Tell whether a named continuation belongs elsewhere; after a card without mark it belongs to that card."""
    return bool(name) and name != announced and (bool(announced) or name in waiting)


def _stray(head: str, now: _Open | None, where: str) -> Problem | None:
    """Name what is wrong if no card announces this continuation; nothing if it follows a card nobody needs."""
    if now is None:
        return Problem("stray_line", where, "a continuation without a card before it", "Remove it")
    if not now.wanted or not now.announced:
        return None
    what = f"continuation {head} follows a card that announces {now.announced}, and no card announces it"
    return Problem("continuation_order", where, what, "Write every continuation straight after its card")


def _begin(now: _Open, split: _Split) -> None:
    if now.wanted:
        now.fields, now.width, now.doubtful = split.data, split.width, split.doubtful
    now.announced, now.flows = split.mark, split.flows


def _go_on(now: _Open, split: _Split, problems: list[Problem]) -> None:
    """Add a continuation line; half a line of large fields must be followed by its other half."""
    if not now.name:
        now.lines.append(split)
    elif now.wanted:
        now.complete()
        now.start, now.width, now.doubtful = len(now.fields), split.width, split.doubtful
        if split.width == _ROW and now.start % _ROW and any(split.data):
            where = place(now.source, now.line)
            what = f"a line of small fields follows half a line of large ones of this {now.name}"
            problems.append(Problem("half_line", where, what, "Begin the other half with *"))
        now.fields += split.data
    now.announced, now.flows = split.mark, split.flows


def _flow(now: _Open, line: str) -> None:
    """Add a line that follows one with a comma at its end: its first field is data, too."""
    split = _free(["", *line.split(",")])
    if not now.name:
        before = now.lines.pop()
        now.lines.append(split._replace(data=before.data + split.data, width=before.width))
    elif now.wanted:
        now.fields += split.data
        now.doubtful = split.doubtful
    now.announced, now.flows = split.mark, split.flows


def _closed(now: _Open, waiting: dict[str, list[_Open]]) -> Iterator[Card]:
    """Give the card, unless it announces a continuation that must be looked for."""
    if now.name and now.announced[1:]:
        waiting.setdefault(now.announced[1:], []).extend([now] if now.wanted else [])
    elif now.name and now.wanted:
        yield now.card()


def _rejoined(
    waiting: dict[str, list[_Open]], strays: dict[str, list[tuple[_Open, Problem | None]]], problems: list[Problem]
) -> Iterator[Card]:
    """Give the cards whose continuations stand elsewhere, or nowhere."""
    for name, opened in waiting.items():
        for now in opened:
            mark = name
            while mark in strays:
                found = strays.pop(mark)
                if len(found) > 1 or len(waiting.get(mark, ())) > 1:
                    where = place(found[-1][0].source, found[-1][0].line)
                    what = f"continuation {mark} and its card cannot be matched, as the name is used again"
                    problems.append(Problem("continuation_twice", where, what, "Write it straight after its card"))
                for split in found[0][0].lines:
                    _go_on(now, split, problems)
                mark = now.announced[1:]
            yield now.card()
    problems += [problem for found in strays.values() for _, problem in found if problem]


def _no_name(head: str, where: str) -> Problem:
    if head[0] == "=":
        what = f"{head!r} is no card name; it repeats the card before it"
        return Problem("replication", where, what, "Write the cards out, without replication")
    remedy = "Write fields in columns of 8 or 16, or with commas; a line after a comma at the end goes on"
    return Problem("bad_card", where, f"{head!r} is no card name", remedy)


def _split(line: str) -> _Split:
    """Cut a line in fields: 8 of 8 columns, 4 of 16 if its first field has a ``*``, or with commas."""
    if "," in line[:_FREE]:
        return _free(line.split(","))
    size = 16 if "*" in line[:8] else 8
    data = [line[k : k + size].strip() for k in range(8, min(len(line), 72), size)]
    mark = line[72:80].strip().upper()
    return _Split(data, mark if mark[:1] in ("+", "*") else "", 64 // size)


def _free(parts: list[str]) -> _Split:
    """Cut a comma line in fields; NASTRAN reads on where it holds more than a line has, without a mark in field 10.

    A mark between them (``..,+A,+A,..``) is field 10 and field 1 of the next line; a comma at the end is none.
    """
    head = parts[0].strip()
    width = 4 if head.startswith("*") or head.endswith("*") else _ROW
    body = [part.strip() for part in parts[1:]]
    flows = bool(body) and not body[-1]
    if flows:
        body.pop()
    mark = doubtful = ""
    if body and _is_mark(body[-1]):
        mark, flows = body.pop().upper(), False
    elif len(body) == width + 1 and body[-1][:1] == "+" and not flows:
        mark = body.pop().upper()
        doubtful = "" if mark[1:].isdigit() else mark
    at = width
    while at < len(body):
        if at + 1 < len(body) and _is_mark(body[at]) and (not body[at + 1] or _is_mark(body[at + 1])):
            del body[at : at + 2]
        at += width
    return _Split(body, mark, width, doubtful, flows)


def _is_mark(text: str) -> bool:
    return text[:1] in ("+", "*") and not _REAL.match(text.upper())
