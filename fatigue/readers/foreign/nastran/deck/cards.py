"""Lines of NASTRAN bulk data to cards: small, large and free fields, and continuations in any order."""

import re
from collections.abc import Container, Iterable, Iterator
from dataclasses import dataclass, field

from fatigue.errors import DataError, Problem
from fatigue.readers.foreign.nastran.deck.card import Card
from fatigue.readers.foreign.nastran.deck.fields import FREE, ROW, Split, split_commas, split_line
from fatigue.readers.foreign.nastran.deck.lines import Line, place
from fatigue.readers.foreign.nastran.deck.notes import LeftOut
from fatigue.readers.foreign.nastran.deck.replication import repeats, replicated

_NAME = re.compile(r"[A-Z][A-Z0-9_]*\Z", re.ASCII)
_WORDS = ("THRU", "BY", "EXCEPT", "ENDTHRU", "ALL", "YES", "NO", "SYM")  # may begin a line after one that goes on


@dataclass(slots=True)
class _Open:
    """A card that may go on, or stray continuation lines, without a name and kept as ``lines``.

    ``announced`` is the mark of field 10; ``unsure`` a number such as ``+1.`` in its place, which is data unless a
    continuation follows; ``flows`` tells that the last line ended in a comma, ``start`` and ``width`` where the fields
    of the last line begin and how many its form has. ``pattern`` is the replicating line that made the card.
    """

    name: str
    source: str
    line: int
    wanted: bool
    fields: list[str] = field(default_factory=list)
    announced: str = ""
    unsure: str = ""
    unread: str = ""
    flows: bool = False
    start: int = 0
    width: int = ROW
    pattern: list[str] | None = None
    lines: list[Split] = field(default_factory=list)

    def card(self) -> Card:
        """Close the card."""
        data = [*self.fields, self.unsure] if self.unsure else self.fields
        return Card(self.name, tuple(data), self.source, self.line)

    def complete(self) -> None:
        """Fill the last line with empty fields, as a continuation begins a line of its own."""
        length = len(self.fields) - self.start
        self.fields += [""] * (max(self.width, -(-length // self.width) * self.width) - length)
        self.unsure = ""


@dataclass(slots=True)
class _Joining:
    """Cards on their way: the one that may go on, those that wait for continuations, stray continuations, done ones."""

    wanted: Container[str]
    left_out: LeftOut
    problems: list[Problem]
    now: _Open | None = None
    waiting: dict[str, list[_Open]] = field(default_factory=dict)
    strays: dict[str, list[tuple[_Open, Problem | None]]] = field(default_factory=dict)
    done: list[Card] = field(default_factory=list)

    def open(self, card: _Open) -> None:
        """Close the card before, and begin one."""
        self.close()
        self.now = card
        if not card.wanted:
            self.left_out.add(card.name, card.source, card.line)

    def close(self) -> None:
        """Give the card, unless it announces a continuation that must be looked for."""
        now = self.now
        if now is None or not now.name:
            return
        self.leave_unread(now)
        if now.announced[1:]:
            self.waiting.setdefault(now.announced[1:], []).extend([now] if now.wanted else [])
        elif now.wanted:
            self.done.append(now.card())

    def leave_unread(self, now: _Open) -> None:
        """Note text behind the fields of a line that turned out to be no mark."""
        if now.unread and now.wanted:
            self.left_out.first_unread = self.left_out.first_unread or place(now.source, now.line)
            self.left_out.unread += 1
        now.unread = ""


def cards(lines: Iterable[Line], wanted: Container[str], left_out: LeftOut, problems: list[Problem]) -> Iterator[Card]:
    """Join lines and their continuations to cards; those not wanted are counted, whatever they hold.

    Named continuations may stand anywhere, as NASTRAN allows. What cannot be read goes to ``problems``.
    """
    joining = _Joining(wanted, left_out, problems)
    for source, number, text in lines:
        line = text.expandtabs(8) if "\t" in text else text
        head = (line.split(",", 1)[0] if "," in line[:FREE] else line[:8]).strip().upper()
        now = joining.now
        if not head or head[0] in "+*":
            _continuation(joining, head, line, (source, number))
        elif head[0] == "=" and now is not None and now.name:
            _replication(joining, now, head, split_line(line), (source, number))
        elif now is not None and now.flows and (not _NAME.match(head.rstrip("* ")) or head in _WORDS):
            _flow(now, line)
        elif name := _name(joining, head, source, number):
            card = _Open(name, source, number, name in wanted)
            joining.open(card)
            _begin(card, split_line(line))
        if joining.done:
            yield from joining.done
            joining.done.clear()
    joining.close()
    _rejoin(joining)
    yield from joining.done


def _name(joining: _Joining, head: str, source: str, number: int) -> str:
    """Name the card that begins here, or none, which is a problem unless the line belongs to a card nobody needs."""
    name = head.rstrip("* ")
    if _NAME.match(name):
        return name
    first, now = (name.split() or [""])[0], joining.now
    if first not in joining.wanted and _NAME.match(first):
        return first
    if now is not None and not now.wanted and first not in joining.wanted:
        joining.left_out.add(now.name, source, number)
    else:
        remedy = "Write fields in columns of 8 or 16, or with commas; a line after a comma at the end goes on"
        joining.problems.append(Problem("bad_card", place(source, number), f"{head!r} is no card name", remedy))
    return ""


def _continuation(joining: _Joining, head: str, line: str, at: tuple[str, int]) -> None:
    """Add a line to its card, or keep it until its card is found.

    One with a name belongs to the card that announces it, and after a card that announces none to that card.
    """
    now, name = joining.now, head[1:]
    if now is None or (name and name != now.announced[1:] and (now.announced[1:] or name in joining.waiting)):
        joining.close()
        stray = _Open("", *at, wanted=True)
        joining.strays.setdefault(name, []).append((stray, _stray(head, now, place(*at))))
        joining.now = now = stray
    elif now.unread:
        if name and now.unread[1:8].upper() == name:
            now.unread = ""  # a mark without its +
        joining.leave_unread(now)
    _go_on(now, split_line(line), joining.problems)


def _stray(head: str, now: _Open | None, where: str) -> Problem | None:
    """Name what is wrong if no card announces this continuation; nothing if it follows a card nobody needs."""
    if now is None:
        return Problem("stray_line", where, "a continuation without a card before it", "Remove it")
    if not now.wanted or not now.announced:
        return None
    what = f"continuation {head} follows a card that announces {now.announced}, and no card announces it"
    return Problem("continuation_order", where, what, "Write every continuation straight after its card")


def _begin(now: _Open, split: Split) -> None:
    if now.wanted:
        now.fields, now.width, now.unsure, now.unread = split.data, split.width, split.unsure, split.unread
    now.announced, now.flows = split.mark, split.flows


def _go_on(now: _Open, split: Split, problems: list[Problem]) -> None:
    """Add a continuation line; half a line of large fields must be followed by its other half."""
    if not now.name:
        now.lines.append(split)
    elif now.wanted:
        now.complete()
        now.start, now.width, now.unsure, now.unread = (
            len(now.fields),
            split.width,
            split.unsure,
            split.unread,
        )
        if split.width == ROW and now.start % ROW and any(split.data):
            where = place(now.source, now.line)
            what = f"a line of small fields follows half a line of large ones of this {now.name}"
            problems.append(Problem("half_line", where, what, "Begin the other half with *"))
        now.fields += split.data
    now.announced, now.flows = split.mark, split.flows


def _flow(now: _Open, line: str) -> None:
    """Add a line that follows one with a comma at its end: its first field is data, too."""
    split = split_commas(["", *line.split(",")])
    if not now.name:
        before = now.lines.pop()
        now.lines.append(split._replace(data=before.data + split.data, width=before.width))
    elif now.wanted:
        now.fields += split.data
        now.unsure = split.unsure
    now.announced, now.flows = split.mark, split.flows


def _replication(joining: _Joining, before: _Open, head: str, split: Split, at: tuple[str, int]) -> None:
    """Open the cards that a replicating line makes of the card before it."""
    count = repeats(head)
    times = 1 if count is None else count
    if not before.wanted:
        for _ in range(times):
            joining.open(_Open(before.name, *at, wanted=False))
        return
    pattern = split.data if count is None else before.pattern
    try:
        if pattern is None or before.announced[1:]:
            what = "repeats no line with =" if pattern is None else "the card before has several lines"
            raise DataError(Problem("replication", place(*at), f"{head!r}: {what}", "Write the cards out"))
        for _ in range(times):
            before = _Open(before.name, *at, wanted=True, fields=replicated(before.fields, pattern, place(*at)))
            before.pattern = pattern
            joining.open(before)
    except DataError as error:
        joining.problems += error.problems


def _rejoin(joining: _Joining) -> None:
    """Give the cards whose continuations stand elsewhere, or nowhere."""
    waiting, strays, problems = joining.waiting, joining.strays, joining.problems
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
            joining.leave_unread(now)
            joining.done.append(now.card())
    problems += [problem for found in strays.values() for _, problem in found if problem]
