"""Forces, mode shapes and frequencies from an exported text, whichever program it comes from."""

from collections.abc import Callable, Collection
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.readers.foreign.export.layout import Block, blocks, damaged, solver_of
from fatigue.readers.foreign.export.rows import columns, ids, only_row
from fatigue.readers.foreign.fe.assembly import FileBlocks, assemble
from fatigue.readers.foreign.fe.force_rows import sharing_rows
from fatigue.readers.foreign.fe.results import Eigenvalue, FeResults, ForceBlock, ShapeBlock
from fatigue.readers.foreign.fe.static_case import Heading, heading

_BLOCKS = frozenset({"elements", "mode", "static", "shape", "forces"})
_MODAL = 1_000_000  # subcase of the modes, beside the numbers of static cases


def read_results(
    path: Path,
    kinds_of: Callable[[Path, Block], dict[int, str]],
    subcase: int | None,
    interface: Collection[int],
    loads: Collection[int] | None,
) -> FeResults:
    """Forces and shapes of all modes, and of static cases beside them; ``kinds_of`` names the elements of a block.

    Raises
    ------
    DataError : a damaged or cut text, forces of an element that it does not list; as ``assemble``
    """
    kinds: dict[int, str] = {}
    forces: list[ForceBlock] = []
    shapes: list[ShapeBlock] = []
    summary: list[Eigenvalue] = []
    headings: dict[int, Heading] = {}
    current: tuple[int, int] | None = None
    for block in blocks(path, _BLOCKS):
        if block.name == "elements":
            kinds |= kinds_of(path, block)
        elif block.name == "mode":
            summary.append(_eigenvalue(path, block))
            current = (_MODAL, summary[-1].mode)
        elif block.name == "static":
            number = int(only_row(path, block, 1)[0])
            current = (number, 0)
            headings[number] = heading("", block.words, "")
        elif current is None:
            raise damaged(path, block.line, f"*{block.name} stands before any *mode or *static")
        elif block.name == "shape":
            shapes.append(ShapeBlock(*current, ids(path, block, 0), columns(path, block, 7)[:, 1:]))
        else:
            forces.append(sharing_rows(_forces(path, block, current, kinds), forces))
    file = FileBlocks(str(path), solver_of(path), forces, shapes, summary, {}, (), headings)
    return assemble(file, subcase, interface, loads)


def _eigenvalue(path: Path, block: Block) -> Eigenvalue:
    """Number, frequency [Hz] and modal mass of a mode; a mass of zero, as none, is one that is not known."""
    number, frequency, mass = only_row(path, block, 3).tolist()
    if mass < 0.0:
        raise damaged(path, block.line + 1, f"{mass:g} is no modal mass")
    return Eigenvalue(_MODAL, int(number), frequency, mass or np.nan, (2.0 * np.pi * frequency) ** 2)


def _forces(path: Path, block: Block, current: tuple[int, int], kinds: dict[int, str]) -> ForceBlock:
    """Rows of one mode or static case."""
    values = columns(path, block, 8)
    element, node = ids(path, block, 0), ids(path, block, 1)
    known, place = np.unique(element, return_inverse=True)
    if unknown := set(known.tolist()) - kinds.keys():
        row = int(np.flatnonzero(np.isin(element, list(unknown)))[0])
        raise damaged(path, block.line + row + 1, f"element {element[row]} has forces and is not listed above")
    kind: NDArray[np.str_] = np.array([kinds[number] for number in known.tolist()], np.str_)[place]
    number, mode = current
    called = f"mode {mode}" if mode else f"static case {number}"
    return ForceBlock(f"{path}, line {block.line}, {called}", number, mode, node, element, kind, values[:, 2:])
