"""Grid point forces, mode shapes, frequencies and generalised masses from a NASTRAN or OptiStruct OP2 file."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem
from fatigue.readers.fe_results import REQUEST, Eigenvalue, FeResults, ForceBlock, ShapeBlock, assemble, is_sound
from fatigue.readers.op2_records import Op2File, Op2Table, Span, read_records

_FORCE_TABLES = ("OGPFB1",)
_SORT2_TABLES = ("OGPFB2",)
_SHAPE_TABLES = ("OUGV1", "OUG1")
_EIGENVALUE_TABLES = ("LAMA", "LAMAS")
_APPROACHES = {
    1: "static",
    2: "real eigenvalues",
    3: "differential stiffness",
    4: "differential stiffness",
    5: "frequency response",
    6: "transient response",
    7: "pre-buckling",
    8: "post-buckling",
    9: "complex eigenvalues",
    10: "nonlinear statics",
    11: "geometric nonlinear statics",
    12: "contran",
}
_STATIC, _MODES = 1, 2
_GRID_POINT_FORCE, _EIGENVECTOR, _DISPLACEMENT = 19, 7, 1
_GRID = 1
_ID_WORDS = 146


@dataclass(frozen=True, slots=True)
class _Identification:
    """The words of an identification record that say what the next record holds."""

    approach: int
    device: int
    table_code: int
    subcase: int
    mode: int
    words_per_row: int
    text: str


def read_op2(path: Path, subcase: int | None = None) -> FeResults:
    """Read the grid point forces of a real modal run or of static subcases.

    Both word sizes and both byte orders are read.

    Raises
    ------
    DataError : damaged file, no OGPFB1 table, complex or other than modal and static results, superelements, SORT2
    """
    op2 = read_records(path)
    forces: list[ForceBlock] = []
    shapes: list[ShapeBlock] = []
    eigenvalues: dict[int, Eigenvalue] = {}
    for table in op2.tables:
        if table.name in _FORCE_TABLES:
            forces += [_force_block(op2, table, *pair) for pair in _pairs(op2, table)]
        elif table.name in _SHAPE_TABLES:
            shapes += [block for pair in _pairs(op2, table) if (block := _shape_block(op2, table, *pair))]
        elif table.name in _EIGENVALUE_TABLES:
            for _, record in _pairs(op2, table):
                eigenvalues |= _eigenvalues(op2, table, record)
    if not forces:
        raise _without_forces(op2)
    return assemble(str(path), op2.label, forces, shapes, eigenvalues, subcase)


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
    return DataError(
        Problem("no_forces", str(op2.path), f"no grid point forces (table OGPFB1); tables found: {found}", REQUEST)
    )


def _pairs(op2: Op2File, table: Op2Table) -> list[tuple[_Identification, NDArray[np.uint8]]]:
    """Identification and data record of every block of a results table."""
    if len(table.records) % 2:
        raise _damaged(op2, table, f"{len(table.records)} records where pairs were expected")
    pairs = zip(table.records[::2], table.records[1::2], strict=True)
    return [(_identification(op2, table, head), op2.record(body)) for head, body in pairs]


def _damaged(op2: Op2File, table: Op2Table, found: str) -> DataError:
    """Refusal of a table whose content contradicts itself."""
    return DataError(
        Problem(
            "op2_table_damaged",
            f"{op2.path}, table {table.name}",
            found,
            "Copy the file again in binary mode, or repeat the run",
        )
    )


def _identification(op2: Op2File, table: Op2Table, head: tuple[Span, ...]) -> _Identification:
    """Decode an identification record."""
    record = op2.record(head)
    if record.size != _ID_WORDS * op2.word:
        raise _damaged(op2, table, f"an identification record of {record.size // op2.word} words, not {_ID_WORDS}")
    words = record.view(f"{op2.order}i{op2.word}")
    if op2.word == 8:
        record = record.reshape(-1, 8)[:, :4].ravel()  # four characters in each word
    return _Identification(
        approach=int(words[0]) // 10,
        device=int(words[0]) % 10,
        table_code=int(words[1]),
        subcase=int(words[3]),
        mode=int(words[4]),
        words_per_row=int(words[9]),
        text=record[200:].tobytes().decode("latin-1"),
    )


def _force_block(op2: Op2File, table: Op2Table, head: _Identification, record: NDArray[np.uint8]) -> ForceBlock:
    """Rows of one mode; refuses everything that is not a real SORT1 grid point force balance."""
    where = f"{op2.path}, {table.name} subcase {head.subcase}"
    if head.approach not in (_STATIC, _MODES):
        raise DataError(
            Problem(
                "wrong_analysis",
                where,
                f"the forces belong to a solution of type {_APPROACHES.get(head.approach, head.approach)}",
                REQUEST,
            )
        )
    if head.table_code >= 1000 or head.words_per_row == 16:
        raise DataError(
            Problem("complex_forces", where, "the forces are complex or sorted by node (SORT2)", "Request REAL, SORT1")
        )
    if "SUPERELEMENT" in head.text and not head.text.split("SUPERELEMENT", 1)[1].lstrip().startswith("0"):
        raise DataError(
            Problem(
                "superelement",
                where,
                "the forces belong to a superelement: " + " ".join(head.text.split("SUPERELEMENT", 1)[1].split()[:1]),
                "Run the model without superelements, or give the residual structure that holds the welds",
            )
        )
    if head.table_code != _GRID_POINT_FORCE or head.words_per_row != 10:
        raise _damaged(
            op2, table, f"table code {head.table_code} with {head.words_per_row} words in a row, not 19 with 10"
        )
    if head.subcase < 1 or (head.approach == _MODES) != (head.mode > 0):
        raise _damaged(op2, table, f"subcase {head.subcase} mode {head.mode} is impossible")
    o, w = op2.order, op2.word
    dtype = np.dtype([("key", f"{o}i{w}"), ("element", f"{o}i{w}"), ("kind", f"S{2 * w}"), ("force", f"{o}f{w}", 6)])
    if record.size % dtype.itemsize:
        raise _damaged(op2, table, f"a record of {record.size // w} words is no whole number of rows")
    rows = record.view(dtype)
    node = _nodes(op2, table, head, rows["key"])
    return ForceBlock(
        f"{where} mode {head.mode}" if head.mode else where,
        head.subcase,
        head.mode,
        node,
        rows["element"].astype(np.int64),
        _kinds(op2, table, rows["kind"]),
        rows["force"].astype(f"=f{w}"),
    )


def _nodes(op2: Op2File, table: Op2Table, head: _Identification, key: NDArray[np.signedinteger]) -> NDArray[np.int64]:
    """Grid ids of keys 10 x grid + device code, the device being that of the identification."""
    if (key % 10 != head.device).any() or (key < 10).any():
        bad = key[(key % 10 != head.device) | (key < 10)][0]
        raise _damaged(op2, table, f"the key {bad} is no grid of device {head.device}, as in superelement results")
    return np.asarray(key // 10, np.int64)


def _kinds(op2: Op2File, table: Op2Table, raw: NDArray[np.bytes_]) -> NDArray[np.str_]:
    """Row names, every distinct one decoded once."""
    distinct, which = np.unique(raw, return_inverse=True)
    names = []
    for name in distinct.tolist():
        text = name if op2.word == 4 else name[:4] + name[8:12]
        if not (text.isascii() and text.decode("ascii").isprintable()):
            raise _damaged(op2, table, f"a row is named {text!r}")
        names.append(text.decode("ascii").strip())
    return np.array(names, dtype=np.str_)[which]


def _shape_block(op2: Op2File, table: Op2Table, head: _Identification, record: NDArray[np.uint8]) -> ShapeBlock | None:
    """Mode shape of one mode; None for what the audit has no use for."""
    if head.approach not in (_STATIC, _MODES) or head.table_code not in (_EIGENVECTOR, _DISPLACEMENT):
        return None
    o, w = op2.order, op2.word
    dtype = np.dtype([("key", f"{o}i{w}"), ("type", f"{o}i{w}"), ("shape", f"{o}f{w}", 6)])
    if head.words_per_row != 8 or record.size % dtype.itemsize:
        raise _damaged(op2, table, f"rows of {head.words_per_row} words in a record of {record.size // w}, not 8")
    rows = record.view(dtype)
    rows = rows[rows["type"] == _GRID]
    if not is_sound(rows["shape"]).all():
        raise _damaged(op2, table, f"mode {head.mode} holds a value that is no number")
    node = _nodes(op2, table, head, rows["key"])
    if np.unique(node).size < node.size:
        raise _damaged(op2, table, f"a grid is given twice in mode {head.mode}")
    mode = head.mode if head.approach == _MODES else 0
    return ShapeBlock(head.subcase, mode, node, rows["shape"].astype(f"=f{w}"))


def _eigenvalues(op2: Op2File, table: Op2Table, record: NDArray[np.uint8]) -> dict[int, Eigenvalue]:
    """Frequencies and generalised masses of the eigenvalue summary: 7 words a mode."""
    o, w = op2.order, op2.word
    dtype = np.dtype([("mode", f"{o}i{w}"), ("order", f"{o}i{w}"), ("value", f"{o}f{w}", 5)])
    if record.size % dtype.itemsize:
        raise _damaged(op2, table, f"a record of {record.size // w} words is no whole number of 7-word rows")
    found = {}
    for row in record.view(dtype):
        eigenvalue, omega, frequency, mass, _ = (float(v) for v in row["value"])
        if row["mode"] < 1 or not is_sound(row["value"]).all() or mass < 0:
            raise _damaged(
                op2, table, f"mode {row['mode']} with eigenvalue {eigenvalue:g} and mass {mass:g} is impossible"
            )
        if not np.allclose([omega, 2 * np.pi * frequency], np.sqrt(abs(eigenvalue)), rtol=1e-3, atol=1e-6):
            raise _damaged(
                op2, table, f"eigenvalue {eigenvalue:g} and {frequency:g} Hz of mode {row['mode']} contradict"
            )
        found[int(row["mode"])] = Eigenvalue(float(np.sqrt(abs(eigenvalue)) / (2 * np.pi)), mass)
    return found
