"""Hashes by which a run is known: of its inputs, its settings and the software, never of where anything lies."""

import hashlib
import json
import math
from collections.abc import Mapping
from pathlib import Path
from threading import Lock
from typing import Any

from fatigue.errors import DataError
from fatigue.files.hashes import sha256
from fatigue.files.mishaps import refusal
from fatigue.results import software_versions


class Hashes:
    """SHA-256 of files, each read once in a study; threads may share it."""

    def __init__(self) -> None:
        self._known: dict[Path, str] = {}
        self._lock = Lock()

    def of(self, path: Path) -> str:
        """SHA-256 of a file that no run writes.

        Raises
        ------
        DataError : it cannot be read
        """
        with self._lock:
            known = self._known.get(path)
        if known is None:
            known = file_hash(path)
            with self._lock:
                self._known[path] = known
        return known

    def of_all(self, files: Mapping[str, Path]) -> dict[str, str]:
        """SHA-256 of files by their names."""
        return {name: self.of(path) for name, path in files.items()}


def file_hash(path: Path) -> str:
    """SHA-256 of a file.

    Raises
    ------
    DataError : it cannot be read
    """
    try:
        return sha256(path)
    except OSError as error:
        raise DataError(refusal(error, path)) from None


def key_of(record: Mapping[str, Any]) -> str:
    """Key of a run: equal for equal records and equal software."""
    text = json.dumps({**record, "software": software_versions()}, sort_keys=True, default=repr)
    return hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()


def are_unchanged(folder: Path, known: Mapping[str, str]) -> bool:
    """Whether files of a folder are there and as they were."""
    try:
        return all(sha256(folder / name) == digits for name, digits in known.items())
    except OSError:
        return False


def files_below(folder: Path) -> list[Path]:
    """Files of a folder and those in it, in one order."""
    return sorted(path for path in folder.rglob("*") if path.is_file())


def as_json(value: float) -> float | str | None:
    """A number as a record has it: NaN is null, infinite is a word."""
    if math.isnan(value):
        return None
    return value if math.isfinite(value) else ("inf" if value > 0.0 else "-inf")


def from_json(value: float | str | None) -> float:
    """A number of a record."""
    return math.nan if value is None else float(value)
