"""Solid elements on NASTRAN and OptiStruct cards."""

from dataclasses import dataclass

from fatigue.errors import DataError, Problem
from fatigue.readers.foreign.fe.model import Solid
from fatigue.readers.foreign.nastran.deck.card import Card


@dataclass(frozen=True, slots=True)
class _Layout:
    """Corners and mid-side grids of a solid card, which follow its id and property."""

    corners: int
    mids: int


SOLIDS = {"CHEXA": _Layout(8, 12), "CPENTA": _Layout(6, 9), "CTETRA": _Layout(4, 6)}
"""Layouts of the solid cards that are read, by card name; NASTRAN lists the mid-side grids as ``SolidMesh`` does."""

_SPARE = 8
"""Further fields that some solvers have behind the grids (OptiStruct: CORDM); what stands there is told."""


def solid(card: Card) -> Solid:
    """Solid of a card; mid-side grids that are blank or left out altogether are 0.

    Raises
    ------
    DataError : a bad field, or more fields than the card has
    """
    layout = SOLIDS[card.name]
    last = 2 + layout.corners + layout.mids
    card.no_more_than(last + (_SPARE if card.text(last).upper() == "CORDM" else 0))
    element = card.integer(0)
    mids = []
    for at in range(2 + layout.corners, last):
        if card.text(at).upper() == "CORDM":  # OptiStruct: the material system, from here on no grids
            break
        mids.append(card.integer(at, 0))
    if any(n < 0 for n in mids):
        what = f"{card.name} {element} has the mid-side grid {min(mids)}"
        raise DataError(Problem("bad_field", card.where, what, "Correct the card"))
    mids += [0] * (layout.mids - len(mids))
    corners = tuple(card.integer(2 + k) for k in range(layout.corners))
    return Solid(element, card.integer(1, element), corners, tuple(mids) if any(mids) else ())
