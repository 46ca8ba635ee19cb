"""The folder of a basis: its tables, its page and its record, in place of those before and of nothing else."""

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

from fatigue import __version__
from fatigue.basis.finding import Finding
from fatigue.basis.page import PAGE, basis_page
from fatigue.basis.summary import Basis
from fatigue.basis.tables import write_csv, write_table
from fatigue.files.hashes import sha256
from fatigue.files.mishaps import refused_writing
from fatigue.files.recorded import Filled, put_in_place
from fatigue.files.whole import staged
from fatigue.results import write_json
from fatigue.results.dictionary.basis import BASIS

RECORD = "basis.json"
TABLE_FILES = tuple(f"{name}.{kind}" for name in BASIS for kind in ("parquet", "csv"))
FILLED = Filled("fatigue basis", "basis", RECORD, (*TABLE_FILES, PAGE))
FILES = (*FILLED.files, RECORD)


def write_basis(folder: Path, found: Basis, inputs: Sequence[Path], *, csv: bool) -> list[str]:
    """Write tables, page and record; returns their names.

    What an earlier run wrote and this one does not is removed. The record has the SHA-256 of every file.

    Raises
    ------
    DataError : the disk is full or the place cannot be written
    """
    with staged(folder, ".basis-") as stage:
        for finding in _with_rows(found.findings):
            write_table(stage, finding.table, finding.rows)
            if csv:
                write_csv(stage, finding.table, finding.rows)
        page = stage / PAGE
        with refused_writing(page):
            page.write_text(basis_page(found), encoding="utf-8", errors="backslashreplace", newline="\n")
        outputs = {path.name: sha256(path) for path in sorted(stage.iterdir())}
        record = {
            "program": FILLED.program,
            "version": __version__,
            "title": found.title,
            "inputs": {path.name: sha256(path) for path in inputs},
            "outputs": outputs,
            "said": {f.table: {"said": list(f.said), "notes": list(f.notes)} for f in found.findings},
            "warnings": [asdict(problem) for problem in found.warnings],
        }
        write_json(stage / RECORD, record)
        put_in_place(stage, folder, FILLED, outputs)
    return [*outputs, RECORD]


def _with_rows(findings: Sequence[Finding]) -> list[Finding]:
    return [finding for finding in findings if finding.rows]
