"""The files of a case with gauges: none of them is overwritten, and of all of them a record keeps the hash."""

from collections.abc import Iterable, Iterator
from pathlib import Path

from fatigue.case import Case
from fatigue.case.tables import GAUGE_FILES
from fatigue.files.hashes import hashes_of


def case_files(case: Case) -> Iterator[Path]:
    """The case, the files an assessment reads, and those that only gauges read; each once."""
    own = [getattr(case.body, key) for key in GAUGE_FILES] + [load.gauge_forces for load in case.body.unit_load]
    paths = (case.path, *case.input_files().values(), *(case.resolve(name) for name in own if name is not None))
    yield from dict.fromkeys(paths)


def input_hashes(case: Case, others: Iterable[Path]) -> dict[str, str]:
    """SHA-256 of the files of a case that are there, and of others."""
    return hashes_of([*(path for path in case_files(case) if path.is_file()), *others])
