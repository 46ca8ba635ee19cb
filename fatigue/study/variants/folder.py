"""The folder of a study: tables, page and record, in place of those before and of nothing else, and ``runs``."""

import json
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import Any

from fatigue import __version__
from fatigue.errors import DataError, Problem, refuse
from fatigue.files.hashes import sha256
from fatigue.files.mishaps import refused_writing
from fatigue.files.whole import replacing, staged
from fatigue.results import write_json
from fatigue.results.dictionary.claims import CLAIMED
from fatigue.results.dictionary.study import STUDY
from fatigue.study.variants.runs.planned_runs import RUNS
from fatigue.study.variants.tables import Tables, write_csv, write_table

RECORD, PAGE = "study.json", "study.html"
BEGUN = ".fatigue-study"  # says whose runs are below ``runs``
TABLE_FILES = tuple(f"{name}.{kind}" for name in (*STUDY, *CLAIMED) for kind in ("parquet", "csv"))
FILES = (*TABLE_FILES, PAGE, RECORD)
PROGRAM = "fatigue study run"


def refuse_foreign(folder: Path, *, force: bool, inputs: Collection[Path]) -> None:
    """Refuse to overwrite or remove what ``fatigue study run`` did not write as it is, and any input of the study.

    Raises
    ------
    DataError : everything in the way; with ``force`` only folders and inputs are
    """
    if folder.exists() and not folder.is_dir():
        raise DataError(Problem("not_a_folder", str(folder), "is a file, not a folder", "Give another folder with -o"))
    another, known = "Give another folder with -o", _written(folder)
    remedy = f"Move it away, or --force to overwrite it. {another}"
    problems = []
    for path in (folder / name for name in FILES):
        if not path.exists():
            continue
        if path.is_dir():
            what = "is a folder where a file of the study has its place"
            problems.append(Problem("foreign_files", str(path), what, "Move it away"))
        elif any(one.exists() and path.samefile(one) for one in inputs):
            problems.append(Problem("input_in_the_way", str(path), "is an input of this study", another))
        elif not force and (known is None if path.name == RECORD else (known or {}).get(path.name) != sha256(path)):
            what = "is there already and was not written by fatigue study run, or was changed since"
            problems.append(Problem("foreign_files", str(path), what, remedy))
    runs = folder / RUNS
    inside = [one for one in inputs if one.resolve().is_relative_to(runs.resolve())]
    problems += [
        Problem("input_in_the_way", str(one), "is an input below the runs of a study", another) for one in inside
    ]
    if not force and known is None and runs.exists() and not (folder / BEGUN).is_file():
        what = "is there already and is not of a study"
        problems.append(Problem("foreign_files", str(runs), what, remedy))
    refuse(DataError, problems)


def begin(folder: Path) -> None:
    """Say that what is below ``runs`` belongs to a study.

    Raises
    ------
    DataError : the place cannot be written
    """
    with refused_writing(folder):
        (folder / BEGUN).write_text(f"{PROGRAM}\n", encoding="utf-8", newline="\n")


def write_study(folder: Path, tables: Tables, page: str | None, record: Mapping[str, Any], *, csv: bool) -> list[str]:
    """Write tables, page and record; returns their names.

    What an earlier run wrote and this one does not is removed. The record has the SHA-256 of every file.

    Raises
    ------
    DataError : the disk is full or the place cannot be written
    """
    with staged(folder, ".study-") as stage:
        for name, (columns, rows) in tables.items():
            write_table(stage, name, columns, rows)
            if csv:
                write_csv(stage, name, columns, rows)
        if page is not None:
            with replacing(stage / PAGE) as unfinished:
                unfinished.write_text(page, encoding="utf-8", errors="backslashreplace", newline="\n")
        outputs = {path.name: sha256(path) for path in sorted(stage.iterdir())}
        write_json(stage / RECORD, {"program": PROGRAM, "version": __version__, **record, "outputs": outputs})
        with refused_writing(folder):
            for name in FILES:
                if name not in outputs:
                    (folder / name).unlink(missing_ok=True)
            for name in (*outputs, RECORD):
                (stage / name).replace(folder / name)
    return [*outputs, RECORD]


def left_over(folder: Path, runs: Sequence[Path]) -> list[str]:
    """Folders of variants below ``runs`` that the study no longer has."""
    known = {path.parent.name for path in runs}
    there = (folder / RUNS).iterdir() if (folder / RUNS).is_dir() else ()
    return sorted(path.name for path in there if path.is_dir() and path.name not in known)


def _written(folder: Path) -> dict[str, str] | None:
    """SHA-256 of what the record of an earlier run lists, by name; None where there is no such record."""
    try:
        record = json.loads((folder / RECORD).read_text(encoding="utf-8"))
        return dict(record["outputs"]) if record["program"] == PROGRAM else None
    except (OSError, ValueError, LookupError, TypeError, RecursionError):
        return None
