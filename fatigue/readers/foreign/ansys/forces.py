"""Element nodal forces, frequencies and mode shapes from the text that our macro writes in ANSYS."""

from collections.abc import Collection
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem
from fatigue.readers.foreign.ansys.elements import SHELLS, SOLIDS, element_of, kind_of
from fatigue.readers.foreign.export.layout import HEAD, Block, blocks, solver_of
from fatigue.readers.foreign.fe.assembly import FileBlocks, assemble
from fatigue.readers.foreign.fe.force_rows import sharing_rows
from fatigue.readers.foreign.fe.results import Eigenvalue, FeResults, ForceBlock, ShapeBlock
from fatigue.readers.foreign.fe.static_case import Heading, heading

_MODAL = 1_000_000  # subcase of the modes, beside the numbers of static load cases
_ANEW = "Write it again with the macro (fatigue request ansys), or copy it whole"
_CORNERS = {4: 4, 10: 4, 8: 8, 20: 8}
"""Of solids the macro lists the corners, which tell a brick from a prism."""
_COLUMNS = {"mode": 3, "static": 1, "shape": 7, "forces": 8}


def is_ansys_export(head: str) -> bool:
    """Whether a text begins as our macro begins it."""
    found = HEAD.match(head)
    return found is not None and found[2].upper() == "ANSYS"


def read_ansys_forces(
    path: Path, subcase: int | None = None, interface: Collection[int] = (), loads: Collection[int] | None = ()
) -> FeResults:
    """Read forces and shapes of all modes, and of static load cases beside them; forces stay as ANSYS has them.

    ANSYS gives the force of the element on the node, ``-K_e u_e``, in global axes (``RSYS,0``).

    Raises
    ------
    DataError : a damaged or cut text, another version, an element that is not listed, as ``assemble``
    """
    kinds: dict[int, str] = {}
    forces: list[ForceBlock] = []
    shapes: list[ShapeBlock] = []
    summary: list[Eigenvalue] = []
    headings: dict[int, Heading] = {}
    current: tuple[int, int] | None = None
    for block in blocks(path, frozenset({"elements", *_COLUMNS})):
        if block.name == "elements":
            kinds |= _kinds(path, block)
            continue
        if block.values.shape[1] != _COLUMNS[block.name]:
            what = f"*{block.name} has {block.values.shape[1]} columns, and {_COLUMNS[block.name]} are read"
            raise _damaged(path, block.line, what)
        if block.name in ("mode", "static"):
            if len(block.values) != 1:
                raise _damaged(path, block.line, f"*{block.name} has {len(block.values)} rows, and 1 is read")
            number = int(_ids(path, block, 0)[0])
            current = (_MODAL, number) if block.name == "mode" else (number, 0)
            if block.name == "mode":
                frequency, mass = (float(value) for value in block.values[0, 1:])
                if mass < 0.0:
                    raise _damaged(path, block.line + 1, f"{mass:g} is no modal mass")
                mass = mass if mass > 0.0 else np.nan  # the macro was told that shapes are not normalised to mass
                summary.append(Eigenvalue(_MODAL, number, frequency, mass, (2.0 * np.pi * frequency) ** 2))
            else:
                headings[number] = heading("", block.words, "")
        elif current is None:
            raise _damaged(path, block.line, f"*{block.name} stands before any *mode or *static")
        elif block.name == "shape":
            shapes.append(ShapeBlock(*current, _ids(path, block, 0), block.values[:, 1:]))
        else:
            forces.append(sharing_rows(_forces(path, block, current, kinds), forces))
    return assemble(
        FileBlocks(str(path), solver_of(path), forces, shapes, summary, {}, (), headings), subcase, interface, loads
    )


def _kinds(path: Path, block: Block) -> dict[int, str]:
    """Names of elements in force rows, by id; the words of the block are the element routine."""
    if not block.words.rstrip(".").isdigit():
        raise _damaged(path, block.line, f"{block.words[:20]!r} is no element routine")
    routine = int(block.words.rstrip("."))
    nodes = SHELLS.get(routine) or _CORNERS.get(SOLIDS.get(routine, 0))
    if nodes is not None and block.values.shape[1] != 2 + nodes:
        what = f"elements {routine} have {nodes} nodes in the text, and {block.values.shape[1] - 2} here"
        raise _damaged(path, block.line, what)
    found = {}
    for element, row in zip(_ids(path, block, 0).tolist(), _whole(path, block).tolist(), strict=True):
        made = element_of(routine, element, row[1], row[2:])
        found[element] = kind_of(made) if made else f"E{routine}"
    return found


def _forces(path: Path, block: Block, current: tuple[int, int], kinds: dict[int, str]) -> ForceBlock:
    """Rows of one mode or load case; at a node that a degenerate element repeats they stand once."""
    element, node = _ids(path, block, 0), _ids(path, block, 1)
    unknown = np.flatnonzero(~np.isin(element, np.fromiter(kinds, np.int64, len(kinds))))
    if unknown.size:
        row = int(unknown[0])
        raise _damaged(path, block.line + row + 1, f"element {element[row]} has forces and is not listed above")
    known, place = np.unique(element, return_inverse=True)
    kind = np.array([kinds[int(number)] for number in known], np.str_)[place]
    number, mode = current
    where = f"{path}, line {block.line}, " + (f"mode {mode}" if mode else f"load case {number}")
    return ForceBlock(where, number, mode, node, element, kind, block.values[:, 2:])


def _ids(path: Path, block: Block, column: int) -> NDArray[np.int64]:
    """A column of ids."""
    values = block.values[:, column]
    bad = np.flatnonzero(~((values >= 1) & (values < 2**53) & (values == np.rint(values))))
    if bad.size:
        raise _damaged(path, block.line + int(bad[0]) + 1, f"{values[bad[0]]:g} is no id")
    return values.astype(np.int64)


def _whole(path: Path, block: Block) -> NDArray[np.int64]:
    """Rows of whole numbers from 0."""
    bad = np.flatnonzero(
        ~((block.values >= 0) & (block.values < 2**53) & (block.values == np.rint(block.values))).all(1)
    )
    if bad.size:
        raise _damaged(path, block.line + int(bad[0]) + 1, "a row of ids holds a value that is none")
    return block.values.astype(np.int64)


def _damaged(path: Path, line: int, what: str) -> DataError:
    return DataError(Problem("export_damaged", f"{path}, line {line}", what, _ANEW))
