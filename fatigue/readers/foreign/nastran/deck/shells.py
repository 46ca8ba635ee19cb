"""Shell elements and their sections on NASTRAN and OptiStruct cards."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import isnan

import numpy as np

from fatigue.errors import DataError, Problem
from fatigue.readers.foreign.fe.model import Section, Shell
from fatigue.readers.foreign.nastran.deck.card import Card

_THICKNESS_SPREAD = 0.01
_FULL_BENDING = 1.0  # 12 I / T^3 of a homogeneous plate
_PSHELL_OFFSET = 12
_SIDES = {"TOP": -0.5, "BOTTOM": 0.5}  # OptiStruct: this face lies on the grids; mid-surface over thickness


@dataclass(frozen=True, slots=True)
class _Layout:
    """Where a shell card keeps its mid-side grids, offset, thickness flag and corner thicknesses; its data fields."""

    corners: int
    mids: int
    offset: int
    flag: int
    thickness: int
    fields: int


SHELLS = {
    "CQUAD4": _Layout(4, 0, 7, 9, 10, 14),
    "CQUADR": _Layout(4, 0, 7, 9, 10, 14),
    "CQUAD4K": _Layout(4, 0, 7, 9, 10, 14),  # MYSTRAN: thin plates
    "CTRIA3": _Layout(3, 0, 6, 9, 10, 13),
    "CTRIAR": _Layout(3, 0, 6, 9, 10, 13),
    "CTRIA3K": _Layout(3, 0, 6, 9, 10, 13),
    "CQUAD8": _Layout(4, 4, 15, 16, 10, 17),
    "CTRIA6": _Layout(3, 3, 9, 13, 10, 14),
}
"""Layouts of the shell cards that are read, by card name."""


@dataclass(frozen=True, slots=True)
class Property:
    """A shell property: its section, and the PSHELL that may hold an offset for elements without one (OptiStruct)."""

    section: Section
    pshell: Card | None = None


def shell(card: Card, properties: Mapping[int, Property]) -> Shell:
    """Shell of a card; unequal corner thicknesses are averaged and have to be confirmed.

    Raises
    ------
    DataError : a bad field, or more fields than the card has
    """
    layout = SHELLS[card.name]
    n = layout.corners
    card.no_more_than(layout.fields)
    element = card.integer(0)
    pid = card.integer(1, element)
    prop = properties.get(pid, Property(Section(np.nan)))
    base = prop.section.thickness
    given = [card.real(layout.thickness + k, np.nan) for k in range(n)] if len(card.fields) > layout.thickness else []
    thickness, unconfirmed = None, ""
    if not all(isnan(t) for t in given):
        scale = base if card.integer(layout.flag, 0) == 1 else 1.0
        corner = [base if isnan(t) else t * scale for t in given]
        thickness = float(np.mean(corner))
        if not np.ptp(corner) <= _THICKNESS_SPREAD * thickness:
            unconfirmed = f"{card.name} {card.text(0)} has unequal corner thicknesses"
    return Shell(
        element,
        pid,
        tuple([card.integer(2 + k) for k in range(n)]),
        tuple([card.integer(2 + n + k, 0) for k in range(layout.mids)]),
        thickness,
        _offset(card, layout.offset, prop, base if thickness is None else thickness),
        unconfirmed,
    )


def _offset(card: Card, at: int, prop: Property, thickness: float) -> float:
    """ZOFFS of the element, else of its property: a length, or the face that lies on the grids."""
    if not card.text(at) and prop.pshell:
        card, at = prop.pshell, _PSHELL_OFFSET
    side = _SIDES.get(card.text(at).upper())
    return card.real(at, 0.0) if side is None else side * thickness


def pshell(card: Card) -> Property:
    """Read a PSHELL; a thickness of zero is one that is left blank, as its elements may give their own."""
    membrane, bending = card.integer(1, 0), card.integer(3, 0)
    ratio = card.real(4, _FULL_BENDING)
    thickness = card.real(2, 0.0)
    if not membrane or (bending not in (membrane, -1)) or card.integer(10, 0):
        unconfirmed = f"PSHELL {card.text(0)} has materials of its own for membrane and bending"
    elif abs(ratio - _FULL_BENDING) > 1e-6:
        unconfirmed = f"PSHELL {card.text(0)} has the bending stiffness 12 I / T^3 = {ratio:g} of another section"
    else:
        unconfirmed = ""
    _checked(card, thickness)
    return Property(Section(thickness or np.nan, 0.0, unconfirmed), card)


def pcomp(card: Card) -> Property:
    """Read a PCOMP or PCOMPG: plies of a PCOMP come two in a line of eight fields, of a PCOMPG one, after its id."""
    starts = range(8, len(card.fields), 4) if card.name == "PCOMP" else range(9, len(card.fields), 8)
    total, last = 0.0, 0.0
    for at in starts:
        if any(card.text(at + k) for k in range(4)):  # an angle alone makes a ply, too
            last = card.real(at + 1, last)
            total += last
    if card.text(7).upper().startswith("SY"):  # SYM, SYMEM, SYBEND, SYSMEAR
        total *= 2
    side = _SIDES.get(card.text(1).upper())
    offset = card.real(1, -total / 2) + total / 2 if side is None else side * total
    _checked(card, total)
    return Property(Section(total, offset, f"{card.name} {card.text(0)} is a layered section"))


def _checked(card: Card, thickness: float) -> None:
    if thickness < 0 or (thickness == 0 and card.name != "PSHELL"):
        what = f"the thickness of property {card.integer(0)} is {thickness:g}"
        raise DataError(Problem("bad_thickness", card.where, what, "Correct it"))
