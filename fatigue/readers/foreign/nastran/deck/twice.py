"""Whether two NASTRAN cards of one id say the same, in whatever form their numbers are written."""

import re

from fatigue.errors import DataError
from fatigue.readers.foreign.nastran.deck.card import Card

_DIGITS = re.compile(r"[+-]?(\d*)\.?(\d*)(?:[ED]?([+-]?\d+))?\Z", re.IGNORECASE | re.ASCII)
_FULL = 6  # characters; a shorter number was not cut to fit its field


def same_card(a: Card, b: Card) -> bool:
    """Whether all fields are equal, numbers by their value."""
    return a.name == b.name and all(_same_field(a, b, at) for at in range(max(len(a.fields), len(b.fields))))


def _same_field(a: Card, b: Card, at: int) -> bool:
    if a.text(at).upper() == b.text(at).upper():
        return True
    try:
        return a.real(at) == b.real(at)
    except DataError:
        return False


def same_grid(a: Card, b: Card, cp: int, cd: int) -> Card | None:
    """The GRID written with more digits, if both are the same point in the same systems to the digits written.

    ``cp`` and ``cd`` are the systems of grids that name none. Blank coordinates are 0.0; constraints do not count.
    """
    if a.integer(1, cp) != b.integer(1, cp) or a.integer(5, cd) != b.integer(5, cd):
        return None
    finer = a
    for at in (2, 3, 4):
        x, y = a.real(at, 0.0), b.real(at, 0.0)
        if x == y:
            continue
        coarse, fine = sorted((a, b), key=lambda card: _step(card.text(at)), reverse=True)
        if len(coarse.text(at)) < _FULL or abs(x - y) > 0.500001 * _step(coarse.text(at)):
            return None
        finer = fine
    return finer


def _step(text: str) -> float:
    """Value of one unit in the last digit written."""
    found = _DIGITS.match(text)
    return 10.0 ** (int(found[3] or 0) - len(found[2])) if found else 0.0
