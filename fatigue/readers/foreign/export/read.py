"""Forces, mode shapes and mesh from the text that our script writes in Abaqus."""

from collections.abc import Collection
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.readers.foreign.export.elements import abaqus_form, element_of
from fatigue.readers.foreign.export.layout import Block, blocks, damaged
from fatigue.readers.foreign.export.results import read_results
from fatigue.readers.foreign.export.rows import columns, ids, whole
from fatigue.readers.foreign.fe.model import FeModel, Section, Shell, Solid, others_left_out, shell_mesh, solid_mesh
from fatigue.readers.foreign.fe.results import FeResults

_OF_MESH = frozenset({"nodes", "elements", "sections", "layered"})


def read_export(
    path: Path, subcase: int | None = None, interface: Collection[int] = (), loads: Collection[int] | None = ()
) -> FeResults:
    """Forces and shapes of all modes, and of static cases beside them.

    Raises
    ------
    DataError : a damaged or cut text, forces of an element that it does not list; as ``assemble``
    """
    return read_results(path, _kinds, subcase, interface, loads)


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
            rows = columns(path, block, 4)
            grids |= dict(zip(ids(path, block, 0).tolist(), rows[:, 1:], strict=True))
        elif block.name == "sections":
            for number, thickness, offset in columns(path, block, 3).tolist():
                sections[int(number)] = Section(thickness if thickness > 0.0 else np.nan, offset)
        elif block.name == "layered":
            layered |= set(ids(path, block, 0).tolist())
        elif (form := abaqus_form(block.words)) is None:
            others[block.words] = others.get(block.words, 0) + len(block.values)
        else:
            if block.values.shape[1] != 2 + form.corners + len(form.mids):
                own = form.corners + len(form.mids)
                what = f"elements {block.words} have {own} nodes, and {block.values.shape[1] - 2} here"
                raise damaged(path, block.line, what)
            for element, pid, *nodes in whole(path, block).tolist():
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


def _kinds(path: Path, block: Block) -> dict[int, str]:
    """Names of elements in force rows, by id; the words of the block are their type."""
    form = abaqus_form(block.words)
    return dict.fromkeys(ids(path, block, 0).tolist(), form.kind if form else block.words.upper()[:8])
