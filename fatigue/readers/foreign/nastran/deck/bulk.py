"""The cards of NASTRAN or OptiStruct bulk data that weld lines need, by id; one given twice has to say the same."""

from collections.abc import Callable
from dataclasses import dataclass, field

from fatigue.errors import DataError, Problem
from fatigue.readers.foreign.nastran.deck.card import Card, KeptCards
from fatigue.readers.foreign.nastran.deck.notes import Twice
from fatigue.readers.foreign.nastran.deck.sets import set_on_card
from fatigue.readers.foreign.nastran.deck.shells import SHELLS, Property, pcomp, pshell
from fatigue.readers.foreign.nastran.deck.solids import SOLIDS
from fatigue.readers.foreign.nastran.deck.twice import same_card, same_grid
from fatigue.readers.foreign.nastran.frames import FrameCard

_GRID_FIELDS, _CORD1_FIELDS, _CORD2_FIELDS = 8, 8, 11


@dataclass(slots=True)
class Bulk:
    """What the cards of a deck leave behind."""

    source: str
    grids: KeptCards = field(default_factory=KeptCards)
    grids_again: list[Card] = field(default_factory=list)
    grdset: Card | None = None
    frames: dict[int, tuple[FrameCard, Card]] = field(default_factory=dict)
    shells: KeptCards = field(default_factory=KeptCards)
    solids: KeptCards = field(default_factory=KeptCards)
    properties: dict[int, tuple[Property, Card]] = field(default_factory=dict)
    sets: dict[int, list[int]] = field(default_factory=dict)
    markers: dict[str, list[tuple[int, int]]] = field(default_factory=dict)
    bars: dict[str, int] = field(default_factory=dict)
    twice: Twice = field(default_factory=Twice)
    warnings: list[Problem] = field(default_factory=list)

    def default(self, at: int) -> int:
        """Coordinate system of grids that name none: field ``at`` of GRDSET, else the basic one."""
        return self.grdset.integer(at, 0) if self.grdset else 0


def _grid(bulk: Bulk, card: Card) -> None:
    grid = card.identity()
    card.no_more_than(_GRID_FIELDS)
    if card.integer(7, 0):
        raise DataError(
            Problem(
                "superelement", card.where, f"grid {grid} belongs to superelement {card.text(7)}", "Give the residual"
            )
        )
    if grid in bulk.grids:
        bulk.grids_again.append(card)
    else:
        bulk.grids[grid] = card


def grids_twice(bulk: Bulk) -> list[Problem]:
    """Take each grid once, the one with more digits; give those that differ, once the defaults of GRDSET are known."""
    problems: list[Problem] = []
    for card in bulk.grids_again:
        grid = card.integer(0)
        known = bulk.grids[grid]
        try:
            same = same_grid(known, card, bulk.default(1), bulk.default(5))
        except DataError as error:
            problems += error.problems
            continue
        if same is None:
            what = f"grid {grid} is already defined at {known.where}, elsewhere or in another system"
            problems.append(Problem("grid_twice", card.where, what, "Give it another id"))
            continue
        bulk.grids[grid] = same
        bulk.twice.add(card.name, card.text(0), card.where)
    return problems


def _grdset(bulk: Bulk, card: Card) -> None:
    if bulk.grdset and not same_card(bulk.grdset, card):
        what = f"the defaults of grids are already set at {bulk.grdset.where}"
        raise DataError(Problem("grdset_twice", card.where, what, "Keep one GRDSET"))
    if card.integer(7, 0):
        what = f"all grids belong to superelement {card.text(7)}"
        raise DataError(Problem("superelement", card.where, what, "Give the residual"))
    card.integer(1, 0)
    card.integer(5, 0)
    bulk.grdset = card


def _cord1(bulk: Bulk, card: Card) -> None:
    card.no_more_than(_CORD1_FIELDS)
    for at in (0, 4):
        if card.text(at):
            grids = tuple(card.integer(at + k) for k in (1, 2, 3))
            _add_frame(bulk, card, card.integer(at), FrameCard(card.name[-1], grids=grids))


def _cord2(bulk: Bulk, card: Card) -> None:
    card.no_more_than(_CORD2_FIELDS)
    a, b, c = ((card.real(k, 0.0), card.real(k + 1, 0.0), card.real(k + 2, 0.0)) for k in (2, 5, 8))
    _add_frame(bulk, card, card.integer(0), FrameCard(card.name[-1], card.integer(1, 0), (a, b, c)))


def _add_frame(bulk: Bulk, card: Card, cid: int, frame: FrameCard) -> None:
    known = bulk.frames.get(cid)
    if known is None:
        bulk.frames[cid] = frame, card
    elif known[0] == frame:
        bulk.twice.add(card.name, card.text(0), card.where)
    else:
        what = f"coordinate system {cid} is defined twice, the first time at {known[1].where}"
        raise DataError(Problem("frame_twice", card.where, what, "Rename one"))


def _pshell(bulk: Bulk, card: Card) -> None:
    _add_property(bulk, card, pshell(card))


def _pcomp(bulk: Bulk, card: Card) -> None:
    _add_property(bulk, card, pcomp(card))


def _add_property(bulk: Bulk, card: Card, found: Property) -> None:
    pid = card.integer(0)
    known = bulk.properties.get(pid)
    if known is None:
        bulk.properties[pid] = found, card
    elif same_card(known[1], card):
        bulk.twice.add(card.name, card.text(0), card.where)
    else:
        what = f"property {pid} is defined twice, the first time at {known[1].where}"
        raise DataError(Problem("property_twice", card.where, what, "Rename one"))


def _shell(bulk: Bulk, card: Card) -> None:
    _add_element(bulk, card, bulk.shells)


def _solid(bulk: Bulk, card: Card) -> None:
    _add_element(bulk, card, bulk.solids)


def _psolid(bulk: Bulk, card: Card) -> None:
    if card.text(6).upper() == "PFLUID":
        what = f"PSOLID {card.text(0)} is a fluid"
        raise DataError(Problem("fluid_solid", card.where, what, "Give the structure alone"))


def _add_element(bulk: Bulk, card: Card, known_cards: KeptCards) -> None:
    element = card.identity()
    kept = next((some for some in (bulk.shells, bulk.solids) if element in some), None)
    known = card if kept is None else kept[element]
    if kept is None:
        known_cards[element] = card
    elif same_card(known, card):
        bulk.twice.add(card.name, card.text(0), card.where)
    else:
        what = f"the element id {element} is used twice, the first time at {known.where}"
        raise DataError(Problem("element_twice", card.where, what, "Give it another id"))


def _set(bulk: Bulk, card: Card) -> None:
    bulk.warnings += set_on_card(bulk.sets, card)


def _plotel(bulk: Bulk, card: Card) -> None:
    for at in (0, 4):
        if card.text(at):
            _mark(bulk, card, at + 1)


def _bar(bulk: Bulk, card: Card) -> None:
    bulk.bars[card.name] = bulk.bars.get(card.name, 0) + 1
    _mark(bulk, card, 2)


def _mark(bulk: Bulk, card: Card, at: int) -> None:
    """Keep two grids that a line card joins; one that cannot be read can mark no weld and is no more than a warning."""
    try:
        bulk.markers.setdefault(card.name, []).append((card.integer(at), card.integer(at + 1)))
    except DataError as error:
        bulk.warnings += [Problem("no_mark", p.where, f"{p.what}; it marks no weld", p.remedy) for p in error.problems]


HANDLERS: dict[str, Callable[[Bulk, Card], None]] = {
    "GRID": _grid,
    "GRDSET": _grdset,
    "PSHELL": _pshell,
    "PCOMP": _pcomp,
    "PCOMPG": _pcomp,
    "PLOTEL": _plotel,
    "CBAR": _bar,
    "CBEAM": _bar,
    **dict.fromkeys(("SET", "SET1", "SET3"), _set),
    **dict.fromkeys(("CORD1R", "CORD1C", "CORD1S"), _cord1),
    **dict.fromkeys(("CORD2R", "CORD2C", "CORD2S"), _cord2),
    **dict.fromkeys(SHELLS, _shell),
    **dict.fromkeys(SOLIDS, _solid),
    "PSOLID": _psolid,
}
