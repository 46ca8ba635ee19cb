"""What a file that is asked for must not take the place of: tables and inputs of the result, and what is there."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from fatigue.errors import Problem
from fatigue.results import case_of
from fatigue.results.folder import DERIVED, RECORDS

ELSEWHERE = "Give another file with -o"


def in_the_way(
    output: Path, folder: Path, record: Mapping[str, Any], case_file: Path | None, *, force: bool
) -> Iterator[Problem]:
    """Refusal of a file that may not be written over: without ``force`` any, inputs and tables of the result always."""
    case = case_of(record, folder) if case_file is None else case_file
    inputs = [case, *(case.parent / str(one["file"]) for one in record["inputs"])]
    if output.is_dir():
        yield Problem("not_a_file", str(output), "is a folder, not a file", ELSEWHERE)
    elif output.name in (*DERIVED, *RECORDS) and output.resolve().parent == folder.resolve():
        yield Problem("foreign_file", str(output), "is the place of a file of the result", ELSEWHERE)
    elif not output.exists():
        return
    elif any(one.exists() and one.samefile(output) for one in inputs):
        yield Problem("input_in_the_way", str(output), "is an input of this result", ELSEWHERE)
    elif not force:
        yield Problem("foreign_file", str(output), "is there already", f"{ELSEWHERE}, or --force to overwrite it")
