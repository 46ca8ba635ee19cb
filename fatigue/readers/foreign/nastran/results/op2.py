"""Grid point forces, mode shapes, frequencies and generalised masses from a NASTRAN or OptiStruct OP2 file.

Only the tables that hold them are decoded; whatever else a solver writes is stepped over.
"""

import re
from collections import defaultdict
from collections.abc import Collection
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem
from fatigue.readers.foreign.fe.assembly import FileBlocks, assemble
from fatigue.readers.foreign.fe.force_rows import sharing_rows
from fatigue.readers.foreign.fe.results import (
    REQUEST,
    Eigenvalue,
    FeResults,
    ForceBlock,
    ShapeBlock,
    UnusableBlock,
    frequency_of,
    is_sound,
)
from fatigue.readers.foreign.fe.static_case import Heading
from fatigue.readers.foreign.nastran.results.analysis import ANALYSES, BUCKLING, MODES, STATIC, wrong_analysis
from fatigue.readers.foreign.nastran.results.op2_blocks import Identification, blocks, damaged, heads
from fatigue.readers.foreign.nastran.results.op2_records import Op2File, Op2Table, Record, characters, read_records

_FORCE_TABLES = ("OGPFB1",)
_SORT2_TABLES = ("OGPFB2",)
_SHAPE_TABLES = ("OUGV1", "OUG1")
_EIGENVALUE_TABLES = ("LAMA", "LAMAS")
_STATES_EIGENVALUE = re.compile(r"B?OUG|OQM?G")
"""Tables with the eigenvalue in word 6 of their identification: displacements in any frame, reactions."""
_GRID_POINT_FORCE, _EIGENVECTOR, _DISPLACEMENT = 19, 7, 1
_GRID = 1


def read_op2(
    path: Path, subcase: int | None = None, interface: Collection[int] = (), loads: Collection[int] | None = ()
) -> FeResults:
    """Read the grid point forces of a real modal run or of static subcases.

    Both word sizes and both byte orders are read.

    Parameters
    ----------
    subcase : the one to read, where the file has several that cannot be read together
    interface : static subcases that are modes of the basis, beside the modes of a modal subcase
    loads : static subcases that are loads beside them; None: all that can be

    Raises
    ------
    DataError : damaged file, no OGPFB1 table, complex or other than modal and static results, superelements, SORT2
    """
    op2 = read_records(path)
    forces: list[ForceBlock] = []
    unusable: list[UnusableBlock] = []
    shapes: list[ShapeBlock] = []
    stated: defaultdict[tuple[int, int], list[float]] = defaultdict(list)
    headings: dict[int, Heading] = {}
    for table in _tables(op2):
        if table.name in _FORCE_TABLES:
            for head, body in blocks(op2, table):
                if (other := _unusable(op2, table, head)) is not None:
                    unusable.append(UnusableBlock(head.subcase, other))
                else:
                    forces.append(sharing_rows(_force_block(op2, table, head, op2.record(body)), forces))
                    stated[head.key].append(_own_eigenvalue(head))
                    headings[head.subcase] = head.heading
        elif table.name in _SHAPE_TABLES:
            shapes += [block for pair in blocks(op2, table) if (block := _shape_block(op2, table, *pair))]
        if _STATES_EIGENVALUE.match(table.name):
            for head in heads(op2, table):
                if head.is_modal and not head.superelement:
                    stated[head.key].append(head.eigenvalue)
    summary: list[Eigenvalue] = []
    if any(block.mode for block in forces) or not (forces or unusable):
        tables = [table for table in _tables(op2) if table.name in _EIGENVALUE_TABLES]
        summary = [line for t in tables for pair in blocks(op2, t) for line in _eigenvalues(op2, t, *pair)]
    if not forces and not unusable:
        raise _without_forces(op2)
    file = FileBlocks(str(path), op2.label, forces, shapes, summary, stated, unusable, headings)
    results = assemble(file, subcase, interface, loads)
    return results if op2.is_closed else replace(results, warnings=(*results.warnings, _unclosed(op2)))


def _tables(op2: Op2File) -> tuple[Op2Table, ...]:
    """Tables of the one run of the file that has forces; a second run may have been appended to the first."""
    runs = sorted({table.run for table in op2.tables if table.name in _FORCE_TABLES})
    if len(runs) > 1:
        raise DataError(
            Problem(
                "many_runs",
                str(op2.path),
                f"the file holds {len(runs)} runs with grid point forces, one behind the other",
                "Delete the OP2 file before the run that matters, and repeat it",
            )
        )
    return tuple(table for table in op2.tables if not runs or table.run == runs[0])


def _unclosed(op2: Op2File) -> Problem:
    """Warning about a file that ends with a whole table and without an end mark."""
    return Problem(
        "no_end_mark",
        str(op2.path),
        f"the file has no end mark: tables behind the last one, {op2.tables[-1].name}, may be missing",
        "Copy the file again, or repeat the run, if it was cut",
    )


def _without_forces(op2: Op2File) -> DataError:
    """Refusal that tells which tables the file has instead."""
    names = list(dict.fromkeys(table.name for table in op2.tables))
    found = ", ".join(names[:12]) + (" ..." if len(names) > 12 else "") if names else "none"
    if any(name in _SORT2_TABLES for name in names):
        return DataError(
            Problem(
                "sort2", str(op2.path), "the grid point forces are sorted by node (OGPFB2)", "Request SORT1 results"
            )
        )
    shapes = [head for t in op2.tables if _STATES_EIGENVALUE.match(t.name) for head in heads(op2, t)]
    if buckling := next((head for head in shapes if head.approach in BUCKLING), None):
        return DataError(wrong_analysis(str(op2.path), buckling.approach, "shapes"))
    return DataError(
        Problem("no_forces", str(op2.path), f"no grid point forces (table OGPFB1); tables found: {found}", REQUEST)
    )


def _own_eigenvalue(head: Identification) -> float:
    """Eigenvalue in the identification of forces, if its frequency stands beside it; NaN otherwise."""
    eigenvalue, frequency = head.own
    if head.approach != MODES or not 0 < abs(eigenvalue) < np.inf:
        return np.nan
    return eigenvalue if np.isclose(frequency_of(eigenvalue), frequency, rtol=1e-4, atol=0) else np.nan


def _unusable(op2: Op2File, table: Op2Table, head: Identification) -> Problem | None:
    """Why a block is no real SORT1 grid point force balance of the residual structure; None if it is."""
    where = f"{op2.path}, {table.name} subcase {head.subcase}"
    if head.approach not in (STATIC, MODES):
        return wrong_analysis(where, head.approach)
    if head.table_code >= 1000 or head.words_per_row == 16:
        return Problem(
            "complex_forces", where, "the forces are complex or sorted by node (SORT2)", "Request REAL, SORT1"
        )
    if head.superelement:
        return Problem(
            "superelement",
            where,
            f"the forces belong to a superelement: {head.superelement}",
            "Run the model without superelements, or give the residual structure that holds the welds",
        )
    return None


def _force_block(op2: Op2File, table: Op2Table, head: Identification, record: NDArray[np.uint8]) -> ForceBlock:
    """Rows of one mode."""
    if head.table_code != _GRID_POINT_FORCE or head.words_per_row != 10:
        raise damaged(
            op2, table, f"table code {head.table_code} with {head.words_per_row} words in a row, not 19 with 10"
        )
    if head.subcase < (0 if head.approach == MODES else 1) or (head.approach == MODES and head.mode < 1):
        raise damaged(op2, table, f"subcase {head.subcase} mode {head.mode} is impossible")
    o, w = op2.order, op2.word
    dtype = np.dtype([("key", f"{o}i{w}"), ("element", f"{o}i{w}"), ("kind", f"S{2 * w}"), ("force", f"{o}f{w}", 6)])
    if record.size % dtype.itemsize:
        raise damaged(op2, table, f"a record of {record.size // w} words is no whole number of rows")
    rows = record.view(dtype)
    subcase, mode = head.key
    where = f"{op2.path}, {table.name} subcase {subcase}"
    return ForceBlock(
        f"{where} mode {mode}" if mode else where,
        subcase,
        mode,
        _nodes(op2, table, rows["key"]),
        rows["element"].astype(np.int64),
        _kinds(op2, table, rows["kind"]),
        rows["force"].astype(f"=f{w}"),
    )


def _nodes(op2: Op2File, table: Op2Table, key: NDArray[np.signedinteger]) -> NDArray[np.int64]:
    """Grid ids of keys 10 x grid + device code; the identification may have another code."""
    if (key < 10).any():
        raise damaged(op2, table, f"the key {key[key < 10][0]} is no grid")
    return np.asarray(key // 10, np.int64)


def _kinds(op2: Op2File, table: Op2Table, raw: NDArray[np.bytes_]) -> NDArray[np.str_]:
    """Row names, every distinct one decoded once."""
    raw = np.ascontiguousarray(raw)
    _, first, which = np.unique(raw.view(np.uint64) if op2.word == 4 else raw, return_index=True, return_inverse=True)
    names = [characters(name, op2.word).strip(" \0") for name in raw[first].tolist()]
    for name in names:
        if not (name.isascii() and name.isprintable()):
            raise damaged(op2, table, f"a row is named {name!r}")
    return np.array(names, dtype=np.str_)[which]


def _shape_block(op2: Op2File, table: Op2Table, head: Identification, body: Record) -> ShapeBlock | None:
    """Mode shape of one mode; None for what the audit has no use for, superelements among it."""
    if head.approach not in (STATIC, MODES) or head.table_code not in (_EIGENVECTOR, _DISPLACEMENT):
        return None
    if head.is_thermal or head.superelement:
        return None
    record = op2.record(body)
    o, w = op2.order, op2.word
    dtype = np.dtype([("key", f"{o}i{w}"), ("type", f"{o}i{w}"), ("shape", f"{o}f{w}", 6)])
    if head.words_per_row != 8 or record.size % dtype.itemsize:
        raise damaged(op2, table, f"rows of {head.words_per_row} words in a record of {record.size // w}, not 8")
    rows = record.view(dtype)
    rows = rows[rows["type"] == _GRID]
    if not is_sound(rows["shape"]).all():
        raise damaged(op2, table, f"mode {head.mode} holds a value that is no number")
    node = _nodes(op2, table, rows["key"])
    if np.unique(node).size < node.size:
        raise damaged(op2, table, f"a grid is given twice in mode {head.mode}")
    return ShapeBlock(*head.key, node, rows["shape"].astype(f"=f{w}"))


def _eigenvalues(op2: Op2File, table: Op2Table, head: Identification, body: Record) -> list[Eigenvalue]:
    """Frequencies and generalised masses of the eigenvalue summary, 7 words a mode; none of load factors."""
    if head.approach in ANALYSES and head.approach not in (STATIC, MODES):
        return []
    record = op2.record(body)
    o, w = op2.order, op2.word
    dtype = np.dtype([("mode", f"{o}i{w}"), ("order", f"{o}i{w}"), ("value", f"{o}f{w}", 5)])
    if record.size % dtype.itemsize:
        raise damaged(op2, table, f"a record of {record.size // w} words is no whole number of 7-word rows")
    found = []
    for row in record.view(dtype):
        eigenvalue, omega, frequency, mass, _ = (float(v) for v in row["value"])
        if row["mode"] < 1 or not is_sound(row["value"]).all() or mass < 0:
            raise damaged(
                op2, table, f"mode {row['mode']} with eigenvalue {eigenvalue:g} and mass {mass:g} is impossible"
            )
        is_zero = eigenvalue < 0 and omega == frequency == 0  # what some solvers state for rigid modes
        size = np.sqrt(abs(eigenvalue))
        if not is_zero and not np.allclose(np.abs([omega, 2 * np.pi * frequency]), size, rtol=1e-3, atol=1e-6):
            raise damaged(
                op2, table, f"eigenvalue {eigenvalue:g} and {frequency:g} Hz of mode {row['mode']} contradict"
            )
        found.append(Eigenvalue(head.subcase, int(row["mode"]), frequency_of(eigenvalue), mass, eigenvalue))
    return found
