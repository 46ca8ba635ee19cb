"""A register of one mesh under the names that its lines have by coordinates, which other meshes give them, too."""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path

from fatigue.errors import Problem
from fatigue.readers.neutral.register.weld_register import RegisterRow
from fatigue.weld.cuts import WeldCut

_Side = tuple[frozenset[int], frozenset[int]]


def moved(
    rows: Iterable[RegisterRow],
    cuts: Mapping[str, WeldCut],
    again: Mapping[str, RegisterRow],
    cuts_again: Mapping[str, WeldCut],
    lines: Path,
) -> tuple[list[RegisterRow], list[Problem]]:
    """Rows under the names of the same plate sides by coordinates, and warnings about welds that have none.

    Parameters
    ----------
    rows, cuts : register of the mesh, and its cuts by line
    again, cuts_again : the same, of the lines as they were written, on the same mesh
    """
    by_side = {_side(cut): name for name, cut in cuts_again.items()}
    taken: set[str] = set()
    found, warnings = [], []
    for row in rows:
        cut = cuts.get(row.line)
        name = by_side.get(_side(cut)) if cut is not None else None
        if name is not None:
            taken.add(name)
            found.append(replace(row, line=name, weld=name if row.weld == row.line else row.weld))
        elif row.status == "assess":
            what = f"weld {row.weld} is cut otherwise by the lines as they are written: they name no line of its nodes"
            remedy = "Register the lines that replace it"
            warnings.append(Problem("line_changed", f"{lines}", what, remedy))
    return [*found, *(row for name, row in again.items() if name not in taken)], warnings


def _side(cut: WeldCut) -> _Side:
    """What tells the plate side of a cut from all others of its mesh."""
    return frozenset(cut.line.node.tolist()), frozenset(cut.elements.tolist())
