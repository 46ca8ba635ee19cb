"""The body of a finished result, read again from inputs that may not have changed since."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from fatigue.case import load_case
from fatigue.errors import DataError, Problem, refuse
from fatigue.pipeline.solve.body import Body, conversion_file, read_body, register_file
from fatigue.results import case_of, changed_inputs, named_case, new_inputs


def assessed_body(record: Mapping[str, Any], folder: Path, case_file: Path | None) -> Body:
    """Body of the result in a folder with this provenance record, read again; ``case_file``: None where it says.

    Raises
    ------
    DataError : the case or an input is gone or has changed since
    """
    path = case_of(record, folder) if case_file is None else named_case(record, case_file)
    if not path.is_file():
        what, remedy = "the case of this result is not there any more", "Name the case file with --case CASE"
        raise DataError(Problem("missing_case", str(path), what, remedy))
    refuse(DataError, changed_inputs(record, path))
    case = load_case(path)
    refuse(DataError, new_inputs(record, filter(None, [register_file(case), conversion_file(case)])))
    return read_body(case, strict=False)
