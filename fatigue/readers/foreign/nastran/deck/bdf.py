"""Shell geometry from NASTRAN or OptiStruct bulk data: the cards that weld lines need; all others are only counted."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem, refuse
from fatigue.readers.foreign.fe.model import FeModel, Shell, shell_mesh
from fatigue.readers.foreign.nastran.deck.card import Card
from fatigue.readers.foreign.nastran.deck.cards import cards
from fatigue.readers.foreign.nastran.deck.lines import Deck, read_deck
from fatigue.readers.foreign.nastran.deck.notes import LeftOut, Twice
from fatigue.readers.foreign.nastran.deck.sets import joined_sets, set_on_card
from fatigue.readers.foreign.nastran.deck.shells import SHELLS, Property, pcomp, pshell, shell
from fatigue.readers.foreign.nastran.deck.twice import same_card, same_grid
from fatigue.readers.foreign.nastran.frames import FrameCard, Frames

_ELEMENT_CARDS = ("C", "RBE", "RBAR", "RROD", "RSPLINE")
_NO_ELEMENTS = ("CORD", "CONV", "CSET", "CAERO", "CSUPEXT")
_GRID_FIELDS, _CORD1_FIELDS, _CORD2_FIELDS = 8, 8, 11
_MOST_PROBLEMS = 10


@dataclass(slots=True)
class _Bulk:
    """What the cards of a deck leave behind."""

    source: str
    grids: dict[int, Card] = field(default_factory=dict)
    grids_again: list[Card] = field(default_factory=list)
    grdset: Card | None = None
    frames: dict[int, tuple[FrameCard, Card]] = field(default_factory=dict)
    shells: dict[int, Card] = field(default_factory=dict)
    properties: dict[int, tuple[Property, Card]] = field(default_factory=dict)
    sets: dict[int, list[int]] = field(default_factory=dict)
    markers: dict[str, list[tuple[int, int]]] = field(default_factory=dict)
    bars: dict[str, int] = field(default_factory=dict)
    twice: Twice = field(default_factory=Twice)
    warnings: list[Problem] = field(default_factory=list)

    def default(self, at: int) -> int:
        """Coordinate system of grids that name none: field ``at`` of GRDSET, else the basic one."""
        return self.grdset.integer(at, 0) if self.grdset else 0


def read_bdf(path: Path) -> FeModel:
    """Read grids, coordinate systems, shells, shell properties, sets and markers; other cards become a warning.

    Raises
    ------
    DataError : unreadable file, bad field, an id with two contents, reference to something missing, superelements, no
        shells
    """
    deck = read_deck(path)
    bulk = _Bulk(str(path))
    left_out = LeftOut()
    problems: list[Problem] = []
    for card in cards(deck.bulk, _HANDLERS, left_out, problems):
        try:
            _HANDLERS[card.name](bulk, card)
        except DataError as error:
            problems += error.problems
    return _model(bulk, deck, left_out, problems + _grids_twice(bulk))


def _refuse_some(problems: list[Problem]) -> None:
    """Refuse with the first problems, and the number of the others."""
    first, others = problems[:_MOST_PROBLEMS], len(problems) - _MOST_PROBLEMS
    if others > 0:
        first.append(Problem("more", first[-1].where, f"{others} more problems follow", "Correct these first", others))
    refuse(DataError, first)


def _model(bulk: _Bulk, deck: Deck, left_out: LeftOut, problems: list[Problem]) -> FeModel:
    """Resolve coordinates and references; refuse with the problems met before and here."""
    xyz: dict[int, NDArray[np.float64]] = {}
    default_cp, default_cd = bulk.default(1), bulk.default(5)

    def position(grid: int) -> NDArray[np.float64]:
        if grid not in xyz:
            if grid not in bulk.grids:
                raise DataError(
                    Problem("no_grid", bulk.source, f"grid {grid} of a coordinate system does not exist", "Define it")
                )
            card = bulk.grids[grid]
            cp = card.integer(1, default_cp)
            xyz[grid] = frames.position(cp, (card.real(2, 0.0), card.real(3, 0.0), card.real(4, 0.0)))
        return xyz[grid]

    frames = Frames(bulk.source, {cid: frame for cid, (frame, _) in bulk.frames.items()}, position)
    cd: dict[int, int] = {}
    shells: list[Shell] = []
    properties = {pid: found for pid, (found, _) in bulk.properties.items()}
    for grid, card in bulk.grids.items():
        try:
            position(grid)
            cd[grid] = _output_frame(card, default_cd)
        except DataError as error:
            problems += error.problems
    for card in bulk.shells.values():
        try:
            shells.append(shell(card, properties))
        except DataError as error:
            problems += error.problems
    _refuse_some(list(dict.fromkeys(_with_unread_frames(problems, left_out))))
    if not shells:
        raise DataError(_no_shells(bulk, left_out))
    turned = sorted(grid for grid, c in cd.items() if c)
    sets, set_warnings = joined_sets(bulk.sets, deck.control)
    return FeModel(
        source=bulk.source,
        mesh=shell_mesh(bulk.source, xyz, shells, {pid: found.section for pid, found in properties.items()}),
        frame_node=np.array(turned, np.int64),
        frame=np.array([frames.axes_at(cd[g], xyz[g]) for g in turned]).reshape(-1, 3, 3),
        unconfirmed_sections=_unconfirmed_sections(properties, shells),
        unconfirmed_elements={s.element: s.unconfirmed for s in shells if s.unconfirmed},
        node_sets={key: np.unique(np.array(ids, np.int64)) for key, ids in sets.items()},
        marker_edges={name: np.array(pairs, np.int64) for name, pairs in bulk.markers.items()},
        other_cards=bulk.bars | {name: n for name, n in left_out.count.items() if _is_element(name)},
        included=deck.included,
        warnings=(
            *deck.warnings,
            *bulk.warnings,
            *set_warnings,
            *bulk.twice.warnings(),
            *left_out.warnings(bulk.source),
        ),
    )


def _no_shells(bulk: _Bulk, left_out: LeftOut) -> Problem:
    """Say which elements the deck has instead."""
    others = bulk.bars | {name: n for name, n in left_out.count.items() if _is_element(name)}
    found = ", ".join(f"{n} {name}" for name, n in sorted(others.items())) or "no element at all"
    what = f"the model has no shell elements ({', '.join(SHELLS)}): {len(bulk.grids)} grids, {found}"
    return Problem("no_shells", bulk.source, what, "Give the bulk data that holds the plates")


def _with_unread_frames(problems: list[Problem], left_out: LeftOut) -> list[Problem]:
    """Name the cards that may define a missing coordinate system in a way that is not read."""
    unread = ", ".join(name for name in left_out.count if name.startswith("CORD"))
    remedy = f"Give it as CORD1 or CORD2; {unread} cards are not read"
    return [replace(p, remedy=remedy) if unread and p.code == "no_frame" else p for p in problems]


def _output_frame(card: Card, default: int) -> int:
    cd = card.integer(5, default)
    if cd < 0:
        what = f"grid {card.text(0)} is a fluid point (CD -1)"
        raise DataError(Problem("fluid_grid", card.where, what, "Give the structure alone"))
    return cd


def _is_element(name: str) -> bool:
    return name.startswith(_ELEMENT_CARDS) and not name.startswith(_NO_ELEMENTS)


def _unconfirmed_sections(properties: dict[int, Property], shells: list[Shell]) -> dict[int, str]:
    """Properties whose thickness needs a confirmation by hand, missing ones included."""
    unconfirmed = {pid: found.section.unconfirmed for pid, found in properties.items() if found.section.unconfirmed}
    for pid in {s.pid for s in shells if s.thickness is None} - properties.keys():
        unconfirmed[pid] = f"property {pid} is not a PSHELL, PCOMP or PCOMPG of this model"
    return unconfirmed


def _grid(bulk: _Bulk, card: Card) -> None:
    grid = card.identity()
    card.no_more_than(_GRID_FIELDS)
    if card.integer(7, 0):
        raise DataError(
            Problem(
                "superelement", card.where, f"grid {grid} belongs to superelement {card.text(7)}", "Give the residual"
            )
        )
    if bulk.grids.setdefault(grid, card) is not card:
        bulk.grids_again.append(card)


def _grids_twice(bulk: _Bulk) -> list[Problem]:
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


def _grdset(bulk: _Bulk, card: Card) -> None:
    if bulk.grdset and not same_card(bulk.grdset, card):
        what = f"the defaults of grids are already set at {bulk.grdset.where}"
        raise DataError(Problem("grdset_twice", card.where, what, "Keep one GRDSET"))
    if card.integer(7, 0):
        what = f"all grids belong to superelement {card.text(7)}"
        raise DataError(Problem("superelement", card.where, what, "Give the residual"))
    card.integer(1, 0)
    card.integer(5, 0)
    bulk.grdset = card


def _cord1(bulk: _Bulk, card: Card) -> None:
    card.no_more_than(_CORD1_FIELDS)
    for at in (0, 4):
        if card.text(at):
            grids = tuple(card.integer(at + k) for k in (1, 2, 3))
            _add_frame(bulk, card, card.integer(at), FrameCard(card.name[-1], grids=grids))


def _cord2(bulk: _Bulk, card: Card) -> None:
    card.no_more_than(_CORD2_FIELDS)
    a, b, c = ((card.real(k, 0.0), card.real(k + 1, 0.0), card.real(k + 2, 0.0)) for k in (2, 5, 8))
    _add_frame(bulk, card, card.integer(0), FrameCard(card.name[-1], card.integer(1, 0), (a, b, c)))


def _add_frame(bulk: _Bulk, card: Card, cid: int, frame: FrameCard) -> None:
    known = bulk.frames.get(cid)
    if known is None:
        bulk.frames[cid] = frame, card
    elif known[0] == frame:
        bulk.twice.add(card.name, card.text(0), card.where)
    else:
        what = f"coordinate system {cid} is defined twice, the first time at {known[1].where}"
        raise DataError(Problem("frame_twice", card.where, what, "Rename one"))


def _pshell(bulk: _Bulk, card: Card) -> None:
    _add_property(bulk, card, pshell(card))


def _pcomp(bulk: _Bulk, card: Card) -> None:
    _add_property(bulk, card, pcomp(card))


def _add_property(bulk: _Bulk, card: Card, found: Property) -> None:
    pid = card.integer(0)
    known = bulk.properties.get(pid)
    if known is None:
        bulk.properties[pid] = found, card
    elif same_card(known[1], card):
        bulk.twice.add(card.name, card.text(0), card.where)
    else:
        what = f"property {pid} is defined twice, the first time at {known[1].where}"
        raise DataError(Problem("property_twice", card.where, what, "Rename one"))


def _shell(bulk: _Bulk, card: Card) -> None:
    element = card.identity()
    known = bulk.shells.get(element)
    if known is None:
        bulk.shells[element] = card
    elif same_card(known, card):
        bulk.twice.add(card.name, card.text(0), card.where)
    else:
        what = f"the element id {element} is used twice, the first time at {known.where}"
        raise DataError(Problem("element_twice", card.where, what, "Give it another id"))


def _set(bulk: _Bulk, card: Card) -> None:
    bulk.warnings += set_on_card(bulk.sets, card)


def _plotel(bulk: _Bulk, card: Card) -> None:
    for at in (0, 4):
        if card.text(at):
            _mark(bulk, card, at + 1)


def _bar(bulk: _Bulk, card: Card) -> None:
    bulk.bars[card.name] = bulk.bars.get(card.name, 0) + 1
    _mark(bulk, card, 2)


def _mark(bulk: _Bulk, card: Card, at: int) -> None:
    """Keep two grids that a line card joins; one that cannot be read can mark no weld and is no more than a warning."""
    try:
        bulk.markers.setdefault(card.name, []).append((card.integer(at), card.integer(at + 1)))
    except DataError as error:
        bulk.warnings += [Problem("no_mark", p.where, f"{p.what}; it marks no weld", p.remedy) for p in error.problems]


_HANDLERS: dict[str, Callable[[_Bulk, Card], None]] = {
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
}
