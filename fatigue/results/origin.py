"""Where a result came from: the way to its case file, and whether case and inputs are still what they were."""

import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from fatigue.errors import DataError, Problem
from fatigue.files.hashes import sha256
from fatigue.files.naming import missing_case_of_result


def way_to_case(case_file: Path, folder: Path) -> str:
    """Path of a case file as seen from a result folder, so that both can be moved together.

    Links to the folders are followed, a link to the case file is not: its inputs lie beside the link. On another drive
    the path is absolute.
    """
    case_file, folder = _placed(case_file), folder.resolve()
    try:
        return Path(os.path.relpath(case_file, folder)).as_posix()
    except ValueError:  # Windows: no way from one drive to another
        return case_file.as_posix()


def case_of(record: Mapping[str, Any], folder: Path) -> Path:
    """Where the case of a result is, by its provenance; it need not be there any more."""
    return Path(os.path.normpath(folder.resolve() / record["case_path"]))


def is_same_case(case_file: Path, record: Mapping[str, Any], folder: Path) -> bool:
    """Tell whether a case file is the one of a result, perhaps edited since.

    It is when it is the file that the provenance leads to, however either is spelled. Where that file is gone, the case
    or the folder was moved: then it is when its text is the one that was assessed.
    """
    known = case_of(record, folder)
    if known.exists():
        return known == _placed(case_file) or known.samefile(case_file)
    text: str = record["case_text"]
    return _text(case_file) == text


def named_case(record: Mapping[str, Any], case_file: Path) -> Path:
    """Take the case file that a user names for a result.

    Raises
    ------
    DataError : there is no such file, or it is not the case that was assessed
    """
    if not case_file.is_file():
        raise DataError(missing_case_of_result(case_file))
    if _text(case_file) != record["case_text"]:
        what = f"is not the case of this result: its text differs from that of {record['case_file']} as it was assessed"
        remedy = "Name the case as it was assessed, or assess again"
        raise DataError(Problem("other_case", str(case_file), what, remedy))
    return case_file


def changed_inputs(record: Mapping[str, Any], case_file: Path) -> list[Problem]:
    """Name every input of a result that is not there any more, or not what it was, seen from its case file."""
    problems = []
    for known in record["inputs"]:
        is_case = known["file"] == record["case_file"]
        path = case_file if is_case else case_file.parent / known["file"]
        if path.is_file() and sha256(path) == known["sha256"]:
            continue
        what = "has changed since the assessment" if path.is_file() else "is not there any more"
        remedy = "Run the assessment again" + (", or name the case as it was with --case" if is_case else "")
        problems.append(Problem("changed_input", str(path), what, remedy))
    return problems


def new_inputs(record: Mapping[str, Any], paths: Iterable[Path]) -> list[Problem]:
    """Name files that the case of a result takes in without naming them, and that came after the assessment.

    ``paths`` are the register and the record of a conversion that lie beside the welds; they need not be there.
    """
    known = {entry["sha256"] for entry in record["inputs"]}
    what = "was not there when the result was computed"
    return [
        Problem("changed_input", str(path), what, "Run the assessment again, or take the file away")
        for path in paths
        if path.is_file() and sha256(path) not in known
    ]


def _placed(case_file: Path) -> Path:
    return case_file.parent.resolve() / case_file.name


def _text(path: Path) -> str | None:
    try:
        return path.read_bytes().decode("utf-8-sig")
    except (OSError, UnicodeDecodeError):
        return None
