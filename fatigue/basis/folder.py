"""The folder of a basis: its tables, its page and its record, in place of those before and of nothing else."""

import json
from collections.abc import Collection, Sequence
from dataclasses import asdict
from pathlib import Path

from fatigue import __version__
from fatigue.basis.finding import Finding
from fatigue.basis.page import PAGE, basis_page
from fatigue.basis.summary import Basis
from fatigue.basis.tables import write_csv, write_table
from fatigue.errors import DataError, Problem, refuse
from fatigue.files.hashes import sha256
from fatigue.files.mishaps import refused_writing
from fatigue.files.whole import staged
from fatigue.results import write_json
from fatigue.results.dictionary.basis import BASIS

RECORD = "basis.json"
TABLE_FILES = tuple(f"{name}.{kind}" for name in BASIS for kind in ("parquet", "csv"))
FILES = (*TABLE_FILES, PAGE, RECORD)
PROGRAM = "fatigue basis"


def refuse_foreign(folder: Path, *, force: bool, inputs: Collection[Path]) -> None:
    """Refuse to overwrite or remove what ``fatigue basis`` did not write as it is, and any input of the case.

    Raises
    ------
    DataError : everything in the way; with ``force`` only folders and inputs are
    """
    if folder.exists() and not folder.is_dir():
        raise DataError(Problem("not_a_folder", str(folder), "is a file, not a folder", "Give another folder with -o"))
    another, known = "Give another folder with -o", _written(folder)
    problems = []
    for path in (folder / name for name in FILES):
        if not path.exists():
            continue
        if path.is_dir():
            what = "is a folder where a file of the basis has its place"
            problems.append(Problem("foreign_files", str(path), what, "Move it away"))
        elif any(one.exists() and path.samefile(one) for one in inputs):
            problems.append(Problem("input_in_the_way", str(path), "is an input of this case", another))
        elif not force and (known is None if path.name == RECORD else (known or {}).get(path.name) != sha256(path)):
            what = "is there already and was not written by fatigue basis, or was changed since"
            remedy = f"Move it away, or --force to overwrite it. {another}"
            problems.append(Problem("foreign_files", str(path), what, remedy))
    refuse(DataError, problems)


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
            "program": PROGRAM,
            "version": __version__,
            "title": found.title,
            "inputs": {path.name: sha256(path) for path in inputs},
            "outputs": outputs,
            "said": {f.table: {"said": list(f.said), "notes": list(f.notes)} for f in found.findings},
            "warnings": [asdict(problem) for problem in found.warnings],
        }
        write_json(stage / RECORD, record)
        with refused_writing(folder):
            for name in FILES:
                if name not in outputs:
                    (folder / name).unlink(missing_ok=True)
            for name in (*outputs, RECORD):
                (stage / name).replace(folder / name)
    return [*outputs, RECORD]


def _with_rows(findings: Sequence[Finding]) -> list[Finding]:
    return [finding for finding in findings if finding.rows]


def _written(folder: Path) -> dict[str, str] | None:
    """SHA-256 of what the record of an earlier run lists, by name; None where there is no such record."""
    try:
        record = json.loads((folder / RECORD).read_text(encoding="utf-8"))
        return dict(record["outputs"]) if record["program"] == PROGRAM else None
    except (OSError, ValueError, LookupError, TypeError, RecursionError):
        return None
