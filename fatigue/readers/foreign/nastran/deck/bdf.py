"""Shells and solids from NASTRAN or OptiStruct bulk data: what its cards say, with all references resolved."""

from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem, refuse
from fatigue.readers.foreign.fe.model import FeModel, Shell, Solid, shell_mesh, solid_mesh
from fatigue.readers.foreign.nastran.deck.bulk import HANDLERS, Bulk, grids_twice
from fatigue.readers.foreign.nastran.deck.card import Card
from fatigue.readers.foreign.nastran.deck.cards import cards
from fatigue.readers.foreign.nastran.deck.lines import Deck, read_deck
from fatigue.readers.foreign.nastran.deck.notes import LeftOut
from fatigue.readers.foreign.nastran.deck.sets import joined_sets
from fatigue.readers.foreign.nastran.deck.shells import SHELLS, Property, shell
from fatigue.readers.foreign.nastran.deck.solids import SOLIDS, solid
from fatigue.readers.foreign.nastran.frames import Frames

_ELEMENT_CARDS = ("C", "RBE", "RBAR", "RROD", "RSPLINE")
_NO_ELEMENTS = ("CORD", "CONV", "CSET", "CAERO", "CSUPEXT")
_MOST_PROBLEMS = 10


def read_bdf(path: Path) -> FeModel:
    """Read grids, coordinate systems, shells, shell properties, solids, sets and markers; other cards become a warning.

    Raises
    ------
    DataError : unreadable file, bad field, an id with two contents, reference to something missing, superelements,
        neither shells nor solids
    """
    deck = read_deck(path)
    bulk = Bulk(str(path))
    left_out = LeftOut()
    problems: list[Problem] = []
    for card in cards(deck.taken(), HANDLERS, left_out, problems):
        try:
            HANDLERS[card.name](bulk, card)
        except DataError as error:
            problems += error.problems
    return _model(bulk, deck, left_out, problems + grids_twice(bulk))


def _refuse_some(problems: list[Problem]) -> None:
    """Refuse with the first problems, and the number of the others."""
    first, others = problems[:_MOST_PROBLEMS], len(problems) - _MOST_PROBLEMS
    if others > 0:
        first.append(Problem("more", first[-1].where, f"{others} more problems follow", "Correct these first", others))
    refuse(DataError, first)


def _model(bulk: Bulk, deck: Deck, left_out: LeftOut, problems: list[Problem]) -> FeModel:
    """Resolve coordinates and references; refuse with the problems met before and here."""
    xyz: dict[int, NDArray[np.float64]] = {}
    default_cp, default_cd = bulk.default(1), bulk.default(5)

    def place(grid: int, card: Card) -> NDArray[np.float64]:
        if grid not in xyz:
            cp = card.integer(1, default_cp)
            xyz[grid] = frames.position(cp, (card.real(2, 0.0), card.real(3, 0.0), card.real(4, 0.0)))
        return xyz[grid]

    def position(grid: int) -> NDArray[np.float64]:
        if grid in xyz:
            return xyz[grid]
        if grid not in bulk.grids:
            what = f"grid {grid} of a coordinate system does not exist"
            raise DataError(Problem("no_grid", bulk.source, what, "Define it"))
        return place(grid, bulk.grids[grid])

    frames = Frames(bulk.source, {cid: frame for cid, (frame, _) in bulk.frames.items()}, position)
    cd: dict[int, int] = {}
    shells: list[Shell] = []
    solids: list[Solid] = []
    properties = {pid: found for pid, (found, _) in bulk.properties.items()}
    for grid, card in bulk.grids.items():
        try:
            place(grid, card)
            if frame := _output_frame(card, default_cd):
                cd[grid] = frame
        except DataError as error:
            problems += error.problems
    bulk.grids.packed.clear()
    for _, card in bulk.shells.taken():
        try:
            shells.append(shell(card, properties))
        except DataError as error:
            problems += error.problems
    for _, card in bulk.solids.taken():
        try:
            solids.append(solid(card))
        except DataError as error:
            problems += error.problems
    _refuse_some(list(dict.fromkeys(_with_unread_frames(problems, left_out))))
    if not shells and not solids:
        raise DataError(_no_shells(bulk, len(xyz), left_out))
    turned = sorted(cd)
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
        solids=solid_mesh(bulk.source, xyz, solids, shells),
    )


def _no_shells(bulk: Bulk, grids: int, left_out: LeftOut) -> Problem:
    """Say which elements the deck has instead."""
    others = bulk.bars | {name: n for name, n in left_out.count.items() if _is_element(name)}
    found = ", ".join(f"{n} {name}" for name, n in sorted(others.items())) or "no element at all"
    what = f"the model has no shell elements ({', '.join(SHELLS)}) and no solid ones ({', '.join(SOLIDS)}): "
    what += f"{grids} grids, {found}"
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
