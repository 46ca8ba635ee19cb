"""A stiffness and a mass matrix from a NASTRAN file of DMIG, with the grids of their rows, in the file's units."""

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from fatigue.errors import DataError, Problem, refuse
from fatigue.readers.foreign.nastran.deck.bulk import HANDLERS, Bulk, grids_twice
from fatigue.readers.foreign.nastran.deck.cards import cards
from fatigue.readers.foreign.nastran.deck.lines import read_deck
from fatigue.readers.foreign.nastran.deck.notes import LeftOut
from fatigue.readers.foreign.nastran.frames import Frames
from fatigue.readers.foreign.nastran.matrices.dmig import Dmig, add_dmig

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

DAMPING = ("K4",)  # names that begin like stiffness and are none
_GRIDS = ("GRID", "GRDSET", "CORD1R", "CORD1C", "CORD1S", "CORD2R", "CORD2C", "CORD2S")
_MOST_PROBLEMS = 10


@dataclass(frozen=True, slots=True, eq=False)
class DeckMatrices:
    """K and M (n, n) in basic axes as a deck has them, and what their rows are.

    ``node`` (n,) are grids, ``direction`` (n,) 0 to 5. ``xyz`` are places of grids, in basic coordinates, by grid:
    those that the deck defines.
    """

    K: sparse.csc_array
    M: sparse.csc_array
    names: tuple[str, str]
    node: Integers
    direction: Integers
    xyz: dict[int, Floats] = field(default_factory=dict)
    included: tuple[Path, ...] = ()


def has_dmig(path: Path) -> bool:
    """Whether a file of the system's text holds a DMIG card."""
    with path.open("rb") as file:
        return any(line.lstrip()[:4].upper() == b"DMIG" for line in file)


def read_dmig(path: Path) -> DeckMatrices:
    """Read the stiffness and the mass of a deck: DMIG whose names begin with K and M, as KAAX and MAAX do.

    Grids of the deck give places and displacement frames; rows in other frames are turned to the basic one.

    Raises
    ------
    DataError : no such matrix or several, a card that is none, a frame without all three components of a grid
    """
    deck = read_deck(path)
    bulk, matrices = Bulk(str(path)), dict[str, Dmig]()
    problems: list[Problem] = []
    for card in cards(deck.bulk, {"DMIG", *_GRIDS}, LeftOut(), problems):
        try:
            if card.name == "DMIG":
                add_dmig(matrices, card)
            else:
                HANDLERS[card.name](bulk, card)
        except DataError as error:
            problems += error.problems
    refuse(DataError, (problems + grids_twice(bulk))[:_MOST_PROBLEMS])
    K, M = _named(path, matrices, "K", "stiffness"), _named(path, matrices, "M", "mass")
    dofs = sorted(K.dofs() | M.dofs())
    if not dofs:
        raise DataError(Problem("empty_matrix", str(path), f"{K.name} and {M.name} have no entries", "Export again"))
    node, component = np.array(dofs, dtype=np.int64).T
    xyz, turned = _places(bulk)
    T = _to_basic(path, node, component, turned)
    full = []
    for matrix in (K, M):
        i, j, value = matrix.entries(dofs)
        full.append(sparse.csc_array(T.T @ sparse.csc_array((value, (i, j)), shape=T.shape) @ T))
    return DeckMatrices(full[0], full[1], (K.name, M.name), node, component - 1, xyz, deck.included)


def _named(path: Path, matrices: dict[str, Dmig], letter: str, what_it_is: str) -> Dmig:
    """Find the matrix whose name begins so; of several, the one that an external superelement has (KAAX, MAAX)."""
    found = [m for name, m in matrices.items() if name.startswith(letter) and not name.startswith(DAMPING)]
    exported = [m for m in found if m.name in (f"{letter}AAX", f"{letter}AA")]
    chosen = exported[:1] or found
    if len(chosen) == 1:
        return chosen[0]
    has = ", ".join(matrices) or "none"
    what = f"{len(found)} matrices may be the {what_it_is} matrix; DMIG here: {has}"
    remedy = f"Give one DMIG whose name begins with {letter}, as {letter}AAX"
    raise DataError(Problem("no_matrix" if not found else "two_matrices", str(path), what, remedy))


def _places(bulk: Bulk) -> tuple[dict[int, Floats], dict[int, Floats]]:
    """Places of grids, and axes of those whose displacement frame is not the basic one.

    Raises
    ------
    DataError : a frame or a grid that does not exist, a field that is no number
    """
    xyz: dict[int, Floats] = {}

    def position(grid: int) -> Floats:
        if grid not in xyz:
            if grid not in bulk.grids:
                what = f"grid {grid} of a coordinate system does not exist"
                raise DataError(Problem("no_grid", bulk.source, what, "Define it"))
            card = bulk.grids[grid]
            system = card.integer(1, bulk.default(1))
            xyz[grid] = frames.position(system, (card.real(2, 0.0), card.real(3, 0.0), card.real(4, 0.0)))
        return xyz[grid]

    frames = Frames(bulk.source, {cid: frame for cid, (frame, _) in bulk.frames.items()}, position)
    turned: dict[int, Floats] = {}
    for grid, card in bulk.grids.items():
        place, system = position(grid), card.integer(5, bulk.default(5))
        if system:
            turned[grid] = frames.axes_at(system, place)
    return xyz, turned


def _to_basic(path: Path, node: Integers, component: Integers, turned: dict[int, Floats]) -> sparse.csr_array:
    """Displacements of the rows in their frames from those in basic axes, T (n, n)."""
    T = sparse.lil_array((len(node), len(node)))
    T.setdiag(1.0)
    for grid, axes in turned.items():
        for first in (1, 4):
            rows = np.flatnonzero((node == grid) & (component >= first) & (component < first + 3))
            if not rows.size:
                continue
            if rows.size < 3:
                what = f"grid {grid} has a displacement frame of its own, and not all three components of it"
                raise DataError(Problem("turned_frame", str(path), what, "Export all components, or in basic axes"))
            T[np.ix_(rows, rows)] = axes
    return T.tocsr()
