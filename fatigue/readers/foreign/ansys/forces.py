"""Element nodal forces, frequencies and mode shapes from the text that our macro writes in ANSYS."""

from collections.abc import Collection
from pathlib import Path

from fatigue.readers.foreign.ansys.elements import SHELLS, SOLIDS, element_of, kind_of
from fatigue.readers.foreign.export.layout import HEAD, Block, damaged
from fatigue.readers.foreign.export.results import read_results
from fatigue.readers.foreign.export.rows import ids, whole
from fatigue.readers.foreign.fe.results import FeResults

_CORNERS = {4: 4, 10: 4, 8: 8, 20: 8}
"""Of solids the macro lists the corners, which tell a brick from a prism."""


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
    return read_results(path, _kinds, subcase, interface, loads)


def _kinds(path: Path, block: Block) -> dict[int, str]:
    """Names of elements in force rows, by id; the words of the block are the element routine."""
    if not block.words.rstrip(".").isdigit():
        raise damaged(path, block.line, f"{block.words[:20]!r} is no element routine")
    routine = int(block.words.rstrip("."))
    nodes = SHELLS.get(routine) or _CORNERS.get(SOLIDS.get(routine, 0))
    if nodes is not None and block.values.shape[1] != 2 + nodes:
        what = f"elements {routine} have {nodes} nodes in the text, and {block.values.shape[1] - 2} here"
        raise damaged(path, block.line, what)
    found = {}
    for element, row in zip(ids(path, block, 0).tolist(), whole(path, block).tolist(), strict=True):
        made = element_of(routine, element, row[1], row[2:])
        found[element] = kind_of(made) if made else f"E{routine}"
    return found
