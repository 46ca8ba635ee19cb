"""Stresses of homogeneous shells from a NASTRAN or OptiStruct OP2 file: tables OES1, OES1X and OES1X1."""

import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem
from fatigue.readers.foreign.fe.shell_stress import REQUEST, ShellStresses, StressBlock
from fatigue.readers.foreign.nastran.results.analysis import MODES, STATIC, wrong_analysis
from fatigue.readers.foreign.nastran.results.op2_blocks import Identification, blocks, damaged, heads
from fatigue.readers.foreign.nastran.results.op2_records import Op2File, Op2Table, Record, read_records
from fatigue.readers.foreign.nastran.results.stress_kinds import (
    LAYERED,
    LAYERED_WHY,
    MATERIAL_BIT,
    STRAIN_BITS,
    STRESS_KINDS,
    StressKind,
    strains,
    wrong_system,
)

_TABLE = re.compile(r"OES1(X1?|A|C)?\Z")
_TELLS_ANALYSIS = re.compile(r"OUGV?1|OGPFB1")
_STRESS, _SORT2 = 5, 1000
_REAL = 1  # format code


def read_op2_stresses(path: Path, wanted: NDArray[np.int64]) -> ShellStresses:
    """Read the stresses of the ``wanted`` elements in all real modes and static subcases.

    Both word sizes and both byte orders are read.

    Raises
    ------
    DataError : damaged file, no stresses of shells, strains, stresses in the material system, complex or SORT2 results,
        several runs
    """
    op2 = read_records(path)
    tables = [table for table in op2.tables if _TABLE.match(table.name)]
    if len({table.run for table in tables}) > 1:
        what = "the file holds several runs with stresses, one behind the other"
        remedy = "Delete the OP2 file before the run that matters, and repeat it"
        raise DataError(Problem("many_runs", str(path), what, remedy))
    modes_of = _modes_told(op2)
    found: list[StressBlock] = []
    unread: dict[int, str] = {}
    problems: list[Problem] = []
    for table in tables:
        for head, body in blocks(op2, table):
            kind = STRESS_KINDS.get(head.element_type)
            if kind is None and head.element_type not in LAYERED:
                continue
            if (problem := _unusable(op2, table, head)) is not None:
                problems.append(problem)
            elif kind is not None:
                found += _block(op2, table, _as_told(head, modes_of), body, kind, wanted)
            else:
                unread |= dict.fromkeys(_layered(op2, table, head, body, wanted), LAYERED_WHY)
    if not tables or not (found or unread or problems):
        names = ", ".join(dict.fromkeys(table.name for table in op2.tables)) or "none"
        what = f"no stresses of these shells (tables OES1, OES1X, OES1X1); tables found: {names}"
        raise DataError(Problem("no_stresses", str(path), what, REQUEST))
    return ShellStresses(str(path), tuple(found), unread, tuple(dict.fromkeys(problems)))


def _modes_told(op2: Op2File) -> set[tuple[int, int]]:
    """Subcase and mode of displacements and forces that are modal, in subcases that are nothing else.

    MYSTRAN states static stresses in a modal run, with the number of the mode where others have that of a load.
    """
    told = [head for table in op2.tables if _TELLS_ANALYSIS.match(table.name) for head in heads(op2, table)]
    static = {head.subcase for head in told if head.approach == STATIC}
    return {(head.subcase, head.mode) for head in told if head.is_modal and head.subcase not in static}


def _as_told(head: Identification, modes_of: set[tuple[int, int]]) -> Identification:
    """Identification as the displacements and forces of the file have it."""
    if head.is_modal or (head.subcase, head.mode) not in modes_of:
        return head
    return replace(head, approach=MODES, eigenvalue=np.nan)


def _unusable(op2: Op2File, table: Op2Table, head: Identification) -> Problem | None:
    """Why a block holds no real stresses of the residual structure in element axes; None if it does."""
    where = f"{op2.path}, {table.name} subcase {head.subcase}"
    if head.approach not in (STATIC, MODES):
        return wrong_analysis(where, head.approach, "stresses")
    if head.table_code >= _SORT2 or head.format_code != _REAL:
        return Problem("complex_stresses", where, "the stresses are complex or sorted by element (SORT2)", REQUEST)
    if head.superelement:
        what = f"the stresses belong to superelement {head.superelement}"
        return Problem("superelement", where, what, "Run the model without superelements")
    if head.table_code != _STRESS or head.stress_code & STRAIN_BITS:
        return strains(where)
    return wrong_system(where) if head.stress_code & MATERIAL_BIT else None


def _rows(op2: Op2File, table: Op2Table, head: Identification, body: Record) -> NDArray[np.uint8]:
    """Bytes of every row."""
    raw, size = op2.record(body), head.words_per_row * op2.word
    if size <= 0 or raw.size % size:
        raise damaged(op2, table, f"a record of {raw.size // op2.word} words is no whole number of rows")
    return raw.reshape(-1, size)


def _ids(op2: Op2File, table: Op2Table, rows: NDArray[np.uint8]) -> NDArray[np.int64]:
    """Element ids of the keys 10 x element + device code that rows begin with."""
    key = np.ascontiguousarray(rows[:, : op2.word]).view(f"{op2.order}i{op2.word}")[:, 0]
    if (key < 10).any():
        raise damaged(op2, table, f"the key {key[key < 10][0]} is no element")
    return np.asarray(key // 10, np.int64)


def _layered(
    op2: Op2File, table: Op2Table, head: Identification, body: Record, wanted: NDArray[np.int64]
) -> Iterator[int]:
    """Ids of the wanted elements of a block of ply stresses."""
    return (int(e) for e in np.unique(_ids(op2, table, _rows(op2, table, head, body))) if e in wanted)


def _block(
    op2: Op2File, table: Op2Table, head: Identification, body: Record, kind: StressKind, wanted: NDArray[np.int64]
) -> Iterator[StressBlock]:
    """Stresses of one mode and element type, none if no element of it is wanted."""
    if head.words_per_row != kind.words:
        found = f"{head.words_per_row} words in a row of element type {head.element_type}, not {kind.words}"
        raise damaged(op2, table, found)
    rows = _rows(op2, table, head, body)
    element = _ids(op2, table, rows)
    chosen = np.isin(element, wanted)
    if not chosen.any():
        return
    rows, element = np.ascontiguousarray(rows[chosen]), element[chosen]
    o, w, points = op2.order, op2.word, 1 + kind.corners
    words = rows.view(f"{o}i{w}")
    reals = rows.view(f"{o}f{w}")
    if kind.corners:
        node = words[:, 2:].reshape(-1, points, 17)[:, :, 0].astype(np.int64)
        values = reals[:, 2:].reshape(-1, points, 17)[:, :, 1:]
    else:
        node = np.zeros((element.size, 1), np.int64)
        values = reals[:, 1:]
    node[:, 0] = 0  # the number of corners stands there
    if (node[:, 1:] < 1).any():
        raise damaged(op2, table, "a stress belongs to no grid")
    fibres = values.reshape(-1, points, 2, 8).astype(
        f"=f{w}"
    )  # distance, sx, sy, txy, angle, principal ones, von Mises
    subcase, mode = head.key
    where = f"{op2.path}, {table.name} subcase {subcase}" + (f" mode {mode}" if mode else "")
    eigenvalue = head.eigenvalue if mode else np.nan
    yield StressBlock(where, subcase, mode, eigenvalue, kind.name, element, node, fibres[..., 0], fibres[..., 1:4])
