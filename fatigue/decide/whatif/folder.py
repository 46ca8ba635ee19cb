"""The folder of a what-if: its tables, its page and its record, in place of those before and of nothing else."""

from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path

from fatigue.decide.whatif.page import PAGE, whatif_page
from fatigue.decide.whatif.summary import WhatIf
from fatigue.errors import DataError, Problem
from fatigue.files import recorded
from fatigue.files.recorded import Filled
from fatigue.results import read_provenance
from fatigue.results.dictionary.decided.whatif import WHATIFS
from fatigue.results.plain_tables import fill, table_files

RECORD = "whatif.json"
FILLED = Filled("fatigue whatif", "what-if", RECORD, (*table_files(tuple(WHATIFS)), PAGE))


def refuse_foreign(folder: Path, result: Path, case_file: Path | None, *, force: bool) -> None:
    """Refuse a folder that is the result itself, and to overwrite what the command did not write there.

    Raises
    ------
    DataError : everything in the way
    """
    if folder.exists() and folder.samefile(result):
        what = "is the result itself, which a what-if does not change"
        raise DataError(Problem("input_in_the_way", str(folder), what, "Give another folder with -o"))
    recorded.refuse_foreign(folder, FILLED, force=force, inputs=list(_inputs(result, case_file)))


def _inputs(result: Path, case_file: Path | None) -> Iterator[Path]:
    yield from result.glob("*")
    if case_file is not None:
        yield case_file


def write_whatif(folder: Path, found: WhatIf, result: Path, *, csv: bool) -> WhatIf:
    """Write tables, page and record; returns the same with their names.

    Raises
    ------
    DataError : the disk is full or the place cannot be written
    """
    record = read_provenance(result)
    said = {
        "title": found.title,
        "result": record.get("result", ""),
        "changes": list(found.changes),
        "recount_because": list(found.reasons),
        "target_km": found.target_km,
        "target_km_before": found.target_km_before,
        "points_by_basis": found.of_basis,
        "warnings": [asdict(problem) for problem in found.warnings],
    }
    rows = {"whatif": found.points, "whatif_welds": found.welds}
    tables = {name: (columns, rows[name]) for name, columns in WHATIFS.items()}
    written = fill(folder, FILLED, tables, {PAGE: whatif_page(found)}, said, csv=csv)
    return found.with_files(tuple(str(folder / name) for name in written))
