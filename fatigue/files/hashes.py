"""Hashes that tell whether a file is still what it was."""

import hashlib
from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path


def sha256(path: Path | str) -> str:
    """SHA-256 of a file's content, in hexadecimal digits."""
    with Path(path).open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def hashes_of(paths: Iterable[Path]) -> dict[str, str]:
    """SHA-256 of files by their names; where several have one name, by their paths."""
    files = list(dict.fromkeys(paths))
    return {name: sha256(path) for name, path in zip(told_apart(files), files, strict=True)}


def told_apart(paths: Sequence[Path]) -> list[str]:
    """Names of files; of several that have one name their paths as they are given.

    >>> told_apart([Path("monday/ride.csv"), Path("tuesday/ride.csv"), Path("gauges.csv")])
    ['monday/ride.csv', 'tuesday/ride.csv', 'gauges.csv']
    """
    times = Counter(path.name for path in paths)
    return [path.name if times[path.name] == 1 else path.as_posix() for path in paths]
