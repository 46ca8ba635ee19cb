"""Forces, mode shapes and mesh from an exported text."""

from collections.abc import Collection
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem
from fatigue.readers.foreign.export.elements import abaqus_form, element_of
from fatigue.readers.foreign.export.layout import Block, blocks, solver_of
from fatigue.readers.foreign.fe.assembly import FileBlocks, assemble
from fatigue.readers.foreign.fe.force_rows import sharing_rows
from fatigue.readers.foreign.fe.model import FeModel, Section, Shell, Solid, others_left_out, shell_mesh, solid_mesh
from fatigue.readers.foreign.fe.results import Eigenvalue, FeResults, ForceBlock, ShapeBlock
from fatigue.readers.foreign.fe.static_case import Heading, heading

_OF_RESULTS = frozenset({"elements", "mode", "static", "shape", "forces"})
_OF_MESH = frozenset({"nodes", "elements", "sections", "layered", "others"})
_MODAL = 1_000_000  # subcase of the modes, beside the numbers of static cases


def read_export(
    path: Path, subcase: int | None = None, interface: Collection[int] = (), loads: Collection[int] | None = ()
) -> FeResults:
    """Forces and shapes of all modes, and of static cases beside them.

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
    for block in blocks(path, _OF_RESULTS):
        where = f"{path}, line {block.line}"
        if block.name == "elements":
            form = abaqus_form(block.words)
            kinds |= dict.fromkeys(_ids(path, block, 0).tolist(), form.kind if form else block.words.upper()[:8])
        elif block.name == "mode":
            number, frequency, mass = _only_row(path, block, 3)
            current = (_MODAL, int(number))
            eigenvalue = (2.0 * np.pi * frequency) ** 2
            summary.append(Eigenvalue(_MODAL, int(number), float(frequency), float(mass), float(eigenvalue)))
        elif block.name == "static":
            number = int(_only_row(path, block, 1)[0])
            current = (number, 0)
            headings[number] = heading("", block.words, "")
        elif current is None:
            raise DataError(
                Problem("export_damaged", where, f"*{block.name} stands before any *mode", "Write it again")
            )
        elif block.name == "shape":
            shapes.append(ShapeBlock(*current, _ids(path, block, 0), _columns(path, block, 7)[:, 1:]))
        else:
            forces.append(sharing_rows(_forces(path, block, where, current, kinds), forces))
    stated: dict[tuple[int, int], list[float]] = {}
    file = FileBlocks(str(path), solver_of(path), forces, shapes, summary, stated, (), headings)
    return assemble(file, subcase, interface, loads)


def read_export_model(path: Path) -> FeModel:
    """Mesh, thicknesses and offsets of an exported text.

    Raises
    ------
    DataError : a damaged or cut text, an element of a node that it does not list, neither shells nor solids
    """
    grids: dict[int, NDArray[np.float64]] = {}
    shells: list[Shell] = []
    solids: list[Solid] = []
    sections: dict[int, Section] = {}
    layered: set[int] = set()
    others: dict[str, int] = {}
    for block in blocks(path, _OF_MESH):
        if block.name == "nodes":
            rows = _finite(path, block, _columns(path, block, 4))
            grids |= dict(zip(_ids(path, block, 0).tolist(), rows[:, 1:], strict=True))
        elif block.name == "sections":
            for number, thickness, offset in _finite(path, block, _columns(path, block, 3)).tolist():
                sections[int(number)] = Section(thickness if thickness > 0.0 else np.nan, offset)
        elif block.name == "layered":
            layered |= set(_ids(path, block, 0).tolist())
        elif (form := abaqus_form(block.words)) is None:
            others[block.words] = others.get(block.words, 0) + len(block.values)
        else:
            if block.values.shape[1] != 2 + form.corners + len(form.mids):
                own = form.corners + len(form.mids)
                what = f"elements {block.words} have {own} nodes, and {block.values.shape[1] - 2} here"
                raise DataError(Problem("export_damaged", f"{path}, line {block.line}", what, "Write it again"))
            for element, pid, *nodes in _whole(path, block).tolist():
                made = element_of(form, element, pid, nodes)
                (shells if isinstance(made, Shell) else solids).append(made)  # type: ignore[arg-type]
    mesh = shell_mesh(str(path), grids, shells, sections)
    unknown = sorted({shell.pid for shell in shells} - sections.keys())
    unconfirmed = {pid: f"section {pid} is not in the text" for pid in unknown}
    unconfirmed |= {pid: f"section {pid} is a layered section" for pid in sorted(layered)}
    return FeModel(
        source=str(path),
        mesh=mesh,
        frame_node=np.zeros(0, np.int64),
        frame=np.zeros((0, 3, 3)),
        unconfirmed_sections=unconfirmed,
        other_cards=others,
        warnings=others_left_out(str(path), others),
        solids=solid_mesh(str(path), grids, solids, shells),
    )


def _forces(path: Path, block: Block, where: str, current: tuple[int, int], kinds: dict[int, str]) -> ForceBlock:
    """Rows of one mode or static case."""
    values = _columns(path, block, 8)
    element, node = _ids(path, block, 0), _ids(path, block, 1)
    unknown = np.flatnonzero(~np.isin(element, np.fromiter(kinds, np.int64, len(kinds))))
    if unknown.size:
        row = int(unknown[0])
        place = f"{path}, line {block.line + row + 1}"
        what = f"element {element[row]} has forces and is not listed above"
        raise DataError(Problem("export_damaged", place, what, "Write it again"))
    kind = np.array([kinds[number] for number in element.tolist()], np.str_)
    number, mode = current
    called = f"mode {mode}" if mode else f"static case {number}"
    return ForceBlock(f"{where}, {called}", number, mode, node, element, kind, values[:, 2:])


def _only_row(path: Path, block: Block, columns: int) -> NDArray[np.float64]:
    row = _columns(path, block, columns)
    if len(row) != 1 or not (row[0, 0] >= 1 and float(row[0, 0]).is_integer()):
        what = f"*{block.name} has to have one row that begins with its number"
        raise DataError(Problem("export_damaged", f"{path}, line {block.line}", what, "Write it again"))
    found: NDArray[np.float64] = row[0]
    return found


def _columns(path: Path, block: Block, columns: int) -> NDArray[np.float64]:
    if block.values.shape[1] != columns:
        what = f"*{block.name} has {block.values.shape[1]} columns, and {columns} are read"
        raise DataError(Problem("export_damaged", f"{path}, line {block.line}", what, "Write it again"))
    return block.values


def _finite(path: Path, block: Block, values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rows, none of which holds a number that is not finite."""
    bad = np.flatnonzero(~np.isfinite(values).all(axis=1))
    if bad.size:
        place = f"{path}, line {block.line + int(bad[0]) + 1}"
        raise DataError(Problem("export_damaged", place, f"a number of *{block.name} is not finite", "Write it again"))
    return values


def _whole(path: Path, block: Block) -> NDArray[np.int64]:
    """Rows of whole numbers, none below zero."""
    values = block.values
    bad = np.argwhere(~((values >= 0) & (values < 2**53) & (values == np.rint(values))))
    if bad.size:
        row, column = bad[0].tolist()
        place = f"{path}, line {block.line + row + 1}"
        raise DataError(Problem("export_damaged", place, f"{values[row, column]:g} is no id", "Write it again"))
    return values.astype(np.int64)


def _ids(path: Path, block: Block, column: int) -> NDArray[np.int64]:
    """A column of ids."""
    values = block.values[:, column] if block.values.shape[1] > column else np.full(len(block.values), np.nan)
    bad = np.flatnonzero(~((values >= 1) & (values < 2**53) & (values == np.rint(values))))
    if bad.size:
        place = f"{path}, line {block.line + int(bad[0]) + 1}"
        raise DataError(Problem("export_damaged", place, f"{values[bad[0]]:g} is no id", "Write it again"))
    return values.astype(np.int64)
