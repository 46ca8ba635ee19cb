"""The inputs of a result: found again, compared with the hashes in its provenance; the case, parsed."""

import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem, refuse
from fatigue.files.hashes import sha256
from fatigue.results import case_of, is_assessed_case, new_inputs
from fatigue.verify.recount.inputs.register import WeldEntries, weld_entries
from fatigue.verify.recount.inputs.tables import read_frame


@dataclass(frozen=True, slots=True, eq=False)
class RecountInputs:
    """The case text, parsed, the folder its file names are relative to, and the welds to assess."""

    case: Mapping[str, Any]
    folder: Path
    register: WeldEntries

    def frame(self, key: str) -> pd.DataFrame:
        """Table of the body by its key in the case."""
        return read_frame(self.path(key))

    def path(self, key: str) -> Path:
        """File of one table of the body."""
        return self.folder / str(self.case["body"][key])


def open_inputs(record: Mapping[str, Any], result: Path, case_file: Path | None) -> RecountInputs:
    """Input files of a result, found and proven to be the very files it was computed from.

    Parameters
    ----------
    record : provenance of the result
    result : the result folder
    case_file : the case; None: where the provenance says

    Raises
    ------
    DataError : inputs are missing or changed; all of them are named
    """
    path = case_file or case_of(record, result)
    if not path.is_file():
        what, remedy = "the case of this result is not there", "Name the case file with --case CASE, or assess again"
        raise DataError(Problem("missing_input", str(path), what, remedy))
    refuse(DataError, _changes(record, path))
    case, folder = tomllib.loads(path.read_text(encoding="utf-8-sig")), path.parent
    beside = (folder / case["body"]["welds"]).parent
    refuse(DataError, new_inputs(record, [beside / "welds_register.csv"] * ("register" not in case["body"])))
    refuse(DataError, new_inputs(record, [beside / "convert.json"]))
    welds = read_frame(folder / case["body"]["welds"])
    return RecountInputs(case, folder, weld_entries(case, folder, welds))


def strength_factors(inputs: RecountInputs) -> list[dict[str, Any]]:
    """Rows of the table of factors on S-N curves; none where the case has no such table."""
    file = inputs.case.get("checks", {}).get("strength_factors")
    if file is None:
        return []
    frame = read_frame(inputs.folder / file)
    names = zip(texts(frame, "curve"), texts(frame, "role"), column(frame, "value").tolist(), strict=True)
    return [{"curve": curve, "role": role, "value": value} for curve, role, value in names]


def _changes(record: Mapping[str, Any], case_file: Path) -> Iterator[Problem]:
    """Problem of every input that is no longer what it was."""
    for known in record["inputs"]:
        path = case_file if known["file"] == record["case_file"] else case_file.parent / known["file"]
        if not path.is_file():
            yield Problem(
                "missing_input", str(path), "this input of the result is missing", "Put the file back, or assess again"
            )
        elif sha256(path) != known["sha256"] and not (path == case_file and is_assessed_case(record, path)):
            what = "is not the file the result was computed from (its SHA-256 differs from the one in provenance.json)"
            case = ", or name the case as it was with --case" if path == case_file else ""
            yield Problem("changed_input", str(path), what, f"Assess again, or put the old file back{case}")


def column(frame: pd.DataFrame, name: str, default: float = np.nan) -> NDArray[np.float64]:
    """Numbers of a column, (r,); the default where the cell is empty or the column absent."""
    if name not in frame:
        return np.full(len(frame), default)
    return np.asarray(frame[name].fillna(default))


def flags(frame: pd.DataFrame, name: str) -> NDArray[np.bool_]:
    """Whether each cell of a column is true, (r,); none is where the column is absent."""
    if name not in frame:
        return np.zeros(len(frame), dtype=bool)
    return np.asarray(frame[name].astype(str).str.strip().str.lower().isin(["true", "1", "1.0"]))


def texts(frame: pd.DataFrame, name: str) -> list[str]:
    """Texts of a column, empty where absent or empty."""
    if name not in frame:
        return [""] * len(frame)
    return [str(text).strip() for text in frame[name].astype(object).where(frame[name].notna(), "")]
