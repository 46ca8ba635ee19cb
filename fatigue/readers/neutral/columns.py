"""Columns of an open file of any format, each read when it is asked for; and what is said of a damaged file."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from fatigue.errors import Problem
from fatigue.files.mishaps import is_of_the_system, refusal

DAMAGE = (pa.ArrowException, OSError, UnicodeDecodeError)  # what Arrow raises over bytes that make no sense


@dataclass(frozen=True, slots=True, eq=False)
class Columns:
    """An open file: names and types of its columns, number of rows, and how to read one column by its position.

    ``numbers``, (r,), are the rows' own numbers in the file, from 0; None where the rows are the whole file.
    ``warnings`` were met while it was opened; ``units`` are what the metadata of a Parquet file states for the columns.
    """

    names: tuple[str, ...]
    kinds: tuple[pa.DataType, ...]
    rows: int
    read: Callable[[int], pa.ChunkedArray]
    numbers: NDArray[np.int64] | None = None
    warnings: tuple[Problem, ...] = ()
    units: tuple[str, ...] = ()


def damaged(path: Path, error: Exception) -> Problem:
    """Say that a file, or a part of it, cannot be decoded, and why; or that the system does not let it be read."""
    if isinstance(error, OSError) and is_of_the_system(error):
        return refusal(error, path)
    kind = "Parquet" if path.suffix.lower() == ".parquet" else "CSV"
    reason = str(error).strip().splitlines()[0].rstrip(".")
    return Problem(
        "damaged_file", path.name, f"cannot be read as {kind}, it is damaged or cut short ({reason})", "Write it again"
    )
