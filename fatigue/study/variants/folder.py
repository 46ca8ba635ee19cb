"""The folder of a study: tables, page and record, in place of those before and of nothing else, and ``runs``."""

from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import Any

from fatigue.errors import DataError, Problem, refuse
from fatigue.files.mishaps import refused_writing
from fatigue.files.recorded import AWAY, ELSEWHERE, Filled, in_the_way
from fatigue.results.dictionary.claims import CLAIMED
from fatigue.results.dictionary.study import STUDY
from fatigue.results.plain_tables import fill, table_files
from fatigue.study.variants.runs.planned_runs import RUNS
from fatigue.study.variants.tables import Tables

RECORD, PAGE = "study.json", "study.html"
BEGUN = ".fatigue-study"  # says whose runs are below ``runs``
FILLED = Filled("fatigue study run", "study", RECORD, (*table_files((*STUDY, *CLAIMED)), PAGE))


def refuse_foreign(folder: Path, *, force: bool, inputs: Collection[Path]) -> None:
    """Refuse to overwrite or remove what ``fatigue study run`` did not write as it is, and any input of the study.

    Raises
    ------
    DataError : everything in the way; with ``force`` only folders and inputs are
    """
    problems = list(in_the_way(folder, FILLED, force=force, inputs=inputs))
    runs = folder / RUNS
    inside = [one for one in inputs if one.resolve().is_relative_to(runs.resolve())]
    what = "is an input below the runs of a study"
    problems += [Problem("input_in_the_way", str(one), what, ELSEWHERE) for one in inside]
    if not force and FILLED.outputs(folder) is None and runs.exists() and not (folder / BEGUN).is_file():
        problems.append(Problem("foreign_files", str(runs), "is there already and is not of a study", AWAY))
    refuse(DataError, problems)


def begin(folder: Path) -> None:
    """Say that what is below ``runs`` belongs to a study.

    Raises
    ------
    DataError : the place cannot be written
    """
    with refused_writing(folder):
        (folder / BEGUN).write_text(f"{FILLED.program}\n", encoding="utf-8", newline="\n")


def write_study(folder: Path, tables: Tables, page: str | None, record: Mapping[str, Any], *, csv: bool) -> list[str]:
    """Write tables, page and record; returns their names.

    What an earlier run wrote and this one does not is removed. The record has the SHA-256 of every file.

    Raises
    ------
    DataError : the disk is full or the place cannot be written
    """
    pages = {} if page is None else {PAGE: page}
    return fill(folder, FILLED, tables, pages, record, csv=csv)


def left_over(folder: Path, runs: Sequence[Path]) -> list[str]:
    """Folders of variants below ``runs`` that the study no longer has."""
    known = {path.parent.name for path in runs}
    there = (folder / RUNS).iterdir() if (folder / RUNS).is_dir() else ()
    return sorted(path.name for path in there if path.is_dir() and path.name not in known)
