"""Shell geometry from NASTRAN or OptiStruct bulk data: the cards that weld lines need, and no others."""

from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem, refuse
from fatigue.readers.fe_model import FeModel, Section, Shell, shell_mesh
from fatigue.readers.nastran_cards import Card, Deck, cards, case_sets, read_deck, set_members
from fatigue.readers.nastran_frames import FrameCard, Frames

_ELEMENT_CARDS = ("C", "RBE", "RBAR", "RROD", "RSPLINE")
_NO_ELEMENTS = ("CORD", "CONV", "CSET", "CAERO", "CSUPEXT")
_THICKNESS_SPREAD = 0.01
_FULL_BENDING = 1.0  # 12 I / T^3 of a homogeneous plate


@dataclass(slots=True)
class _Bulk:
    """What the cards of a deck leave behind."""

    source: str
    grids: dict[int, Card] = field(default_factory=dict)
    default_cp: int = 0
    default_cd: int = 0
    frames: dict[int, FrameCard] = field(default_factory=dict)
    shells: list[Card] = field(default_factory=list)
    sections: dict[int, Section] = field(default_factory=dict)
    sets: dict[int, list[int]] = field(default_factory=dict)
    markers: dict[str, list[tuple[int, int]]] = field(default_factory=dict)
    others: Counter[str] = field(default_factory=Counter)


def read_bdf(path: Path) -> FeModel:
    """Read grids, coordinate systems, shells, shell properties, sets and markers.

    Raises
    ------
    DataError : unreadable file, bad field, duplicate id, reference to something missing, superelements, no shells
    """
    deck = read_deck(path)
    bulk = _Bulk(str(path))
    for card in cards(deck.bulk):
        handle = _HANDLERS.get(card.name)
        if handle:
            handle(bulk, card)
        elif card.name.startswith(_ELEMENT_CARDS) and not card.name.startswith(_NO_ELEMENTS):
            bulk.others[card.name] += 1
    return _model(bulk, deck)


def _model(bulk: _Bulk, deck: Deck) -> FeModel:
    """Resolve coordinates and references."""
    xyz: dict[int, NDArray[np.float64]] = {}

    def position(grid: int) -> NDArray[np.float64]:
        if grid not in xyz:
            if grid not in bulk.grids:
                raise DataError(
                    Problem("no_grid", bulk.source, f"grid {grid} of a coordinate system does not exist", "Define it")
                )
            card = bulk.grids[grid]
            cp = card.integer(1, bulk.default_cp)
            xyz[grid] = frames.position(cp, (card.real(2, 0.0), card.real(3, 0.0), card.real(4, 0.0)))
        return xyz[grid]

    frames = Frames(bulk.source, bulk.frames, position)
    for grid in bulk.grids:
        position(grid)
    cd = {grid: card.integer(5, bulk.default_cd) for grid, card in bulk.grids.items()}
    refuse(
        DataError,
        [
            Problem(
                "fluid_grid",
                bulk.grids[grid].where,
                f"grid {grid} is a fluid point (CD -1)",
                "Give the structure alone",
            )
            for grid, c in cd.items()
            if c < 0
        ][:5],
    )
    turned = sorted(grid for grid, c in cd.items() if c)
    shells = [_shell(card, bulk.sections) for card in bulk.shells]
    return FeModel(
        source=bulk.source,
        mesh=shell_mesh(bulk.source, xyz, shells, bulk.sections),
        frame_node=np.array(turned, np.int64),
        frame=np.array([frames.axes_at(cd[g], xyz[g]) for g in turned]).reshape(-1, 3, 3),
        section_doubt=_section_doubts(bulk, shells),
        element_doubt={shell.element: shell.doubt for shell in shells if shell.doubt},
        node_sets={
            key: np.unique(np.array(ids, np.int64)) for key, ids in (bulk.sets | case_sets(deck.control)).items()
        },
        marker_edges={name: np.array(pairs, np.int64) for name, pairs in bulk.markers.items()},
        other_cards=dict(bulk.others),
    )


def _section_doubts(bulk: _Bulk, shells: Iterable[Shell]) -> dict[int, str]:
    """Properties whose thickness needs a confirmation by hand, missing ones included."""
    doubts = {pid: section.doubt for pid, section in bulk.sections.items() if section.doubt}
    for pid in {shell.pid for shell in shells if shell.thickness is None} - bulk.sections.keys():
        doubts[pid] = f"property {pid} is not a PSHELL, PCOMP or PCOMPG of this model"
    return doubts


def _grid(bulk: _Bulk, card: Card) -> None:
    grid = card.integer(0)
    if card.integer(7, 0):
        raise DataError(
            Problem(
                "superelement", card.where, f"grid {grid} belongs to superelement {card.text(7)}", "Give the residual"
            )
        )
    known = bulk.grids.get(grid)
    if known and [known.text(k) for k in range(6)] != [card.text(k) for k in range(6)]:
        raise DataError(
            Problem("grid_twice", card.where, f"grid {grid} is already defined at {known.where}", "Give it another id")
        )
    bulk.grids[grid] = card


def _grdset(bulk: _Bulk, card: Card) -> None:
    bulk.default_cp, bulk.default_cd = card.integer(1, 0), card.integer(5, 0)


def _cord1(bulk: _Bulk, card: Card) -> None:
    for at in (0, 4):
        if card.text(at):
            grids = tuple(card.integer(at + k) for k in (1, 2, 3))
            _add_frame(bulk, card, card.integer(at), FrameCard(card.name[-1], grids=grids))


def _cord2(bulk: _Bulk, card: Card) -> None:
    a, b, c = ((card.real(k), card.real(k + 1), card.real(k + 2)) for k in (2, 5, 8))
    _add_frame(bulk, card, card.integer(0), FrameCard(card.name[-1], card.integer(1, 0), (a, b, c)))


def _add_frame(bulk: _Bulk, card: Card, cid: int, frame: FrameCard) -> None:
    if bulk.frames.setdefault(cid, frame) != frame:
        raise DataError(Problem("frame_twice", card.where, f"coordinate system {cid} is defined twice", "Rename one"))


def _pshell(bulk: _Bulk, card: Card) -> None:
    membrane, bending = card.integer(1, 0), card.integer(3, 0)
    ratio = card.real(4, _FULL_BENDING)
    if not membrane or (bending not in (membrane, -1)) or card.integer(10, 0):
        doubt = f"PSHELL {card.text(0)} has materials of its own for membrane and bending"
    elif abs(ratio - _FULL_BENDING) > 1e-6:
        doubt = f"PSHELL {card.text(0)} has the bending stiffness 12 I / T^3 = {ratio:g} of another section"
    else:
        doubt = ""
    _add_section(bulk, card, Section(card.real(2, np.nan), 0.0, doubt))


def _pcomp(bulk: _Bulk, card: Card) -> None:
    """Plies of PCOMP come two in a line of eight fields, those of PCOMPG one in a line, after their own id."""
    starts = range(8, len(card.fields), 4) if card.name == "PCOMP" else range(9, len(card.fields), 8)
    total, last = 0.0, 0.0
    for at in starts:
        if any(card.text(at + k) for k in range(2)):
            last = card.real(at + 1, last)
            total += last
    if card.text(7).upper().startswith("SYM"):
        total *= 2
    bottom = card.real(1, -total / 2)
    doubt = f"{card.name} {card.text(0)} is a layered section"
    _add_section(bulk, card, Section(total, bottom + total / 2, doubt))


def _add_section(bulk: _Bulk, card: Card, section: Section) -> None:
    pid = card.integer(0)
    if pid in bulk.sections and not _same(bulk.sections[pid], section):
        raise DataError(Problem("property_twice", card.where, f"property {pid} is defined twice", "Rename one"))
    if not (np.isnan(section.thickness) or section.thickness > 0):
        raise DataError(
            Problem(
                "bad_thickness", card.where, f"the thickness of property {pid} is {section.thickness:g}", "Correct it"
            )
        )
    bulk.sections[pid] = section


def _same(a: Section, b: Section) -> bool:
    return np.array_equal([a.thickness, a.offset], [b.thickness, b.offset], equal_nan=True) and a.doubt == b.doubt


def _set1(bulk: _Bulk, card: Card) -> None:
    members = set_members([word.upper() for word in card.fields[1:] if word])
    if members is not None:
        bulk.sets[card.integer(0)] = members


def _plotel(bulk: _Bulk, card: Card) -> None:
    for at in (0, 4):
        if card.text(at):
            bulk.markers.setdefault(card.name, []).append((card.integer(at + 1), card.integer(at + 2)))


def _bar(bulk: _Bulk, card: Card) -> None:
    bulk.others[card.name] += 1
    bulk.markers.setdefault(card.name, []).append((card.integer(2), card.integer(3)))


@dataclass(frozen=True, slots=True)
class _Layout:
    """Where a shell card keeps its mid-side grids, offset, thickness flag and corner thicknesses."""

    corners: int
    mids: int
    offset: int
    flag: int
    thickness: int


_LAYOUTS = {
    "CQUAD4": _Layout(4, 0, 7, 9, 10),
    "CQUADR": _Layout(4, 0, 7, 9, 10),
    "CTRIA3": _Layout(3, 0, 6, 9, 10),
    "CTRIAR": _Layout(3, 0, 6, 9, 10),
    "CQUAD8": _Layout(4, 4, 15, 16, 10),
    "CTRIA6": _Layout(3, 3, 9, 13, 10),
}


def _shell(card: Card, sections: dict[int, Section]) -> Shell:
    """Decode a shell; unequal corner thicknesses are averaged and make the thickness doubtful."""
    layout = _LAYOUTS[card.name]
    n = layout.corners
    pid = card.integer(1, card.integer(0))
    base = sections.get(pid, Section(np.nan)).thickness
    given = [card.real(layout.thickness + k, np.nan) for k in range(n)]
    thickness, doubt = None, ""
    if not np.isnan(given).all():
        scale = base if card.integer(layout.flag, 0) == 1 else 1.0
        corner = [base if np.isnan(t) else t * scale for t in given]
        thickness = float(np.mean(corner))
        if not np.ptp(corner) <= _THICKNESS_SPREAD * thickness:
            doubt = f"{card.name} {card.text(0)} has unequal corner thicknesses"
    return Shell(
        card.integer(0),
        pid,
        tuple(card.integer(2 + k) for k in range(n)),
        tuple(card.integer(2 + n + k, 0) for k in range(layout.mids)),
        thickness,
        card.real(layout.offset, 0.0),
        doubt,
    )


def _keep_shell(bulk: _Bulk, card: Card) -> None:
    bulk.shells.append(card)


_HANDLERS: dict[str, Callable[[_Bulk, Card], None]] = {
    "GRID": _grid,
    "GRDSET": _grdset,
    "PSHELL": _pshell,
    "PCOMP": _pcomp,
    "PCOMPG": _pcomp,
    "SET1": _set1,
    "PLOTEL": _plotel,
    "CBAR": _bar,
    "CBEAM": _bar,
    **dict.fromkeys(("CORD1R", "CORD1C", "CORD1S"), _cord1),
    **dict.fromkeys(("CORD2R", "CORD2C", "CORD2S"), _cord2),
    **dict.fromkeys(_LAYOUTS, _keep_shell),
}
