"""Grid point forces and mode shapes of one FE run, the same for every solver and file format."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem, refuse

TOTALS = "*TOTALS*"
NOT_AN_ELEMENT = frozenset({"APP-LOAD", "F-OF-SPC", "F-OF-MPC", TOTALS})
"""Row names of a grid point force balance that are no elements."""

_ABSURD = 1e30

REQUEST = "Request GPFORCE(PLOT)=ALL or a set that covers the weld elements, SORT1, REAL, with PARAM,POST,-1 in SOL 103"


@dataclass(frozen=True, slots=True, eq=False)
class FeResults:
    """One modal run, or the static subcases of one run, in the file's own units and frames.

    Attributes
    ----------
    source : file
    solver : version label, empty if the file has none
    analysis : "modal", or "static", where every subcase stands for a mode
    mode : (m,) mode number, or subcase number
    frequency : (m,) frequency [Hz], NaN if unknown
    modal_mass : (m,) generalised mass, NaN if unknown
    node, element, kind : (r,) grid, element and row name ("QUAD4", "APP-LOAD", ...) of every force row; element 0: none
    force : (m, r, 6) forces and moments of the rows, in the displacement frame of the node
    shape_node : (n,) grids of the mode shapes, empty without eigenvectors
    shape : (m, n, 6) mode shapes, in the displacement frame of the node
    remarks : doubts met while reading
    """

    source: str
    solver: str
    analysis: Literal["modal", "static"]
    mode: NDArray[np.int64]
    frequency: NDArray[np.float64]
    modal_mass: NDArray[np.float64]
    node: NDArray[np.int64]
    element: NDArray[np.int64]
    kind: NDArray[np.str_]
    force: NDArray[np.floating]
    shape_node: NDArray[np.int64]
    shape: NDArray[np.floating]
    remarks: tuple[Problem, ...] = field(default=())

    @property
    def of_element(self) -> NDArray[np.bool_]:
        """(r,) rows that are the force of an element."""
        return (self.element > 0) & ~np.isin(self.kind, sorted(NOT_AN_ELEMENT))


@dataclass(frozen=True, slots=True, eq=False)
class ForceBlock:
    """Force rows of one mode or subcase as a file holds them."""

    where: str
    subcase: int
    mode: int  # 0 in a static subcase
    node: NDArray[np.int64]
    element: NDArray[np.int64]
    kind: NDArray[np.str_]
    force: NDArray[np.floating]  # (r, 6)


@dataclass(frozen=True, slots=True, eq=False)
class ShapeBlock:
    """Mode shape of one mode or subcase as a file holds it."""

    subcase: int
    mode: int
    node: NDArray[np.int64]
    shape: NDArray[np.floating]  # (n, 6)


@dataclass(frozen=True, slots=True)
class Eigenvalue:
    """One line of an eigenvalue summary."""

    frequency: float
    modal_mass: float


def is_sound(values: NDArray[np.floating]) -> NDArray[np.bool_]:
    """Whether values are numbers of sensible size; NaN, infinity and 1e30 are signs of damage."""
    return np.asarray(np.abs(values) < _ABSURD)


def assemble(
    source: str,
    solver: str,
    forces: list[ForceBlock],
    shapes: list[ShapeBlock],
    eigenvalues: dict[int, Eigenvalue],
    subcase: int | None,
) -> FeResults:
    """Join the blocks of a file into one run.

    Parameters
    ----------
    subcase : the subcase to take from a file with several modal ones; None if there is only one

    Raises
    ------
    DataError : no blocks, a choice of subcase is needed, a mode or a row given twice, rows that differ between modes, a
        value that is no number
    """
    chosen, remarks = _choose(source, forces, subcase)
    problems = list(_row_problems(chosen))
    first = chosen[0]
    for block in chosen[1:]:
        if not (np.array_equal(block.node, first.node) and np.array_equal(block.element, first.element)):
            problems.append(
                Problem(
                    "rows_differ",
                    block.where,
                    f"its {block.node.size} force rows are not those of {first.where} ({first.node.size} rows)",
                    "Request the same GPFORCE set for all modes",
                )
            )
    refuse(DataError, problems)
    is_modal = first.mode > 0
    key = np.array([block.mode if is_modal else block.subcase for block in chosen], np.int64)
    known = [eigenvalues.get(int(k)) if is_modal else None for k in key]
    if is_modal and eigenvalues and (stray := sorted(set(key.tolist()) - set(eigenvalues))):
        raise DataError(
            Problem(
                "unknown_mode",
                source,
                f"mode {stray[0]} has forces and is not in the eigenvalue summary of {len(eigenvalues)} modes",
                "Give the results of one run; copy the file again if it was one",
            )
        )
    if is_modal and (silent := sorted(set(eigenvalues) - set(key.tolist()))):
        remarks.append(
            Problem(
                "modes_without_forces",
                source,
                f"the eigenvalue summary lists {len(eigenvalues)} modes, {len(silent)} of them without forces, "
                f"mode {silent[0]} the first",
                "Request GPFORCE for all modes that the simulation uses",
            )
        )
    shape_node, shape = _shapes(key, is_modal, shapes, {block.subcase for block in chosen})
    return FeResults(
        source=source,
        solver=solver,
        analysis="modal" if is_modal else "static",
        mode=key,
        frequency=np.array([e.frequency if e else np.nan for e in known]),
        modal_mass=np.array([e.modal_mass if e else np.nan for e in known]),
        node=first.node,
        element=first.element,
        kind=first.kind,
        force=np.stack([block.force for block in chosen]),
        shape_node=shape_node,
        shape=shape,
        remarks=tuple(remarks),
    )


def _choose(source: str, blocks: list[ForceBlock], subcase: int | None) -> tuple[list[ForceBlock], list[Problem]]:
    """Blocks of the run asked for: all static subcases, or the modes of one subcase."""
    if subcase is not None:
        found = sorted({block.subcase for block in blocks})
        blocks = [block for block in blocks if block.subcase == subcase]
        if not blocks:
            raise DataError(
                Problem("no_subcase", source, f"subcase {subcase} has no grid point forces", f"Name one of {found}")
            )
    modal = [block for block in blocks if block.mode > 0]
    remarks = []
    if modal and len(modal) < len(blocks):
        remarks.append(
            Problem(
                "static_left_out",
                source,
                f"{len(blocks) - len(modal)} static subcases are left out beside the modes",
                "Name the static subcase if it was meant",
            )
        )
    chosen = modal or blocks
    subcases = sorted({block.subcase for block in modal})
    if len(subcases) > 1:
        raise DataError(
            Problem("many_subcases", source, f"modes of several subcases: {subcases}", "Name the subcase to use")
        )
    seen: set[tuple[int, int]] = set()
    for block in chosen:
        if (block.subcase, block.mode) in seen:
            raise DataError(
                Problem(
                    "block_twice",
                    block.where,
                    f"subcase {block.subcase} mode {block.mode} is given more than once, as superelements, restarts "
                    "and design cycles do",
                    "Give the results of one residual structure and one run",
                )
            )
        seen.add((block.subcase, block.mode))
    return chosen, remarks


def _row_problems(blocks: list[ForceBlock]) -> Iterator[Problem]:
    """Check the rows of every block; the node and element columns are compared with the first block elsewhere."""
    for block in blocks:
        if (bad := np.flatnonzero(~is_sound(block.force).all(axis=1))).size:
            yield Problem(
                "not_a_number",
                f"{block.where}, node {block.node[bad[0]]}, element {block.element[bad[0]]}",
                f"{bad.size} force rows hold a value that is no number of sensible size",
                "Copy the file again, or repeat the run",
            )
    first = blocks[0]
    if first.node.size == 0 or not ((first.element > 0) & ~np.isin(first.kind, sorted(NOT_AN_ELEMENT))).any():
        yield Problem("no_element_rows", first.where, "there is no force row of an element", REQUEST)
        return
    if (bad := np.flatnonzero((first.node <= 0) | (first.element < 0))).size:
        yield Problem(
            "bad_id",
            first.where,
            f"{bad.size} rows with impossible ids, node {first.node[bad[0]]} element {first.element[bad[0]]} the first",
            "Copy the file again, or repeat the run",
        )
    rows = np.flatnonzero(first.element > 0)
    order = rows[np.lexsort((first.node[rows], first.element[rows]))]
    node, element = first.node[order], first.element[order]
    twice = np.flatnonzero((np.diff(node) == 0) & (np.diff(element) == 0))
    if twice.size:
        yield Problem(
            "row_twice",
            first.where,
            f"{twice.size} element rows are given twice, element {element[twice[0]]} node {node[twice[0]]} the first",
            "Give the results of one run without superelements",
        )
    kind = first.kind[order]
    mixed = np.flatnonzero((np.diff(element) == 0) & (kind[1:] != kind[:-1]))
    if mixed.size:
        yield Problem(
            "kind_differs",
            first.where,
            f"element {element[mixed[0]]} is named {kind[mixed[0]]} and {kind[mixed[0] + 1]}",
            "Copy the file again, or give every element its own id",
        )


def _shapes(
    key: NDArray[np.int64], is_modal: bool, blocks: list[ShapeBlock], subcases: set[int]
) -> tuple[NDArray[np.int64], NDArray[np.floating]]:
    """Mode shapes of all modes, or none if one is missing or their grids differ."""
    found = {
        (b.mode if is_modal else b.subcase): b for b in blocks if b.subcase in subcases and is_modal == (b.mode > 0)
    }
    wanted = [found.get(int(k)) for k in key]
    complete = [b for b in wanted if b is not None]
    if len(complete) < len(wanted) or any(not np.array_equal(b.node, complete[0].node) for b in complete):
        return np.empty(0, np.int64), np.empty((key.size, 0, 6))
    return complete[0].node, np.stack([b.shape for b in complete])
