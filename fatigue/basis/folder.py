"""The folder of a basis: its tables, its page and its record, in place of those before and of nothing else."""

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

from fatigue.basis.page import PAGE, basis_page
from fatigue.basis.summary import Basis
from fatigue.files.hashes import sha256
from fatigue.files.recorded import Filled
from fatigue.results.dictionary.basis import BASIS
from fatigue.results.plain_tables import fill, table_files

RECORD = "basis.json"
FILLED = Filled("fatigue basis", "basis", RECORD, (*table_files(tuple(BASIS)), PAGE))
FILES = (*FILLED.files, RECORD)


def write_basis(folder: Path, found: Basis, inputs: Sequence[Path], *, csv: bool) -> list[str]:
    """Write tables, page and record; returns their names.

    What an earlier run wrote and this one does not is removed. The record has the SHA-256 of every file.

    Raises
    ------
    DataError : the disk is full or the place cannot be written
    """
    said = {
        "title": found.title,
        "inputs": {path.name: sha256(path) for path in inputs},
        "said": {f.table: {"said": list(f.said), "notes": list(f.notes)} for f in found.findings},
        "warnings": [asdict(problem) for problem in found.warnings],
    }
    tables = {f.table: (BASIS[f.table], f.rows) for f in found.findings if f.rows}
    return fill(folder, FILLED, tables, {PAGE: basis_page(found)}, said, csv=csv)
