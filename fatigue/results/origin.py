"""Where a result came from: the way to its case file, and whether case and inputs are still what they were.

A case holds keys that no assessment reads: who answers for the report, the channels of its events, how a ride is
judged, what a modal basis is compared with, what strain gauges are read from. They may come, change and go: the case is
the one that was assessed all the same.
"""

import json
import os
import tomllib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from fatigue.errors import DataError, Problem, refuse
from fatigue.files.hashes import sha256
from fatigue.files.naming import missing_case_of_result

NOT_ASSESSED = (
    "report",
    "ride",
    "mission.event.channel",
    "body.participation",
    "body.total_mass_t",
    "body.inertia_t_mm2",
    "body.interface_shapes",
    "body.flexibility",
    "body.gauge_forces",
    "body.properties",
    "body.unit_load.gauge_forces",
)


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
    """Whether a case file is the one of a result, perhaps edited since.

    It is if it is the file that the provenance leads to, however either is spelled. Where that file is gone, the case
    or the folder was moved: then the case in the file has to be the one that was assessed.
    """
    known = case_of(record, folder)
    if known.exists():
        return known == _placed(case_file) or known.samefile(case_file)
    return is_assessed_case(record, case_file)


def is_assessed_case(record: Mapping[str, Any], case_file: Path) -> bool:
    """Whether a file has the text that was assessed, or a case that differs from it only in ``NOT_ASSESSED`` keys."""
    text: str = record["case_text"]
    found = _text(case_file)
    return found is not None and (found == text or _assessed_keys(found) == _assessed_keys(text) is not None)


def _assessed_keys(text: str) -> str | None:
    """Keys and values of a case that an assessment reads, each with its type, in one order; None of what is no case."""
    try:
        case = tomllib.loads(text)
        for path in NOT_ASSESSED:
            *tables, key = path.split(".")
            for table in _tables(case, tables):
                table.pop(key, None)
        return json.dumps(case, sort_keys=True, default=repr)
    except (ValueError, RecursionError):
        return None


def _tables(value: object, keys: Sequence[str]) -> Iterator[dict[str, Any]]:
    """Tables at a place of a case, each of a list of them."""
    for item in value if isinstance(value, list) else [value]:
        if isinstance(item, dict) and keys:
            yield from _tables(item.get(keys[0]), keys[1:])
        elif isinstance(item, dict):
            yield item


def named_case(record: Mapping[str, Any], case_file: Path) -> Path:
    """Case file that a user names for a result.

    Raises
    ------
    DataError : there is no such file, or it is not the case that was assessed
    """
    if not case_file.is_file():
        raise DataError(missing_case_of_result(case_file))
    refuse(DataError, _unreadable(case_file))
    if not is_assessed_case(record, case_file):
        what = f"is not the case of this result: its text differs from that of {record['case_file']} as it was assessed"
        remedy = "Name the case as it was assessed, or assess again"
        raise DataError(Problem("other_case", str(case_file), what, remedy))
    return case_file


def _unreadable(case_file: Path) -> Iterator[Problem]:
    """Refusal of a case that was edited into something that is no TOML: of it no one can say that it differs."""
    try:
        tomllib.loads(_text(case_file) or "")
    except tomllib.TOMLDecodeError as error:
        yield Problem(
            "toml_syntax", str(case_file), f"not valid TOML: {error}", "Correct the line; `fatigue check` says more"
        )
    except (ValueError, RecursionError):
        return


def changed_inputs(record: Mapping[str, Any], case_file: Path) -> list[Problem]:
    """Refusal of every input of a result that is gone or has changed; the paths start at the case file.

    Of the case itself it is what an assessment reads of it that counts.
    """
    problems = []
    for known in record["inputs"]:
        is_case = known["file"] == record["case_file"]
        path = case_file if is_case else case_file.parent / known["file"]
        if path.is_file() and (sha256(path) == known["sha256"] or (is_case and is_assessed_case(record, path))):
            continue
        what = "has changed since the assessment" if path.is_file() else "is not there any more"
        remedy = "Run the assessment again" + (", or name the case as it was with --case" if is_case else "")
        problems.append(Problem("changed_input", str(path), what, remedy))
    return problems


def new_inputs(record: Mapping[str, Any], paths: Iterable[Path]) -> list[Problem]:
    """Refusal of files that the case of a result takes in without naming them, and that came after the assessment.

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
