"""Node sets of a NASTRAN or OptiStruct deck: SET of case control, SET1, SET3 and SET of bulk data."""

import re

from fatigue.errors import DataError, Problem
from fatigue.readers.foreign.nastran.deck.card import Card
from fatigue.readers.foreign.nastran.deck.lines import Line, place

_SET = re.compile(r"SET\s+(\d{1,9})\s*=\s*(.*)\Z", re.ASCII | re.DOTALL)
_LARGEST = 10_000_000
_NODES = ("GRID", "POINT", "NODE")


def case_sets(lines: list[Line]) -> tuple[dict[int, list[int]], list[Problem]]:
    """Integer SETs of case control, ``SET 5 = 1, 2 THRU 9 EXCEPT 6, 20``; other sets are left out.

    Returns the sets, and a warning for each id that subcases define differently (the last holds).
    """
    text, where = "", ""
    sets: dict[int, list[int]] = {}
    warnings = []
    for source, number, raw in lines:
        line = raw.strip()
        where = where if text else place(source, number)
        text = f"{text} {line}" if text else line
        if text.endswith(","):
            continue
        if found := _SET.match(text.upper()):
            members = set_members(re.findall(r"[^\s,]+", found[2]))
            if members is not None:
                key = int(found[1])
                if key in sets and sorted(sets[key]) != sorted(members):
                    warnings.append(_redefined(key, where))
                sets[key] = members
        text = ""
    return sets, warnings


def joined_sets(on_cards: dict[int, list[int]], control: list[Line]) -> tuple[dict[int, list[int]], list[Problem]]:
    """Sets of bulk data and of case control, which wins; and warnings about ids that are defined differently."""
    sets, warnings = case_sets(control)
    for key in sorted(on_cards.keys() & sets.keys()):
        if sorted(on_cards[key]) != sorted(sets[key]):
            warnings.append(_redefined(key, f"{control[0][0]}, case control"))
    return on_cards | sets, warnings


def _redefined(key: int, where: str) -> Problem:
    return Problem(
        "set_twice", where, f"SET {key} is defined again with other members, which are taken", "Use SETs of unique ids"
    )


def set_on_card(sets: dict[int, list[int]], card: Card) -> list[Problem]:
    """Keep the grids of a SET1, SET3 or SET card; sets of anything else are left out.

    Returns a warning where the set cannot be read or its id has other members already (the last holds).
    """
    if card.name == "SET1":
        words = card.fields[1:]
    elif card.name == "SET3":
        words = card.fields[2:] if card.text(1).upper() in _NODES else ()
    else:  # OptiStruct: the list begins with the second line
        words = card.fields[8:] if card.text(1).upper() in _NODES and card.text(2).upper() in ("LIST", "") else ()
    members = set_members([word.upper() for word in words if word])
    if not words or members == []:
        return []
    try:
        key = card.integer(0)
    except DataError as error:
        return [Problem("no_set", p.where, f"{p.what}; the set is left out", p.remedy) for p in error.problems]
    if members is None:
        what = f"{card.name} {key} is no list of grids; it is left out"
        return [Problem("no_set", card.where, what, "Write ids, THRU and EXCEPT")]
    warnings = [_redefined(key, card.where)] if key in sets and sorted(sets[key]) != sorted(members) else []
    sets[key] = members
    return warnings


def set_members(words: list[str]) -> list[int] | None:
    """Ids of ``1 2 THRU 9 BY 2 EXCEPT 6 THRU 7``; None where something else stands, or a range of over ten million."""
    members: list[int] = []
    at = 0
    excluding = False
    last: range | None = None
    while at < len(words):
        word = words[at]
        if word in ("EXCEPT", "ENDTHRU"):
            excluding, at = word == "EXCEPT", at + 1
            continue
        if not _is_id(word):
            return None
        ids, at = _range(words, at)
        if ids is None:
            return None
        if excluding and last is not None and ids[0] in last:
            gone = set(ids)
            members = [n for n in members if n not in gone]
        else:
            excluding = False
            members += ids
            last = ids if len(ids) > 1 else last
    return members


def _range(words: list[str], at: int) -> tuple[range | None, int]:
    """Ids that begin at a word, one or ``THRU`` many, and the place after them; None where the range is no range."""
    first = int(words[at])
    if words[at + 1 : at + 2] != ["THRU"]:
        return range(first, first + 1), at + 1
    if at + 2 >= len(words) or not _is_id(words[at + 2]):
        return None, at
    last, step, after = int(words[at + 2]), 1, at + 3
    if words[after : after + 1] == ["BY"]:
        if after + 1 >= len(words) or not _is_id(words[after + 1]) or int(words[after + 1]) == 0:
            return None, at
        step, after = int(words[after + 1]), after + 2
    ids = range(first, last + 1, step)
    return (ids if 0 < len(ids) <= _LARGEST else None), after


def _is_id(word: str) -> bool:
    return word.isascii() and word.isdigit() and len(word) < 10
