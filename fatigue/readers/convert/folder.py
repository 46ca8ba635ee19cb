"""Write a folder of neutral files whole or not at all, and never over files of somebody else."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.csv as pa_csv
import pyarrow.parquet as pq

from fatigue.errors import DataError, Problem, refuse
from fatigue.files.hashes import sha256
from fatigue.files.mishaps import refused_writing
from fatigue.files.whole import staged

RECORD = "convert.json"
"""Lists the files of a conversion with their hashes; what it lists unchanged may be written again."""

TABLES = (
    *("modes.csv", "nodes.parquet", "elements.parquet", "element_forces.parquet"),
    *("welds.csv", "weld_nodes.csv", "weld_elements.csv"),
)
"""What every conversion writes besides histories, register, case and record."""


def read_record(path: Path) -> dict[str, Any]:
    """What a conversion recorded: inputs with hashes, sign convention, audit, warnings.

    Raises
    ------
    DataError : the file is damaged
    """
    try:
        record = json.loads(path.read_text("utf-8"))
        return {name: record[name] for name in ("inputs", "convention", "audit", "remarks")}
    except (OSError, ValueError, KeyError, TypeError, RecursionError) as error:
        what = f"is no record of a conversion ({type(error).__name__}: {error})"
        raise DataError(Problem("damaged_record", str(path), what, "Convert again, or remove the file")) from None


def recorded_files(folder: Path) -> dict[str, str]:
    """Hash of every file that an earlier conversion wrote into a folder; none where there was none."""
    try:
        files: dict[str, str] = json.loads((folder / RECORD).read_text("utf-8"))["files"]
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return {}
    return files


def check_folder(folder: Path, names: list[str], editable: str) -> None:
    """Refuse to write over files that an earlier conversion did not write, or that were changed since.

    Parameters
    ----------
    names : files that will be written
    editable : file that is meant to be edited, and was read before

    Raises
    ------
    DataError : ``folder`` is a file, or holds such files
    """
    if folder.exists() and not folder.is_dir():
        raise DataError(Problem("not_a_folder", str(folder), "this is a file", "Name a folder"))
    own = recorded_files(folder)
    problems = []
    for name in names:
        path = folder / name
        if name in (RECORD, editable) and own:
            continue
        if path.exists() and own.get(name) != sha256(path):
            what = "was changed since it was converted" if name in own else "is not the work of an earlier conversion"
            problems.append(
                Problem("foreign_file", str(path), f"the file exists and {what}", "Use --force, or another folder")
            )
    refuse(DataError, problems)


def write_folder(
    folder: Path, files: Mapping[str, pa.Table | str], record: Mapping[str, Any], last: str, kept: Mapping[str, str]
) -> None:
    """Write tables (by suffix) and texts into a folder beside the target, then move them in, ``last`` at the very end.

    ``kept`` are hashes of files that stay, as an earlier conversion wrote them.

    Raises
    ------
    DataError : the folder cannot be written
    """
    with staged(folder, ".convert-") as stage:
        for name, content in files.items():
            with refused_writing(folder / name):
                _write(stage / name, content)
        hashes = {**kept, **{name: sha256(stage / name) for name in sorted(files)}}
        text = json.dumps({**record, "files": hashes}, indent=1, allow_nan=False) + "\n"
        with refused_writing(folder / RECORD):
            (stage / RECORD).write_text(text, "utf-8")
        for name in sorted([*files, RECORD], key=lambda n: (n == last, n)):
            (stage / name).replace(folder / name)


def _write(path: Path, content: pa.Table | str) -> None:
    if isinstance(content, str):
        path.write_text(content, "utf-8", newline="\n")
    elif path.suffix == ".csv":
        pa_csv.write_csv(content, path)
    else:
        pq.write_table(content, path, compression="zstd")
