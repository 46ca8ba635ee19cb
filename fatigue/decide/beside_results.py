"""A folder that is decided into: never one of the results that are read."""

from collections.abc import Iterable
from pathlib import Path

from fatigue.errors import DataError, Problem
from fatigue.files.recorded import ELSEWHERE


def refuse_results(folder: Path, results: Iterable[Path]) -> None:
    """Refuse to write into a folder of a result: it stays as it is.

    Raises
    ------
    DataError : the folder is one of the results, however either is spelled
    """
    if any(folder.exists() and one.exists() and folder.samefile(one) for one in results):
        what = "is one of the results that are read, which stay as they are"
        raise DataError(Problem("input_in_the_way", str(folder), what, ELSEWHERE))
